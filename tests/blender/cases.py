"""Cases for an interpreter that has bpy, run by tests/blender/test_blender.py. Each renders through bpy.ops.render.render.

usage: PYTHON cases.py [NAME ...]   Environment: as in tests/cli/support.py."""
import contextlib
import io
import math
import os
import queue
import sys
import threading
import unittest
from unittest import mock

import bpy
import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "..", "cli"), os.path.join(HERE, "..", "..", "tools", "blender")]
import exr_parts  # noqa: E402
import scenes  # noqa: E402
from polling import GUARD  # noqa: E402
from support import ENVIRONMENT, ECLAT, Case, eclat, read_exr  # noqa: E402

os.environ.update({name: ENVIRONMENT[name] for name in ("XDG_CACHE_HOME", "ECLAT_COMPILE", "ECLAT_KERNELS")}, ECLAT=os.path.abspath(ECLAT))
import eclat_blender  # noqa: E402
from eclat_blender import final, glb, losses, main_thread  # noqa: E402

eclat_blender.register()
SINGLE = numpy.float32  # Blender keeps 32-bit floats
WORDS = ["--size=48x32", "--spp=16", "--lanes=4", "--effects=all"]


class Scene(Case):
    def setUp(self):
        super().setUp()
        final.teller = losses.Teller()

    def render(self, made, name="a.exr", **how):
        """Returns Blender's picture, all passes as 32-bit floats: attributes, and planes by their names after the view layer's."""
        settings, scene = made.render.image_settings, made
        if hasattr(settings, "media_type"):
            settings.media_type = "MULTI_LAYER_IMAGE"
        settings.file_format, settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
        scene.render.filepath, scene.eclat.keep = self.path(name), self.path("kept")
        scene.render.use_file_extension = False
        bpy.ops.render.render("EXEC_DEFAULT", write_still=True, **how)
        return self.read(self.path(name))

    def read(self, path):
        attributes, planes = exr_parts.read(path)
        return attributes, {plane.split(".", 1)[1]: values for plane, values in planes.items()}

    def kept(self, name, frame=1, layer="ViewLayer"):
        return self.path("kept", f"{layer}.{frame:04d}", name)

    def compare(self, planes, words, frame=1, channels=()):
        """Checks that Blender's picture equals, bit for bit, the program's picture of the exported file with these options, which are
        written by hand."""
        words = [word.replace("KEPT", os.path.dirname(self.kept("", frame))) for word in words]
        self.assert_ok(eclat("render", self.kept("scene.glb", frame), *WORDS, *words, *(["--channels=default," + ",".join(channels)] if channels else []),
                             "-q", "-o", self.path("b.exr")))
        attributes, mine = read_exr(self.path("b.exr"))
        self.assertGreater(max(mine["R"]), 0)
        for channel in "RGB":
            self.assertEqual(planes[f"Combined.{channel}"], mine[channel])
        return attributes, mine


class Pictures(Scene):
    def test_cube_and_lamp(self):
        attributes, planes = self.render(scenes.cube_and_lamp())
        theirs, _ = self.compare(planes, ["--env=0.2,0.3,0.4"])
        self.assertEqual(float(attributes["eclat.error"]), float(f"{theirs['eclat.error']:.9g}"))
        self.assertEqual(float(attributes["eclat.errorBound"]), float(f"{theirs['eclat.errorBound']:.9g}"))
        self.assertEqual(attributes["eclat.imageSha256"], theirs["eclat.imageSha256"])
        self.assertEqual(set(planes["Combined.A"]), {1.0})

    def test_glass_and_hdri(self):
        planes = self.render(scenes.glass_and_hdri())[1]
        self.compare(planes, ["--env=KEPT/world.exr", "--env-strength=0.5", f"--env-rotate={-math.degrees(SINGLE(math.radians(40))):.9g}"])
        document, _ = glb.read(self.kept("scene.glb"))
        glass = next(one for one in document["materials"] if one["name"] == "Glass")
        self.assertEqual(glass["extensions"]["KHR_materials_transmission"]["transmissionFactor"], 1)
        self.assertIn("KHR_materials_volume", glass["extensions"])
        bright = [i for i, v in enumerate(read_exr(self.kept("world.exr"))[1]["B"]) if v == 4]
        self.assertEqual(bright, [3 + 16 * (7 - 6)])  # rows from the top

    def test_depth_of_field_and_shift(self):
        """35 mm at f/0.25 is an aperture of 140 mm. The sensor is 36 mm wide and the picture 48x32, so its half height is 18 / 35 x 32 /
        48. A shift counts in widths."""
        planes = self.render(scenes.depth_of_field())[1]
        half = 18 / 35 * 32 / 48
        x, y = 2 * 1.5 * 0.125, -2 * 1.5 * 0.25
        self.compare(planes, ["--env=0.2,0.3,0.4", f"--fstop={0.012 / half / 0.14:.9g}", "--focus=4.5", f"--screen-window={x - 1.5:g},{x + 1.5:g},{y - 1:g},{y + 1:g}"])

    def test_focus_on_an_object(self):
        scene = scenes.depth_of_field()
        dof, camera = scene.camera.data.dof, scene.camera
        dof.focus_object = bpy.data.objects["Cube"]
        self.render(scene)
        ahead = -camera.matrix_world.col[2].xyz
        wanted = (bpy.data.objects["Cube"].location - camera.location).dot(ahead)
        self.assertIn(f"--focus={wanted:.6g}"[:14], self.command())

    def command(self, frame=1):
        with open(self.kept("command.txt", frame), encoding="utf-8") as file:
            return file.read()

    def test_motion_blur(self):
        """Half a frame at 24 frames a second."""
        scene = scenes.motion_blur()
        planes = self.render(scene)[1]
        self.assertEqual((scene.frame_current, scene.frame_subframe), (2, 0))
        self.compare(planes, ["--env=0.2,0.3,0.4", f"--shutter=0:{0.5 / 24:.9g}"], frame=2)
        document, buffer = glb.read(self.kept("scene.glb", 2))
        names = {document["nodes"][channel["target"]["node"]]["name"] + "." + channel["target"]["path"]: channel["sampler"]
                 for channel in document["animations"][0]["channels"]}
        self.assertLessEqual({"Cube.translation", "Cube.rotation", "Camera.translation", "Grid.weights"}, set(names))
        self.assertNotIn("Plane.translation", names)
        moved = glb.floats(document, buffer, document["animations"][0]["samplers"][names["Cube.translation"]]["output"])[:, 0]
        self.assertEqual(len(moved), 3)
        self.assertAlmostEqual(float(moved[1]), -0.4, 5)  # in the middle of its path, as in the middle of the exposure
        self.assertLess(moved[2], moved[0])
        still = scenes.motion_blur()
        still.render.use_motion_blur = False
        self.assertNotEqual(self.render(still)[1]["Combined.R"], planes["Combined.R"])

    def test_animation_of_an_armature(self):
        scene = scenes.armature()
        scene.eclat.seed = 7
        self.render(scene)  # sets the format
        scene.render.filepath = self.path("frame-")
        scene.render.use_file_extension = True
        bpy.ops.render.render(animation=True)
        pictures = []
        for frame in (1, 2, 3):
            planes = self.read(self.path(f"frame-{frame:04d}.exr"))[1]
            self.compare(planes, ["--env=0.2,0.3,0.4", f"--seed={7 + frame}"], frame)
            document, buffer = glb.read(self.kept("scene.glb", frame))
            column = next(mesh for mesh in document["meshes"] if mesh["name"].startswith("Cylinder"))
            pictures.append(glb.floats(document, buffer, column["primitives"][0]["attributes"]["POSITION"]))
        bent = [float(abs(positions[:, 2]).max()) for positions in pictures]  # glTF's z is Blender's -y
        self.assertAlmostEqual(bent[0], 0.3, 3)
        self.assertLess(bent[0] + 0.1, bent[1])
        self.assertLess(bent[1] + 0.1, bent[2])

    def test_render_levels_and_what_is_hidden(self):
        scene = scenes.fresh()
        cube = bpy.data.objects["Cube"]
        subdivision = cube.modifiers.new("S", "SUBSURF")
        subdivision.levels, subdivision.render_levels = 0, 2
        hidden, shown = scenes.link(scene, bpy.data.objects.new("Hidden", cube.data)), scenes.link(scene, bpy.data.objects.new("Shown", cube.data))
        hidden.hide_render, shown.hide_viewport = True, True
        self.render(scene)
        document, _ = glb.read(self.kept("scene.glb"))
        names = {node.get("name") for node in document["nodes"]}
        self.assertEqual(names & {"Hidden", "Shown"}, {"Shown"})
        mesh = document["meshes"][next(node for node in document["nodes"] if node.get("name") == "Cube")["mesh"]]
        self.assertEqual(document["accessors"][mesh["primitives"][0]["indices"]]["count"], 6 * 16 * 2 * 3)
        self.assertEqual((subdivision.levels, shown.hide_viewport, hidden.hide_viewport), (0, True, False))

    def test_border(self):
        scene = scenes.fresh()
        scene.render.use_border = scene.render.use_crop_to_border = True
        scene.render.border_min_x, scene.render.border_max_x, scene.render.border_min_y, scene.render.border_max_y = 0.5, 1, 0.25, 1
        planes = self.render(scene)[1]
        self.compare(planes, ["--env=0.2,0.3,0.4", "--size=24x24", "--screen-window=0,1.5,-0.5,1"])

    def test_other_scenes_and_view_layers(self):
        first = scenes.cube_and_lamp()
        second = bpy.data.scenes.new("Other")
        second.render.engine = "ECLAT"
        bpy.context.window.scene = second
        layer = first.view_layers[0].name
        planes = self.render(first, scene=first.name)[1]
        self.compare(planes, ["--env=0.2,0.3,0.4"])
        self.assertEqual(bpy.context.window.scene, second)
        self.assertEqual(layer, "ViewLayer")


class Passes(Scene):
    def test_values(self):
        """A wall 5 m before the camera: its depth is 5 everywhere, its normal is the camera's -x, and the data of each pixel are the
        program's."""
        scene = scenes.fresh(camera=(5, 0, 0), look=(90, 0, 90))
        for name in ("Cube", "Plane"):
            bpy.data.objects.remove(bpy.data.objects[name])
        bpy.ops.mesh.primitive_plane_add(size=30, rotation=(0, math.radians(90), 0))
        bpy.context.object.data.materials.append(scenes.material("Wall", (0.5, 0.25, 0.125, 1)))
        layer = scene.view_layers[0]
        layer.use_pass_z = layer.use_pass_normal = layer.use_pass_diffuse_color = True
        layer.eclat.use_samples = layer.eclat.use_interval = layer.eclat.use_albedo = True
        planes = self.render(scene)[1]
        _, mine = self.compare(planes, ["--env=0.2,0.3,0.4"], channels=("depth", "normal", "albedo", "low95", "high95"))
        # one is the mean distance over a pixel, the other that of its centre
        self.assertLess(max(abs(v - 5) for v in planes["Depth.Z"]), 0.01)
        self.assertGreater(max(mine["depth.Z"]), 5.4)  # in the corners: 5 m x (1 + 0.36^2 + 0.24^2)^1/2 = 5.45 m
        for axis, value in zip("XYZ", (1, 0, 0)):
            self.assertLess(max(abs(v - value) for v in planes[f"Normal.{axis}"]), 1e-3)
        for channel, value in zip("RGB", (0.5, 0.25, 0.125)):
            self.assertLess(max(abs(v - value) for v in self.plane(planes, "DiffCol", channel)), 1e-3)
            self.assertEqual(self.plane(planes, "Albedo", channel), mine[f"albedo.{channel}"])
            self.assertEqual(self.plane(planes, "Standard Error", channel), mine[f"stderr.{channel}"])
            self.assertEqual(self.plane(planes, "Low 95", channel), mine[f"low95.{channel}"])
            self.assertEqual(self.plane(planes, "High 95", channel), mine[f"high95.{channel}"])
        self.assertEqual(set(self.plane(planes, "Samples", "X")), {16.0})

    def plane(self, planes, name, channel):
        """Blender 4.2 writes "Diffuse Color" under another name than 5."""
        for one in (name, {"DiffCol": "Diffuse Color"}.get(name, name)):
            if f"{one}.{channel}" in planes:
                return planes[f"{one}.{channel}"]
        raise AssertionError(f"no {name}.{channel} in {sorted(planes)}")

    def test_nothing_is_far_away(self):
        scene = scenes.fresh(camera=(0, 0, 5), look=(180, 0, 0))
        scene.view_layers[0].use_pass_z = True
        self.assertEqual({f"{v:.6g}" for v in self.render(scene)[1]["Depth.Z"]}, {"1e+10"})


class Reports(Scene):
    def reports(self, scene):
        """Returns the render's reports as {kind: [lines]}, and how often pictures and figures arrived before the end."""
        found, stats = {}, []
        with mock.patch.object(final, "report", lambda engine, kind, line: found.setdefault(kind, []).append(line)), \
             mock.patch.object(final, "say", lambda engine, line: stats.append(line)):
            try:
                self.render(scene)
            except RuntimeError:
                pass
        return found, stats

    def test_the_stated_error(self):
        found, stats = self.reports(scenes.fresh())
        self.assertRegex(found["INFO"][0], r"^eclat: 16 samples, error [\d.]+ %, (95 % bound [\d.]+ %|no bound)")
        self.assertIn(found["INFO"][0][len("eclat: "):].split(" (")[0], stats[-1])

    def fails(self, scene, says):
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors), self.assertRaisesRegex(RuntimeError, says) as raised:
            self.render(scene)
        self.assertFalse(os.path.exists(self.path("a.exr")))
        self.assertNotIn("Traceback", errors.getvalue())
        self.assertEqual(len([line for line in str(raised.exception).splitlines() if line.startswith("Error: ")]), 1)

    def test_errors_of_the_add_on(self):
        scene = scenes.fresh()
        with mock.patch.dict(os.environ, ECLAT="/none/eclat"):
            self.fails(scene, "'/none/eclat' is not a program that can be run; it comes from the environment variable ECLAT")
        scene.camera.data.type = "PANO"
        self.fails(scene, "the camera is panoramic")

    def test_errors_of_the_program(self):
        scene = scenes.fresh()
        scene.eclat.device = "no such device"
        self.fails(scene, "no such device")
        scene = scenes.fresh()
        scene.eclat.integrator, scene.eclat.clamp = "raster", 2
        self.fails(scene, "clamp")

    def test_what_is_not_known_ends_in_one_line_too(self):
        with mock.patch.object(final, "render", lambda *_: 1 // 0):
            self.fails(scenes.fresh(), "internal error: ZeroDivisionError")

    def test_cancel(self):
        """Stops as soon as there is a picture; that picture stays."""
        scene = scenes.fresh()
        scene.eclat.spp, scene.eclat.update = 1000000, 0.05
        shown = []
        original = final.show

        def show(*arguments, **more):
            shown.append(1)
            original(*arguments, **more)
        with mock.patch.object(final, "show", show), mock.patch.object(final, "is_cancelled", lambda engine: bool(shown)):
            attributes, planes = self.render(scene)
        self.assertEqual(attributes["eclat.stoppedBy"], "user")
        self.assertGreaterEqual(len(shown), 2)
        self.assertLess(float(attributes["eclat.samplesPerPixel"]), 1000000)
        self.assertGreater(max(planes["Combined.R"]), 0)

    def test_pictures_grow(self):
        scene = scenes.fresh()
        scene.eclat.spp, scene.eclat.update = 20000, 0.05
        found, stats = self.reports(scene)
        figures = [float(line.split()[0]) for line in stats if line.endswith("%") and " samples, error " in line]
        self.assertGreaterEqual(len(figures), 3)
        self.assertEqual(figures, sorted(figures))
        self.assertEqual(figures[-1], 20000)
        self.assertEqual(set(found), {"INFO"})

    def test_what_is_lost_is_named_once(self):
        scene = scenes.fresh()
        scenes.light(scene, "POINT", 10, shadow_soft_size=0.1)
        scenes.light(scene, "SUN", 1, angle=0.1)
        paint = bpy.data.materials["Paint"]
        noise = paint.node_tree.nodes.new("ShaderNodeTexNoise")
        paint.node_tree.links.new(noise.outputs[0], scenes.principled(paint).inputs["Roughness"])
        scenes.principled(paint).inputs["Subsurface Weight"].default_value = 0.5
        scenes.link(scene, bpy.data.objects.new("Smoke", bpy.data.volumes.new("Smoke")))
        bpy.data.objects["Plane"].modifiers.new("Grass", "PARTICLE_SYSTEM")
        scene.render.film_transparent = True
        scene.camera.data.dof.use_dof, scene.camera.data.dof.aperture_blades = True, 6
        sky = scene.world.node_tree.nodes.new("ShaderNodeTexSky")
        scene.world.node_tree.links.new(sky.outputs[0], scenes.background(scene).inputs["Color"])
        found, _ = self.reports(scene)
        line, = [line for line in found["WARNING"] if line.startswith("eclat renders without: ")]
        for words in ("light Point: the radius of", "light Sun: the angle of", "material Paint: node Noise Texture", "material Paint: subsurface", "object Smoke: volumes",
                      "object Plane: particle system", "transparent film", "camera Camera: the blades", "world World: node Sky Texture"):
            self.assertIn(words, line)
        self.assertNotIn("Floor", line)
        self.assertFalse([line for line in self.reports(scene)[0].get("WARNING", []) if line.startswith("eclat renders without")])


class Threads(unittest.TestCase):
    """A render from a window runs in a second thread, but only the main thread may export: this test acts as the main thread."""

    def call(self, function, is_cancelled=lambda: False, run=True):
        asked, outcome = queue.Queue(), []

        def other():
            try:
                outcome.append(main_thread.call(function, is_cancelled))
            except ZeroDivisionError as why:
                outcome.append(why)
        with mock.patch.object(main_thread, "defer", asked.put):
            thread = threading.Thread(target=other)
            thread.start()
            one = asked.get(timeout=GUARD)
            if run:
                one()
            thread.join(GUARD)
        if not run:
            one()
        return outcome[0]

    def test_the_main_thread_runs_it(self):
        self.assertIs(self.call(threading.current_thread), threading.main_thread())
        self.assertIs(main_thread.call(threading.current_thread), threading.main_thread())
        self.assertIsInstance(self.call(lambda: 1 // 0), ZeroDivisionError)

    def test_what_is_cancelled_before_it_began_never_runs(self):
        ran = []
        self.assertIsNone(self.call(lambda: ran.append(1), lambda: True, run=False))
        self.assertEqual(ran, [])


class Installing(Case):
    def test_the_zip(self):
        """Installs with Blender's own installer of extensions, in a process of its own, since this process already has the add-on."""
        import subprocess
        addon = os.path.join(HERE, "..", "..", "tools", "blender")
        subprocess.run([sys.executable, os.path.join(addon, "make_zip.py"), self.path("a.zip")], check=True, stdout=subprocess.PIPE)
        text = f"""
import bpy
bpy.ops.preferences.addon_enable(module="bl_pkg")
print(bpy.ops.extensions.package_install_files(filepath={self.path("a.zip")!r}, repo="user_default", enable_on_install=True))
bpy.context.scene.render.engine = "ECLAT"
print("THERE", bpy.context.scene.eclat.spp, [name for name in bpy.context.preferences.addons.keys() if "eclat" in name])
bpy.ops.preferences.addon_disable(module="bl_ext.user_default.eclat_blender")
print("GONE", not hasattr(bpy.types.Scene, "eclat"))
"""
        run = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, env=dict(os.environ, BLENDER_USER_RESOURCES=self.path("user")))
        self.assertIn("THERE 256 ['bl_ext.user_default.eclat_blender']", run.stdout, run.stderr)
        self.assertIn("GONE True", run.stdout)


if __name__ == "__main__":
    sys.argv[1:] = sys.argv[1:] or ["-v"]
    passed = unittest.main(exit=False).result.wasSuccessful()
    sys.stdout.flush()
    os._exit(0 if passed else 1)  # PyPI's bpy 4.2.23 crashes at its end once its glTF exporter has run, also without this add-on

# tier: full
"""The add-on without Blender: its manifest and its file, options as words of a command line, cameras, lights, moments of an exposure,
pictures, and renders of a viewport. tests/blender/test_blender.py tests it in Blender."""
import ast
import importlib.util
import json
import math
import os
import re
import subprocess
import sys
import unittest
import zipfile

from polling import poll_until
from support import ECLAT, ENVIRONMENT, QUICK, SOURCE, Case, eclat, quad_scene, write_exr, write_glb

ADDON = os.path.join(SOURCE, "tools", "blender")
if importlib.util.find_spec("numpy") is None:
    print("skipped: no numpy for this Python; Blender brings its own")
    sys.exit(77)
sys.path.insert(0, ADDON)
import numpy  # noqa: E402
from eclat_blender import camera, exr, glb, lights, materials, motion, options, passes, process, program, session, trouble, view  # noqa: E402

WIDE = camera.Lens("PERSP", 50, 36, 24, "AUTO", 6, (0, 0))
TURN = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


class Package(Case):
    def test_manifest(self):
        with open(os.path.join(ADDON, "eclat_blender", "blender_manifest.toml"), encoding="utf-8") as file:
            fields = dict(re.findall(r"^(\w+) = (.+)$", file.read(), re.M))
        for name in ("schema_version", "id", "version", "name", "tagline", "maintainer", "type", "blender_version_min", "license"):
            self.assertIn(name, fields)
        self.assertEqual((fields["id"], fields["type"]), ('"eclat_blender"', '"add-on"'))
        self.assertRegex(fields["version"], r'^"\d+\.\d+\.\d+"$')
        self.assertLessEqual(len(fields["tagline"]), 66)  # including quotes; Blender allows 64
        self.assertNotIn(fields["tagline"][-2], ".")

    def test_the_file_to_install(self):
        path = self.path("a.zip")
        subprocess.run([sys.executable, os.path.join(ADDON, "make_zip.py"), path], check=True, stdout=subprocess.PIPE)
        with zipfile.ZipFile(path) as packed:
            names = packed.namelist()
        self.assertLessEqual({"blender_manifest.toml", "__init__.py", "options.json", "engine.py", "LICENSE"}, set(names))
        self.assertFalse([name for name in names if "/" in name or "pyc" in name])
        with open(path, "rb") as file:
            first = file.read()
        subprocess.run([sys.executable, os.path.join(ADDON, "make_zip.py"), path], check=True, stdout=subprocess.PIPE)
        with open(path, "rb") as file:
            self.assertEqual(file.read(), first)

    def test_modules_that_need_blender_are_loaded_by_register_alone(self):
        for name in ("camera", "exr", "glb", "lights", "losses", "materials", "motion", "options", "passes", "process", "program", "session", "view"):
            with open(os.path.join(ADDON, "eclat_blender", name + ".py"), encoding="utf-8") as file:
                top = [node for node in ast.parse(file.read()).body if isinstance(node, (ast.Import, ast.ImportFrom))]
            self.assertNotIn("bpy", [alias.name for node in top for alias in node.names], name)


class Options(Case):
    def test_help_is_the_programs(self):
        environment = dict(os.environ, ECLAT_BUILD=os.path.dirname(os.path.abspath(ECLAT)))
        run = subprocess.run([sys.executable, os.path.join(ADDON, "make_options.py"), "--check"], capture_output=True, text=True, env=environment)
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_every_row_is_an_option(self):
        table = options.table()
        for row in options.ROWS:
            self.assertIn(row.option, table)
            self.assertTrue(row.kind != "choice" or row.first in table[row.option]["choices"], row.option)
        self.assertEqual({row.panel for row in options.ROWS}, {name for name, _ in options.PANELS})

    def test_words(self):
        first = {options.identifier(row.option): row.first for row in options.ROWS}
        self.assertEqual(options.words(first), ["--spp=256"])
        self.assertEqual(options.words({"error": 2.5, "max_depth": 7, "integrator": "whitted", "device": "0,1"}),
                         ["--error=2.5", "--integrator=whitted", "--max-depth=7", "--device=0,1"])

    def test_the_program_reads_each(self):
        other = {"int": 3, "real": 1.25, "text": "0"}
        table = options.table()
        for row in options.ROWS:
            value = next(name for name in table[row.option]["choices"] if name != row.unset) if row.kind == "choice" else other[row.kind]
            self.assert_ok(eclat("render", "a.glb", *options.words({options.identifier(row.option): value}), "--help"))


class Camera(unittest.TestCase):
    def test_fields_of_view(self):
        wide, tall = camera.Frame(1920, 1080), camera.Frame(1080, 1920)
        fov = [camera.gltf_camera(WIDE._replace(sensor_fit=fit), frame)["perspective"]["yfov"] for frame in (wide, tall) for fit in ("AUTO", "HORIZONTAL", "VERTICAL")]
        halves = [18 / 50 * 9 / 16, 18 / 50 * 9 / 16, 12 / 50, 18 / 50, 18 / 50 * 16 / 9, 12 / 50]
        for angle, half in zip(fov, halves):
            self.assertAlmostEqual(math.tan(angle / 2), half)
        self.assertAlmostEqual(camera.gltf_camera(WIDE._replace(kind="ORTHO"), wide)["orthographic"]["ymag"], 3 * 9 / 16)

    def test_a_shift_is_in_units_of_the_larger_side(self):
        words = camera.words(WIDE._replace(shift=(0.25, -0.5)), camera.Frame(200, 100))
        self.assertEqual(words, ["--size=200x100", "--screen-window=-1,3,-3,-1"])

    def test_a_border_and_wide_pixels(self):
        self.assertEqual(camera.words(WIDE, camera.Frame(100, 100, border=(0.25, 0.75, 0.5, 1))), ["--size=50x50", "--screen-window=-0.5,0.5,0,1"])
        self.assertEqual(camera.words(WIDE, camera.Frame(100, 100, pixel_aspect=0.5)), ["--size=100x100", "--screen-window=-2,2,-1,1"])
        self.assertEqual(camera.words(WIDE, camera.Frame(100, 100)), ["--size=100x100"])

    def test_a_lens_is_as_wide_as_blenders(self):
        """50 mm at f/2 is an aperture of 25 mm; eclat's sensor is 24 mm high, so a view 24 mm high has a focal length of 50 mm too."""
        words = camera.words(WIDE._replace(fstop=2, focus=3.5), camera.Frame(150, 100))
        self.assertEqual(words, ["--size=150x100", "--fstop=2", "--focus=3.5"])
        self.assertEqual(camera.words(WIDE._replace(fstop=2, focus=3.5), camera.Frame(75, 100))[1], f"--fstop={2 * 24 / 36:.9g}")

    def test_a_panorama_is_refused(self):
        with self.assertRaisesRegex(trouble.Trouble, "panoramic"):
            camera.gltf_camera(WIDE._replace(kind="PANO"), camera.Frame(2, 1))

    def test_depth_is_along_the_axis(self):
        along = camera.along_axis(WIDE._replace(sensor_width=200), camera.Frame(2, 2))  # half a pixel from the axis is a tangent of 1
        self.assertTrue(numpy.allclose(along, 1 / math.sqrt(3)))


class View(Case):
    def test_windows(self):
        even = [[2, 0, 0, 0], [0, 4, 0, 0], [0, 0, -1, -1], [0, 0, -1, 0]]
        self.assertEqual(view.window(even), (-0.5, 0.5, -0.25, 0.25))
        shifted = [[2, 0, 1, 0], [0, 4, -1, 0], [0, 0, -1, -1], [0, 0, -1, 0]]
        self.assertEqual(view.window(shifted), (0, 1, -0.5, 0))
        parallel = [[0.5, 0, 0, 0.5], [0, 0.25, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]
        self.assertEqual(view.window(parallel), (-3, 1, -4, 4))

    def test_the_program_sees_the_same(self):
        """A viewport that looks through the file's own camera, of 0.8 radians at z = 3. y up in the file is z up in Blender."""
        scene = write_glb(self.path("a.glb"), *quad_scene())
        half = math.tan(0.4)
        projection = [[1 / half, 0, 0, 0], [0, 1 / half, 0, 0], [0, 0, -1, -1], [0, 0, -1, 0]]
        camera_matrix = [[1, 0, 0, 0], [0, 0, -1, -3], [0, 1, 0, 0], [0, 0, 0, 1]]
        words = view.words(camera_matrix, projection, (24, 24))
        for name, given in (("a.exr", ["--size=24x24"]), ("b.exr", words)):
            self.assert_ok(eclat("render", scene, *given, *QUICK, "--spp", "8", "-o", self.path(name)))
        a, b = (exr.read(self.path(name))[1]["R"] for name in ("a.exr", "b.exr"))
        self.assertGreater(a.mean(), 0.1)
        self.assertLess(abs(a - b).max(), 0.01)


class Lights(unittest.TestCase):
    def setUp(self):
        self.document, self.buffer = glb.empty()

    def add(self, kind, **more):
        lights.add(self.document, self.buffer, lights.Light("lamp", kind, (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1), (1, 0.5, 2), 40, **more))

    def test_a_point_shines_to_all_sides(self):
        self.add("POINT")
        light = self.document["extensions"]["KHR_lights_punctual"]["lights"][0]
        self.assertAlmostEqual(light["intensity"] * light["color"][1], 40 * 0.5 / (4 * math.pi))
        self.assertEqual(max(light["color"]), 1)

    def test_a_soft_spot_has_the_power_of_blenders(self):
        """Integrates both falloffs over the cosine, which is proportional to the solid angle."""
        self.add("SPOT", cone=1.0, blend=0.4)
        spot = self.document["extensions"]["KHR_lights_punctual"]["lights"][0]["spot"]
        z = numpy.linspace(math.cos(0.5), 1, 100001)
        soft = numpy.clip((z - z[0]) / (0.4 * (1 - z[0])), 0, 1)
        gltf = numpy.clip((z - math.cos(spot["outerConeAngle"])) / (math.cos(spot["innerConeAngle"]) - math.cos(spot["outerConeAngle"])), 0, 1)
        self.assertAlmostEqual((soft * soft * (3 - 2 * soft)).mean(), (gltf ** 2).mean(), 4)

    def test_area_lights_have_their_power(self):
        for shape, size, area in (("SQUARE", (2, 9), 4), ("RECTANGLE", (2, 3), 6), ("DISK", (2, 9), math.pi), ("ELLIPSE", (2, 4), 2 * math.pi)):
            with self.subTest(shape):
                self.setUp()
                self.add("AREA", shape=shape, size=size)
                corners = glb.floats(self.document, self.buffer, 0).reshape(-1, 3, 3)
                normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
                self.assertTrue((normals[:, 2] < 0).all())  # the light shines along -z
                self.assertAlmostEqual(-normals[:, 2].sum() / area, 1, delta=0.002)
                material = self.document["materials"][0]
                radiance = material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] * material["emissiveFactor"][0]
                self.assertAlmostEqual(radiance * math.pi * -normals[:, 2].sum(), 40, 3)

    def test_transmission_is_that_of_a_body(self):
        glass = {"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}, "pbrMetallicRoughness": {"baseColorFactor": [0.25, 1, 0, 1]}}
        document = {"materials": [{}, glass]}
        materials.make_solid(document)
        self.assertEqual(document["materials"][0], {})
        self.assertGreater(glass["extensions"]["KHR_materials_volume"]["thicknessFactor"], 0)
        self.assertEqual(glass["pbrMetallicRoughness"]["baseColorFactor"], [0.5, 1, 0, 1])


class Motion(unittest.TestCase):
    def moment(self, x, corners=3, angle=0.0, yfov=0.5):
        document, buffer = glb.empty()
        document["cameras"] = [{"type": "perspective", "perspective": {"yfov": yfov, "znear": 0.1}}]
        points = [[k, x, 0.0] for k in range(corners)]
        document["meshes"] = [{"name": "sheet", "primitives": [{"attributes": {"POSITION": glb.add_floats(document, buffer, points, "VEC3")}}]}]
        glb.add_node(document, {"name": "still", "mesh": 0})
        glb.add_node(document, {"name": "turns", "matrix": [math.cos(angle), math.sin(angle), 0, 0, -math.sin(angle), math.cos(angle), 0, 0, 0, 0, 2, 0, x, 0, 0, 1]})
        return document, buffer

    def test_nodes_meshes_and_cameras(self):
        document, buffer, left = motion.merge([self.moment(0), self.moment(1, angle=0.4), self.moment(4, angle=0.8, yfov=0.7)], [0, 0.01, 0.02])
        self.assertEqual(left, [])
        channels = {channel["target"]["path"]: document["animations"][0]["samplers"][channel["sampler"]] for channel in document["animations"][0]["channels"]}
        values = {path: glb.floats(document, buffer, sampler["output"]) for path, sampler in channels.items()}
        self.assertEqual(set(values), {"translation", "rotation", "weights", "pointer"})
        self.assertEqual(values["translation"].tolist(), [[0, 0, 0], [1, 0, 0], [4, 0, 0]])
        self.assertTrue(numpy.allclose(values["rotation"], [[0, 0, math.sin(a), math.cos(a)] for a in (0, 0.2, 0.4)]))
        self.assertEqual(values["weights"].reshape(3, 2).tolist(), [[0, 0], [1, 0], [0, 1]])
        self.assertTrue(numpy.allclose(values["pointer"], [[0.5], [0.5], [0.7]]))
        targets = document["meshes"][0]["primitives"][0]["targets"]
        self.assertEqual([glb.floats(document, buffer, target["POSITION"])[0].tolist() for target in targets], [[0, 1, 0], [0, 4, 0]])
        self.assertEqual(document["nodes"][1]["scale"], [1, 1, 2])
        self.assertNotIn("matrix", document["nodes"][1])

    def test_what_stands_still_has_no_animation(self):
        self.assertNotIn("animations", motion.merge([self.moment(0), self.moment(0)], [0, 1])[0])

    def test_what_cannot_move_is_named(self):
        _, _, left = motion.merge([self.moment(0), self.moment(0, corners=4)], [0, 1])
        self.assertEqual(len(left), 1)
        self.assertIn("sheet", left[0])
        other = self.moment(0)
        glb.add_node(other[0], {"name": "new"})
        self.assertIn("other objects", motion.merge([self.moment(0), other], [0, 1])[2][0])

    def test_rotations_of_all_kinds(self):
        random = numpy.random.default_rng(1)
        for _ in range(200):
            q = random.normal(size=4)
            q /= numpy.linalg.norm(q)
            x, y, z, w = q
            rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
            found = motion.quaternion([list(column) for column in zip(*rows)])
            self.assertAlmostEqual(abs(float(numpy.dot(found, q))), 1)


class Pictures(Case):
    def test_what_is_written_is_read(self):
        rgb = numpy.random.default_rng(2).random((5, 7, 3), dtype=numpy.float32)
        exr.write(self.path("a.exr"), rgb)
        planes = exr.read(self.path("a.exr"))[1]
        self.assertTrue((numpy.stack([planes[c] for c in "RGB"], -1) == rgb).all())
        self.assert_ok(eclat("compare", self.path("a.exr"), self.path("a.exr")))  # other programs read it too

    def test_passes(self):
        planes = {name: numpy.array([[1, 2], [3, 4]], numpy.float32) for name in ("R", "G", "B", "normal.X", "normal.Y", "normal.Z", "depth.Z", "samples")}
        planes["A"] = numpy.array([[1, 1], [0, 1]], numpy.float32)
        self.assertEqual(passes.combined(planes)[0, 0].tolist(), [3, 3, 3, 1])
        self.assertEqual(passes.make("Normal", planes, None)[1, 1].tolist(), [2, -2, 2])
        self.assertEqual(passes.make("Depth", planes, numpy.full((2, 2), 0.5))[:, :, 0].tolist(), [[1e10, 2], [0.5, 1]])
        self.assertIsNone(passes.make("Standard Error", planes, None))
        self.assertEqual(passes.channels(["Depth", "DiffCol", "Albedo", "Standard Error"]), "--channels=default,albedo,depth")


class Program(Case):
    def script(self, text):
        path = self.path("eclat")
        with open(path, "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\n" + text)
        os.chmod(path, 0o755)
        return path

    def test_where_the_program_is_looked_for(self):
        path = self.script("")
        self.assertEqual(program.find(path, {}), path)
        self.assertEqual(program.find("", {"ECLAT": path}), path)
        self.assertEqual(program.find("", {"PATH": self.folder}), path)
        for preferred, environment, says in (("/none", {}, "'/none'.*preferences"), ("", {"ECLAT": "/none"}, "'/none'.*ECLAT"), ("", {"PATH": "/none"}, "was not found")):
            with self.assertRaisesRegex(trouble.Trouble, says):
                program.find(preferred, environment)

    def end_of(self, *command):
        one = process.Process(command, self.folder, environment=ENVIRONMENT)
        self.addCleanup(one.kill)
        one.process.wait()
        return one

    def test_a_failure_is_one_line(self):
        with self.assertRaisesRegex(trouble.Trouble, "none.glb: cannot open"):
            self.end_of(ECLAT, "render", self.path("none.glb")).result()
        with self.assertRaisesRegex(trouble.Trouble, "code 3 and no message"):
            self.end_of(self.script("exit 3")).result()
        with self.assertRaisesRegex(trouble.Trouble, "cannot be started"):
            process.Process([self.path("none")], self.folder)

    def test_it_stops_with_the_picture_so_far(self):
        scene = write_glb(self.path("a.glb"), *quad_scene())
        one = process.Process([ECLAT, "render", scene, *QUICK, "--size=16x16", "--spp=1000000"], self.folder, 0.01, ENVIRONMENT)
        self.addCleanup(one.kill)
        shot = poll_until(one.look, one.process)
        self.assertRegex(shot.figures(), r"samples, error .*bound")
        self.assertEqual(shot.planes["R"].shape, (16, 16))
        one.stop()
        one.process.wait()
        self.assertEqual(one.result().attributes["eclat.stoppedBy"], "user")
        self.assertGreaterEqual(one.result().samples, shot.samples)


class Viewport(Case):
    def setUp(self):
        super().setUp()
        self.session = session.Session(ECLAT, ENVIRONMENT)
        self.addCleanup(self.session.close)
        self.scene = [write_glb(self.path("a.glb"), *quad_scene()), *QUICK]

    def wait_for(self, width):
        return poll_until(lambda: (shot := self.session.poll()) and shot.planes["R"].shape[1] == width and not self.session.is_busy and shot)

    def test_coarse_then_fine_then_rest(self):
        self.session.show(self.scene, ["--eye=0,0,3"], (24, 16), 16)
        coarse = poll_until(self.session.poll)
        self.assertEqual(coarse.planes["R"].shape, (4, 6))
        shot = self.wait_for(24)
        self.assertEqual(shot.samples, 16)
        self.assert_ok(eclat("render", self.scene[0], *QUICK, "--eye=0,0,3", "--size=24x16", "--spp=16", "-o", self.path("b.exr")))
        self.assertTrue((exr.read(self.path("b.exr"))[1]["R"] == shot.planes["R"]).all())
        process_before = self.session.number
        self.session.show(self.scene, ["--eye=0,0,3"], (24, 16), 16)  # the view is the same: nothing to do
        self.assertEqual(self.session.number, process_before)

    def test_another_view_ends_what_was_begun(self):
        self.session.show(self.scene, ["--eye=0,0,3"], (64, 64), 1000000)
        first = self.session.process.process
        self.session.show(self.scene, ["--eye=0,0,4"], (12, 12), 8)
        self.assertIsNotNone(first.poll())
        self.assertEqual(self.wait_for(12).samples, 8)

    def test_trouble_is_told_once(self):
        self.session.show([self.path("none.glb")], [], (8, 8), 8)

        def fails():
            try:
                self.session.poll()
            except trouble.Trouble as why:
                return str(why)
            return None
        self.assertIn("none.glb", poll_until(fails))
        self.assertFalse(self.session.is_busy)
        self.assertIsNone(self.session.poll())


if __name__ == "__main__":
    unittest.main()

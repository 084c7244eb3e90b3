# tiers: quick, full
"""Sequences of frames: each frame has the bits of a render of it alone. Also tests what frames share, and the command line."""
import json
import math
import os
import unittest

from support import QUICK, SHARED, Case, data_uri, eclat, read_exr, write_gltf
from test_motion import GLOW, GREY, Builder, room, turn
from tiers import full

SMALL = ["--size", "16x12", "--spp", "4", "-q"]
# Scenes of these materials need only the Cornell box's effects, whose kernels other tests compile.
MATT, LAMP = (dict(material, doubleSided=False) for material in (GREY, GLOW))


def rows_of(run):
    """Output of --json: a line for each frame, and one for the sequence."""
    rows = [json.loads(line) for line in run.stdout.splitlines()]
    return rows[:-1], rows[-1]


class FramesCase(Case):
    def render(self, scene, *options):
        return self.assert_ok(eclat("render", scene, *SMALL, "--json", *options, cwd=self.folder))

    def refuse(self, scene, says, *options, code=2):
        line = self.assert_one_error(eclat("render", scene, *SMALL, *options, cwd=self.folder), code)
        self.assertIn(says, line)

    def model(self, name, half=4):
        """Returns a sample model with a camera added: without one, each still would be framed by itself."""
        path = os.path.join(SHARED, "assets", "gltf", name, "glTF", name + ".gltf")
        if not os.path.exists(path):
            self.skipTest("no " + path)
        with open(path, encoding="utf-8") as file:
            scene = json.load(file)
        for part in scene["buffers"] + scene.get("images", []):
            if not part.get("uri", "data:").startswith("data:"):
                with open(os.path.join(os.path.dirname(path), part["uri"]), "rb") as file:
                    part["uri"] = data_uri(file.read())
        scene["cameras"] = [{"type": "orthographic", "orthographic": {"xmag": half, "ymag": half, "znear": 0.1, "zfar": 1000}}]
        scene["nodes"].append({"camera": 0, "translation": [12, 18, 12], "rotation": [-.3536, .3536, .1464, .8536]})
        scene["scenes"][scene.get("scene", 0)]["nodes"].append(len(scene["nodes"]) - 1)
        return write_gltf(self.path(name + ".gltf"), scene)

    def sliding(self):
        """A lamp that slides over a grey floor. The camera is behind the lamp and does not see it. With --animation all, a slab turns too.
        Renders quickly."""
        b = Builder()
        b.add(MATT, scale=[4, 4, 4], translation=[0, 0, -1])
        b.animate(b.add(LAMP, rotation=turn(0, 180)), "translation", [(-1, 0, 1), (1, 0, 1)])
        b.animate(b.add(MATT), "rotation", [turn(0, 0), turn(0, 140)])
        b.camera(2)
        return b.write(self.path("slide.gltf"))


@full
class SameBits(FramesCase):
    def assert_as_alone(self, scene, *options, frames="0:4:2", fps="8", numbers=(0, 2, 4)):
        """Compares the sequence with a render of each frame by --at, and one frame with a run of the command in its report."""
        frames, last = rows_of(self.render(scene, "--frames", frames, "--fps", fps, "-o", "s.%02d.exr", *options))
        self.assertEqual((last["frames"], last["rendered"], last["skipped"], last["failed"]), (len(numbers), len(numbers), 0, 0))
        self.assertEqual([row["frame"] for row in frames], list(numbers))
        hashes = [row["image_sha256"] for row in frames]
        self.assertGreater(len(set(hashes)), 1, "nothing moves")
        for number, sha in zip(numbers, hashes):
            at = repr(number / float(fps))
            alone = json.loads(self.render(scene, "--at", at, "-o", "alone.exr", *options).stdout)
            self.assertEqual(alone["image_sha256"], sha, f"frame {number}")
        name = f"s.{numbers[1]:02d}.exr"
        attributes, planes = read_exr(self.path(name))
        os.rename(self.path(name), self.path("kept.exr"))
        self.assertIn("--frames %d " % numbers[1], attributes["eclat.command"])
        command = attributes["eclat.command"].split()
        self.assert_ok(eclat(*command[1:], "-q", cwd=self.folder))
        self.assertEqual(read_exr(self.path(name))[1], planes)
        return frames

    def test_nodes_lamps_lights_and_cameras(self):
        self.assert_as_alone(room().write(self.path("room.gltf")), "--animation", "all", "--env", "0.3,0.3,0.3", *QUICK)

    def test_a_camera_alone(self):
        b = Builder()
        b.add(MATT, scale=[4, 4, 4])
        b.add(LAMP, translation=[0, 0, 1], rotation=turn(0, 180))
        b.animate(b.camera(2), "translation", [(0, 0, 5), (.5, .2, 5)])
        frames = self.assert_as_alone(b.write(self.path("pan.gltf")))
        for row in frames[1:]:
            self.assertEqual(row["shared"]["structures"], "kept", row["frame"])

    def test_a_light_alone(self):
        b = Builder()
        b.add(GREY, scale=[4, 4, 4])
        b.scene["extensionsUsed"] = ["KHR_lights_punctual"]
        b.scene["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 4}]}}
        b.animate(b.node(translation=[0, 0, 1], extensions={"KHR_lights_punctual": {"light": 0}}), "translation", [(-1, 0, 1), (1, 0, 1)])
        b.camera(2)
        frames = self.assert_as_alone(b.write(self.path("light.gltf")), *QUICK)
        for row in frames[1:]:
            self.assertEqual(row["shared"]["structures"], "kept", row["frame"])

    def test_each_frame_has_its_own_clamp(self):
        """The clamp depends on each frame's mean luminance."""
        frames = self.assert_as_alone(room().write(self.path("room.gltf")), "--animation", "all", "--env", "0.3,0.3,0.3", "--clamp", "0.5", *QUICK)
        for row in frames:
            self.assertGreater(row["clamp"]["missing"], 0)

    def test_skins_and_morph_targets(self):
        for name, half in (("AnimatedMorphCube", 2.5), ("Fox", 90)):
            with self.subTest(name):
                for old in os.listdir(self.folder):
                    os.remove(self.path(old))
                self.assert_as_alone(self.model(name, half), "--animation", "0", *QUICK)

    def test_in_every_structure(self):
        scene, common = self.sliding(), ["--animation", "all", "--frames", "0:2", "--fps", "4"]
        wanted = None
        for accel in ("auto", "bvh2", "bvh8", "grid", "kdtree", "none", "twolevel"):
            frames, _ = rows_of(self.render(scene, *common, "--accel", accel, "-o", accel + ".%d.exr"))
            got = [row["image_sha256"] for row in frames]
            wanted = wanted or got
            self.assertEqual(got, wanted, accel)

    def test_a_frame_without_surfaces(self):
        """The object appears after the first frame, which shows only the environment, with every integrator. kernel/test_traversal has
        empty structures."""
        b = Builder()
        b.animate(b.add(GLOW), "scale", [(0, 0, 0), (1, 1, 1)])
        b.camera(1)
        scene = b.write(self.path("pop.gltf"))
        run = self.assert_ok(eclat("render", scene, *SMALL, *QUICK, "--env", "0.25,0.25,0.25", "--frames", "0:1", "--fps", "1", "-o", "p.%d.exr", cwd=self.folder))
        self.assertEqual(run.stderr, f"eclat: warning: {scene}: no surface shows: scaled to nothing by nodes[0]\n")
        self.assertEqual(set(read_exr(self.path("p.0.exr"))[1]["G"]), {0.25})
        self.assertGreater(max(read_exr(self.path("p.1.exr"))[1]["G"]), 0.9)
        for integrator in ("whitted", "raster"):
            self.render(scene, "--at", "0", "--env", "0.25,0.25,0.25", "-o", "alone.exr", "--integrator", integrator, *QUICK)
            self.assertEqual(set(read_exr(self.path("alone.exr"))[1]["G"]), {0.25}, integrator)

    def test_instances_that_move_and_that_do_not(self):
        b = Builder()
        moving = b.add(GREY, translation=[-1, 0, 0])
        b.add(GLOW, translation=[0, 0, 2], rotation=turn(0, 180))
        for k in range(3):
            b.node(mesh=0, translation=[1, k - 1, 0])
        b.animate(moving, "translation", [(-1, -1, 0), (-1, 1, 0)])
        b.camera(2)
        self.assert_as_alone(b.write(self.path("instances.gltf")), "--instancing", "on", "--lanes", "1")

    def test_a_shutter_counts_from_the_frame(self):
        scene = self.sliding()
        frames, _ = rows_of(self.render(scene, "--frames", "1:2", "--fps", "4", "--shutter", "0:0.2", *QUICK, "-o", "b.%d.exr"))
        for row, span in zip(frames, ("0.25:0.45", "0.5:0.7")):
            alone = json.loads(self.render(scene, "--shutter", span, *QUICK, "-o", "alone.exr").stdout)
            self.assertEqual(alone["image_sha256"], row["image_sha256"])

    def test_triangles_that_would_be_cut(self):
        """Long beams across each other. A still may cut triangles into parts; frames never do, so that a frame does not depend on those
        before it."""
        b = Builder()
        b.add(MATT, scale=[6, 6, 6], translation=[0, 0, -1])
        b.animate(b.add(LAMP, translation=[0, 0, 3], rotation=turn(0, 180)), "translation", [(0, 0, 3), (1, 0, 3)])
        for k in range(2000):
            b.node(mesh=0, translation=[2 * math.cos(2.1 * k), 2 * math.sin(1.7 * k), 1 + math.sin(3.3 * k)], scale=[3, .01, 1],
                   rotation=[.35 * math.sin(k), .35 * math.cos(k), .87 * math.sin(2.4 * k), .87 * math.cos(2.4 * k)])
        b.camera(2)
        scene, common = b.write(self.path("beams.gltf")), ["--fps", "4", "--instancing", "off", "--accel", "bvh8"]
        still = json.loads(self.assert_ok(eclat("info", scene, "--accel", "bvh8", "--json")).stdout)
        self.assertGreater(still["accels"][0]["references"], 1.05 * still["triangles"], "nothing to cut")
        rows, _ = rows_of(self.render(scene, "--frames", "0:2", *common, "-o", "s.%d.exr"))
        first, *others = [row["shared"]["structures"] for row in rows]
        self.assertEqual(first, "built")
        self.assertLessEqual(set(others), {"refitted", "rebuilt"})  # by whichever took less time
        for row in rows:
            alone, _ = rows_of(self.render(scene, "--frames", str(row["frame"]), *common, "-o", f"alone{row['frame']}.exr"))
            self.assertEqual(alone[0]["image_sha256"], row["image_sha256"], row["frame"])

    def test_noise_changes_only_with_the_seed(self):
        b = Builder()
        b.add(MATT, scale=[4, 4, 4])
        b.add(LAMP, translation=[0, 0, 1], rotation=turn(0, 180))
        b.animate(b.camera(2), "translation", [(0, 0, 5), (0, 0, 5)])
        scene = b.write(self.path("still.gltf"))
        for options, kinds in (([], 1), (["--seed", "frame"], 3)):
            rows, _ = rows_of(self.render(scene, "--frames", "0:2", *options, "-o", f"n{kinds}.%d.exr"))
            self.assertEqual(len({row["image_sha256"] for row in rows}), kinds)
        self.assertEqual([row["seed"] for row in rows], [0, 1, 2])
        at = json.loads(self.render(scene, "--at", "0.1", "--seed", "2", "-o", "alone.exr").stdout)
        self.assertEqual(at["image_sha256"], rows[2]["image_sha256"])
        self.refuse(scene, "--seed frame belongs to --frames", "--seed", "frame")

    def test_objects_that_appear_and_disappear(self):
        """Triangles without area are dropped: the set of triangles changes from frame to frame."""
        b = Builder()
        b.add(MATT, scale=[4, 4, 4], translation=[0, 0, -1])
        b.animate(b.add(LAMP), "scale", [(0, 0, 0), (1, 1, 1), (0, 0, 0)], times=(0.0, 0.5, 1.0))
        b.camera(2)
        self.assert_as_alone(b.write(self.path("grow.gltf")), frames="0:8:4", numbers=(0, 4, 8))


class Sharing(FramesCase):
    """After the first frame, whatever stays as it is is kept. The figures are the program's own counts."""

    def shared(self, scene, *options):
        rows, _ = rows_of(self.render(scene, *options, "-o", "x.%d.exr"))
        return [row["shared"] for row in rows]

    def test_programs_textures_and_structures(self):
        scene = self.model("Fox", 90)
        first, *others = self.shared(scene, "--animation", "Run", "--frames", "0:4", *QUICK)
        self.assertEqual((first["structures"], first["programs_kept"], first["bytes_kept"]), ("built", 0, 0))
        texels = 1024 * 1024 * 4
        self.assertGreater(first["bytes_uploaded"], texels)
        for row in others:
            self.assertIn(row["structures"], ("refitted", "rebuilt"))
            self.assertEqual((row["programs_built"], row["programs_kept"]), (0, first["programs_built"]))
            self.assertGreaterEqual(row["bytes_kept"], texels)
            self.assertLess(row["bytes_uploaded"], first["bytes_uploaded"] - texels + 1)
        self.assertIn("refitted", [row["structures"] for row in others])
        for row in others:  # ends at the first rebuilt tree, since that has another number of nodes
            if row["structures"] == "rebuilt":
                break
            self.assertEqual(row["bytes_kept"] + row["bytes_uploaded"], first["bytes_uploaded"])

    def test_on_several_devices(self):
        scene = self.sliding()
        rows, _ = rows_of(self.render(scene, "--frames", "0:2", "-o", "one.%d.exr"))
        run = eclat("render", scene, *SMALL, "--frames", "0:2", "--device", "all", "--json", "-o", "all.%d.exr", cwd=self.folder,
                    env={"POCL_DEVICES": "pthread basic"})
        several, _ = rows_of(self.assert_ok(run))
        self.assertEqual([row["image_sha256"] for row in several], [row["image_sha256"] for row in rows])
        if len(several[0].get("devices", [])) > 1:
            self.assertEqual([row["shared"]["bytes_kept"] > 0 for row in several], [False, True, True])

    def test_an_environment_map_is_read_and_uploaded_once(self):
        scene = self.sliding()
        self.render(scene, "--at", "0", "--size", "64x32", "-o", "sky.exr")
        command = ["--env", "sky.exr", "--env-rotate", "30", "--env-strength", "2", *QUICK, "--fps", "4"]
        _, *others = self.shared(scene, "--frames", "0:2", *command)
        for row in others:
            self.assertGreaterEqual(row["bytes_kept"], 64 * 32 * 16)
        alone = json.loads(self.render(scene, "--at", "0.5", *command[:-2], "-o", "alone.exr").stdout)
        self.assertEqual(read_exr(self.path("x.2.exr"))[0]["eclat.imageSha256"], alone["image_sha256"])

    @full
    def test_meshes_that_stand_in_many_places_are_built_once(self):
        b = Builder()
        mesh = b.add(GREY, translation=[-1, 0, 0])
        b.add(GLOW, translation=[0, 0, 2], rotation=turn(0, 180))
        others = [b.node(mesh=0, translation=[1, k - 1, 0]) for k in range(3)]
        b.animate(others[0], "translation", [(1, -1, 0), (0, -1, 0)])
        b.camera(2)
        first, *rest = self.shared(b.write(self.path("instances.gltf")), "--frames", "0:2", "--fps", "4", "--instancing", "on", "--lanes", "1")
        self.assertGreaterEqual(mesh, 0)
        self.assertEqual((first["meshes_built"], first["meshes_kept"]), (1, 0))
        for row in rest:
            self.assertEqual((row["meshes_built"], row["meshes_kept"]), (0, 1))

    @full
    def test_other_effects_build_other_programs_and_only_then(self):
        """The lamp goes out between frames 1 and 2: from then on the scene needs kernels for other effects."""
        b = Builder()
        b.add(MATT, scale=[4, 4, 4], translation=[0, 0, -1])
        lamp = b.add(LAMP)
        b.animate(lamp, "scale", [(1, 1, 1), (0, 0, 0)], times=(0.0, 0.5))
        b.scene["animations"][0]["samplers"][0]["interpolation"] = "STEP"
        b.camera(2)
        rows = self.shared(b.write(self.path("lamp.gltf")), "--frames", "0:3", "--fps", "4", "--lanes", "1", "--env", "1,1,1")
        self.assertEqual([row["programs_built"] > 0 for row in rows], [True, False, True, False])


class CommandLine(FramesCase):
    def test_names(self):
        scene = self.sliding()
        for says, *options in (("one name for all", "-o", "out.exr"), ("2 places", "-o", "a%d.%04d.exr"), ("there may be d", "-o", "a.%s.exr"),
                               ("there may be d", "-o", "a.%4d.exr"), ("there may be d", "-o", "a.%-4d.exr"), ("there may be d", "-o", "a.%f.png"),
                               ("there may be d", "-o", "a.%0099d.png"), ("has no known extension", "-o", "a.%d.tif"), ("given twice", "-o", "a%d.png", "-o", "a%01d.png")):
            with self.subTest(options):
                self.refuse(scene, says, "--frames", "0:2", *options)
        self.assertEqual(os.listdir(self.folder), ["slide.gltf"])
        self.render(scene, "--frames", "7:8", "-o", "100%%.%d.png")
        self.render(scene, "--frames", "9", "-o", "one.png")
        self.render(scene, "--frames", "3")
        self.render(scene, "-o", "%d.png")
        self.assertEqual(sorted(os.listdir(self.folder)), ["%d.png", "100%.7.png", "100%.8.png", "one.png", "slide.0003.exr", "slide.0003.png", "slide.gltf"])

    def test_ranges(self):
        scene = self.sliding()
        for text in ("", ":", "1:", ":2", "a:b", "1:2:", "1:2:0", "1:2:3:4", "-1:2", "1.5", "0:99999999"):
            with self.subTest(text):
                self.refuse(scene, "--frames", "--frames", text, "-o", "a.%d.png")
        self.refuse(scene, "ends before it begins", "--frames", "4:2", "-o", "a.%d.png")
        rows, _ = rows_of(self.render(scene, "--frames", "0:7:3", "-o", "r.%d.png"))
        self.assertEqual([row["frame"] for row in rows], [0, 3, 6])

    def test_combinations(self):
        scene, frames = self.sliding(), ["--frames", "0:2", "-o", "a.%d.exr"]
        self.refuse(scene, "leave --at out", *frames, "--at", "1")
        self.refuse(scene, "--frames and --checkpoint", *frames, "--checkpoint", "c.exr")
        self.refuse(scene, "--frames and --samples", *frames, "--samples", "0:2")
        self.refuse(scene, "--fps belongs to --frames", "--fps", "24")
        self.refuse(scene, "--overwrite works with --frames only", "--overwrite")
        self.refuse(scene, "--fps", *frames, "--fps", "0")
        with open(scene, encoding="utf-8") as file:
            textured = dict(json.load(file), images=[{"uri": "map1.png"}])
        with open(self.path("map1.png"), "wb") as file:
            file.write(b"precious")
        self.refuse(write_gltf(self.path("textured.gltf"), textured), "'map1.png' is an input", "--frames", "0:2",
                    "-o", "map%d.png", "--overwrite", code=1)
        os.mkfifo(self.path("pipe0.exr"))
        for more in [["-o", "pipe%d.exr"], [*frames[2:], "--env", "pipe0.exr"]]:
            self.refuse(scene, "'pipe0.exr': it is not a regular file", "--frames", "0", *more, code=1)
        still = Builder()
        still.add(GLOW)
        self.refuse(still.write(self.path("still.gltf")), "no animation", *frames, code=1)
        self.refuse(self.path("nothing.gltf"), "nothing.gltf", *frames, code=1)
        self.refuse(scene, "folder", "--frames", "0:2", "-o", "nowhere/a.%d.exr", code=1)


if __name__ == "__main__":
    unittest.main()

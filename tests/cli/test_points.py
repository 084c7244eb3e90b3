# tiers: quick, full
"""Points and lines are as wide as --point-size says; bits do not depend on the structure, nor on whether frames are rendered alone."""
import json
import math
import struct
import unittest

from support import QUICK, Case, data_uri, eclat, move_node, quad_scene, read_exr, write_gltf
from tiers import full

SQUARE = 512  # pixels of a picture in which a point of width 1 covers one pixel


class Points(Case):
    def scene(self, mode, change=lambda scene: None):
        """The corners of the quad, 2 x 2, as points or lines that emit. The camera is 3 before it."""
        scene, _ = quad_scene()
        del scene["meshes"][0]["primitives"][0]["indices"]
        scene["meshes"][0]["primitives"][0]["mode"] = mode
        del scene["cameras"][0]["perspective"]["aspectRatio"]
        change(scene)
        return write_gltf(self.path("scene.gltf"), scene)

    def render(self, scene, *options):
        out = self.path("a.exr")
        run = self.assert_ok(eclat("render", scene, "--env", "0,0,0", *QUICK, "--json", "-q", "-o", out, *options))
        return json.loads(run.stdout)["image_sha256"], read_exr(out)[1]

    def test_widths(self):
        """The share of the picture that an upright line of a loop covers."""
        for size, window in [(4, 0.2), (24, 0.5)]:
            left = 1 / (3 * math.tan(0.4))  # the middle of the line, in half heights of the picture
            part = [left - window, left + window, -0.05, 0.05]
            _, planes = self.render(self.scene(2), "--point-size", str(size), "--size", "64x8", "--spp", "64", "--screen-window", ",".join(map(str, part)))
            share = sum(planes["A"]) / len(planes["A"])
            self.assertAlmostEqual(share * 2 * window * SQUARE / 2 / size, math.hypot(1, 1 / 3), delta=0.06)  # wider away from the axis

    @full
    def test_all_structures_have_the_same_bits(self):
        scene = self.scene(3)
        options = ["--size", "48x48", "--spp", "4", "--point-size", "9"]
        pictures = {name: self.render(scene, *options, "--accel", name) for name in ["bvh8", "bvh2", "grid", "kdtree", "none", "twolevel"]}
        self.assertEqual(len({sha for sha, _ in pictures.values()}), 1)
        self.assertGreater(sum(pictures["bvh8"][1]["G"]), 0)
        self.assertNotEqual(self.render(scene, *options, "--accel", "bvh8", "--point-size", "8")[0], pictures["bvh8"][0])

    def test_triangles_stay(self):
        """Triangles of the same mesh stay. Without points and lines the option changes nothing."""
        def both(scene):
            scene["meshes"][0]["primitives"].append({"attributes": {"POSITION": 0}, "indices": 1, "material": 0})
        info = json.loads(self.assert_ok(eclat("info", self.scene(0, both), "--json")).stdout)
        self.assertEqual(info["triangles"], 4 * 48 + 2)
        plain = write_gltf(self.path("plain.gltf"), quad_scene()[0])
        options = ["--size", "24x16", "--spp", "2"]
        self.assertEqual(self.render(plain, *options)[0], self.render(plain, *options, "--point-size", "9")[0])

    def test_frames_of_a_camera_that_comes_nearer(self):
        """Each frame is what it is alone: points keep their width in pixels, however near the camera is."""
        scene = self.scene(0, lambda scene: move_node(scene, 1, (0, 0, 6), (0, 0, 3)))
        options = ["--size", "32x32", "--spp", "4", "--env", "0,0,0", "--point-size", "40", *QUICK, "-q"]
        self.assert_ok(eclat("render", scene, *options, "--frames", "0:2", "--fps", "2", "-o", self.path("f%d.exr")))
        shares = []
        for frame in range(3):
            alone = self.path("alone.exr")
            self.assert_ok(eclat("render", scene, *options, "--at", str(frame / 2), "-o", alone))
            a, b = read_exr(self.path(f"f{frame}.exr"))[1], read_exr(alone)[1]
            self.assertEqual(a["G"], b["G"])
            shares.append(sum(a["A"]))
        self.assertAlmostEqual(shares[0] / shares[2], 1, delta=0.2)

    def moved(self, how):
        """The picture of points moved by (0.5, 0.25, 0): in the file, by a morph target, by a joint."""
        shift = (0.5, 0.25, 0)

        def change(scene):
            points = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
            primitive = scene["meshes"][0]["primitives"][0]
            if how == "file":
                primitive["attributes"]["POSITION"] = self.add_floats(scene, "VEC3", [[a + b for a, b in zip(p, shift)] for p in points])
            elif how == "morph":
                primitive["targets"] = [{"POSITION": self.add_floats(scene, "VEC3", [shift] * 4)}]
                scene["meshes"][0]["weights"] = [1]
            elif how == "skin":
                scene["buffers"].append({"byteLength": 16, "uri": data_uri(bytes([0, 1, 0, 0] * 4))})
                scene["bufferViews"].append({"buffer": 1, "byteLength": 16})
                scene["accessors"].append({"bufferView": 2, "componentType": 5121, "count": 4, "type": "VEC4"})
                primitive["attributes"].update(JOINTS_0=2, WEIGHTS_0=self.add_floats(scene, "VEC4", [[0.5, 0.5, 0, 0]] * 4))
                scene["nodes"][0]["skin"] = 0
                scene["nodes"] += [{"translation": [2 * x for x in shift]}, {}]
                scene["scenes"][0]["nodes"] += [2, 3]
                scene["skins"] = [{"joints": [2, 3]}]
        return self.render(self.scene(0, change), "--size", "48x32", "--spp", "4", "--point-size", "60")[1]["A"]

    @staticmethod
    def add_floats(scene, kind, rows):
        data = struct.pack(f"<{len(rows) * len(rows[0])}f", *(value for row in rows for value in row))
        scene["buffers"].append({"byteLength": len(data), "uri": data_uri(data)})
        scene["bufferViews"].append({"buffer": len(scene["buffers"]) - 1, "byteLength": len(data)})
        scene["accessors"].append({"bufferView": len(scene["bufferViews"]) - 1, "componentType": 5126, "count": len(rows), "type": kind,
                                   "min": [min(column) for column in zip(*rows)], "max": [max(column) for column in zip(*rows)]})
        return len(scene["accessors"]) - 1

    def test_morph_targets_and_skins_move_them(self):
        as_written = self.moved("file")
        self.assertGreater(sum(a != b for a, b in zip(as_written, self.moved("not at all"))), 100)
        for how in "morph", "skin":
            with self.subTest(how):
                self.assertLess(sum(abs(a - b) for a, b in zip(as_written, self.moved(how))), 0.01 * sum(as_written))

    def test_they_move_while_the_shutter_is_open(self):
        """Points move by half of their distance along x. Each leaves a trail with as much light as a point that stands still."""
        scene = self.scene(0, lambda scene: move_node(scene, 0, (0, 0, 0), (1, 0, 0)))
        options = ["--size", "96x64", "--spp", "16", "--point-size", "30"]
        still, trail = (self.render(scene, *options, *when)[1]["A"] for when in (["--at", "0.5"], ["--shutter", "0:1"]))
        self.assertAlmostEqual(sum(trail) / sum(still), 1, delta=0.05)
        self.assertGreater(sum(a > 0 for a in trail), 3 * sum(a > 0 for a in still))


if __name__ == "__main__":
    unittest.main()

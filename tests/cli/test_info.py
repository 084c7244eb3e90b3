# tiers: quick, full
"""eclat info: figures of scenes with known contents."""
import json
import os
import struct
import unittest
import zlib

from support import CORNELL, RING, SHARED, SOURCE, Case, data_uri, eclat, quad_scene, write_glb, write_gltf
from tiers import full


def png(*texels):
    """A picture of one row, as a data URI."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    row = b"\0" + b"".join(bytes(t) for t in texels)
    return data_uri(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(texels), 1, 8, 6 if len(texels[0]) == 4 else 2, 0, 0, 0)) +
                    chunk(b"IDAT", zlib.compress(row)) + chunk(b"IEND", b""))


class InfoCase(Case):
    def info(self, path, *options):
        run = self.assert_ok(eclat("info", "--json", path, *options))
        return json.loads(run.stdout)


class Info(InfoCase):
    def test_quad(self):
        report = self.info(write_gltf(self.path("quad.gltf"), quad_scene()[0]))
        self.assertEqual([report[key] for key in ["meshes", "instances", "triangles", "vertices", "images"]],
                         [1, 1, 2, 4, 0])
        self.assertEqual(report["lights"]["emissive_triangles"], 2)
        self.assertTrue(report["lights"]["any"])
        self.assertEqual([(camera["name"], camera["type"]) for camera in report["cameras"]], [("front", "perspective")])
        self.assertEqual(report["extensions_used"], [])
        self.assertGreater(report["device_bytes"], 0)
        self.assertGreater(report["peak_memory_bytes"], 0)
        self.assertIsInstance(report["effects"], list)
        for key in ["references", "nodes", "leaves", "max_depth", "sah_cost", "leaf_fill", "build_seconds"]:
            self.assertIn(key, report["bvh"])

    def test_glb_says_the_same(self):
        scene, buffer = quad_scene()
        gltf = self.info(write_gltf(self.path("quad.gltf"), scene))
        glb = self.info(write_glb(self.path("quad.glb"), scene, buffer))
        for key in ["triangles", "vertices", "lights", "cameras", "device_bytes", "effects"]:
            self.assertEqual(gltf[key], glb[key])

    def test_text(self):
        run = self.assert_ok(eclat("info", CORNELL))
        for word in ["geometry", "triangles", "materials", "lights", "cameras", "extensions", "unsupported", "kernels", "effects",
                     "memory", "BVH"]:
            self.assertRegex(run.stdout, rf"(?m)^{word} ")

    def test_pairs_of_lamps_with_a_tree_and_without(self):
        for job, expected in (((RING, "--light-choice", "power"), {"lamp-pairs"}), ((RING, "--light-choice", "tree"), {"lamp-pairs", "light-tree"}),
                              ((CORNELL, "--light-choice", "tree"), {"light-tree"})):
            with self.subTest(job=job):
                self.assertEqual({"lamp-pairs", "light-tree"} & set(self.info(*job)["effects"]), expected)

    def test_what_casts_caustics(self):
        found = self.assert_ok(eclat("info", RING)).stdout
        self.assertRegex(found, r'(?m)^caustics +light is mirrored by material 1 "ring"\n +render looks first whether light paths pay')
        self.assertEqual(self.info(RING)["caustics"], [{"material": 1, "name": "ring", "light": "mirrored"}])
        self.assertRegex(self.assert_ok(eclat("info", CORNELL)).stdout, r"(?m)^caustics +none: no surface bends light")
        glass = self.info(os.path.join(SOURCE, "scenes", "vase", "vase.gltf"))["caustics"]
        self.assertEqual({one["light"] for one in glass}, {"bent"})

    @full
    def test_accelerators_are_measured(self):
        report = json.loads(self.assert_ok(eclat("info", "--json", "--accel", "all", CORNELL)).stdout)
        rows = {row["name"]: row for row in report["accels"]}
        self.assertEqual(set(rows), {"bvh2", "bvh8", "grid", "kdtree", "none", "twolevel"})
        triangles = report["triangles"]
        self.assertEqual((rows["none"]["nodes_per_ray"], rows["none"]["triangles_per_ray"]), (0, triangles))
        self.assertIsNone(rows["grid"]["sah_cost"])
        for name, row in rows.items():
            with self.subTest(name):
                self.assertGreaterEqual(row["references"], triangles)
                self.assertGreater(row["rays_per_second"], 0)
                self.assertGreater(row["bytes"], 0)
                self.assertLessEqual(row["triangles_per_ray"], 2 * triangles)
                self.assertTrue(name == "none" or 1 <= row["nodes_per_ray"] < 100)
        run = self.assert_ok(eclat("info", "--accel", "grid", CORNELL))
        self.assertRegex(run.stdout, r"(?m)^accel +build +memory +nodes")
        self.assertRegex(run.stdout, r"(?m)^grid ")
        self.assertNotIn("kdtree", run.stdout)
        self.assert_one_error(eclat("info", "--accel", "octree", CORNELL), 2)

    @full
    def test_grid_density_changes_the_cells(self):
        def grid(*options, scene=CORNELL):
            report = json.loads(self.assert_ok(eclat("info", "--json", "--accel", *options, scene)).stdout)
            return {row["name"]: row for row in report["accels"]}["grid"]
        default = grid("grid")["nodes"]
        for options in [("grid", "--grid-density", "27"), ("all", "--grid-density=27.0")]:
            self.assertEqual(grid(*options)["nodes"], default)
        self.assertEqual(grid("grid", "--grid-density", "0.01")["nodes"], 64)  # one block
        # 40 960 small triangles. Axes are rounded up to blocks of four cells; there are 50 and 100 cells here.
        spheres = os.path.join(SOURCE, "scenes", "furnace", "spheres.gltf")
        for density in [3, 24]:
            cells = grid("grid", f"--grid-density={density}", scene=spheres)["nodes"]
            self.assertTrue(0.85 < cells / (40960 * density) < 1.15, (density, cells))
        # The grid is made coarser until it has no more than 64 entries a reference.
        bounded = grid("grid", "--grid-density=10000", scene=spheres)
        self.assertTrue(32 * 40960 < bounded["references"] <= 64 * 40960, bounded)

    def test_unsupported_extensions_are_told_and_required_ones_refused(self):
        scene, _ = quad_scene()
        scene["extensionsUsed"] = ["EXT_of_another_world"]
        path = write_gltf(self.path("used.gltf"), scene)
        run = self.assert_ok(eclat("info", "--json", path))
        self.assertEqual(json.loads(run.stdout)["extensions_unsupported"], ["EXT_of_another_world"])
        self.assertRegex(run.stderr, r"(?m)^eclat: warning: .*EXT_of_another_world")
        scene["extensionsRequired"] = ["EXT_of_another_world"]
        line = self.assert_one_error(eclat("info", write_gltf(self.path("required.gltf"), scene)), 1)
        self.assertIn("EXT_of_another_world", line)

    def test_a_mesh_without_a_material_is_in_order(self):
        scene, _ = quad_scene()
        del scene["materials"], scene["meshes"][0]["primitives"][0]["material"]
        self.assertEqual(self.assert_ok(eclat("info", "--quiet", write_gltf(self.path("bare.gltf"), scene))).stderr, "")

    def test_cameras_say_where_they_stand(self):
        # A quarter turn about y, at (5, 6, 7), as a node's matrix, by columns. 5e5 more moves the scene's centre, which must not show.
        for x in [5, 5e5]:
            scene, _ = quad_scene()
            scene["nodes"][0]["translation"] = [x, 0, 0]
            scene["nodes"][1] = {"camera": 0, "translation": [x, 6, 7], "rotation": [0, 0.5 ** 0.5, 0, 0.5 ** 0.5]}
            camera = self.info(write_gltf(self.path("turned.gltf"), scene))["cameras"][0]
            for got, expected in zip(camera["matrix"], [0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, x, 6, 7, 1], strict=True):
                self.assertAlmostEqual(got, expected, delta=1e-5)
        scene["cameras"][0] = {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0, "zfar": 9}}
        camera = self.info(write_gltf(self.path("orthographic.gltf"), scene))["cameras"][0]
        self.assertEqual([camera["xmag"], camera["ymag"]], [3, 2])

    def test_lamps_without_light(self):
        """A cone without an opening, a lamp hidden by vertex alpha, and one with a black picture emit nothing: the report leaves them out."""
        black = {"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}}
        hidden = {"emissiveFactor": [1, 1, 1], "alphaMode": "BLEND"}
        spot = {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {"outerConeAngle": 0}}]}}
        for what, material, alpha, lights, lit in (("spot", {}, 1, spot, False), ("alpha", hidden, 0, None, False), ("alpha", hidden, 1, None, True),
                                                   ("black", black, 1, None, False),
                                                   ("unlit", {"extensions": {"KHR_materials_unlit": {}}}, 1, None, True),
                                                   ("black unlit", {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]},
                                                                    "extensions": {"KHR_materials_unlit": {}}}, 1, None, False)):
            scene, buffer = quad_scene(material=material)
            buffer += struct.pack("<16f", *[1, 1, 1, alpha] * 4)
            scene["bufferViews"].append({"buffer": 0, "byteOffset": 60, "byteLength": 64})
            scene["accessors"].append({"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC4"})
            scene["accessors"].append({"componentType": 5126, "count": 4, "type": "VEC2"})
            scene["meshes"][0]["primitives"][0]["attributes"].update(COLOR_0=2, TEXCOORD_0=3)
            scene["buffers"] = [{"byteLength": len(buffer), "uri": data_uri(buffer)}]
            scene["images"], scene["textures"] = [{"uri": png((0, 0, 0))}], [{"source": 0}]
            if lights:
                scene["extensions"] = lights
                scene["nodes"][0]["extensions"] = {"KHR_lights_punctual": {"light": 0}}
            with self.subTest(what, alpha=alpha):
                report = self.info(write_gltf(self.path("quad.gltf"), scene))
                self.assertEqual((report["lights"]["any"], report["lights"]["emissive_triangles"]), (lit, 2 * lit))
                self.assertEqual("environment" in report["effects"], not lit)

    def test_no_light_and_no_camera_are_told(self):
        scene, _ = quad_scene(material={})
        del scene["cameras"], scene["nodes"][1]["camera"]
        path = write_gltf(self.path("bare.gltf"), scene)
        run = self.assert_ok(eclat("info", path))
        self.assertRegex(run.stdout, "none at all: .*built-in studio")
        self.assertRegex(run.stderr, r"(?m)^eclat: note: .*camera")
        self.assertEqual(self.assert_ok(eclat("info", "--quiet", path)).stderr, "")

    def test_malformed_files_neither_crash_nor_hang(self):
        folder = os.path.join(SHARED, "assets", "bad-gltf")
        if not os.path.isdir(folder):
            self.skipTest("skipped: no ../shared/assets/bad-gltf here")
        for parent, _, names in os.walk(folder):
            for name in sorted(names):
                if not name.endswith((".gltf", ".glb")):
                    continue
                with self.subTest(file=os.path.join(parent, name)):
                    run = eclat("info", "--json", os.path.join(parent, name))
                    self.assertIn(run.returncode, (0, 1), run.stderr)
                    if run.returncode == 0:
                        json.loads(run.stdout)
                    errors = [line for line in run.stderr.splitlines() if line.startswith("eclat: error: ")]
                    self.assertEqual(len(errors), run.returncode, run.stderr)


if __name__ == "__main__":
    unittest.main()

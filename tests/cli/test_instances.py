# tiers: quick, full
"""Meshes that are kept once, from end to end: the picture is that of copies written out, and reports count what is kept."""
import copy
import glob
import json
import math
import os
import random
import shutil
import unittest

from support import NARROW, SOURCE, Case, eclat, quad_scene, read_exr, write_gltf
from tiers import full

LAMPS = os.path.join(SOURCE, "scenes", "lamps")  # needs every effect of core glTF: textures, normal maps, alpha, vertex colours


def multiplied(document, times):
    """The scene with every mesh in `times` more places: turned, mirrored, sheared, flattened or small."""
    draw = random.Random(7)
    document = copy.deepcopy(document)
    nodes, roots = document["nodes"], document["scenes"][document.get("scene", 0)]["nodes"]
    for mesh in range(len(document["meshes"])):
        for k in range(times):
            a = [[(0.7 if row == column else 0) + draw.uniform(-0.3, 0.3) for column in range(3)] for row in range(3)]
            if k == 1:
                a[0] = [-x for x in a[0]]
            at = [draw.uniform(-0.6, 0.6) for _ in range(3)]
            columns = [[a[row][column] for row in range(3)] + [0] for column in range(3)]
            nodes.append({"mesh": mesh, "matrix": columns[0] + columns[1] + columns[2] + at + [1]})
            roots.append(len(nodes) - 1)
    nodes.append({"mesh": 0, "scale": [1, 0, 1]})
    roots.append(len(nodes) - 1)
    return document


class Instances(Case):
    def setUp(self):
        super().setUp()
        for file in glob.glob(os.path.join(LAMPS, "*")):
            shutil.copy(file, self.folder)
        with open(os.path.join(LAMPS, "lamps.gltf"), encoding="utf-8") as file:
            document = multiplied(json.load(file), 2)
        self.scene = self.path("many.gltf")
        with open(self.scene, "w", encoding="utf-8") as file:
            json.dump(document, file)

    def render(self, *options):
        run = self.assert_ok(eclat("render", self.scene, *NARROW, "--json", "--quiet", "--size", "40x30", "--spp", "8", "--env", "0.3,0.4,0.5", *options,
                                   cwd=self.folder))
        return json.loads(run.stdout)

    @full
    def test_the_picture_is_that_of_what_is_written_out(self):
        kept = self.render("--instancing", "on", "-o", "kept.exr")
        self.assertGreater(kept["instances"], 20)
        self.assertLess(2 * kept["stored_triangles"], kept["triangles"])
        self.assertIn("instances", kept["effects"])
        self.assertEqual(kept["invalid_samples"], 0)
        for change in [["--accel", "kdtree"], ["--lanes", "4"]]:
            with self.subTest(change=change):
                other = self.render("--instancing", "on", *change)
                self.assertEqual(other["image_sha256"], kept["image_sha256"])
                self.assertEqual(other["instances"], 0 if "--accel" in change else kept["instances"])
        attributes = read_exr(self.path("kept.exr"))[0]
        self.assertIn(f'{kept["instances"]}', str(attributes["eclat.instances"]))
        # Copies written out are rounded differently and have other numbers, which gives other samples of the same picture. Four standard
        # errors.
        off = self.render("--instancing", "off", "--accel", "kdtree")
        self.assertEqual((off["instances"], off["triangles"]), (0, kept["triangles"]))
        self.assertNotEqual(off["image_sha256"], kept["image_sha256"])
        error = math.hypot(*(r["error"] * r["mean_luminance"] for r in (off, kept))) / math.sqrt(40 * 30)
        self.assertAlmostEqual(off["mean_luminance"], kept["mean_luminance"], delta=4 * error)

    @full
    def test_other_integrators(self):
        """Without random light the pictures differ only by rounding: 3e-3 allows for a few texels or pixels at edges."""
        for integrator in ["whitted", "raster"]:
            with self.subTest(integrator=integrator):
                kept, off = (self.render("--instancing", how, "--integrator", integrator) for how in ["on", "off"])
                self.assertAlmostEqual(off["mean_luminance"], kept["mean_luminance"], delta=0.003 * kept["mean_luminance"])

    def test_info_says_what_is_kept(self):
        kept, off = (json.loads(self.assert_ok(eclat("info", "--json", "--instancing", how, self.scene)).stdout) for how in ["on", "off"])
        self.assertEqual(kept["triangles"], off["triangles"])
        self.assertEqual(off["stored_triangles"], off["triangles"])
        self.assertLess(2 * kept["stored_triangles"], kept["triangles"])
        self.assertEqual(off["kept_instances"], 0)
        self.assertLess(kept["device_bytes"], off["device_bytes"])
        self.assertRegex(self.assert_ok(eclat("info", "--instancing", "on", self.scene)).stdout,
                         rf'(?m)^kept once   {kept["kept_meshes"]} meshes at {kept["kept_instances"]} places: {kept["triangles"]} triangles in all$')


class InOnePlane(Case):
    def assert_the_first_is_met(self, accels):
        """Two meshes, each kept once and in two places, overlap in one plane: every ray meets the same one, in every accelerator."""
        scene, _ = quad_scene(material={"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.1, 0.1, 1], "metallicFactor": 0}, "doubleSided": True})
        scene["materials"].append({"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.1, 0.9, 1], "metallicFactor": 0}, "doubleSided": True})
        scene["meshes"].append({"primitives": [{**scene["meshes"][0]["primitives"][0], "material": 1}]})
        camera = scene["nodes"].pop()
        half = [math.radians(angle) / 2 for angle in (3, -5, 11, 21)]
        scene["nodes"] = [{"mesh": k % 2, "translation": [0, 0, 0.1], "rotation": [0, 0, math.sin(a), math.cos(a)], "scale": [-1 if k == 3 else 1, 1, 1]}
                          for k, a in enumerate(half)] + [camera]
        scene["scenes"][0]["nodes"] = list(range(5))
        path, shas = write_gltf(self.path("a.gltf"), scene), set()
        for accel in accels:
            run = self.assert_ok(eclat("render", path, "--instancing", "on", *accel, "--env", "1,1,1", "--size", "24x16", "--spp", "16", "--json", "--quiet",
                                       "--channels", "albedo", "-o", self.path("a.exr")))
            found = json.loads(run.stdout)
            shas.add(found["image_sha256"])
            self.assertIn("coplanar-faces", found["effects"])
            _, channels = read_exr(self.path("a.exr"))
            seen = [channels["albedo.R"][24 * y + x] for y in range(5, 11) for x in range(9, 15)]
            self.assertLess(max(seen) - min(seen), 1e-3, seen)
        self.assertEqual(len(shas), 1)

    def test_the_first_of_faces_in_one_plane_is_met(self):
        self.assert_the_first_is_met([[], ["--accel", "none"]])

    @full
    def test_the_first_of_faces_is_met_by_single_rays(self):
        self.assert_the_first_is_met([["--lanes", "1"], ["--accel", "none", "--lanes", "1"]])


if __name__ == "__main__":
    unittest.main()

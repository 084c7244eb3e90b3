# tiers: quick, full
"""--ground: a floor under the scene, and a floor that only catches shadows."""
import json
import math
import unittest

from support import QUICK, Case, eclat, move_node, quad_scene, read_exr, write_gltf
from test_ranks import mpirun, without_mpi
from tiers import full

N = 16
BLACK = {"doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0, 0, 0, 1]}}


class Ground(Case):
    def setUp(self):
        super().setUp()
        scene = quad_scene(material=BLACK)[0]
        scene["nodes"][0] = {"mesh": 0, "rotation": [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)]}  # turns the square into y = 0, 2 x 2
        self.document = scene
        self.scene = write_gltf(self.path("scene.gltf"), scene)

    def render(self, name, *options, spp=64, scene=None):
        run = self.assert_ok(eclat("render", scene or self.scene, *QUICK, "--size", f"{N}x{N}", "--spp", str(spp), "--seed", "3", "--json", *options, "-o", self.path(name)))
        return json.loads(run.stdout), read_exr(self.path(name))[1]

    def test_a_matte_floor_at_the_lowest_point(self):
        """In a white environment of 1, a floor of reflectance 0.5 shows 0.5, except where an object hides the sky. Seen straight from
        above, its depth is that of its height."""
        away = ("--env", "1,1,1", "--eye", "9,5,0", "--look-at", "9,0,0", "--up", "0,0,1", "--fov", "5", "--channels", "A,depth")
        _, seen = self.render("a.exr", "--ground", *away, spp=256)
        for c in "RGB":
            self.assertAlmostEqual(sum(seen[c]) / N ** 2, 0.5, delta=0.005)
        self.assertEqual(set(seen["A"]), {1.0})
        for depth in seen["depth.Z"]:
            self.assertAlmostEqual(depth, 5 + 1e-4 * math.sqrt(2), delta=5 * (1 / math.cos(math.radians(3.6)) - 1) + 1e-5)
        _, none = self.render("none.exr", "--env", "1,1,1", *away[2:])
        self.assertEqual(set(none["A"]), {0.0})
        _, below = self.render("below.exr", "--ground", "--env", "1,1,1", "--eye", "9,-5,0", "--look-at", "9,0,0", "--up", "0,0,1", "--channels", "A", spp=8)
        self.assertEqual(set(below["A"]), {1.0})  # the floor is opaque

    def test_instances_and_the_ground(self):
        self.document["nodes"] += [{"mesh": 0, "translation": [2.5 * k, 1, -2]} for k in range(-2, 3)]
        self.document["scenes"][0]["nodes"] += list(range(2, 7))
        many = write_gltf(self.path("many.gltf"), self.document)
        hashes = {self.render("b.exr", "--ground", "--env", "1,0.8,0.6", "--eye", "3,4,9", "--look-at", "0,0,0", "--effects", "needed", "--instancing", kept, scene=many, spp=16)[0]["image_sha256"]
                  for kept in ("on", "off")}
        self.assertEqual(len(hashes), 1)

    def test_the_shadow_of_a_square(self):
        """A square at height h hides a part of a sky of 1. Cosine-weighted, that part is a view factor. For the point below the centre it
        is (2 / pi) * 2 * a / sqrt(1 + a^2) * atan(a / sqrt(1 + a^2)), a = side / 2 h (Howell, B-3)."""
        # the lowest point brings the ground to y = -1
        self.document["nodes"].append({"mesh": 0, "scale": [1e-3] * 3, "translation": [4, -1, 0]})
        self.document["scenes"][0]["nodes"].append(2)
        scene = write_gltf(self.path("high.gltf"), self.document)
        under = ("--env", "1,1,1", "--background", "transparent", "--eye", "0,-0.5,0", "--look-at", "0,-1,0", "--up", "0,0,1", "--fov", "3")
        report, seen = self.render("c.exr", "--ground=shadow", *under, spp=1024, scene=scene)
        a = 1 / math.sqrt(2)
        expected = 4 / math.pi * a * math.atan(a)
        mean = sum(seen["A"]) / N ** 2
        self.assertLess(report["shadow_stderr"], 0.02)
        self.assertAlmostEqual(mean, expected, delta=max(0.003, 4 * report["shadow_stderr"] / N))
        spread = math.sqrt(sum((x - mean) ** 2 for x in seen["A"]) / (N ** 2 - 1))
        self.assertLess(0.6, report["shadow_stderr"] / spread)  # the stated error matches the spread
        self.assertGreater(1.6, report["shadow_stderr"] / spread)
        self.assertEqual({v for c in "RGB" for v in seen[c]}, {0.0})  # the picture has only the shadow

    @full
    def test_no_shadow_where_nothing_is_in_the_way(self):
        """Equal bits: both pictures have the same samples. The sun is straight above, so that the shadow is the square itself."""
        self.document["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}}
        self.document["extensionsUsed"] = ["KHR_lights_punctual"]
        self.document["nodes"] += [{"extensions": {"KHR_lights_punctual": {"light": 0}}, "rotation": [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)]},
                                   {"mesh": 0, "scale": [1e-3] * 3, "translation": [9, -4, 0]}]
        self.document["scenes"][0]["nodes"] += [2, 3]
        scene = write_gltf(self.path("sun.gltf"), self.document)
        for colour in ("transparent", "white"):
            report, seen = self.render("d.exr", "--ground=shadow", "--background", colour, "--eye", "0,-2,4", "--look-at", "0,-4,0", "--fov", "60", spp=16, scene=scene)
            self.assertEqual(set(seen["A"]) & {0.0, 1.0}, {0.0, 1.0})
            self.assertLess(sum(0 < x < 1 for x in seen["A"]), N ** 2 / 4)

    @full
    def test_the_ground_stays_while_objects_move(self):
        """The ground is the same in all frames, under the lowest point of all times: a square falls from y = 3 to 1 within a second, and
        the camera is 5 above y = 1. A shorter range of frames gives the same bits. The box is 2 x 2 x 2."""
        move_node(self.document, 0, [0, 3, 0], [0, 1, 0])
        scene = write_gltf(self.path("falling.gltf"), self.document)
        away = ("--env", "1,1,1", "--eye", "9,6,0", "--look-at", "9,1,0", "--up", "0,0,1", "--fov", "5", "--channels", "A,depth")
        for frames, name in (("0:2", "frame"), ("1:1", "alone")):
            self.assert_ok(eclat("render", scene, *QUICK, "--size", f"{N}x{N}", "--spp", "8", "--ground", *away, "--fps", "2", "--frames", frames, "-q", "-o", self.path(name + "%d.exr")))
        for frame in range(3):
            for depth in read_exr(self.path(f"frame{frame}.exr"))[1]["depth.Z"]:
                self.assertAlmostEqual(depth, 5 + 1e-4 * math.sqrt(3), delta=5 * (1 / math.cos(math.radians(3.6)) - 1) + 1e-5)
        self.assertEqual(read_exr(self.path("frame1.exr"))[1], read_exr(self.path("alone1.exr"))[1])

    @full
    @unittest.skipIf(without_mpi(), "no MPI")
    def test_processes_of_an_mpi_job(self):
        """The ranks' picture has the bits of one process, shadow included."""
        for ground in (["--ground"], ["--ground=shadow", "--background", "transparent"]):
            job = [self.scene, *QUICK, *ground, "--size", f"{N}x{N}", "--spp", "32", "--env", "1,0.8,0.6", "--eye", "3,4,9", "--look-at", "0,0,0", "-q"]
            self.assert_ok(eclat("render", *job, "-o", self.path("one.exr")))
            self.assert_ok(mpirun(2, "render", *job, "-o", self.path("two.exr")))
            self.assertEqual(read_exr(self.path("one.exr"))[1], read_exr(self.path("two.exr"))[1])

    def test_what_does_not_go_together(self):
        for options, code, says in [(["--ground=mud"], 2, "is not one of none, matte, shadow"),
                                    (["--ground=shadow"], 2, "give --background transparent, a colour or blur"),
                                    (["--ground=shadow", "--background", "white", "--integrator", "raster"], 2, "belongs to --integrator path"),
                                    (["--ground=shadow", "--background", "white", "--env-strength", "0", "--env", "1,1,1"], 1, "give a --light")]:
            run = eclat("render", self.scene, *QUICK, "--size", "8x8", "--spp", "1", *options, "-o", self.path("e.exr"))
            self.assertIn(says, self.assert_one_error(run, code))


if __name__ == "__main__":
    unittest.main()

# tiers: quick, full
"""Pixels at a lamp's edge: rays of their own find how much of the lamp each pixel sees, and the picture's mean does not change."""
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "robust"))
from hard_scene import Scene
from other_way import OtherWay
from support import read_exr
from tiers import full

BLACK = {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}, "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}
GRAY = {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}, "doubleSided": True}
LAMP = {**BLACK, "emissiveFactor": [1, 1, 1]}
GRAY_LAMP = {**GRAY, "emissiveFactor": [1, 1, 1]}
SIZE = 32
ENVIRONMENT = ["--env", "0.1,0.1,0.1"]


def turned(half, angle, z):
    """A square in the plane z, turned by `angle` radians: its corners, and two triangles that face +z."""
    corners = [(half * math.sqrt(2) * math.cos(angle + k * math.pi / 2), half * math.sqrt(2) * math.sin(angle + k * math.pi / 2)) for k in range(4)]
    return corners, [c for k in (0, 1, 2, 0, 2, 3) for c in (*corners[k], z)]


def clipped_area(corners, x0, y0, x1, y1):
    """Area of the intersection of a convex polygon and a rectangle (Sutherland and Hodgman 1974)."""
    for axis, bound, sign in ((0, x0, 1), (0, x1, -1), (1, y0, 1), (1, y1, -1)):
        kept = []
        for a, b in zip(corners, corners[1:] + corners[:1]):
            da, db = sign * (a[axis] - bound), sign * (b[axis] - bound)
            if da >= 0:
                kept.append(a)
            if da * db < 0:
                kept.append(tuple(a[k] + (b[k] - a[k]) * da / (da - db) for k in range(2)))
        corners = kept
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(corners, corners[1:] + corners[:1]))


def coverage(corners):
    """Coverage of each pixel, row by row from the top, in a picture of [-1, 1] x [-1, 1]."""
    step = 2 / SIZE
    return [clipped_area(corners, x * step - 1, 1 - (y + 1) * step, (x + 1) * step - 1, 1 - y * step) / step ** 2 for y in range(SIZE) for x in range(SIZE)]


class LampEdges(OtherWay):
    def lamp(self, *shapes, materials=(LAMP, BLACK)):
        scene = Scene(*materials)
        scene.extend("KHR_materials_specular")
        scene.json["cameras"][0] = {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 9}}
        for triangles, material in shapes:
            scene.add(triangles, material)
        return scene.write(self.path("lamp.gltf"))

    def pixels(self, job, *options, channel="G"):
        self.render(*job, *options)
        return read_exr(self.path("a.exr"))[1][channel]

    def assert_covers(self, path, truth, most, *options):
        """Checks the root mean square error over the pixels that lamps cover in part; with plain samples it is about 0.017."""
        pixels = self.pixels([path, "--size", f"{SIZE}x{SIZE}"], "--spp", "64", *options)
        apart = [(p - t) ** 2 for p, t in zip(pixels, truth) if min(truth) + 1e-6 < t < max(truth) - 1e-6]
        self.assertGreater(len(apart), 50)
        self.assertLess(math.sqrt(sum(apart) / len(apart)), most)

    def test_a_lamp(self):
        corners, triangles = turned(0.5, 0.3, 0)
        self.assert_covers(self.lamp((triangles, 0)), coverage(corners), 0.007)

    def test_before_an_environment(self):
        corners, triangles = turned(0.5, 0.3, 0)
        self.assert_covers(self.lamp((triangles, 0)), [c + 0.1 * (1 - c) for c in coverage(corners)], 0.007, *ENVIRONMENT)

    def test_before_a_lamp(self):
        corners, triangles = turned(0.6, 0.3, 0)
        hole, hides = turned(0.3, 0.9, 0.5)
        truth = [a - b for a, b in zip(coverage(corners), coverage(hole))]
        self.assert_covers(self.lamp((triangles, 0), (hides, 1)), truth, 0.007)

    def lit(self):
        """Lamps that also reflect, above a floor that does not fill the picture."""
        floor = turned(0.8, 0, 0)[1]
        return self.lamp((floor, 1), (turned(0.3, 0.4, 0.2)[1], 0), ([-0.9, -0.5, 1, -0.3, -0.9, 1, -0.3, -0.9, 0.3], 0), materials=(GRAY_LAMP, GRAY))

    def assert_same_mean(self, *options):
        """Pictures of 32 x 32 pixels, and of one pixel, which has no neighbours to differ from."""
        path = self.lit()
        one = self.render(path, "--size", "1x1", "--spp", "65536", *ENVIRONMENT, *options)
        self.render(path, "--size", f"{SIZE}x{SIZE}", "--spp", "256", *ENVIRONMENT, *options)
        _, planes = read_exr(self.path("a.exr"))
        mean, noise = sum(planes["G"]) / SIZE ** 2, math.sqrt(sum(s * s for s in planes["stderr.G"])) / SIZE ** 2
        self.assertAlmostEqual(mean / one["mean_luminance"], 1, delta=5 * math.hypot(noise / mean, one["error"]))
        self.assertLess(noise / mean, 3e-3)

    def test_mean(self):
        self.assert_same_mean()

    @full
    def test_mean_with_other_options(self):
        for options in (["--fog", "0.3,0.8,0"], ["--clamp", "100"], ["--adaptive"], ["--sampler", "independent"], ["--light-paths", "1"],
                        ["--sample", "bsdf"], ["--integrator", "light"], ["--max-depth", "1"]):
            with self.subTest(options=options):
                self.assert_same_mean(*options)

    def test_bits(self):
        job = [self.lit(), "--size", f"{SIZE}x{SIZE}"]
        self.assert_same_bits(job, [["--wave", "64"], ["--accel", "kdtree"], ["--effects", "all"]])
        self.assert_slices_and_resume(job)

    @full
    def test_bits_of_a_lane(self):
        self.assert_same_bits([self.lit(), "--size", f"{SIZE}x{SIZE}"], [["--lanes", "1"]])


if __name__ == "__main__":
    unittest.main()

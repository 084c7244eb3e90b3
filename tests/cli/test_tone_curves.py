# tier: quick
"""Tone curves equal the published shaders to a step of 1/255."""
import json
import math
import os
import random
import re
import unittest

from screen import CURVES, read_png, shown
from support import QUICK, SOURCE, Case, eclat, quad_scene, read_exr, write_exr, write_gltf


class ToneCurves(Case):
    def slice(self):
        """A map of colours from 2^-9 to 2^6, from grey to saturated. Curves are applied to its rendered picture."""
        dice = random.Random(26)
        colors = [[2 ** dice.uniform(-9, 6) * dice.choice([1, dice.random(), dice.random() ** 4, 0]) for _ in range(32 * 16)] for _ in "RGB"]
        sky = write_exr(self.path("sky.exr"), 32, 16, dict(zip("RGB", colors)))
        scene = write_gltf(self.path("scene.gltf"), quad_scene()[0])
        self.assert_ok(eclat("render", scene, *QUICK, "--size", "40x24", "--spp", "8", "--samples", "0:8", "--fov", "140", "--env", sky, "-q",
                             "-o", self.path("slice.exr")))

    def merge(self, *options):
        self.assert_ok(eclat("merge", self.path("slice.exr"), *options, "-q", "-o", self.path("a.png")))
        return read_png(self.path("a.png"))

    def test_all_equal_their_publications(self):
        self.slice()
        planes = read_exr(self.path("slice.exr"))[1]
        pixels = list(zip(planes["R"], planes["G"], planes["B"]))
        self.assertTrue(min(map(max, pixels)) < 0.1 and max(map(max, pixels)) > 10)
        for curve, exposure in [(name, 0) for name in CURVES] + [("agx", 2.5)]:
            width, height, channels, bits, rows = self.merge("--tonemap", curve, "--exposure", str(exposure))
            self.assertEqual((width, height, channels, bits), (40, 24, 3, 8))
            for i, rgb in enumerate(pixels):
                there = rows[i // 40][i % 40 * 3:i % 40 * 3 + 3]
                for a, b in zip(there, shown(curve, rgb, exposure)):
                    self.assertLessEqual(abs(a - 255 * b), 0.51, (curve, rgb))  # rounding of the code and of the EXR's floats

    def test_help_and_manual_know_them_all(self):
        """One table has the names: help and the window's choice are made from it."""
        text = self.assert_ok(eclat("help", "render")).stdout
        words = " ".join(re.search(r"--tonemap CURVE(.*?)\n +(-\S, )?--", text, re.S)[1].split())
        with open(os.path.join(SOURCE, "docs", "looks.md"), encoding="utf-8") as file:
            manual = file.read()
        for name in CURVES:
            self.assertIn(f"; {name}: ", words)
            self.assertIn(f"| `{name}` |", manual)

    def test_auto_shows_the_log_average_as_middle_grey(self):
        """Reinhard et al. 2002, equations 1 and 2, over all pixels that are not black. The report states the exposure; giving that number
        has the same result."""
        self.slice()
        planes = read_exr(self.path("slice.exr"))[1]
        logs = [math.log2(y) for r, g, b in zip(planes["R"], planes["G"], planes["B"]) if (y := 0.2126 * r + 0.7152 * g + 0.0722 * b) > 0]
        stops = math.log2(0.18) - sum(logs) / len(logs)
        run = self.assert_ok(eclat("merge", self.path("slice.exr"), "--exposure", "auto", "--json", "-o", self.path("auto.png")))
        report = json.loads(run.stdout)
        self.assertAlmostEqual(report["exposure"], stops, places=5)
        self.assertTrue(report["exposure_auto"])
        rows = self.merge("--exposure", repr(report["exposure"]))[4]
        self.assertEqual(read_png(self.path("auto.png"))[4], rows)
        scene = self.path("scene.gltf")
        for env, expected in [("0.05,0.05,0.05", math.log2(0.18 / 0.05)), ("0,0,0", 0)]:
            run = self.assert_ok(eclat("render", scene, *QUICK, "--size", "8x8", "--spp", "8", "--eye", "0,0,-9", "--look-at", "0,0,-99", "--env", env,
                                       "--exposure", "auto", "-o", self.path("dim.png"), "--json"))
            self.assertAlmostEqual(json.loads(run.stdout)["exposure"], expected, places=5)

    def test_auto_wants_the_whole_picture(self):
        scene = write_gltf(self.path("scene.gltf"), quad_scene()[0])
        run = eclat("render", scene, *QUICK, "--size", "4000x4000", "--spp", "1", "--memory", "64M", "--exposure", "auto", "-o", self.path("a.png"))
        self.assertIn("--exposure auto", self.assert_one_error(run, 1))


if __name__ == "__main__":
    unittest.main()

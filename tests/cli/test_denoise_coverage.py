# tier: long
"""Does the stated interval of a denoised picture hold its real error, on ten scenes at three budgets, 100 seeds each? Errors are measured against a long
render, whose own variance is taken off. Prints a line a case, with how often each interval held."""
import json
import math
import os
import sys
import unittest

import denoiser
from support import SOURCE, Case, eclat, read_exr

SCENES = ["cornell-box/cornell-box", "showcase/showcase", "ring/ring", "veach-plates/veach-plates", "lamps/lamps", "glass/glass", "furnace/spheres",
          "drink/drink", "brushed-metal/brushed-metal", "stadium/stadium"]
BUDGETS, SEEDS, REFERENCE, SIZE = (16, 64, 256), 100, 16384, "96x72"
LEAST = 89  # of 100 seeds: 94 stray by 2.4


def luminance(planes, layer=""):
    return [0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in zip(*(planes[layer + c] for c in "RGB"))]


def root_mean_square(values):
    return math.sqrt(sum(x * x for x in values) / len(values))


class Reference:
    def __init__(self, planes):
        self.y = luminance(planes)
        self.mean = sum(self.y) / len(self.y)
        self.variance = sum(s * s for s in planes["stderr.Y"]) / len(self.y)

    def error(self, planes, layer):
        square = sum((a - b) ** 2 for a, b in zip(luminance(planes, layer), self.y)) / len(self.y)
        return math.sqrt(max(square - self.variance, 0)) / self.mean


class Coverage(Case):
    @classmethod
    def setUpClass(cls):
        cls.oidn = denoiser.environment()

    def render(self, scene, *options):
        path = os.path.join(SOURCE, "scenes", scene + ".gltf")
        run = self.assert_ok(eclat("render", path, "--size", SIZE, *options, "-q", "--json", "-o", self.path("a.exr"), env=self.oidn, timeout=3600))
        return json.loads(run.stdout), read_exr(self.path("a.exr"))[1]

    def study(self, scene, spp, reference, *options):
        """One line, and how many intervals held that have an upper end: of the denoised picture and of the best."""
        real, stated, held, open_ones = {"": [], "denoised.": [], "best.": []}, {"denoised.": [], "best.": []}, {"denoised.": 0, "best.": 0}, 0
        for seed in range(1, SEEDS + 1):
            report, planes = self.render(scene, "--spp", str(spp), "--seed", str(seed), "--denoise", *options)
            for layer, values in real.items():
                values.append(reference.error(planes, layer))
            for layer in stated:
                one = report[layer[:-1]]
                stated[layer].append(one["error"])
                held[layer] += one["low95"] <= real[layer][-1] <= (math.inf if one["high95"] is None else one["high95"])
            open_ones += report["denoised"]["high95"] is None
        noisy, denoised, best = (root_mean_square(values) for values in real.values())
        print(f"{scene.split('/')[1]:14} {spp:4} spp: noisy {noisy:.2%}, denoised {denoised:.2%} (stated {root_mean_square(stated['denoised.']):.2%}, held "
              f"{held['denoised.']} of {SEEDS}), best {best:.2%} (stated {root_mean_square(stated['best.']):.2%}, held {held['best.']}); {open_ones} without an "
              f"upper end", file=sys.stderr, flush=True)
        return held, noisy, best / min(noisy, denoised)

    def test_ten_scenes(self):
        total, cases = {"denoised.": 0, "best.": 0}, 0
        for scene in SCENES:
            reference = Reference(self.render(scene, "--spp", str(REFERENCE), "--seed", "777")[1])
            for spp in BUDGETS:
                held, noisy, worse = self.study(scene, spp, reference)
                cases += SEEDS
                for layer in total:
                    total[layer] += held[layer]
                with self.subTest(scene=scene, spp=spp):
                    self.assertGreaterEqual(min(held.values()), LEAST)
                    self.assertLess(worse, 1.02 if noisy < 0.9 else 1.04)  # beyond, single seeds decide what 100 come to
        for layer, count in total.items():
            self.assertGreater(count, 0.93 * cases, layer)

    def test_with_a_clamp(self):
        """Of the clamped picture: the reference has the same limit."""
        clamp = ("--clamp", "10")
        for scene, spp in (("ring/ring", 64), ("lamps/lamps", 16)):
            reference = Reference(self.render(scene, "--spp", str(REFERENCE), "--seed", "777", *clamp)[1])
            held, _, worse = self.study(scene, spp, reference, *clamp)
            with self.subTest(scene=scene, spp=spp):
                self.assertGreaterEqual(min(held.values()), LEAST)
                self.assertLess(worse, 1.04)


if __name__ == "__main__":
    unittest.main()

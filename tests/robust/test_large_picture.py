# tier: full
"""A picture of six million pixels, rendered in 250 MB, has the bits of the whole one, which takes 0.9 GB."""
import json
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cli"))
from support import CORNELL, Case, eclat  # noqa: E402

BOUND = 250 * 10 ** 6
HEADER = 40000  # larger than the header and the table of blocks of such a file


class LargePicture(Case):
    def render(self, name, *options):
        run = self.assert_ok(eclat("render", CORNELL, "--json", "-q", "--size", "2048x3072", "--spp", "2", "--max-depth", "2", *options, "-o", self.path(name + ".exr"),
                                   "-o", self.path(name + ".png"), timeout=1100))
        return json.loads(run.stdout)

    def assert_same_blocks(self, a, b):
        """Compares two EXR files, which compress equal rows to equal bytes."""
        with open(self.path(a), "rb") as one, open(self.path(b), "rb") as other:
            size = min(os.path.getsize(one.name), os.path.getsize(other.name)) - HEADER
            self.assertGreater(size, 4 * 10 ** 7)
            one.seek(-size, os.SEEK_END)
            other.seek(-size, os.SEEK_END)
            for _ in range(0, size, 1 << 20):
                self.assertTrue(one.read(1 << 20) == other.read(1 << 20))

    def test_in_250_mb(self):
        # compiles the kernels
        self.assert_ok(eclat("render", CORNELL, "-q", "--size", "600x600", "--spp", "2", "--max-depth", "2", "-o", self.path("warm.png")))
        strips = self.render("strips", "--memory", "250M")
        self.assertGreater(strips["strips"], 10)
        self.assertLess(strips["peak_memory_bytes"], BOUND)
        whole = self.render("whole")
        self.assertEqual(whole["strips"], 1)
        self.assertGreater(whole["peak_memory_bytes"], 3 * BOUND)
        for name in ["image_sha256", "error", "error_bound", "relmse", "heavy_pixels", "mean_luminance", "rays"]:
            self.assertEqual(strips[name], whole[name], name)
        self.assert_same_blocks("strips.exr", "whole.exr")
        with open(self.path("strips.png"), "rb") as one, open(self.path("whole.png"), "rb") as other:
            self.assertTrue(one.read() == other.read())


if __name__ == "__main__":
    unittest.main()

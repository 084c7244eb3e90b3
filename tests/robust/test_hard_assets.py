# tier: full
"""Every file under shared/assets/hard by every integrator: no NaN, no crash, something to see, and structures no larger than their
triangles call for. Self-intersecting and non-manifold meshes, slivers to 1e8, the Cornell box at 1e-4, 1e4 and far away."""
import glob
import json
import os
import unittest

from hard_scene import HardCase
from support import SHARED, eclat

HARD = os.path.join(SHARED, "assets", "hard")
FILES = sorted(glob.glob(os.path.join(HARD, "**", "*.gl[tb]*"), recursive=True))
REFERENCES_MOST = 2  # of the BVH a triangle: cutting adds a third at most on meshes that are not hard


@unittest.skipUnless(FILES, "there is no " + HARD)
class HardAssets(HardCase):
    def each(self, judge):
        for path in FILES:
            with self.subTest(file=os.path.relpath(path, HARD)):
                judge(path)

    def test_structures_are_no_larger_than_the_mesh(self):
        def judge(path):
            info = json.loads(self.assert_ok(eclat("info", "--json", path)).stdout)
            self.assertLessEqual(info["bvh"]["references"], REFERENCES_MOST * info["triangles"])
        self.each(judge)

    def test_path(self):
        self.each(lambda path: self.assertGreater(self.render(path, spp="8").mean, 0))

    def test_whitted_and_raster(self):
        """Direct light alone: on some of the meshes it falls on few pixels."""
        for integrator in ["whitted", "raster"]:
            self.each(lambda path: self.assertGreater(self.render(path, "--integrator", integrator, size="48x48", spp="2").mean, 0))


if __name__ == "__main__":
    unittest.main()

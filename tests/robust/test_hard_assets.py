# tier: full
"""Renders every file under shared/assets/hard with every integrator: no NaN, no crash, a picture that is not empty, and structures of a
size that their triangles justify. The files have self-intersecting and non-manifold meshes, slivers to 1e8, and the Cornell box at scales
of 1e-4 and 1e4 and far away."""
import glob
import json
import os
import unittest

from hard_scene import HardCase
from support import SHARED, eclat

HARD = os.path.join(SHARED, "assets", "hard")
FILES = sorted(glob.glob(os.path.join(HARD, "**", "*.gl[tb]*"), recursive=True))
REFERENCES_MOST = 2  # references of the BVH for each triangle: on ordinary meshes, cutting adds a third at most


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
        """Direct light only, which reaches few pixels of some meshes."""
        for integrator in ["whitted", "raster"]:
            self.each(lambda path: self.assertGreater(self.render(path, "--integrator", integrator, size="48x48", spp="2").mean, 0))


if __name__ == "__main__":
    unittest.main()

# tier: quick
"""Caustics of bodies of few triangles with smooth normals, which are bent where the camera path would see their back: light paths lose no light there and
count none twice."""
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "robust"))
from hard_scene import Scene
from other_way import OtherWay
from test_caustic_forms import GLASS, LAMP, MATT, ball, square

MIRROR = {"pbrMetallicRoughness": {"roughnessFactor": 0}}
SEEN = ["--size", "24x24", "--eye", "0.2,3,2.6", "--look-at=-0.4,0.1,0"]


class CoarseBodies(OtherWay):
    WAY = ["--light-paths", "1"]

    def check(self, body, fewer):
        positions, normals, indices = ball(3, 0.55, 0.5)
        scene = Scene(MATT, body, LAMP)
        for name in ("ior", "transmission", "volume", "specular", "emissive_strength"):
            scene.extend("KHR_materials_" + name)
        scene.add(square(3, 0), 0).add(positions, 1, indices=indices, streams=[("NORMAL", 3, normals)]).add(square(1, 3, up=False), 2)
        self.assert_same_picture([scene.write(self.path("coarse.gltf")), *SEEN], 2048, fewer)

    def test_glass(self):
        self.check(GLASS, 0.5)

    def test_mirror(self):
        self.check(MIRROR, 0.5)


if __name__ == "__main__":
    unittest.main()

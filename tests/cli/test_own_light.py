# tier: quick
"""A lamp that transmits light does not light itself: alone in the dark, a flat one shows only what it emits."""
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "robust"))
from hard_scene import QUAD, HardCase, Scene

TILT = {"rotation": [math.sin(0.2), 0, 0, math.cos(0.2)], "scale": [2, 2, 2]}  # hits leave the lamp's plane only by rounding
PASSING = {"diffuse_transmission": {"diffuseTransmissionFactor": 0.5}, "transmission": {"transmissionFactor": 0.8}}


class OwnLight(HardCase):
    def picture(self, name, **material):
        lamp = {"emissiveFactor": [1, 1, 1], "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.5},
                "extensions": {"KHR_materials_" + name: PASSING[name]}, **material}
        return self.render(Scene(lamp).extend("KHR_materials_" + name).add(QUAD, **TILT), size="8x8", spp="64")

    def test_flat_lamps(self):
        for name in PASSING:
            for two_sided in (False, True):
                with self.subTest(name=name, two_sided=two_sided):
                    picture = self.picture(name, doubleSided=two_sided)
                    for value in picture.channels["R"]:
                        self.assertAlmostEqual(value, 1, delta=1e-5)


if __name__ == "__main__":
    unittest.main()

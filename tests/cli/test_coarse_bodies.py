# tiers: quick, long
"""Caustics of bodies that have few triangles and smooth normals. Normals are bent where a camera path would see a back. Light paths must
lose no light there, and count none twice."""
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "robust"))
from hard_scene import Scene
from other_way import OtherWay
from test_caustic_forms import GLASS, LAMP, MATT, ball, square
from tiers import long


def material(roughness, metallic=0, **extensions):
    return {"pbrMetallicRoughness": {"roughnessFactor": roughness, "metallicFactor": metallic},
            "extensions": {"KHR_materials_" + name: extension for name, extension in extensions.items()}}


CLEAR, BODY = {"transmissionFactor": 1}, {"thicknessFactor": 1}
MIRROR = material(0, 1)
OTHERS = {
    "rough glass": material(0.3, transmission=CLEAR, volume=BODY), "a thin wall": material(0, transmission=CLEAR), "a rough wall": material(0.3, transmission=CLEAR),
    "half clear": material(0, transmission={"transmissionFactor": 0.5}, volume=BODY), "dispersion": material(0, transmission=CLEAR, volume=BODY, dispersion={"dispersion": 3}),
    "water": material(0, transmission=CLEAR, volume={"thicknessFactor": 1, "attenuationDistance": 0.3, "attenuationColor": [0.9, 0.4, 0.2]}, ior={"ior": 1.33}),
    "rough metal": material(0.2, 1), "brushed metal": material(0.3, 1, anisotropy={"anisotropyStrength": 0.8}), "plastic": material(0),
    "film": material(0, 1, iridescence={"iridescenceFactor": 1}),
    "coated metal": material(0.5, 1, clearcoat={"clearcoatFactor": 1}), "coated glass": material(0.3, transmission=CLEAR, volume=BODY, clearcoat={"clearcoatFactor": 1})}
SEEN = ["--size", "24x24", "--eye", "0.2,3,2.6", "--look-at=-0.4,0.1,0"]
BESIDE = ["--size", "16x16", "--eye", "1.9,1,0", "--look-at", "1.3,0,0", "--fov", "40"]


class CoarseBodies(OtherWay):
    WAY = ["--light-paths", "1"]

    def scene(self, body):
        positions, normals, indices = ball(3, 0.55, 0.5)
        scene = Scene(MATT, body, LAMP)
        for name in {name for one in (MATT, body, LAMP) for name in one.get("extensions", ())}:
            scene.extend(name)
        scene.add(square(3, 0), 0).add(positions, 1, indices=indices, streams=[("NORMAL", 3, normals)]).add(square(1, 3, up=False), 2)
        return scene.write(self.path("coarse.gltf"))

    def check(self, body, fewer, samples=2048):
        self.assert_same_picture([self.scene(body), *SEEN], samples, fewer)

    def test_glass(self):
        self.check(GLASS, 0.5, 512)

    def test_mirror(self):
        self.check(MIRROR, 0.5, 512)

    def test_light_alone(self):
        """The floor beside a mirror, rendered with light paths alone."""
        self.assert_same_picture([self.scene(MIRROR), *BESIDE], 512, 0, ["--integrator", "light"])

    @long
    def test_others(self):
        for name, body in {"glass": GLASS, "mirror": MIRROR, **OTHERS}.items():
            with self.subTest(name):
                self.check(body, 0.1)


if __name__ == "__main__":
    unittest.main()

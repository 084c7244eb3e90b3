"""KHR_texture_transform turns and mirrors a picture on the surface, and what its texels call right and up goes with it: a normal map and a
direction of brushing look the same as where the mesh's own coordinates are turned. A sun lights a plate directly, so pictures are free of
noise."""
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "robust"))
from hard_scene import NORMAL, QUAD, Scene, one_pixel_png
from support import QUICK, Case, eclat, read_exr

LIGHTS, TRANSFORM = "KHR_lights_punctual", "KHR_texture_transform"
METAL = {"roughnessFactor": 0.4}
MATERIALS = {  # of a texture
    "normal": lambda t: {"pbrMetallicRoughness": METAL, "normalTexture": t},
    "coat": lambda t: {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "extensions": {"KHR_materials_clearcoat": {
        "clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.4, "clearcoatNormalTexture": t}}},
    "brushed": lambda t: {"pbrMetallicRoughness": METAL, "extensions": {"KHR_materials_anisotropy": {
        "anisotropyStrength": 0.8, "anisotropyTexture": t}}},
}
TEXELS = {"normal": (170, 140, 240), "coat": (170, 140, 240), "brushed": (220, 180, 255)}
# A turn, a mirrored picture, one that stands on its head, both with unequal scales
TURNS = [(0.7, 1, 1), (math.pi, 1, 1), (0, -1, 1), (0, 1, -1), (-2.1, 3, -0.5)]


def rows(rotation, x, y):
    """The linear part of what KHR_texture_transform says."""
    c, s = math.cos(rotation), math.sin(rotation)
    return (c * x, s * y), (-s * x, c * y)


def coordinates(turn=(0, 1, 1), skew=0.0):
    """Of the plate, v down: u goes along x, and by `skew` along y."""
    points = [(x + skew * y, -y) for x, y, _ in zip(*[iter(QUAD)] * 3)]
    return "TEXCOORD_0", 2, [row[0] * u + row[1] * v for u, v in points for row in rows(*turn)]


class Turned(Case):
    def plate(self, kind, uv, turn=None, tangent=None):
        info = {"index": 0}
        if turn:
            info["extensions"] = {TRANSFORM: {"rotation": turn[0], "scale": turn[1:], "offset": [0.3, 0.2]}}
        scene = Scene(MATERIALS[kind](info)).texture(one_pixel_png(TEXELS[kind])).extend(LIGHTS, {"lights": [{"type": "directional", "intensity": 3}]})
        streams = [NORMAL, uv] + ([("TANGENT", 4, tangent * 6)] if tangent else [])
        scene.add(QUAD, streams=streams).node(rotation=[-0.3, 0.35, 0, math.sqrt(1 - 0.3 ** 2 - 0.35 ** 2)], extensions={LIGHTS: {"light": 0}})
        out = self.path("out.exr")
        self.assert_ok(eclat("render", scene.write(self.path("scene.gltf")), "-q", *QUICK, "--size", "8x8", "--spp", "4", "--max-depth", "2", "-o", out))
        return read_exr(out)[1]["R"]

    def check(self, kind):
        def apart(a, b):
            return max(abs(x - y) for x, y in zip(a, b)) / max(b)
        as_is = self.plate(kind, coordinates())
        for turn in TURNS:
            baked = self.plate(kind, coordinates(turn))
            if kind != "brushed" or abs(turn[0]) % math.pi:  # brushed back to front is brushed alike
                self.assertGreater(apart(as_is, baked), 0.05, "the test cannot see it")
            self.assertLess(apart(self.plate(kind, coordinates(), turn), baked), 1e-4, turn)
            self.assertLess(apart(self.plate(kind, coordinates(), turn, tangent=[1, 0, 0, 1]), baked), 1e-4, f"{turn}, with tangents")
            self.assertLess(apart(self.plate(kind, coordinates(skew=0.4), turn), self.plate(kind, coordinates(turn, skew=0.4))), 1e-4, f"{turn}, skew")

    def test_normal_map(self):
        self.check("normal")

    def test_coat(self):
        self.check("coat")

    def test_brushed(self):
        self.check("brushed")


if __name__ == "__main__":
    unittest.main()

# tier: full
"""KHR_texture_transform turns and mirrors a picture on the surface, and with it the directions in a normal map or an anisotropy texture.
Both must look as if the mesh's own coordinates were turned. A sun lights a plate directly, so pictures have no noise."""
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "robust"))
from hard_scene import NORMAL, QUAD, Scene, one_pixel_png
from support import Case, eclat, read_exr

LIGHTS, TRANSFORM = "KHR_lights_punctual", "KHR_texture_transform"
METAL = {"roughnessFactor": 0.4}
MATERIALS = {  # textures of each kind
    "normal": lambda t: {"pbrMetallicRoughness": METAL, "normalTexture": t},
    "coat": lambda t: {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "extensions": {"KHR_materials_clearcoat": {
        "clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.4, "clearcoatNormalTexture": t}}},
    "brushed": lambda t: {"pbrMetallicRoughness": METAL, "extensions": {"KHR_materials_anisotropy": {
        "anisotropyStrength": 0.8, "anisotropyTexture": t}}},
}
TEXEL = (170, 140, 240)
# a turn; upside down; two mirrored pictures; a mirrored, turned one with unequal scales
TURNS = [(0.7, 1, 1), (math.pi, 1, 1), (0, -1, 1), (0, 1, -1), (-2.1, 3, -0.5)]


def rows(rotation, x, y):
    """The linear part of a KHR_texture_transform."""
    c, s = math.cos(rotation), math.sin(rotation)
    return (c * x, s * y), (-s * x, c * y)


def coordinates(turn=(0, 1, 1), skew=0.0):
    """Coordinates of the plate: v points down, and u goes along x, and by `skew` along y."""
    points = [(x + skew * y, -y) for x, y, _ in zip(*[iter(QUAD)] * 3)]
    return "TEXCOORD_0", 2, [row[0] * u + row[1] * v for u, v in points for row in rows(*turn)]


class Turned(Case):
    def colours(self, plates):
        """Red of each plate (kind, coordinates, turn or None, tangent or None), side by side in one picture: one set of kernels, and the
        same eye."""
        scene = Scene(*(MATERIALS[kind](self.texture(turn)) for kind, _, turn, _ in plates)).texture(one_pixel_png(TEXEL))
        scene.extend(LIGHTS, {"lights": [{"type": "directional", "intensity": 3}]})
        scene.node(rotation=[-0.3, 0.35, 0, math.sqrt(1 - 0.3 ** 2 - 0.35 ** 2)], extensions={LIGHTS: {"light": 0}})
        count = len(plates)
        scene.json["cameras"] = [{"type": "orthographic", "orthographic": {"xmag": count, "ymag": 1, "znear": 0.1, "zfar": 10}}]
        for k, (_, uv, _, tangent) in enumerate(plates):
            streams = [NORMAL, uv] + ([("TANGENT", 4, tangent * 6)] if tangent else [])
            scene.add(QUAD, material=k, streams=streams, translation=[2 * k + 1 - count, 0, 0])
        out = self.path("out.exr")
        self.assert_ok(eclat("render", scene.write(self.path("scene.gltf")), "-q", "--lanes", "1", "--size", f"{3 * count}x3", "--spp", "4",
                             "--max-depth", "2", "-o", out))
        return read_exr(out)[1]["R"][3 * count + 1:6 * count:3]

    @staticmethod
    def texture(turn):
        return dict({"index": 0}, **{"extensions": {TRANSFORM: {"rotation": turn[0], "scale": turn[1:], "offset": [0.3, 0.2]}}} if turn else {})

    def test_maps_turn_as_coordinates_do(self):
        cases = [(kind, turn, skew, tangent) for kind in MATERIALS for turn in TURNS
                 for skew, tangent in ((0, None), (0, [1, 0, 0, 1]), (0.4, None))]
        red = self.colours([(kind, coordinates(skew=skew), turn, tangent) for kind, turn, skew, tangent in cases] +
                           [(kind, coordinates(turn, skew), None, None) for kind, turn, skew, _ in cases] +
                           [(kind, coordinates(skew=skew), None, None) for kind, _, skew, _ in cases])
        for case, turned, baked, as_is in zip(cases, *(red[k * len(cases):(k + 1) * len(cases)] for k in range(3))):
            kind, turn = case[:2]
            if kind != "brushed" or abs(turn[0]) % math.pi:  # half a turn leaves the direction of brushing as it is
                self.assertGreater(abs(baked - as_is), 0.05 * max(baked, as_is), f"{case}: the test cannot see it")
            self.assertLess(abs(turned - baked), 1e-4 * baked, case)


if __name__ == "__main__":
    unittest.main()

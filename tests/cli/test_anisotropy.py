# tier: full
"""The direction in which brushed metal and brushed glass are brushed: KHR_materials_anisotropy's rotation, counter-clockwise from the
tangent; its texture's direction; the bitangent's sign; meshes without tangents. A sun lights a plate directly, so pictures have no noise.
Pictures of one direction, described in different ways, agree to rounding."""
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "robust"))
from hard_scene import NORMAL, QUAD, UV, Scene, row_png
from support import QUICK, Case, eclat, read_exr

ANISOTROPY, LIGHTS = "KHR_materials_anisotropy", "KHR_lights_punctual"
PANE = {"KHR_materials_transmission": {"transmissionFactor": 1}}
BODY = {**PANE, "KHR_materials_volume": {"thicknessFactor": 1}}
SUN, BEHIND = (-0.3, 0.35, 0, math.sqrt(1 - 0.3 ** 2 - 0.35 ** 2)), (0.25, math.sqrt(1 - 0.25 ** 2 - 0.3 ** 2), 0.3, 0)
ALONG = 0.7  # radians: the direction that all descriptions mean, from +x towards +y
TURNED_UV = ("TEXCOORD_0", 2, [c for x, y, _ in zip(*[iter(QUAD)] * 3) for c in (math.cos(ALONG) * x + math.sin(ALONG) * y, math.sin(ALONG) * x - math.cos(ALONG) * y)])


def tangents(angle, sign=1):
    return "TANGENT", 4, [math.cos(angle), math.sin(angle), 0, sign] * 6


def towards(angle):
    """Texels of a texture that all mean this direction, at full strength or nearly so. Texels of one value only would be folded into a
    factor."""
    return [(round(127.5 + 127.5 * math.cos(angle)), round(127.5 + 127.5 * math.sin(angle)), strength) for strength in (255, 254)]


class Direction(Case):
    def plate(self, *streams, rotation=0.0, texture=None, strength=0.8, glass=None, sun=SUN):
        brushed = {"anisotropyStrength": strength, "anisotropyRotation": rotation}
        if texture:
            brushed["anisotropyTexture"] = {"index": 0}
        scene = Scene({"pbrMetallicRoughness": {"roughnessFactor": 0.4, "metallicFactor": 0 if glass else 1}, "extensions": {ANISOTROPY: brushed, **(glass or {})}})
        for name in glass or {}:
            scene.extend(name)
        scene.extend(ANISOTROPY).extend(LIGHTS, {"lights": [{"type": "directional", "intensity": 3}]}).add(QUAD, streams=[NORMAL, *streams])
        scene.node(rotation=list(sun), extensions={LIGHTS: {"light": 0}})
        if texture:
            scene.texture(row_png(*texture))
        out = self.path("out.exr")
        self.assert_ok(eclat("render", scene.write(self.path("scene.gltf")), "-q", *QUICK, "--size", "8x8", "--spp", "4", "--max-depth", "2", "-o", out))
        return read_exr(out)[1]["R"]

    def assert_alike(self, a, b, delta, what):
        apart = max(abs(x - y) for x, y in zip(a, b)) / max(b)
        self.assertLess(apart, delta, what)

    def test_all_ways_to_say_one_direction(self):
        expected = self.plate(tangents(ALONG), UV)
        other = self.plate(tangents(-ALONG), UV)
        self.assertGreater(max(abs(x - y) for x, y in zip(expected, other)), 0.2 * max(expected))  # the test can tell directions apart
        self.assert_alike(self.plate(tangents(0), UV, rotation=ALONG), expected, 1e-4, "rotation")
        self.assert_alike(self.plate(tangents(0.3), UV, rotation=ALONG - 0.3 - 4 * math.pi), expected, 1e-4, "rotation from a tangent that is turned")
        self.assert_alike(self.plate(tangents(0, -1), UV, rotation=-ALONG), expected, 1e-4, "the bitangent the other way round")
        self.assert_alike(self.plate(TURNED_UV), expected, 1e-4, "along u where there are no tangents")
        self.assert_alike(self.plate(tangents(0), UV, texture=towards(ALONG)), expected, 0.02, "texture")  # the texture's bytes round
        self.assert_alike(self.plate(tangents(0), UV, rotation=ALONG - 0.4, texture=towards(0.4)), expected, 0.02, "rotation and texture")
        self.assert_alike(self.plate(tangents(0), UV, rotation=ALONG - 0.4, texture=towards(0.4)[:1]), expected, 0.02, "rotation and one texel")
        self.assert_alike(self.plate(tangents(ALONG + math.pi), UV), expected, 1e-4, "back to front")

    def test_glass(self):
        """Tests reflection and transmission, through a wall and into a body."""
        for what, options in {"mirrored": {"glass": PANE}, "through a pane": {"glass": PANE, "sun": BEHIND}, "out of a body": {"glass": BODY, "sun": BEHIND}}.items():
            with self.subTest(what):
                expected = self.plate(tangents(ALONG), UV, **options)
                for other in self.plate(tangents(-ALONG), UV, **options), self.plate(tangents(ALONG), UV, strength=0, **options):
                    self.assertGreater(max(abs(x - y) for x, y in zip(expected, other)), 0.1 * max(expected))
                self.assert_alike(self.plate(tangents(0), UV, rotation=ALONG, **options), expected, 1e-4, "rotation")
                self.assert_alike(self.plate(TURNED_UV, **options), expected, 1e-4, "along u")


if __name__ == "__main__":
    unittest.main()

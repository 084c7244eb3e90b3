"""Metallic car paint: aluminium flakes that lie a little askew under a smooth clear coat."""
import math

from scenes import png
from scenes.mesh import uv_sphere
from scenes.stage import stage

SIZE = 128


def flake(x, y):
    """A normal for each flake of 2 x 2 texels; green up."""
    tilt, turn = 0.22 * png.hash01(x // 2, y // 2, 3) ** 2, 2 * math.pi * png.hash01(x // 2, y // 2, 4)
    n = (tilt * math.cos(turn), tilt * math.sin(turn))
    return tuple(png.byte(0.5 + 0.5 * c) for c in (*n, math.sqrt(1 - tilt * tilt)))


def make(folder):
    g = stage()
    flakes = g.texture_use(g.texture("flakes", png.encode(SIZE, SIZE, 3, flake), mag=9728), scale=(4.0, 2.0))
    paint = g.material("paint", (0.55, 0.02, 0.03), metallic=0.85, roughness=0.35, normal_texture=flakes, extensions={
        "KHR_materials_clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.0}})
    g.add("body", uv_sphere(0.5, 48, 24), paint, translation=(0.0, 0.5, 0.0))
    g.write(folder, "car-paint")

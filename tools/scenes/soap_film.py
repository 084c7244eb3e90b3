"""A soap bubble: a film of water in air, thin at its top, where it has drained, and swirled."""
import math

from scenes import png
from scenes.gltf import Gltf
from scenes.mesh import uv_sphere
from scenes.showcase import panel, sweep

SIZE = 96
THIN, THICK = 80.0, 700.0  # nanometres


def drained(x, y):
    """Thickness in the green channel; it grows downwards, in folds."""
    u, v = x / SIZE, y / SIZE
    fold = png.value_noise(u * 4, v * 8, 4, 5) - 0.5 + 0.5 * (png.value_noise(u * 8, v * 16, 8, 9) - 0.5)
    depth = 0.5 - 0.5 * math.cos(math.pi * min(max(v, 0.0), 1.0))
    return (0, png.byte(depth + 0.16 * fold * math.sin(math.pi * v)), 0)


def make(folder):
    g = Gltf()
    g.add("backdrop", sweep(7.0, 4.0, -2.2, 4.5, 1.2, 12), g.material("backdrop", (0.03, 0.032, 0.036), lambert=True))
    panel(g, "left", (-2.2, 1.6, 1.2), (0.0, 0.6, 0.0), 1.5, 1.1, (1.0, 0.97, 0.92), 5.0)
    panel(g, "right", (2.3, 1.3, 0.9), (0.0, 0.6, 0.0), 1.2, 0.9, (0.9, 0.95, 1.0), 4.0)
    panel(g, "top", (0.0, 3.4, 0.3), (0.0, 0.5, 0.0), 1.2, 1.6, (1.0, 1.0, 1.0), 4.0)
    panel(g, "front", (0.0, 1.0, 6.5), (0.0, 0.6, 0.0), 1.6, 4.5, (1.0, 1.0, 1.0), 1.2)
    film = g.texture("thickness", png.encode(SIZE, SIZE, 3, drained))
    soap = g.material("soap", (1.0, 1.0, 1.0), roughness=0.0, transmission=1.0, ior=1.0, double_sided=True, extensions={
        "KHR_materials_iridescence": {"iridescenceFactor": 1.0, "iridescenceIor": 1.33, "iridescenceThicknessMinimum": THIN,
                                      "iridescenceThicknessMaximum": THICK, "iridescenceThicknessTexture": g.texture_use(film)}})
    g.add("bubble", uv_sphere(0.5, 48, 24), soap, translation=(0.0, 0.62, 0.0))
    g.perspective("camera", (0.0, 0.9, 3.4), (0.0, 0.6, 0.0), 22.0, 1.5)
    g.write(folder, "soap-film")

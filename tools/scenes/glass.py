"""How glass acts on light: a clear ball and a frosted one, a star in amber, a block of coloured glass, a thin pane. The lamps are large,
so that paths find their caustics on the floor."""
import math

from scenes.gltf import Gltf, axis_angle
from scenes.mesh import box, icosphere, quad, star
from scenes.png import encode
from scenes.showcase import panel


def boards():
    """Two planks, light and dark."""
    light, dark = (226, 220, 208), (150, 138, 124)
    return encode(2, 2, 3, lambda x, y: light if (x + y) % 2 else dark)


def make(folder):
    g = Gltf()
    tiles = g.texture_use(g.texture("boards", boards(), mag=9728), scale=(9.0, 9.0))
    g.add("floor", quad((0.0, 0.0, -0.5), (6.0, 0.0, 0.0), (0.0, 0.0, -6.0)),
          g.material("boards", (1.0, 1.0, 1.0), lambert=True, base_texture=tiles), rotation=axis_angle((0, 1, 0), 30))
    wall = quad((0.0, 3.0, -4.5), (9.0, 0.0, 0.0), (0.0, 3.5, 0.0))
    wall.uvs = []
    g.add("wall", wall, g.material("wall", (0.45, 0.5, 0.56), lambert=True))

    fine, coarse = icosphere(1.0, 4), icosphere(1.0, 3)

    def put(name, material, x, z, radius):
        g.add(name, fine if radius > 0.45 else coarse, material, translation=(x, radius, z), scale=radius)

    white = (1.0, 1.0, 1.0)
    glass = dict(transmission=1.0, ior=1.5, body=True)
    put("clear-ball", g.material("clear-glass", white, roughness=0.0, **glass), -0.62, 0.55, 0.5)
    put("frosted-ball", g.material("frosted-glass", white, roughness=0.35, **glass), 1.42, 0.3, 0.42)
    put("amber-ball", g.material("amber", white, roughness=0.0, transmission=1.0, ior=1.55, body=True,
                                 attenuation=((0.93, 0.55, 0.12), 0.6)), 0.42, -0.35, 0.62)
    g.add("star", star(0.3), g.material("gold", (1.0, 0.78, 0.34), metallic=1.0, roughness=0.3), translation=(0.42, 0.62, -0.35),
          rotation=axis_angle((0.3, 1, 0.2), 40))
    block = box((-0.3, 0.0, -0.3), (0.3, 0.6, 0.3))
    block.uvs = []
    g.add("blue-block", block, g.material("blue-glass", white, roughness=0.0, transmission=1.0, ior=1.5, body=True,
                                          attenuation=((0.2, 0.5, 0.9), 0.5)), translation=(-1.55, 0.001, -0.2), rotation=axis_angle((0, 1, 0), 32))
    put("water-drop", g.material("water", white, roughness=0.0, transmission=1.0, ior=1.33, body=True), 0.42, 1.15, 0.17)
    put("diamond-ball", g.material("diamond", white, roughness=0.0, transmission=1.0, ior=2.42, body=True), 0.86, 0.98, 0.13)
    put("matt-ball", g.material("clay", (0.75, 0.28, 0.18), roughness=0.7), -0.18, 1.3, 0.14)
    put("hidden-ball", g.material("leaf", (0.25, 0.5, 0.2), roughness=0.6), -0.75, -1.35, 0.34)
    pane = quad((-0.85, 0.75, -0.75), (0.75, 0.0, 0.0), (0.0, 0.75, 0.0))
    pane.uvs = []
    g.add("pane", pane, g.material("pane", (0.82, 0.95, 0.88), roughness=0.0, transmission=1.0, double_sided=True),
          rotation=axis_angle((0, 1, 0), math.degrees(0.12)))

    panel(g, "key", (-3.4, 3.6, 1.6), (0.0, 0.4, 0.0), 1.3, 1.3, (1.0, 0.92, 0.8), 9.0)
    panel(g, "fill", (3.8, 2.4, 2.2), (0.2, 0.4, 0.0), 1.4, 1.4, (0.7, 0.84, 1.0), 2.5)
    panel(g, "top", (0.4, 4.2, -1.2), (0.4, 0.0, -0.6), 1.6, 1.0, (1.0, 0.98, 0.95), 3.5)
    panel(g, "front-card", (0.5, 3.0, 8.0), (0.0, 0.8, 0.0), 2.2, 4.5, (0.8, 0.88, 1.0), 0.5)
    g.perspective("camera", (0.25, 1.55, 5.4), (0.0, 0.5, 0.0), 26.0, 1.5)
    g.write(folder, "glass")

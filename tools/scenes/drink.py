"""Bodies in bodies: a tumbler with a liquid that overlaps its wall, ice across the surface, bubbles, a glass rod, and a ball in a ball."""
import math

from scenes.gltf import Gltf, axis_angle
from scenes.glass import boards
from scenes.mesh import box, icosphere, lathe, quad
from scenes.showcase import panel

WHITE = (1.0, 1.0, 1.0)
OVERLAP = 0.004  # by which the liquid reaches into the wall that holds it


def inner_radius(y):
    return 0.335 + 0.035 * (y - 0.08) / 1.02


def tumbler():
    rim = [(0.385 + 0.015 * math.cos(math.pi * k / 6), 1.1 + 0.015 * math.sin(math.pi * k / 6)) for k in range(7)]
    return lathe([(0.0, 0.0), (0.34, 0.0), (0.36, 0.02)] + rim + [(inner_radius(0.08), 0.08), (0.0, 0.08)], 96)


def liquid(level):
    bottom, top = 0.08 - OVERLAP, level
    return lathe([(0.0, bottom), (inner_radius(bottom) + OVERLAP, bottom), (inner_radius(top) + OVERLAP, top), (0.0, top)], 96)


def make(folder):
    g = Gltf()
    tiles = g.texture_use(g.texture("boards", boards(), mag=9728), scale=(9.0, 9.0))
    g.add("floor", quad((0.0, 0.0, -0.5), (6.0, 0.0, 0.0), (0.0, 0.0, -6.0)),
          g.material("boards", WHITE, lambert=True, base_texture=tiles), rotation=axis_angle((0, 1, 0), 24))
    wall = quad((0.0, 3.0, -4.5), (9.0, 0.0, 0.0), (0.0, 3.5, 0.0))
    wall.uvs = []
    g.add("wall", wall, g.material("wall", (0.5, 0.5, 0.48), lambert=True))

    def body(name, ior, **more):
        return g.material(name, WHITE, roughness=0.0, transmission=1.0, ior=ior, body=True, **more)

    g.add("tumbler", tumbler(), body("glass", 1.5), translation=(0.0, 0.001, 0.0))
    g.add("liquid", liquid(0.78), body("cola", 1.34, attenuation=((0.72, 0.36, 0.14), 0.35)), translation=(0.0, 0.001, 0.0))
    ice, air = body("ice", 1.31), body("air", 1.0)
    cube = box((-0.1, -0.1, -0.1), (0.1, 0.1, 0.1))
    cube.uvs = []
    fine, coarse, tiny = icosphere(1.0, 4), icosphere(1.0, 3), icosphere(1.0, 2)
    for k, (at, axis, angle) in enumerate([((-0.16, 0.76, 0.08), (0.3, 1.0, 0.1), 25), ((0.09, 0.74, 0.17), (1.0, 0.5, 0.2), 50),
                                           ((0.13, 0.77, -0.13), (0.2, 0.4, 1.0), 35)]):
        g.add(f"ice-{k}", cube, ice, translation=at, rotation=axis_angle(axis, angle))
        g.add(f"ice-bubble-{k}", tiny, air, translation=(at[0] + 0.01, at[1] - 0.02, at[2]), scale=0.025)
    for k in range(9):
        angle, radius = 2.4 * k, 0.08 + 0.022 * k
        g.add(f"bubble-{k}", tiny, air, translation=(radius * math.cos(angle), 0.16 + 0.05 * k, radius * math.sin(angle)),
              scale=0.010 + 0.002 * (k % 3))
    rod = lathe([(0.0, 0.0), (0.02, 0.0), (0.02, 1.35), (0.0, 1.35)], 32)
    g.add("rod", rod, body("rod-glass", 1.52, attenuation=((0.55, 0.8, 0.95), 0.05)), translation=(-0.05, 0.1, -0.26),
          rotation=axis_angle((0.25, 0.0, -1.0), 12))

    g.add("outer-ball", fine, body("ball-glass", 1.52), translation=(0.86, 0.3, 0.35), scale=0.3)
    g.add("inner-ball", coarse, body("water", 1.33, attenuation=((0.25, 0.6, 0.9), 0.3)), translation=(0.86, 0.3, 0.35), scale=0.24)
    g.add("hollow", coarse, air, translation=(0.86, 0.36, 0.35), scale=0.09)
    g.add("frosted-ball", coarse, g.material("frosted-glass", WHITE, roughness=0.25, transmission=1.0, ior=1.5, body=True,
                                              attenuation=((0.35, 0.8, 0.4), 0.4)), translation=(-0.92, 0.26, 0.3), scale=0.26)
    g.add("behind", coarse, g.material("clay", (0.75, 0.28, 0.18), roughness=0.7), translation=(-0.55, 0.22, -0.8), scale=0.22)

    pane = quad((0.5, 0.6, -0.95), (0.42, 0.0, -0.12), (0.0, 0.6, 0.0))
    pane.uvs = []
    g.add("pane", pane, g.material("pane", (0.75, 0.92, 0.9), roughness=0.0, transmission=1.0, double_sided=True))

    panel(g, "key", (-3.4, 3.6, 1.6), (0.0, 0.4, 0.0), 1.3, 1.3, (1.0, 0.92, 0.8), 9.0)
    panel(g, "fill", (3.8, 2.4, 2.2), (0.2, 0.4, 0.0), 1.4, 1.4, (0.7, 0.84, 1.0), 2.5)
    panel(g, "back", (0.6, 3.7, -2.6), (0.0, 0.5, 0.0), 1.3, 1.2, (1.0, 0.98, 0.95), 5.0)
    panel(g, "front-card", (0.5, 3.0, 8.0), (0.0, 0.8, 0.0), 2.2, 4.5, (0.8, 0.88, 1.0), 0.5)
    g.perspective("camera", (0.1, 1.35, 4.6), (0.0, 0.55, 0.0), 24.0, 1.5)
    g.write(folder, "drink")

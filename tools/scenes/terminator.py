"""Balls of 80 and 320 facets with the normals of a sphere, under a small lamp. Where light grazes them, a facet turns away from the lamp
before the smooth surface does."""
from scenes.gltf import Gltf
from scenes.mesh import icosphere, quad
from scenes.showcase import panel


def make(folder):
    g = Gltf()
    floor = quad((0.0, 0.0, 0.0), (6.0, 0.0, 0.0), (0.0, 0.0, -6.0))
    floor.uvs = []
    g.add("floor", floor, g.material("floor", (0.5, 0.5, 0.5), lambert=True))
    clay = g.material("clay", (0.8, 0.8, 0.78), lambert=True)
    g.add("ball", icosphere(1.0, 1), clay, translation=(-1.15, 1.0, 0.0))
    g.add("rounder-ball", icosphere(1.0, 2), clay, translation=(1.15, 1.0, 0.0))
    panel(g, "lamp", (-3.5, 4.5, 2.0), (0.0, 0.8, 0.0), 0.3, 0.3, (1.0, 1.0, 1.0), 150.0)
    g.perspective("camera", (0.6, 1.6, 8.0), (0.0, 0.95, 0.0), 24.0, 2.0)
    g.write(folder, "terminator")

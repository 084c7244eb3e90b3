"""A polished ring on a matt sheet, with the caustic that everyone knows from a cup. Path tracing finds it only if a path that leaves
the sheet meets the lamp by way of the mirror, so few samples carry much light: a hard case for a stated error."""
import math

from scenes.gltf import Gltf, normalize
from scenes.mesh import Mesh, icosphere, sheet

SEGMENTS, INNER, OUTER, HEIGHT = 96, 1.0, 1.06, 0.4
LAMP, RADIUS, POWER = (-2.4, 1.9, 0.6), 0.25, 40.0  # centre, radius, area x radiance


def wall(radius, side):
    """The ring's wall, standing on y = 0; side +1 looks outwards, -1 inwards."""
    out = Mesh()
    for i in range(SEGMENTS):
        a, b = (2 * math.pi * (i + k) / SEGMENTS for k in (0, 1))
        corners = [(radius * math.cos(t), y, radius * math.sin(t)) for t, y in ((b, 0.0), (a, 0.0), (a, HEIGHT), (b, HEIGHT))]
        normals = [(side * math.cos(t), 0.0, side * math.sin(t)) for t in (b, a, a, b)]
        faces = [(0, 1, 2), (0, 2, 3)] if side > 0 else [(0, 2, 1), (0, 3, 2)]
        out.append(Mesh(corners, faces, [normalize(n) for n in normals]))
    return out


def rim():
    out = Mesh()
    for i in range(SEGMENTS):
        a, b = (2 * math.pi * (i + k) / SEGMENTS for k in (0, 1))
        corners = [(r * math.cos(t), HEIGHT, r * math.sin(t)) for r, t in ((OUTER, b), (OUTER, a), (INNER, a), (INNER, b))]
        out.append(Mesh(corners, [(0, 1, 2), (0, 2, 3)], [(0.0, 1.0, 0.0)] * 4))
    return out


def make(folder):
    g = Gltf()
    g.add("sheet", sheet((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 0.0, -4.0)), g.material("sheet", (0.7, 0.68, 0.65), lambert=True))
    ring = wall(OUTER, 1).append(wall(INNER, -1)).append(rim())
    g.add("ring", ring, g.material("ring", (1.0, 0.78, 0.34), metallic=1.0, roughness=0.0))
    ball = icosphere(RADIUS, 2)
    radiance = POWER / math.pi / ball.area()
    ball.normals = []  # flat facets, so that area and picture agree
    g.add("lamp", ball, g.material("lamp", (0.0, 0.0, 0.0), lambert=True, emission=(radiance,) * 3), translation=LAMP)
    g.perspective("camera", (0.9, 3.2, 2.6), (0.1, 0.1, 0.0), 36.0, 1.5)
    g.write(folder, "ring")

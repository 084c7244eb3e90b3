"""After the scene with which E. Veach and L. Guibas introduced multiple importance sampling (1995; Veach's thesis 1997, ch. 9):
four metal plates, smooth to rough, each tilted to mirror a row of four spheres of equal power into the camera. The layout is
computed here from that idea; the proportions follow the original's look."""
import math

from scenes.gltf import Gltf, cross, normalize
from scenes.mesh import dot, icosphere, quad, sub

EYE, TARGET = (0.0, 2.0, 15.0), (0.0, -1.75, 2.0)
LAMPS = (0.0, 0.3, 0.0)                       # middle of the row
RADII = (0.033, 0.1, 0.3, 0.9)
POWER = 60.0                                  # area x radiance of each lamp
PLATES = ((-2.45, -0.2, 0.07), (-3.05, 0.85, 0.14), (-3.55, 2.1, 0.22), (-3.9, 3.5, 0.32))  # height, depth, roughness


def make(folder):
    g = Gltf()
    wall = g.material("wall", (0.4, 0.4, 0.4), lambert=True)
    sheet = quad((0.0, -4.3, 0.0), (12.0, 0.0, 0.0), (0.0, 0.0, -12.0))
    sheet.append(quad((0.0, 3.7, -5.0), (12.0, 0.0, 0.0), (0.0, 8.0, 0.0)))
    sheet.uvs = []
    g.add("floor-and-wall", sheet, wall)

    for y, z, roughness in PLATES:
        center = (0.0, y, z)
        normal = normalize([a + b for a, b in zip(normalize(sub(EYE, center)), normalize(sub(LAMPS, center)))])
        right = (1.0, 0.0, 0.0)
        up = cross(normal, right)
        plate = quad(center, (4.0, 0.0, 0.0), tuple(0.48 * x for x in up))
        plate.uvs = []
        assert dot(normal, plate.normals[0]) > 0.999
        name = f"plate-roughness-{roughness}"
        g.add(name, plate, g.material(name, (0.33, 0.3, 0.28), metallic=1.0, roughness=roughness))

    tints = ((1.0, 0.75, 0.5), (1.0, 0.95, 0.8), (0.8, 0.95, 1.0), (0.6, 0.75, 1.0))
    for i, (radius, tint) in enumerate(zip(RADII, tints)):
        ball = icosphere(radius, 3)
        luminance = 0.2126 * tint[0] + 0.7152 * tint[1] + 0.0722 * tint[2]
        radiance = POWER / math.pi / ball.area() / luminance  # by the area of the facets, not of the sphere around them
        ball.normals = []                                     # flat facets, so that area and picture agree
        name = f"lamp-radius-{radius}"
        g.add(name, ball, g.material(name, (0.0, 0.0, 0.0), lambert=True, emission=[radiance * c for c in tint]),
              translation=(-3.75 + 2.5 * i, LAMPS[1], LAMPS[2]))
    fill = quad((0.0, 9.0, 6.0), (3.0, 0.0, 0.0), (0.0, 0.0, 3.0))  # u x v points down
    fill.uvs = []
    g.add("fill", fill, g.material("fill", (0.0, 0.0, 0.0), lambert=True, emission=(1.2, 1.2, 1.2)))
    g.perspective("camera", EYE, TARGET, 27.0, 1.5)
    g.write(folder, "veach-plates")

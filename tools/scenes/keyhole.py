"""Two rooms and a hole of 5 cm in the wall between them. The lamp hangs on the other side of that wall, so no point of the camera's
room sees it. All light comes through the hole from matt walls, and only one path in some thousands finds the hole."""
from scenes.gltf import Gltf
from scenes.mesh import Mesh, box, polygon, ring, sheet

X, Y, Z = 3.0, 2.5, 3.0            # size of each room
THICK, HOLE = 0.02, 0.05           # of the wall; edge of the hole
AT = (1.2, 1.5)                    # y and z of the hole's middle
RADIANCE = 2e5


def pierced(x, side):
    """The wall's face at x, with the hole; side +1 looks to +x."""
    y0, y1, z0, z1 = AT[0] - HOLE / 2, AT[0] + HOLE / 2, AT[1] - HOLE / 2, AT[1] + HOLE / 2
    outer = [(x, 0.0, Z), (x, 0.0, 0.0), (x, Y, 0.0), (x, Y, Z)]
    inner = [(x, y0, z1), (x, y0, z0), (x, y1, z0), (x, y1, z1)]
    out = ring(outer, inner)
    return out if side > 0 else out.flipped()


def open_box(lo, hi, open_sides):
    """A box seen from inside, without its face at the greatest x (+1), at the least x (-1), or both."""
    shape, kept = box(lo, hi, inward=True), Mesh()
    for first in range(0, len(shape.positions), 4):
        if -shape.normals[first][0] not in open_sides:
            kept.append(polygon(*shape.positions[first:first + 4]))
    return kept


def make(folder):
    g = Gltf()
    y, z, half = *AT, HOLE / 2
    here = open_box((0.0, 0.0, 0.0), (X, Y, Z), (1,)).append(pierced(X, -1))
    here.append(open_box((X, y - half, z - half), (X + THICK, y + half, z + half), (-1, 1)))
    there = open_box((X + THICK, 0.0, 0.0), (2 * X + THICK, Y, Z), (-1,)).append(pierced(X + THICK, 1))
    for shape in (here, there):
        shape.uvs = []
    g.add("this-room", here, g.material("plaster", (0.7, 0.68, 0.62), lambert=True))
    g.add("other-room", there, g.material("chalk", (0.8, 0.8, 0.8), lambert=True))
    block = box((0.9, 0.0, 1.6), (1.5, 0.7, 2.2))
    block.uvs = []
    g.add("block", block, g.material("clay", (0.6, 0.35, 0.25), lambert=True))
    lamp = sheet((X + THICK + 0.005, 2.0, AT[1]), (0.0, 0.0, -0.3), (0.0, 0.3, 0.0))
    g.add("lamp", lamp, g.material("lamp", (0.0, 0.0, 0.0), lambert=True, emission=(RADIANCE,) * 3))
    g.perspective("camera", (2.7, 1.4, 0.4), (0.9, 0.7, 2.0), 55.0, 1.0)
    g.write(folder, "keyhole")

"""Furniture made by a few formulas each: shapes that stand on y = 0 at the origin, in metres."""
import math

from scenes.gltf import normalize
from scenes.mesh import Mesh, box, lathe, polygon

GOLDEN = (math.sqrt(5) - 1) / 2


def bare(shape):
    """Removes texture coordinates, so that shapes of all kinds can be joined."""
    shape.uvs, shape.tangents = [], []
    return shape


def joined(*shapes):
    out = Mesh()
    for shape in shapes:
        out.append(bare(shape))
    return out


def board(lo, hi):
    return bare(box(lo, hi))


def cushion(half, e=0.35, columns=24, rows=12):
    """A superellipsoid (A. Barr, "Superquadrics and angle-preserving transformations", 1981) of these half lengths."""
    def power(x, k):
        return math.copysign(abs(x) ** k, x)
    out = Mesh()
    for j in range(rows + 1):
        for i in range(columns):
            theta, phi = math.pi * (j / rows - 0.5), 2 * math.pi * i / columns
            if j in (0, rows):
                p = n = (0.0, math.copysign(1.0, theta), 0.0)
            else:
                p, n = ((power(math.cos(theta), k) * power(math.cos(phi), k), power(math.sin(theta), k),
                         power(math.cos(theta), k) * power(math.sin(phi), k)) for k in (e, 2 - e))
            out.positions.append(tuple(h * x for h, x in zip(half, p)))
            out.normals.append(normalize([x / h for h, x in zip(half, n)]))
    for j in range(rows):
        for i in range(columns):
            a, b = j * columns + i, j * columns + (i + 1) % columns
            c, d = a + columns, b + columns
            if j > 0:
                out.triangles.append((a, d, b))
            if j < rows - 1:
                out.triangles.append((a, c, d))
    return out


def legs(half_x, half_z, height, thick=0.03, thin=0.018):
    return joined(*[lathe([(0.0, 0.0), (thin, 0.0), (thick, height), (0.0, height)], 12).moved((x, 0.0, z))
                    for x in (-half_x, half_x) for z in (-half_z, half_z)])


def table(half_x, half_z, height):
    return board((-half_x, height - 0.04, -half_z), (half_x, height, half_z)), legs(half_x - 0.08, half_z - 0.08, height - 0.04)


def chair(slats=7):
    """A chair. Its back, at -z, is an arc of slats."""
    out = joined(legs(0.18, 0.18, 0.44, 0.02, 0.014), board((-0.22, 0.44, -0.22), (0.22, 0.47, 0.22)))
    for k in range(slats):
        x = 0.2 * (2 * k / (slats - 1) - 1)
        z = -0.22 - 0.5 * (0.04 - x * x)
        out.append(board((x - 0.016, 0.47, z - 0.012), (x + 0.016, 0.86, z + 0.012)))
    return out.append(board((-0.22, 0.86, -0.255), (0.22, 0.92, -0.2)))


def sofa(seats=3, width=0.62):
    """A sofa along x, with its back at -z: frame and cushions."""
    half = seats * width / 2
    frame = joined(board((-half - 0.1, 0.08, -0.42), (half + 0.1, 0.26, 0.42)), board((-half - 0.1, 0.26, -0.42), (half + 0.1, 0.78, -0.3)),
                   board((-half - 0.14, 0.08, -0.42), (-half, 0.58, 0.42)), board((half, 0.08, -0.42), (half + 0.14, 0.58, 0.42)))
    soft = Mesh()
    for k in range(seats):
        x = (k - (seats - 1) / 2) * width
        soft.append(cushion((width / 2 - 0.01, 0.1, 0.36)).moved((x, 0.36, 0.06)))
        soft.append(cushion((width / 2 - 0.02, 0.22, 0.09)).moved((x, 0.64, -0.2)))
    return frame, soft


def shelf(width, height, depth, boards):
    """A shelf, open to +z."""
    out = board((-width / 2, 0.0, -depth / 2), (width / 2, height, -depth / 2 + 0.02))
    for x in (-width / 2, width / 2 - 0.025):
        out.append(board((x, 0.0, -depth / 2), (x + 0.025, height, depth / 2)))
    for k in range(boards):
        y = (height - 0.025) * k / (boards - 1)
        out.append(board((-width / 2, y, -depth / 2), (width / 2, y + 0.025, depth / 2)))
    return out


def books(width, height, depth, boards, covers=4):
    """A mesh for each cover colour; widths, heights and gaps come from multiples of the golden ratio."""
    out = [Mesh() for _ in range(covers)]
    count = 0
    for k in range(boards - 1):
        y, x = (height - 0.025) * k / (boards - 1) + 0.025, -width / 2 + 0.04
        while x < width / 2 - 0.1:
            r, q = (count * GOLDEN) % 1, (count * GOLDEN * GOLDEN * 5) % 1
            thick, tall, deep = 0.02 + 0.035 * r, 0.18 + 0.1 * q, depth * (0.55 + 0.3 * r)
            out[count % covers].append(board((x, y, -depth / 2 + 0.03), (x + thick, y + tall, -depth / 2 + 0.03 + deep)))
            x += thick + (0.12 if count % 11 == 7 else 0.002)
            count += 1
    return out


def bowl(radius, height, wall=0.008, steps=10):
    """A bowl: outside from the foot to the rim, then inside back to the middle."""
    def at(t, shrink):
        return (max(radius - shrink, 0.0) * math.sin(math.pi / 2 * t), height * (1 - math.cos(math.pi / 2 * t)) + shrink * (1 - t))
    outer, inner = [at(k / steps, 0.0) for k in range(steps + 1)], [at(k / steps, wall) for k in range(steps, -1, -1)]
    return lathe(outer + inner, 40)


def vase(height, steps=24):
    """A vase, closed at the top: its mouth is dark anyway."""
    profile = [(0.0, 0.0)] + [(height * (0.16 + 0.1 * math.sin(2 * math.pi * (0.9 * k / steps + 0.02))), height * k / steps) for k in range(steps + 1)]
    return lathe(profile + [(0.0, height)], 40)


def foliage(leaves=70):
    """Rhombic leaves on a spiral of golden angles, visible from both sides."""
    out = Mesh()
    for k in range(leaves):
        turn, rise = 2 * math.pi * k * GOLDEN, (k + 0.5) / leaves
        reach, up = math.sin(math.pi * (0.25 + 0.6 * rise)), 0.75 * rise
        c, s = math.cos(turn), math.sin(turn)
        root, tip = (0.05 * c, up, 0.05 * s), (0.34 * reach * c, up + 0.22, 0.34 * reach * s)
        middle, side = tuple((a + b) / 2 for a, b in zip(root, tip)), (-0.045 * s, 0.0, 0.045 * c)
        points = (root, tuple(m - x for m, x in zip(middle, side)), tip, tuple(m + x for m, x in zip(middle, side)))
        out.append(bare(polygon(*points)))
    return out

"""A gilded star on a plinth, a copper knot and a handful of balls on terrazzo, under coloured area lights."""
import math

from scenes import png
from scenes.gltf import Gltf, axis_angle, cross, normalize, quaternion
from scenes.mesh import Mesh, box, face_normal, icosphere, lathe, polygon, quad, star, sub, torus_knot, uv_sphere

# Normal-incidence reflectance of metals, linear sRGB (A. Schueler / S. Lagarde's tables of measured metals).
GOLD, COPPER, SILVER, STEEL = (1.0, 0.766, 0.336), (0.955, 0.638, 0.538), (0.972, 0.96, 0.915), (0.56, 0.57, 0.58)


def terrazzo(size=512):
    """Stone chips in cement: base colour, and roughness in green (chips are polished, cement less so)."""
    chips = [(0.72, 0.66, 0.58), (0.48, 0.27, 0.2), (0.2, 0.29, 0.31), (0.8, 0.78, 0.74), (0.1, 0.1, 0.12),
          (0.56, 0.45, 0.3)]
    cement = (0.36, 0.35, 0.35)
    layers = [(9, 11, 0.16), (23, 21, 0.14)]  # cells per tile, seed, half width of the joint
    picture = []
    for y in range(size):
        row = []
        for x in range(size):
            color, chip = cement, 0.0
            for period, seed, gap in layers:
                u, v = x / size * period, y / size * period
                first, second, name = png.cells(u, v, period, seed)
                if name < 0.62:
                    edge = (second - first - 2 * gap) * size / period / 2  # distance from the rim in texels, for a soft rim
                    cover = min(max(edge + 0.5, 0.0), 1.0)
                    stone = chips[int(name / 0.62 * len(chips)) % len(chips)]
                    color = tuple(c + (s - c) * cover for c, s in zip(color, stone))
                    chip += (1 - chip) * cover
            row.append((color, chip))
        picture.append(row)
    color = png.encode(size, size, 3, lambda x, y: [int(c * 255 / 5 + 0.5) * 5 for c in picture[y][x][0]])
    rough = png.encode(size, size, 3, lambda x, y: (255, png.byte(0.38 - 0.2 * round(picture[y][x][1] * 4) / 4), 0))
    return color, rough


def hammered(size=256, period=12):
    """Dents of a ball-peen hammer as a normal map."""
    def height(x, y):
        first, second, _ = png.cells(x / size * period, y / size * period, period, 77)
        return min(first, 0.75) ** 2
    return png.normal_map(size, size, height, 5.0)


def shard(seed):
    """A splinter: a stretched, lopsided tetrahedron with flat facets."""
    r = lambda k: png.hash01(seed, k, 5) - 0.5
    a = (-0.5 + 0.2 * r(1), -0.04, 0.16 + 0.1 * r(2))
    b = (0.5 + 0.2 * r(3), -0.04, 0.12 * r(4))
    c = (-0.35 + 0.3 * r(5), -0.04, -0.22 + 0.1 * r(6))
    d = (-0.15 + 0.3 * r(7), 0.34 + 0.1 * r(8), 0.1 * r(9))
    out = Mesh()
    for f in ((a, b, d), (b, c, d), (c, a, d), (a, c, b)):
        out.append(polygon(*f))
    return out


def sweep(width, depth, back, top, radius, steps=24):
    """The wall and the curve that joins it to the floor: a photographer's backdrop."""
    profile = [(depth, 0.0)] if depth > back + radius else []
    for i in range(steps + 1):
        a = math.pi / 2 * i / steps
        profile.append((back + radius - radius * math.sin(a), radius - radius * math.cos(a)))
    profile.append((back, top))
    out = Mesh()
    for k, (z, y) in enumerate(profile):
        before, after = profile[max(k - 1, 0)], profile[min(k + 1, len(profile) - 1)]
        dz, dy = after[0] - before[0], after[1] - before[1]
        n = normalize((0.0, -dz, dy))
        for x in (-width, width):
            out.positions.append((x, y, z))
            out.normals.append(n)
    for k in range(len(profile) - 1):
        a = 2 * k
        out.triangles += [(a, a + 1, a + 3), (a, a + 3, a + 2)]
    return out


def panel(g, name, center, target, half_width, half_height, color, strength):
    """A rectangular lamp that shines at the target from its front only."""
    forward = normalize(sub(target, center))
    side = normalize(cross(forward, (0.0, 1.0, 0.0) if abs(forward[1]) < 0.99 else (0.0, 0.0, 1.0)))
    up = cross(side, forward)
    shape = quad(center, tuple(half_width * x for x in up), tuple(half_height * x for x in side))
    if sum(a * b for a, b in zip(shape.normals[0], forward)) < 0:
        shape = shape.flipped()
    shape.uvs = []
    g.add(name, shape, g.material(name, (0.0, 0.0, 0.0), lambert=True, emission=[strength * c for c in color]))


def make(folder):
    g = Gltf()
    color, rough = terrazzo()
    tile = 2.0
    floor = quad((0.0, 0.0, 0.5), (6.0, 0.0, 0.0), (0.0, 0.0, -4.0), uvs=[(0, 8 / tile), (12 / tile, 8 / tile),
          (12 / tile, 0), (0, 0)])
    g.add("floor", floor,
          g.material("terrazzo", (1.0, 1.0, 1.0), roughness=1.0,
          base_texture=g.texture_use(g.texture("terrazzo-color", color)),
                                     metallic_roughness_texture=g.texture_use(g.texture("terrazzo-roughness", rough))))
    g.add("backdrop", sweep(6.0, 0.0, -3.5, 5.0, 1.6).moved((0.0, 0.001, 0.0)),
          g.material("backdrop", (0.16, 0.17, 0.2), lambert=True))

    stone = g.material("stone", (0.62, 0.6, 0.57), roughness=0.4)
    g.add("plinth", lathe([(0.74, 0.0), (0.74, 0.07), (0.72, 0.09), (0.62, 0.09), (0.62, 0.19), (0.6, 0.21),
          (0.0, 0.21)], 96), stone,
          translation=(0.0, 0.0, -0.25))

    gold = g.material("gold", GOLD, metallic=1.0, roughness=0.16)
    # The star stands on a tip: the icosahedron's vertex (0, -1, phi) points down.
    tip = normalize((0.0, -1.0, (1 + math.sqrt(5)) / 2))
    turn = axis_angle(cross(tip, (0.0, -1.0, 0.0)), math.degrees(math.acos(-tip[1] * -1.0)))
    spin = axis_angle((0, 1, 0), 26)
    g.add("star", star(0.7), gold, translation=(0.0, 0.21 + 0.69, -0.25), rotation=multiply(spin, turn))
    for i, (x, z, size, angle) in enumerate(((-0.3, 0.8, 0.24, 20), (0.36, 0.7, 0.2, 200), (0.0, 1.12, 0.16, 75),
          (0.98, 0.3, 0.2, 130),
                                             (0.62, 1.36, 0.12, 310), (-1.05, 1.12, 0.14, 165),
                                                   (1.2, 1.1, 0.15, 255))):
        g.add(f"splinter-{i}", shard(i), gold, translation=(x, 0.05 * size, z),
              rotation=axis_angle((0, 1, 0), angle), scale=size)

    knot = torus_knot(2, 3, 0.44, 0.115, 280, 28)
    low = min(p[1] for p in knot.positions)
    g.add("knot", knot, g.material("copper", COPPER, metallic=1.0, roughness=0.28), translation=(-1.3, -low, -0.1),
          rotation=axis_angle((0, 1, 0), 24))

    ball, small = icosphere(1.0, 5), icosphere(1.0, 4)
    def put(name, shape, material, x, z, radius):
        g.add(name, shape, material, translation=(x, radius, z), scale=radius)
    put("mirror-ball", ball, g.material("silver", SILVER, metallic=1.0, roughness=0.04), 1.28, -0.25, 0.43)
    put("blue-ball", small, g.material("blue-plastic", (0.02, 0.06, 0.42), roughness=0.12), 0.8, 0.86, 0.24)
    put("red-ball", small, g.material("red-lacquer", (0.52, 0.02, 0.03), roughness=0.2), -0.78, 1.0, 0.2)
    put("steel-ball", small, g.material("steel", STEEL, metallic=1.0, roughness=0.45), 1.3, 0.62, 0.17)
    put("chalk-ball", small, g.material("chalk", (0.8, 0.78, 0.74), lambert=True), 0.38, 1.2, 0.1)
    put("green-ball", small, g.material("green-plastic", (0.04, 0.3, 0.16), roughness=0.5), -1.42, 0.78, 0.15)
    dents = g.texture_use(g.texture("hammered-normal", hammered()), scale=(2.0, 1.0))
    put("hammered-ball", uv_sphere(1.0, 64, 32),
          g.material("bronze", (0.78, 0.5, 0.28), metallic=1.0, roughness=0.22, normal_texture=dents),
        -0.4, 1.34, 0.13)

    panel(g, "key", (-2.7, 3.1, 2.5), (0.0, 0.6, 0.0), 0.9, 0.9, (1.0, 0.9, 0.76), 15.0)
    panel(g, "fill", (3.3, 1.7, 3.0), (0.2, 0.5, 0.0), 1.1, 1.1, (0.62, 0.78, 1.0), 2.4)
    panel(g, "rim-blue", (2.6, 2.2, -2.0), (0.2, 0.7, 0.0), 1.1, 0.25, (0.16, 0.55, 1.0), 22.0)
    panel(g, "rim-rose", (-3.3, 1.9, -1.6), (-0.3, 0.6, 0.0), 1.0, 0.25, (1.0, 0.2, 0.36), 22.0)
    panel(g, "top", (0.0, 3.8, -0.2), (0.0, 0.0, -0.2), 0.35, 1.4, (1.0, 0.96, 0.9), 8.0)
    panel(g, "wash-blue", (-3.6, 0.9, -2.2), (-1.2, 1.4, -3.6), 0.5, 0.3, (0.15, 0.35, 1.0), 14.0)
    panel(g, "wash-rose", (3.6, 0.9, -2.2), (1.2, 1.4, -3.6), 0.5, 0.3, (1.0, 0.35, 0.3), 11.0)
    # Big and dim, so that metal has something to mirror where there is no lamp.
    panel(g, "front-card", (0.5, 3.0, 8.0), (0.0, 0.8, 0.0), 2.2, 4.5, (0.8, 0.88, 1.0), 0.55)
    panel(g, "left-card", (-6.0, 2.6, 1.5), (0.0, 0.8, 0.0), 2.4, 2.4, (1.0, 0.8, 0.66), 0.7)
    panel(g, "right-card", (5.0, 3.6, 2.2), (0.0, 0.8, 0.0), 2.4, 2.4, (0.66, 0.8, 1.0), 1.0)
    panel(g, "ceiling-card", (0.0, 5.5, 1.2), (0.0, 0.0, 1.2), 2.2, 3.0, (1.0, 0.96, 0.92), 0.9)
    g.perspective("camera", (0.45, 1.42, 5.6), (0.0, 0.66, 0.0), 23.5, 1.5)
    g.write(folder, "showcase")


def multiply(a, b):
    """Returns the quaternion of the rotation b followed by a."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)

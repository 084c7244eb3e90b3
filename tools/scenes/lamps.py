"""A small room that uses every core feature once: a look at it shows whether anything is broken."""
import math

from scenes import png
from scenes.gltf import CLAMP, MIRROR, NEAREST, REPEAT, Gltf, axis_angle
from scenes.mesh import Mesh, box, icosphere, lathe, polygon, quad, uv_sphere

WIDTH, HEIGHT, DEPTH = 2.0, 2.6, 2.0  # half width, height, half depth of the room
WINDOW = (0.9, 2.0, -0.7, 0.5)        # in the right wall: from y, to y, from z, to z


def tile_texture():
    """2 x 2 texels, shown with NEAREST and repeated by KHR_texture_transform."""
    dark, light = (70, 62, 58), (205, 196, 180)
    return png.encode(2, 2, 3, lambda x, y: light if (x + y) % 2 else dark)


def stained_glass(size=128):
    """Emission in colour: cells of glass between black leads."""
    def pixel(x, y):
        first, second, name = png.cells(x / size * 6, y / size * 6, 6, 31)
        if second - first < 0.07:
            return 0, 0, 0
        hue = [(230, 60, 40), (250, 180, 40), (50, 120, 220), (60, 180, 110), (240, 230, 200), (150, 60, 190)]
        return hue[int(name * len(hue)) % len(hue)]
    return png.encode(size, size, 3, pixel)


def grille(size=128):
    """A round hole in a lattice, opaque where the metal is."""
    def pixel(x, y):
        u, v = (x + 0.5) / size * 4 % 1 - 0.5, (y + 0.5) / size * 4 % 1 - 0.5
        edge = (math.hypot(u, v) - 0.36) * size / 4
        return 120, 110, 100, png.byte(edge + 0.5)
    return png.encode(size, size, 4, pixel)


def leaf(size=128):
    """A leaf that stands on the lower edge of the picture; its stem runs up the middle."""
    def pixel(x, y):
        u, v = (x + 0.5) / size * 2 - 1, 1 - (y + 0.5) / size
        half = 0.75 * math.sin(math.pi * v ** 0.75) ** 1.2 * (1 - 0.12 * abs(math.sin(28 * v)))
        inside = (max(half, 0.04 if v < 0.6 else 0.0) - abs(u)) * size / 2
        vein = abs(u) < 0.025 or abs(math.sin(20 * (v - 0.4 * abs(u)))) < 0.12
        shade = 1.25 if vein else 1.0
        return int(52 * shade), int(112 * shade), int(40 * shade), png.byte(inside + 0.5)
    return png.encode(size, size, 4, pixel)


def gel(size=64):
    """A stage lamp's colour foil: red to blue, and from clear at the top to nearly opaque at the bottom."""
    return png.encode(size, size, 4, lambda x, y: (255 - 3 * x, 60, 70 + 2 * x, int(40 + 200 * y / (size - 1))))


def stripes(size=64):
    """Roughness in green, metalness in blue: four stripes from polished metal to matt plastic."""
    def pixel(x, y):
        k = x * 4 // size
        return 255, (90, 150, 100, 220)[k], (255, 255, 0, 0)[k]
    return png.encode(size, size, 3, pixel)


def sign(size=64):
    """An arrow, unlit."""
    def pixel(x, y):
        u, v = (x + 0.5) / size, abs((y + 0.5) / size - 0.5)
        arrow = (0.15 < u < 0.55 and v < 0.1) or (0.5 < u < 0.85 and v < 0.85 - u)
        return (255, 255, 255) if arrow else (10, 130, 70)
    return png.encode(size, size, 3, pixel)


def ripples(size=128):
    def height(x, y):
        return 0.5 + 0.5 * math.sin(2 * math.pi * (6 * x + 2 * y) / size) * math.sin(2 * math.pi * (5 * y - x) / size)
    return png.normal_map(size, size, height, 1.5)


def wall_with_window():
    y0, y1, z0, z1 = WINDOW
    outer = [(WIDTH, 0.0, DEPTH), (WIDTH, 0.0, -DEPTH), (WIDTH, HEIGHT, -DEPTH), (WIDTH, HEIGHT, DEPTH)]
    inner = [(WIDTH, y0, z1), (WIDTH, y0, z0), (WIDTH, y1, z0), (WIDTH, y1, z1)]
    outer.reverse()
    inner.reverse()
    out = Mesh()
    for i in range(4):
        j = (i + 1) % 4
        out.append(polygon(outer[i], outer[j], inner[j], inner[i]))
    out.uvs = []
    return out if out.normals[0][0] < 0 else out.flipped()


def rainbow_ball():
    ball = icosphere(0.2, 3)
    ball.colors = [tuple(png.byte(0.5 + 0.5 * c) for c in n) + (255,) for n in ball.normals]
    return ball


def make(folder):
    g = Gltf()
    use = g.texture_use
    plain = lambda shape: (setattr(shape, "uvs", []), shape)[1]

    tiles = use(g.texture("tiles", tile_texture(), mag=NEAREST), scale=(5.0, 5.0), rotation=0.3)
    g.add("floor", quad((0.0, 0.0, 0.0), (WIDTH, 0.0, 0.0), (0.0, 0.0, -DEPTH)),
          g.material("tiles", (1.0, 1.0, 1.0), roughness=0.35, base_texture=tiles))
    plaster = g.material("plaster", (0.72, 0.7, 0.66), lambert=True)
    g.add("back-wall", plain(quad((0.0, HEIGHT / 2, -DEPTH), (WIDTH, 0.0, 0.0), (0.0, HEIGHT / 2, 0.0))), plaster)
    # The camera stands outside. It sees through the back of this single-sided wall, but light inside does not leave through it.
    g.add("front-wall", plain(quad((0.0, HEIGHT / 2, DEPTH), (-WIDTH, 0.0, 0.0), (0.0, HEIGHT / 2, 0.0))), plaster)
    g.add("ceiling", plain(quad((0.0, HEIGHT, 0.0), (WIDTH, 0.0, 0.0), (0.0, 0.0, DEPTH))), plaster)
    g.add("left-wall", plain(quad((-WIDTH, HEIGHT / 2, 0.0), (0.0, 0.0, -DEPTH), (0.0, HEIGHT / 2, 0.0))),
          g.material("blue-plaster", (0.25, 0.36, 0.5), lambert=True))
    g.add("right-wall", wall_with_window(), plaster)

    y0, y1, z0, z1 = WINDOW
    lattice = quad((WIDTH, (y0 + y1) / 2, (z0 + z1) / 2), (0.0, 0.0, -(z1 - z0) / 2), (0.0, (y1 - y0) / 2, 0.0),
          uvs=[(0, 3), (3, 3), (3, 0), (0, 0)])
    g.add("grille", lattice,
          g.material("grille", (1.0, 1.0, 1.0), metallic=1.0, roughness=0.4, alpha_mode="MASK", cutoff=0.5,
          double_sided=True,
                                        base_texture=use(g.texture("grille", grille()))))
    glass = quad((-0.75, 1.55, -DEPTH + 0.02), (0.55, 0.0, 0.0), (0.0, 0.55, 0.0))
    glass.uvs1, glass.uvs = glass.uvs, [(0.0, 0.0)] * 4  # on the second set; a loader that uses the first shows a single colour
    g.add("stained-glass", glass, g.material("stained-glass", (0.0, 0.0, 0.0), lambert=True, emission=(4.0, 4.0, 4.0),
                                             emission_texture=use(g.texture("stained-glass", stained_glass(),
                                                   wrap=(CLAMP, CLAMP)), uv_set=1)))
    g.add("sign", quad((0.55, 2.0, -DEPTH + 0.02), (0.22, 0.0, 0.0), (0.0, 0.22, 0.0)),
          g.material("sign", (0.9, 0.9, 0.9), unlit=True, base_texture=use(g.texture("sign", sign()))))

    wood = g.material("wood", (0.35, 0.2, 0.1), roughness=0.5, specular=0.5)
    table = box((-0.1, 0.68, -1.5), (1.3, 0.74, -0.7))
    for x, z in ((-0.04, -1.44), (1.16, -1.44), (-0.04, -0.84), (1.16, -0.84)):
        table.append(box((x, 0.0, z), (x + 0.08, 0.68, z + 0.08)))
    g.add("table", plain(table), wood)
    g.add("lamp-foot", lathe([(0.11, 0.0), (0.11, 0.02), (0.02, 0.04), (0.015, 0.3), (0.0, 0.3)], 32),
          g.material("brass", (0.9, 0.7, 0.35), metallic=1.0, roughness=0.5),
          translation=(0.25, 0.74, -1.1))
    g.add("lamp-bulb", plain(icosphere(0.05, 1)),
          g.material("bulb", (0.0, 0.0, 0.0), lambert=True, emission=(260.0, 190.0, 120.0)),
          translation=(0.25, 1.08, -1.1))
    g.add("lamp-shade", lathe([(0.2, 0.0), (0.12, 0.22)], 48),
          g.material("shade", (0.8, 0.72, 0.6), alpha=0.8, lambert=True, alpha_mode="BLEND", double_sided=True),
          translation=(0.25, 0.98, -1.1))
    g.add("rainbow-ball", rainbow_ball(),
          g.material("vertex-colours", (1.0, 1.0, 1.0), roughness=0.3), translation=(0.72, 0.94, -0.98))
    striped = use(g.texture("stripes", stripes(), wrap=(MIRROR, REPEAT), mag=NEAREST), offset=(0.5, 0.0),
          scale=(2.0, 1.0))
    g.add("striped-plate", quad((1.02, 0.94, -1.32), (0.2, 0.0, 0.06), (0.0, 0.19, -0.05)),
          g.material("stripes", (0.8, 0.75, 0.7), metallic=1.0, roughness=1.0, metallic_roughness_texture=striped))

    rippled = g.material("ripples", (0.85, 0.85, 0.88), metallic=1.0, roughness=0.35,
          normal_texture=use(g.texture("ripples", ripples()), scale=(2.0, 1.0)), normal_scale=0.7)
    ball = uv_sphere(0.26, 48, 24)
    g.add("rippled-ball", ball, rippled, translation=(-0.2, 0.26, 0.35))
    g.add("rippled-ball-mirrored", ball, rippled, translation=(0.75, 0.18, 0.75), scale=(-0.7, 0.7, 0.7))

    g.add("pot", lathe([(0.0, 0.0), (0.14, 0.0), (0.2, 0.3), (0.17, 0.3), (0.16, 0.26), (0.0, 0.26)], 40),
          g.material("clay", (0.5, 0.24, 0.15), lambert=True), translation=(-1.35, 0.0, -0.4))
    leaves = g.material("leaf", (1.0, 1.0, 1.0), roughness=0.6, alpha_mode="MASK", cutoff=0.5, double_sided=True,
          base_texture=use(g.texture("leaf", leaf(), wrap=(CLAMP, CLAMP))))
    plant = Mesh()
    for k in range(7):
        a = 2 * math.pi * k / 7 + 0.3
        c, s = math.cos(a), math.sin(a)
        lean, size = 0.35 + 0.25 * png.hash01(k, 1, 9), 0.55 + 0.3 * png.hash01(k, 2, 9)
        up = (lean * c * size / 2, size / 2 * math.sqrt(1 - lean * lean), lean * s * size / 2)
        plant.append(quad(tuple(u + d for u, d in zip(up, (0.03 * c, 0.25, 0.03 * s))),
              (-0.13 * s, 0.0, 0.13 * c), up))
    g.add("plant", plant, leaves, translation=(-1.35, 0.0, -0.4))
    foil = quad((0.0, 0.0, 0.0), (0.3, 0.0, 0.0), (0.0, 0.4, 0.0))
    g.add("foil", foil,
          g.material("foil", (1.0, 1.0, 1.0), roughness=0.2, alpha_mode="BLEND", double_sided=True,
          base_texture=use(g.texture("foil", gel(), wrap=(CLAMP, CLAMP)))),
          translation=(1.35, 0.42, 0.2), rotation=axis_angle((0, 1, 0), -35))

    g.light("point", "point", (-1.2, 2.2, 0.9), (1.0, 0.85, 0.7), 2.0)
    g.light("spot", "spot", (0.2, 2.4, 1.3), (0.8, 0.9, 1.0), 9.0, target=(0.72, 0.94, -0.98), inner=14.0, outer=24.0)
    g.light("sun", "directional", (4.0, 3.6, 0.6), (1.0, 0.92, 0.8), 1.5, target=(0.2, 0.2, 0.1))
    g.perspective("camera", (-0.1, 1.3, 5.2), (0.0, 1.15, 0.0), 36.0, 4 / 3)
    g.orthographic("plan", (0.0, 6.0, 0.0), (0.0, 0.0, 0.0), 2.2, 2.2)
    g.write(folder, "lamps")

"""A teapot in a stadium: nearly all triangles lie in a hundred-thousandth of a large sparse scene, which defeats a uniform grid."""
import math

from scenes.gltf import Gltf
from scenes.mesh import Mesh, box, lathe, quad


def tube(points, radii, around=24):
    """A pipe in the plane z = 0 along points (x, y), with a radius at each."""
    out = Mesh()
    for i, ((x, y), r) in enumerate(zip(points, radii)):
        ahead, behind = points[min(i + 1, len(points) - 1)], points[max(i - 1, 0)]
        dx, dy = ahead[0] - behind[0], ahead[1] - behind[1]
        length = math.hypot(dx, dy)
        nx, ny = -dy / length, dx / length
        for k in range(around):
            a = 2 * math.pi * k / around
            c, s = math.cos(a), math.sin(a)
            out.positions.append((x + r * c * nx, y + r * c * ny, r * s))
            out.normals.append((c * nx, c * ny, s))
    for i in range(len(points) - 1):
        for k in range(around):
            a, b = i * around + k, i * around + (k + 1) % around
            out.triangles += [(a, b, a + around), (b, b + around, a + around)]
    return out


def teapot():
    """0.2 m across, standing on y = 0."""
    def profile(points):
        return [(0.1 * r, 0.1 * y) for r, y in points]
    body = [(0.6 + 0.42 * math.sin(math.pi * (0.12 + 0.76 * t)) - 0.12 * t, 0.06 + 1.0 * t) for t in [i / 40 for i in range(41)]]
    out = lathe(profile([(0.0, 0.0), (0.62, 0.0), (0.68, 0.06)] + body + [(0.62, 1.08)]), 64)
    lid = [(0.6 * math.cos(t), 1.1 + 0.18 * math.sin(t)) for t in [math.pi / 2 * i / 10 for i in range(10)]]
    out.append(lathe(profile(lid + [(0.08, 1.3), (0.12, 1.36), (0.1, 1.42), (0.0, 1.44)]), 64))
    spout = [(0.09 + 0.001 * i * 4, 0.035 + 0.0001 * i * i * 1.6) for i in range(21)]
    out.append(tube(spout, [0.022 - 0.0006 * i for i in range(21)]))
    handle = [(-0.085 - 0.04 * math.sin(math.pi * i / 20), 0.1 - 0.08 * i / 20) for i in range(21)]
    out.append(tube(handle, [0.009] * 21))
    return out


def make(folder):
    g = Gltf()
    grass, concrete = g.material("grass", (0.12, 0.3, 0.08), lambert=True), g.material("concrete", (0.5, 0.5, 0.48), lambert=True)
    g.add("field", quad((0.0, 0.0, 0.0), (110.0, 0.0, 0.0), (0.0, 0.0, -90.0)), grass)
    stands = Mesh()
    for row in range(6):
        for i in range(48):
            a = 2 * math.pi * i / 48
            x, z, y = (60 + 6 * row) * math.cos(a), (45 + 6 * row) * math.sin(a), 3.0 * row
            stands.append(box((x - 2.5, y, z - 2.5), (x + 2.5, y + 3.0, z + 2.5)))
    stands.uvs = []
    g.add("stands", stands, concrete)
    g.add("teapot", teapot(), g.material("glaze", (0.75, 0.8, 0.85), roughness=0.15))
    for i, (x, z) in enumerate(((80.0, 60.0), (-80.0, 60.0), (80.0, -60.0), (-80.0, -60.0))):
        lamp = g.material(f"lamp-{i}", (0.0, 0.0, 0.0), lambert=True, emission=(900.0, 880.0, 820.0), double_sided=True)
        g.add(f"lamp-{i}", quad((x, 40.0, z), (2.0, 0.0, 0.0), (0.0, 2.0, 0.0)), lamp)
    g.perspective("close", (0.25, 0.2, 0.45), (0.0, 0.06, 0.0), 35.0, 1.5)
    g.perspective("seat", (0.0, 27.0, 84.0), (0.0, 0.0, 0.0), 50.0, 1.5)
    g.write(folder, "stadium")

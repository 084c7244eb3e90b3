"""Triangle meshes: counter-clockwise as seen from the front, with normals on that side."""
import math

from scenes.gltf import cross, normalize


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def lerp(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


class Mesh:
    def __init__(self, positions=(), triangles=(), normals=(), uvs=(), uvs1=(), colors=(), tangents=()):
        self.positions, self.triangles = list(positions), list(triangles)
        self.normals, self.uvs, self.uvs1 = list(normals), list(uvs), list(uvs1)
        self.colors, self.tangents = list(colors), list(tangents)
        self.accessors = {}

    def append(self, other):
        base = len(self.positions)
        self.positions += other.positions
        self.triangles += [tuple(i + base for i in t) for t in other.triangles]
        self.normals += other.normals
        self.uvs += other.uvs
        self.uvs1 += other.uvs1
        self.colors += other.colors
        self.tangents += other.tangents
        return self

    def flipped(self):
        return Mesh(self.positions, [(a, c, b) for a, b, c in self.triangles],
                    [tuple(-x for x in n) for n in self.normals], self.uvs, self.uvs1, self.colors,
                    self.tangents)

    def moved(self, by):
        return Mesh([tuple(p + b for p, b in zip(q, by)) for q in self.positions], self.triangles, self.normals,
                    self.uvs, self.uvs1, self.colors, self.tangents)

    def area(self):
        total = 0.0
        for a, b, c in self.triangles:
            pa, pb, pc = self.positions[a], self.positions[b], self.positions[c]
            n = cross(sub(pb, pa), sub(pc, pa))
            total += math.sqrt(dot(n, n)) / 2
        return total

    def check(self, name):
        """Checks what a generator can get wrong: lengths, indices, zero area, normals against the winding."""
        count = len(self.positions)
        for stream in (self.normals, self.uvs, self.uvs1, self.colors, self.tangents):
            assert len(stream) in (0, count), name
        for t in self.triangles:
            assert all(0 <= i < count for i in t), name
            a, b, c = (self.positions[i] for i in t)
            n = cross(sub(b, a), sub(c, a))
            assert dot(n, n) > 0, f"{name}: triangle {t} has no area"
            for i in t if self.normals else ():
                assert dot(n, self.normals[i]) > 0, f"{name}: normal of vertex {i} opposes the winding"
                assert abs(dot(self.normals[i], self.normals[i]) - 1) < 1e-6, f"{name}: normal {i} is not unit"


def face_normal(a, b, c):
    return normalize(cross(sub(b, a), sub(c, a)))


def polygon(*points, uvs=None):
    """A flat convex polygon; its corners are counter-clockwise as seen from the front."""
    n = face_normal(*points[:3])
    if uvs is None and len(points) == 4:
        uvs = [(0, 1), (1, 1), (1, 0), (0, 0)]
    return Mesh(points, [(0, i, i + 1) for i in range(1, len(points) - 1)], [n] * len(points), uvs or [])


def ring(outer, inner):
    """A polygon with a hole of as many corners: quadrilaterals join the edges."""
    out = Mesh()
    for i in range(len(outer)):
        j = (i + 1) % len(outer)
        out.append(polygon(outer[i], outer[j], inner[j], inner[i]))
    out.uvs = []
    return out


def quad(center, u, v, uvs=None):
    """A quad by its centre and two half edges; u x v points to its front."""
    corner = lambda s, t: tuple(c + s * a + t * b for c, a, b in zip(center, u, v))
    return polygon(corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1), uvs=uvs)


def sheet(center, u, v):
    """A quad without texture coordinates."""
    out = quad(center, u, v)
    out.uvs = []
    return out


def box(lo, hi, inward=False):
    (x0, y0, z0), (x1, y1, z1) = lo, hi
    faces = [((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)), ((x1, y0, z0), (x0, y0, z0), (x0, y1, z0), (x1, y1, z0)),
             ((x1, y0, z1), (x1, y0, z0), (x1, y1, z0), (x1, y1, z1)), ((x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)),
             ((x0, y1, z1), (x1, y1, z1), (x1, y1, z0), (x0, y1, z0)), ((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1))]
    out = Mesh()
    for f in faces:
        out.append(polygon(*(reversed(f) if inward else f)))
    return out


_PHI = (1 + math.sqrt(5)) / 2
_ICO_POINTS = [normalize(p) for p in ((-1, _PHI, 0), (1, _PHI, 0), (-1, -_PHI, 0), (1, -_PHI, 0), (0, -1, _PHI), (0, 1, _PHI),
                                      (0, -1, -_PHI), (0, 1, -_PHI), (_PHI, 0, -1), (_PHI, 0, 1), (-_PHI, 0, -1), (-_PHI, 0, 1))]
_ICO_FACES = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
              (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]


def icosphere(radius=1.0, subdivisions=4):
    """A sphere of 20 x 4^subdivisions triangles, with smooth normals; its vertices lie on the sphere."""
    points, faces = list(_ICO_POINTS), list(_ICO_FACES)
    for _ in range(subdivisions):
        middle, finer = {}, []

        def mid(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                middle[key] = len(points)
                points.append(normalize([x + y for x, y in zip(points[a], points[b])]))
            return middle[key]

        for a, b, c in faces:
            ab, bc, ca = mid(a, b), mid(b, c), mid(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = finer
    return Mesh([tuple(radius * x for x in p) for p in points], faces, points)


def uv_sphere(radius=1.0, columns=64, rows=32):
    """A sphere with texture coordinates and tangents (along +u)."""
    out = Mesh()
    for j in range(rows + 1):
        theta = math.pi * j / rows
        for i in range(columns + 1):
            phi = 2 * math.pi * i / columns
            n = (math.sin(theta) * math.cos(phi), math.cos(theta), -math.sin(theta) * math.sin(phi))
            n = normalize(n)
            out.positions.append(tuple(radius * x for x in n))
            out.normals.append(n)
            out.uvs.append((i / columns, j / rows))
            out.tangents.append((-math.sin(phi), 0.0, -math.cos(phi), 1.0))
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b, c, d = a + 1, a + columns + 1, a + columns + 2
            if j > 0:
                out.triangles.append((a, d, b))
            if j < rows - 1:
                out.triangles.append((a, c, d))
    return out


def lathe(profile, segments=64, closed_ends=True):
    """Turns (radius, height) points, from the bottom up, about y. Every segment of the profile is a smooth band, with sharp edges
    between bands. A radius of 0 closes the end."""
    out = Mesh()
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        slope = normalize((y1 - y0, r0 - r1))  # normal in the (radius, y) plane
        base = len(out.positions)
        for i in range(segments + 1):
            a = 2 * math.pi * i / segments
            c, s = math.cos(a), -math.sin(a)
            n = normalize((slope[0] * c, slope[1], slope[0] * s))
            for r, y in ((r0, y0), (r1, y1)):
                out.positions.append((r * c, y, r * s))
                out.normals.append(n)
        for i in range(segments):
            a = base + 2 * i
            b, c, d = a + 1, a + 2, a + 3  # a below, b above; c, d the next such pair
            if r0 > 0:
                out.triangles.append((a, c, b) if r1 == 0 else (a, c, d))
            if r1 > 0:
                out.triangles.append((a, d, b))
    return out


def torus_knot(p, q, radius, tube, along=320, around=24):
    """The (p, q) torus knot with a round tube and smooth normals."""
    def point(t):
        r = radius * (2 + math.cos(q * t)) / 3
        return (r * math.cos(p * t), r * math.sin(p * t), radius * math.sin(q * t) / 2)

    out = Mesh()
    for i in range(along):
        t = 2 * math.pi * p * i / along / p
        a, b = point(t), point(t + 1e-4)
        tangent = normalize(sub(b, a))
        binormal = normalize(cross(tangent, tuple(x + y for x, y in zip(a, b))))
        side = cross(binormal, tangent)
        for j in range(around):
            v = 2 * math.pi * j / around
            n = normalize(tuple(math.cos(v) * s + math.sin(v) * w for s, w in zip(side, binormal)))
            out.positions.append(tuple(x + tube * y for x, y in zip(a, n)))
            out.normals.append(n)
    for i in range(along):
        for j in range(around):
            a, b = i * around + j, i * around + (j + 1) % around
            c, d = (i + 1) % along * around + j, (i + 1) % along * around + (j + 1) % around
            out.triangles += [(a, b, d), (a, d, c)]
    if dot(face_normal(*(out.positions[k] for k in out.triangles[0])), out.normals[out.triangles[0][0]]) < 0:
        out.triangles = [(a, c, b) for a, b, c in out.triangles]
    return out


def star(radius=1.0, depth=0.447):
    """A small stellated dodecahedron: a five-sided spike on each face of a dodecahedron, flat facets. depth: distance of the
    spikes' feet from the centre, over that of their tips (1/sqrt(5) = 0.447 makes the regular star)."""
    out = Mesh()
    tips = _ICO_POINTS
    feet = [normalize([sum(tips[i][k] for i in f) for k in range(3)]) for f in _ICO_FACES]
    foot = radius * depth
    for index, tip in enumerate(tips):
        ring = [k for k, f in enumerate(_ICO_FACES) if index in f]
        u = normalize(cross(tip, (0.37, 0.61, 0.53)))
        v = cross(tip, u)
        ring.sort(key=lambda k: math.atan2(dot(feet[k], v), dot(feet[k], u)))
        for a, b in zip(ring, ring[1:] + ring[:1]):
            out.append(polygon(tuple(radius * x for x in tip), tuple(foot * x for x in feet[a]), tuple(foot * x for x in feet[b])))
    return out

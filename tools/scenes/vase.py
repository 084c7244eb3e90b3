"""A glass vase on a matt floor, for an environment map with a sun. Light sampling cannot find the sun through glass."""
import math

from scenes.gltf import Gltf, normalize
from scenes.mesh import Mesh, sheet

SEGMENTS, STEPS, HEIGHT, WALL, FOOT = 48, 13, 0.5, 0.012, 0.03


def radius(y):
    return 0.13 + 0.055 * math.sin(2 * math.pi * (0.85 * y / HEIGHT + 0.02))


def profile():
    """Returns (radius, height) from the foot's middle up on the outside, over the rim, and down on the inside."""
    outside = [(radius(HEIGHT * k / STEPS), HEIGHT * k / STEPS) for k in range(STEPS + 1)]
    rim = [(radius(HEIGHT) - WALL / 2, HEIGHT + WALL / 2)]
    inside = [(radius(y) - WALL, y) for y in (FOOT + (HEIGHT - FOOT) * k / STEPS for k in range(STEPS, -1, -1))]
    return [(0.0, 0.0), (0.7 * radius(0.0), 0.0)] + outside + rim + inside + [(0.7 * radius(FOOT), FOOT), (0.0, FOOT)]


def turned(points):
    """Turns a profile about y; normals are smooth in both directions."""
    out, count = Mesh(), len(points)
    for k, (r, y) in enumerate(points):
        (r0, y0), (r1, y1) = points[max(k - 1, 0)], points[min(k + 1, count - 1)]
        slope = (0.0, math.copysign(1.0, r1 - r0) * -1.0) if r == 0 else normalize((y1 - y0, r0 - r1))
        for i in range(SEGMENTS):
            a = 2 * math.pi * i / SEGMENTS
            out.positions.append((r * math.cos(a), y, -r * math.sin(a)))
            out.normals.append(normalize((slope[0] * math.cos(a), slope[1], -slope[0] * math.sin(a))))
    for k in range(count - 1):
        for i in range(SEGMENTS):
            a, c = k * SEGMENTS + i, k * SEGMENTS + (i + 1) % SEGMENTS
            b, d = a + SEGMENTS, c + SEGMENTS
            if points[k][0] > 0:
                out.triangles.append((a, c, d) if points[k + 1][0] > 0 else (a, c, b))
            if points[k + 1][0] > 0:
                out.triangles.append((a, d, b))
    return out


def make(folder):
    g = Gltf()
    g.add("floor", sheet((0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.0, 0.0, -2.0)), g.material("floor", (0.5, 0.48, 0.45), lambert=True))
    glass = g.material("glass", (1.0, 1.0, 1.0), roughness=0.0, transmission=1.0, ior=1.5, body=True, attenuation=((0.75, 0.9, 0.85), 0.1))
    g.add("vase", turned(profile()), glass, translation=(0.0, 0.001, 0.0))
    g.perspective("camera", (0.0, 0.75, 1.6), (0.0, 0.2, 0.0), 30.0, 1.0)
    g.write(folder, "vase")

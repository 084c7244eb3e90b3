"""A velvet cushion: short fibres that catch light along the edges."""
import math

from scenes.gltf import cross, normalize
from scenes.mesh import Mesh, sub
from scenes.stage import stage

STEPS = 40


def cushion():
    """A square bag, fullest in its middle, drawn in by a button and wrinkled towards its corners."""
    def point(u, v, side):
        r = math.hypot(u, v)
        full = max((1 - u ** 4) * (1 - v ** 4), 0.0) ** 0.5
        button = 1 - 0.55 * math.exp(-60 * r * r)
        wrinkle = 1 + 0.07 * math.sin(8 * math.atan2(v, u)) * math.exp(-8 * (r - 0.3) ** 2)
        pull = 1 - 0.1 * (1 - abs(u * v))
        return (0.62 * u * pull, side * 0.24 * full * button * wrinkle, 0.62 * v * pull)

    out = Mesh()
    for side in (1, -1):
        at = lambda i, j: point(2 * i / STEPS - 1, 2 * j / STEPS - 1, side)
        near = lambda i: min(max(i, 0.5), STEPS - 0.5)  # at the seam, the slope is that of half a step inside
        base = len(out.positions)
        for j in range(STEPS + 1):
            for i in range(STEPS + 1):
                across = sub(at(near(i) + 0.25, near(j)), at(near(i) - 0.25, near(j)))
                along = sub(at(near(i), near(j) + 0.25), at(near(i), near(j) - 0.25))
                out.positions.append(at(i, j))
                out.normals.append(normalize(tuple(side * x for x in cross(along, across))))
        for j in range(STEPS):
            for i in range(STEPS):
                a = base + j * (STEPS + 1) + i
                b, c, d = a + 1, a + STEPS + 1, a + STEPS + 2
                out.triangles += [(a, c, d), (a, d, b)] if side > 0 else [(a, d, c), (a, b, d)]
    return out


def make(folder):
    g = stage(eye=(0.0, 1.5, 3.0), target=(0.0, 0.33, 0.0), yfov=25.0)
    velvet = g.material("velvet", (0.16, 0.015, 0.03), roughness=1.0, specular=0.3, extensions={
        "KHR_materials_sheen": {"sheenColorFactor": [0.75, 0.3, 0.36], "sheenRoughnessFactor": 0.35}})
    turn = math.radians(-28) / 2
    g.add("cushion", cushion(), velvet, translation=(0.0, 0.3, 0.0), rotation=(-math.sin(turn), 0.0, 0.0, math.cos(turn)))
    g.write(folder, "velvet")

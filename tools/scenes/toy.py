"""A toy car under a smooth coat, a ball of felt and a glass marble, for an environment map with a sun: each coat is a mirror of a few per cent."""
import math

from scenes.gltf import Gltf, axis_angle
from scenes.mesh import Mesh, icosphere, lathe, sheet


def rounded(half, round_):
    """A box with round edges: the eight parts of a sphere are moved to the corners, and the triangles between them become the faces."""
    ball = icosphere(1.0, 3)
    move = lambda n, h: round_ * n + (math.copysign(h - round_, n) if abs(n) > 1e-9 else 0.0)
    return Mesh([tuple(move(n, h) for n, h in zip(p, half)) for p in ball.positions], ball.triangles, ball.normals)


def make(folder):
    g = Gltf()
    g.add("floor", sheet((0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.0, 0.0, -2.0)), g.material("floor", (0.5, 0.48, 0.45), lambert=True))
    coat = {"KHR_materials_clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.0}}
    paint = g.material("paint", (0.6, 0.04, 0.03), roughness=0.6, extensions=coat)
    cream = g.material("cream", (0.75, 0.7, 0.55), roughness=0.6, extensions=coat)
    rubber = g.material("rubber", (0.04, 0.04, 0.04), roughness=0.8)
    turn = axis_angle((0, 1, 0), 25)
    c, s = math.cos(math.radians(25)), math.sin(math.radians(25))
    at = lambda x, y, z: (c * x + s * z, y, c * z - s * x)
    g.add("body", rounded((0.36, 0.09, 0.17), 0.07), paint, translation=at(0.0, 0.17, 0.0), rotation=turn)
    g.add("cabin", rounded((0.18, 0.09, 0.14), 0.07), cream, translation=at(-0.04, 0.32, 0.0), rotation=turn)
    wheel = lathe([(0.0, 0.0), (0.09, 0.0), (0.09, 0.05), (0.0, 0.05)], 24)
    lying = axis_angle((1, 0, 0), 90)
    (x1, y1, z1, w1), (x2, y2, z2, w2) = turn, lying
    both = (w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2, w1 * y2 - x1 * z2 + y1 * w2 + z1 * x2,
            w1 * z2 + x1 * y2 - y1 * x2 + z1 * w2, w1 * w2 - x1 * x2 - y1 * y2 - z1 * z2)
    for k, (x, z) in enumerate(((-0.2, 0.15), (0.2, 0.15), (-0.2, -0.2), (0.2, -0.2))):
        g.add(f"wheel-{k}", wheel, rubber, translation=at(x, 0.09, z), rotation=both)
    felt = g.material("felt", (0.1, 0.12, 0.3), roughness=1.0, specular=0.3, extensions={
        "KHR_materials_sheen": {"sheenColorFactor": [0.4, 0.45, 0.7], "sheenRoughnessFactor": 0.4}})
    ball = icosphere(1.0, 3)
    g.add("felt-ball", ball, felt, translation=(-0.52, 0.14, 0.2), scale=0.14)
    marble = g.material("marble", (1.0, 1.0, 1.0), roughness=0.0, transmission=1.0, ior=1.5, body=True, attenuation=((0.5, 0.8, 0.6), 0.2))
    g.add("marble", ball, marble, translation=(0.3, 0.101, 0.42), scale=0.1)
    g.perspective("camera", (0.2, 0.9, 1.9), (-0.05, 0.15, 0.0), 38.0, 1.0)
    g.write(folder, "toy")

"""Scenes whose picture is known without rendering it."""
import math

from scenes.gltf import Gltf
from scenes.mesh import box, icosphere, polygon, quad


def closed_box(folder, albedo):
    g = Gltf()
    wall = g.material("wall", (albedo,) * 3, lambert=True, emission=(1.0, 1.0, 1.0))
    shape = box((-1, -1, -1), (1, 1, 1), inward=True)
    shape.uvs = []
    g.add("box", shape, wall)
    g.perspective("camera", (0.3, 0.2, 0.6), (-0.4, -0.3, -1.0), 70.0, 1.0)
    g.write(folder, f"box-albedo-{albedo}")


def mixed_box(folder):
    """Six walls of six materials, all emitting 1. The value is not known, but all light strategies must agree on it."""
    g = Gltf()
    look = dict(emission=(1.0, 1.0, 1.0))
    materials = [g.material("matt", (0.5, 0.5, 0.5), lambert=True, **look),
                 g.material("plastic-smooth", (0.6, 0.3, 0.1), roughness=0.4, **look),
                 g.material("plastic-rough", (0.1, 0.4, 0.6), roughness=0.7, **look),
                 g.material("metal-smooth", (0.5, 0.45, 0.4), metallic=1.0, roughness=0.35, **look),
                 g.material("metal-rough", (0.7, 0.5, 0.3), metallic=1.0, roughness=0.6, **look),
                 g.material("half-metal", (0.4, 0.6, 0.5), metallic=0.5, roughness=0.4, **look)]
    shape = box((-1, -1, -1), (1, 1, 1), inward=True)
    for i, material in enumerate(materials):
        wall = polygon(*shape.positions[4 * i:4 * i + 4])
        wall.uvs = []
        g.add("wall-" + g.doc["materials"][material]["name"], wall, material)
    g.perspective("camera", (0.3, 0.2, 0.6), (-0.4, -0.3, -1.0), 90.0, 1.0)
    g.write(folder, "box-materials")


def spheres(folder):
    g = Gltf()
    looks = [("lambert-1", dict(lambert=True)), ("metal-0", dict(metallic=1.0, roughness=0.0)),
             ("metal-alpha-0.1", dict(metallic=1.0, roughness=math.sqrt(0.1))),
             ("metal-alpha-0.5", dict(metallic=1.0, roughness=math.sqrt(0.5))), ("metal-alpha-1", dict(metallic=1.0, roughness=1.0)),
             ("plastic-0.1", dict(roughness=0.1)), ("plastic-0.5", dict(roughness=0.5)), ("plastic-1", dict(roughness=1.0))]
    shape = icosphere(1.0, 4)
    for i, (name, look) in enumerate(looks):
        g.add(name, shape, g.material(name, (1.0, 1.0, 1.0), **look), translation=(2.5 * (i - 3.5), 0.0, 0.0))
    g.orthographic("camera", (0.0, 0.0, 10.0), (0.0, 0.0, 0.0), 10.0, 1.25)
    g.write(folder, "spheres")


def plates(folder):
    """Coplanar plates seen at a fixed angle, so that every pixel of a plate has the same directional albedo."""
    g = Gltf()
    looks = [("lambert-0.8", (0.8,) * 3, dict(lambert=True)), ("metal-alpha-0.1", (1.0,) * 3, dict(metallic=1.0, roughness=math.sqrt(0.1))),
             ("metal-alpha-0.5", (1.0,) * 3, dict(metallic=1.0, roughness=math.sqrt(0.5))),
             ("metal-alpha-1", (1.0,) * 3, dict(metallic=1.0, roughness=1.0))]
    for i, (name, base, look) in enumerate(looks):
        shape = quad((2.0 * (i - 1.5), 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 20.0, 0.0))
        shape.uvs = []
        g.add(name, shape, g.material(name, base, **look))
    for mu in (1.0, 0.5, 0.1):
        eye = (0.0, 10.0 * math.sqrt(1 - mu * mu), 10.0 * mu)
        g.orthographic(f"mu-{mu}", eye, (0.0, 0.0, 0.0), 4.0, 1.0)
    g.write(folder, "plates")


def make(folder):
    closed_box(folder, 0.5)
    closed_box(folder, 0.8)
    mixed_box(folder)
    spheres(folder)
    plates(folder)

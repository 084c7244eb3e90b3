"""A floor with three spheres, matt, metal and plastic, and no lamp: only the environment map lights it."""
from scenes.gltf import Gltf
from scenes.mesh import icosphere, sheet

RADIUS = 0.5


def make(folder):
    g = Gltf()
    g.add("floor", sheet((0.0, 0.0, 0.0), (6.0, 0.0, 0.0), (0.0, 0.0, -6.0)), g.material("floor", (0.4, 0.4, 0.4), lambert=True))
    ball = icosphere(RADIUS, 4)
    materials = (("matt", g.material("matt", (0.6, 0.55, 0.45), lambert=True)),
                 ("metal", g.material("metal", (0.95, 0.79, 0.45), metallic=1.0, roughness=0.25)),
                 ("plastic", g.material("plastic", (0.5, 0.06, 0.05), roughness=0.3)))
    for i, (name, material) in enumerate(materials):
        g.add(name, ball, material, translation=(1.2 * (i - 1), RADIUS, 0.0))
    g.perspective("camera", (0.0, 1.6, 4.2), (0.0, 0.45, 0.0), 32.0, 1.5)
    g.write(folder, "spheres")

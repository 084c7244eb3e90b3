"""A knot of chrome on a matt floor, for an environment map with a sun: caustics of the sun, by one mirror and by several."""
from scenes.gltf import Gltf
from scenes.mesh import sheet, torus_knot

RADIUS, TUBE = 0.4, 0.06


def make(folder):
    g = Gltf()
    g.add("floor", sheet((0.0, 0.0, 0.0), (2.5, 0.0, 0.0), (0.0, 0.0, -2.5)), g.material("floor", (0.5, 0.48, 0.45), lambert=True))
    chrome = g.material("chrome", (0.55, 0.556, 0.554), metallic=1.0, roughness=0.0)
    g.add("curl", torus_knot(2, 3, RADIUS, TUBE, 144, 12), chrome, translation=(0.0, RADIUS + TUBE, 0.0))
    g.perspective("camera", (0.5, 1.0, 2.2), (0.0, 0.3, 0.0), 30.0, 1.0)
    g.write(folder, "curl")

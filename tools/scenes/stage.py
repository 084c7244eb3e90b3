"""A photographer's table for one object about a metre across at the origin: a backdrop, two soft boxes, a 3:2 camera."""
from scenes.gltf import Gltf
from scenes.showcase import panel, sweep


def stage(backdrop=(0.4, 0.41, 0.43), key=9.0, fill=3.0, eye=(0.0, 1.35, 3.4), target=(0.0, 0.48, 0.0), yfov=24.0):
    g = Gltf()
    g.add("backdrop", sweep(7.0, 4.0, -2.2, 4.5, 1.2, 12), g.material("backdrop", backdrop, lambert=True))
    panel(g, "key", (-1.9, 2.6, 1.5), (0.0, 0.5, 0.0), 0.7, 0.7, (1.0, 0.95, 0.88), key)
    panel(g, "fill", (2.4, 1.7, 1.1), (0.0, 0.5, 0.0), 0.4, 1.0, (0.85, 0.92, 1.0), fill)
    g.perspective("camera", eye, target, yfov, 1.5)
    return g

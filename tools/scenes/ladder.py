"""One room in which every step of the ladder shows: soft shadows, mirror, glossy metal, glass with its caustic, coloured walls."""
from scenes.gltf import Gltf
from scenes.mesh import icosphere, quad


def make(folder):
    g = Gltf()
    white = g.material("white", (0.75, 0.75, 0.75), lambert=True)
    g.add("floor", quad((0.0, 0.0, 0.0), (1.2, 0.0, 0.0), (0.0, 0.0, -1.2)), white)
    g.add("ceiling", quad((0.0, 2.0, 0.0), (1.2, 0.0, 0.0), (0.0, 0.0, 1.2)), white)
    g.add("back", quad((0.0, 1.0, -1.2), (1.2, 0.0, 0.0), (0.0, 1.0, 0.0)), white)
    g.add("left", quad((-1.2, 1.0, 0.0), (0.0, 0.0, -1.2), (0.0, 1.0, 0.0)), g.material("red", (0.65, 0.1, 0.08), lambert=True))
    g.add("right", quad((1.2, 1.0, 0.0), (0.0, 0.0, 1.2), (0.0, 1.0, 0.0)), g.material("blue", (0.1, 0.25, 0.6), lambert=True))
    lamp = g.material("lamp", (0.0, 0.0, 0.0), lambert=True, emission=(24.0, 21.0, 17.0))
    g.add("lamp", quad((0.0, 1.99, 0.1), (0.3, 0.0, 0.0), (0.0, 0.0, 0.3)), lamp)
    ball = icosphere(1.0, 5)
    for name, look, size, at in (
            ("mirror", dict(base=(0.95, 0.93, 0.9), metallic=1.0, roughness=0.0), 0.38, (-0.6, -0.45)),
            ("glossy", dict(base=(0.95, 0.7, 0.35), metallic=1.0, roughness=0.35), 0.34, (0.3, -0.65)),
            ("glass", dict(base=(1.0, 1.0, 1.0), roughness=0.0, transmission=1.0, body=True), 0.3, (0.5, 0.3)),
            ("matt", dict(base=(0.7, 0.7, 0.65), roughness=0.6), 0.2, (-0.3, 0.45))):
        g.add(name, ball, g.material(name, **look), translation=(at[0], size, at[1]), scale=(size,) * 3)
    g.perspective("camera", (0.0, 1.05, 4.1), (0.0, 0.93, 0.0), 34.0, 1.0)
    g.write(folder, "ladder")

"""A room whose lamp, a square of 0.1 mm behind a screen, lights the camera's part by way of a mirror. No path from the camera meets the lamp.
Light sampling finds only the light that matt walls send round the screen, and a picture shows nothing else.

unfolded.gltf gives the same picture without the mirror: behind its frame is the mirrored room with the mirrored lamp. Light sampling finds that
lamp directly through the frame. The mirror reflects all light, so both pictures are the same."""
from scenes.gltf import Gltf
from scenes.mesh import Mesh, ring, sheet

X, Y, Z = 3.0, 2.5, 3.0                       # room: 0 <= x <= X and so on, the mirror's wall at x = 0
MIRROR = (0.3, 2.2, 1.0, 2.3)                 # from y, to y, from z, to z
SCREEN_X, SCREEN_Z = 1.0, 1.5                 # reaches from SCREEN_X to the wall at X, from floor to ceiling
LAMP, EDGE, RADIANCE = (2.5, 1.2, 0.9), 1e-4, 6e9


def wall_around_mirror():
    y0, y1, z0, z1 = MIRROR
    outer = [(0.0, 0.0, Z), (0.0, 0.0, 0.0), (0.0, Y, 0.0), (0.0, Y, Z)]
    inner = [(0.0, y0, z1), (0.0, y0, z0), (0.0, y1, z0), (0.0, y1, z1)]
    return ring(outer, inner)


def parts():
    """Returns (name, shape, colour) of everything but mirror and lamp."""
    screen = sheet(((SCREEN_X + X) / 2, Y / 2, SCREEN_Z), ((X - SCREEN_X) / 2, 0.0, 0.0), (0.0, Y / 2, 0.0))
    white = (0.7, 0.7, 0.7)
    return [("floor", sheet((X / 2, 0.0, Z / 2), (X / 2, 0.0, 0.0), (0.0, 0.0, -Z / 2)), (0.5, 0.4, 0.3)),
            ("ceiling", sheet((X / 2, Y, Z / 2), (X / 2, 0.0, 0.0), (0.0, 0.0, Z / 2)), white),
            ("back-wall", sheet((X / 2, Y / 2, 0.0), (X / 2, 0.0, 0.0), (0.0, Y / 2, 0.0)), white),
            ("front-wall", sheet((X / 2, Y / 2, Z), (-X / 2, 0.0, 0.0), (0.0, Y / 2, 0.0)), white),
            ("right-wall", sheet((X, Y / 2, Z / 2), (0.0, 0.0, Z / 2), (0.0, Y / 2, 0.0)), (0.6, 0.55, 0.4)),
            ("mirror-wall", wall_around_mirror(), white),
            ("screen", screen.append(screen.flipped().moved((0.0, 0.0, -0.01))), (0.4, 0.5, 0.6))]


def mirrored(shape):
    turn = lambda rows: [(-x, y, z) for x, y, z in rows]
    return Mesh(turn(shape.positions), [(a, c, b) for a, b, c in shape.triangles], turn(shape.normals))


def room(folder, stem, unfolded):
    g = Gltf()
    # faces -x: the mirror and the back of the screen
    lamp = sheet(LAMP, (0.0, 0.0, EDGE / 2), (0.0, EDGE / 2, 0.0))
    glow = g.material("lamp", (0.0, 0.0, 0.0), lambert=True, emission=(RADIANCE,) * 3)
    if not unfolded:
        y0, y1, z0, z1 = MIRROR
        mirror = sheet((0.0, (y0 + y1) / 2, (z0 + z1) / 2), (0.0, 0.0, (z0 - z1) / 2), (0.0, (y1 - y0) / 2, 0.0))
        g.add("mirror", mirror, g.material("mirror", (1.0, 1.0, 1.0), metallic=1.0, roughness=0.0))
    for name, shape, color in parts():
        material = g.material(name, color, lambert=True)
        g.add(name, shape, material)
        if unfolded:
            g.add(name + "-mirrored", mirrored(shape), material)
    g.add("lamp", lamp, glow)
    if unfolded:
        g.add("lamp-mirrored", mirrored(lamp), glow)
    g.perspective("camera", (0.5, 1.4, 2.7), (2.7, 0.7, 2.0), 60.0, 1.0)
    g.write(folder, stem)


def make(folder):
    room(folder, "pinlamp", False)
    room(folder, "unfolded", True)

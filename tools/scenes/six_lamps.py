"""A closed living room and the six lamps in it: large and small, strong and weak, three of them hidden from the camera."""
from scenes import furniture as f
from scenes.gltf import Gltf, axis_angle
from scenes.mesh import icosphere, lathe, sheet

X, Y, Z = 3.0, 2.7, 2.4  # half width, height, half depth of the room, metres


def room(g):
    matt = lambda name, color: g.material(name, color, lambert=True)
    white = matt("white", (0.72, 0.71, 0.68))
    for name, center, u, v, material in (
            ("floor", (0.0, 0.0, 0.0), (X, 0.0, 0.0), (0.0, 0.0, -Z), matt("boards", (0.42, 0.28, 0.17))),
            ("ceiling", (0.0, Y, 0.0), (X, 0.0, 0.0), (0.0, 0.0, Z), white),
            ("back-wall", (0.0, Y / 2, -Z), (X, 0.0, 0.0), (0.0, Y / 2, 0.0), matt("sand", (0.68, 0.6, 0.46))),
            ("front-wall", (0.0, Y / 2, Z), (-X, 0.0, 0.0), (0.0, Y / 2, 0.0), white),
            ("left-wall", (-X, Y / 2, 0.0), (0.0, 0.0, -Z), (0.0, Y / 2, 0.0), matt("teal", (0.18, 0.38, 0.37))),
            ("right-wall", (X, Y / 2, 0.0), (0.0, 0.0, Z), (0.0, Y / 2, 0.0), white)):
        g.add(name, sheet(center, u, v), material)


def lamps(g, steel):
    def lamp(name, shape, color, radiance, **placing):
        g.add(name, shape, g.material(name, (0.0, 0.0, 0.0), lambert=True, emission=[radiance * c for c in color]), **placing)

    shade = g.material("shade", (0.5, 0.2, 0.14), lambert=True, double_sided=True)
    warm, day, sky = (1.0, 0.78, 0.5), (1.0, 0.95, 0.88), (0.55, 0.75, 1.0)
    lamp("ceiling-panel", sheet((0.9, Y - 0.01, 0.6), (0.55, 0.0, 0.0), (0.0, 0.0, 0.3)), day, 16.0)
    g.add("shade-over-table", lathe([(0.34, 1.48), (0.16, 1.76)], 40), shade, translation=(-0.1, 0.0, -0.35))
    g.add("cord", f.board((-0.004, 1.76, -0.004), (0.004, Y, 0.004)), steel, translation=(-0.1, 0.0, -0.35))
    bulb = icosphere(0.1, 0)
    bulb.normals = []  # flat facets, so that area and picture agree
    lamp("bulb-over-table", bulb, warm, 40.0, translation=(-0.1, 1.6, -0.35))
    g.add("uplight", lathe([(0.0, 0.0), (0.16, 0.0), (0.16, 0.02), (0.015, 0.03), (0.015, 1.6), (0.19, 1.78)], 40),
          g.material("brass", (0.55, 0.45, 0.3), lambert=True, double_sided=True), translation=(-2.55, 0.0, -1.95))
    disc = lathe([(0.12, 0.0), (0.0, 0.0)], 12)
    disc.normals = []
    lamp("uplight-disc", disc, warm, 70.0, translation=(-2.55, 1.72, -1.95))
    lamp("cove", sheet((1.2, 2.08, -2.25), (0.85, 0.0, 0.0), (0.0, 0.0, -0.06)), warm, 14.0)
    g.add("screen-body", f.board((-0.5, -0.3, 0.0), (0.5, 0.3, 0.03)), g.material("black", (0.02, 0.02, 0.02), roughness=0.3), translation=(-1.35, 1.4, -Z))
    lamp("screen", sheet((-1.35, 1.4, -Z + 0.031), (0.46, 0.0, 0.0), (0.0, 0.26, 0.0)), sky, 2.0)
    g.add("reading-lamp", f.joined(lathe([(0.0, 0.0), (0.09, 0.0), (0.09, 0.02), (0.01, 0.025), (0.01, 0.36), (0.0, 0.36)], 24),
                                   f.board((-0.2, 0.34, -0.02), (0.01, 0.36, 0.02)), f.board((-0.27, 0.3, -0.06), (-0.15, 0.36, 0.06))),
          steel, translation=(2.55, 0.6, -0.9))
    lamp("reading-light", sheet((2.34, 0.899, -0.9), (0.04, 0.0, 0.0), (0.0, 0.0, 0.04)), day, 120.0)


def make(folder):
    g = Gltf()
    matt = lambda name, color, **more: g.material(name, color, lambert=True, **more)
    room(g)
    steel = g.material("steel", (0.6, 0.6, 0.62), metallic=1.0, roughness=0.3)
    walnut, varnish = matt("walnut", (0.25, 0.15, 0.09)), g.material("varnish", (0.3, 0.15, 0.07), roughness=0.3)
    top, legs = f.table(0.75, 0.45, 0.74)
    g.add("table-top", top, varnish, translation=(-0.1, 0.0, -0.35))
    g.add("table-legs", legs, walnut, translation=(-0.1, 0.0, -0.35))
    seat = f.chair()
    for i, (x, z, turn) in enumerate(((-0.55, 0.25, 190.0), (0.3, 0.3, 165.0), (-0.4, -1.0, 5.0), (1.0, -0.4, -80.0))):
        g.add(f"chair-{i}", seat, walnut, translation=(x, 0.0, z), rotation=axis_angle((0.0, 1.0, 0.0), turn))
    frame, soft = f.sofa()
    along_wall = {"translation": (-2.5, 0.0, 0.45), "rotation": axis_angle((0.0, 1.0, 0.0), 90.0)}
    g.add("sofa", frame, matt("linen", (0.5, 0.46, 0.4)), **along_wall)
    g.add("cushions", soft, matt("wool", (0.55, 0.3, 0.12)), **along_wall)
    g.add("shelf", f.shelf(1.9, 2.0, 0.3, 6), matt("pine", (0.6, 0.47, 0.3)), translation=(1.2, 0.0, -2.22))
    g.add("cornice", f.board((-0.95, 2.0, 0.13), (0.95, 2.2, 0.15)), matt("cornice", (0.6, 0.47, 0.3)), translation=(1.2, 0.0, -2.22))
    covers = ((0.45, 0.08, 0.07), (0.08, 0.16, 0.36), (0.12, 0.3, 0.12), (0.7, 0.64, 0.5))
    for i, (color, mesh) in enumerate(zip(covers, f.books(1.9, 2.0, 0.3, 6))):
        g.add(f"books-{i}", mesh, matt(f"cover-{i}", color), translation=(1.2, 0.0, -2.22))
    g.add("side-table", f.joined(lathe([(0.0, 0.0), (0.2, 0.0), (0.2, 0.02), (0.03, 0.05), (0.03, 0.57), (0.32, 0.58), (0.32, 0.6), (0.0, 0.6)], 40)),
          varnish, translation=(2.45, 0.0, -0.9))
    g.add("rug", lathe([(1.25, 0.0), (1.25, 0.012), (0.0, 0.012)], 64), matt("rug", (0.33, 0.1, 0.1)), translation=(-0.2, 0.0, -0.2))
    g.add("bowl", f.bowl(0.17, 0.09), g.material("glaze", (0.65, 0.68, 0.7), roughness=0.2, double_sided=True), translation=(-0.35, 0.741, -0.3))
    g.add("vase", f.vase(0.34), g.material("celadon", (0.3, 0.48, 0.38), roughness=0.25), translation=(0.3, 0.741, -0.45))
    g.add("ball", icosphere(0.07, 3), g.material("copper", (0.93, 0.62, 0.52), metallic=1.0, roughness=0.25), translation=(0.02, 0.811, -0.12))
    pot = lathe([(0.0, 0.0), (0.14, 0.0), (0.18, 0.3), (0.15, 0.3), (0.0, 0.27)], 32)
    g.add("pot", pot, g.material("pot", (0.5, 0.22, 0.12), roughness=0.5), translation=(-2.5, 0.0, 1.85))
    g.add("plant", f.foliage(), matt("leaves", (0.1, 0.28, 0.07), double_sided=True), translation=(-2.5, 0.28, 1.85))
    lamps(g, steel)
    g.perspective("camera", (2.6, 1.6, 2.1), (-0.75, 0.95, -0.85), 50.0, 1.5)
    g.write(folder, "six-lamps")

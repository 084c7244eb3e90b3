"""A dispersive prism's caustic: light of a bright slit goes through a prism of strongly dispersive glass onto a screen, where its
colours lie apart. It is found only by paths from the screen that happen to meet the slit through the prism."""
import math

from scenes.gltf import Gltf
from scenes.mesh import Mesh, box, polygon, quad
from scenes.showcase import panel

APEX, INDEX, DISPERSION = math.radians(60), 1.6, 4.0


def prism(side, length):
    """Its edges along z, a corner up; outwards."""
    h = side * math.cos(APEX / 2)
    a, b, c = (-side / 2, 0.0), (side / 2, 0.0), (0.0, h)
    out = Mesh()
    for p, q in ((a, b), (b, c), (c, a)):
        out.append(polygon((*q, -length), (*p, -length), (*p, length), (*q, length)))
    out.append(polygon((*a, length), (*b, length), (*c, length)))
    out.append(polygon((*b, -length), (*a, -length), (*c, -length)))
    out.uvs = []
    return out


def make(folder):
    g = Gltf()
    rise = math.asin(INDEX * math.sin(APEX / 2)) - APEX / 2  # of light that crosses level, over the horizon
    middle = (0.0, 0.85)                                    # of the way through, x and y
    glass = g.material("flint", (1.0, 1.0, 1.0), roughness=0.0, transmission=1.0, ior=INDEX, body=True,
                       extensions={"KHR_materials_dispersion": {"dispersion": DISPERSION}})
    g.add("prism", prism(0.6, 0.45), glass, translation=(0.0, middle[1] - 0.22, 0.0))
    block = box((-0.2, 0.0, -0.3), (0.2, middle[1] - 0.24, 0.3))
    block.uvs = []
    g.add("block", block, g.material("block", (0.12, 0.12, 0.13), roughness=0.6))
    sheet = quad((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 0.0, -2.0))
    sheet.uvs = []
    paper = g.material("paper", (0.75, 0.75, 0.73), lambert=True)
    g.add("table", sheet, paper)
    wall = quad((0.0, 1.5, -2.0), (4.0, 0.0, 0.0), (0.0, 1.5, 0.0))
    wall.uvs = []
    g.add("wall", wall, g.material("wall", (0.25, 0.25, 0.27), lambert=True))
    way = 2.2
    slit = (middle[0] - 0.15 - way * math.cos(rise), middle[1] - way * math.sin(rise), 0.0)
    panel(g, "slit", slit, (middle[0] - 0.15, middle[1], 0.0), 0.08, 0.4, (1.0, 1.0, 1.0), 120.0)
    panel(g, "fill", (1.0, 3.2, 2.5), (0.0, 0.4, 0.0), 0.8, 0.8, (1.0, 0.97, 0.92), 3.0)
    g.perspective("camera", (1.5, 2.2, 3.9), (1.15, 0.3, 0.0), 33.0, 1.5)
    g.write(folder, "prism")

"""A prism of strongly dispersive glass, with tube lamps around it: seen through the glass, each tube appears three times, once in each colour."""
import math

from scenes.gltf import Gltf, axis_angle
from scenes.mesh import Mesh, polygon, sheet
from scenes.showcase import panel

SIDE, HEIGHT = 0.8, 0.75
TUBES, ROUND = 16, 2.6  # number of tubes; radius of their circle


def prism():
    """An upright prism: three faces, foot and top, facing outwards."""
    corners = [(SIDE / math.sqrt(3) * math.sin(2 * math.pi * k / 3), SIDE / math.sqrt(3) * math.cos(2 * math.pi * k / 3)) for k in range(3)]
    out = Mesh()
    for k in range(3):
        (ax, az), (bx, bz) = corners[k], corners[(k + 1) % 3]
        out.append(polygon((ax, 0.0, az), (bx, 0.0, bz), (bx, HEIGHT, bz), (ax, HEIGHT, az)))
    out.append(polygon(*((x, HEIGHT, z) for x, z in corners)))
    out.append(polygon(*((x, 0.0, z) for x, z in reversed(corners))))
    out.uvs = []
    return out


def make(folder):
    g = Gltf()
    g.add("table", sheet((0.0, 0.0, 0.0), (3.5, 0.0, 0.0), (0.0, 0.0, -3.5)), g.material("table", (0.3, 0.3, 0.31), lambert=True))
    glass = g.material("flint", (1.0, 1.0, 1.0), roughness=0.0, transmission=1.0, ior=1.6, body=True,
                       extensions={"KHR_materials_dispersion": {"dispersion": 2.5}})
    g.add("prism", prism(), glass, translation=(0.0, 0.002, 0.0), rotation=axis_angle((0, 1, 0), 12))
    for k in range(TUBES):
        a = 2 * math.pi * (k + 0.5) / TUBES
        if math.cos(a) < 0.75:  # leaves out tubes near the camera
            at = (ROUND * math.sin(a), 0.62, ROUND * math.cos(a))
            panel(g, f"tube-{k}", at, (0.0, 0.62, 0.0), 0.6, 0.05, (1.0, 1.0, 1.0), 6.0)
    g.perspective("camera", (0.0, 1.0, 4.0), (0.0, 0.36, 0.0), 20.0, 1.5)
    g.write(folder, "prism")

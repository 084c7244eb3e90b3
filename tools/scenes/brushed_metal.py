"""A steel lid, brushed in circles: the highlight becomes a pair of fans."""
import math

from scenes.gltf import normalize
from scenes.mesh import Mesh, lathe
from scenes.stage import stage

SEGMENTS = 64


def disc(inner, outer, height, dome):
    """A ring, a little domed, with tangents along the circles."""
    out = Mesh()
    for i in range(SEGMENTS + 1):
        a = 2 * math.pi * i / SEGMENTS
        c, s = math.cos(a), -math.sin(a)
        for r in (inner, outer):
            out.positions.append((r * c, height - dome * r * r, r * s))
            out.normals.append(normalize((2 * dome * r * c, 1.0, 2 * dome * r * s)))
            out.uvs.append((i / SEGMENTS, r))
            out.tangents.append((-math.sin(a), 0.0, -math.cos(a), 1.0))
    for i in range(SEGMENTS):
        a = 2 * i
        out.triangles += [(a, a + 1, a + 3), (a, a + 3, a + 2)]
    return out


def make(folder):
    g = stage(eye=(0.0, 1.9, 2.9), target=(0.0, 0.2, 0.0), yfov=23.0)
    brushed = g.material("brushed", (0.68, 0.66, 0.63), metallic=1.0, roughness=0.25, extensions={
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.85}})
    polished = g.material("polished", (0.68, 0.66, 0.63), metallic=1.0, roughness=0.12)
    lid = Mesh()
    for k in range(8):
        lid.append(disc(0.12 + 0.06 * k, 0.18 + 0.06 * k, 0.16, 0.08))
    g.add("lid", lid, brushed)
    g.add("rim", lathe([(0.6, 0.0), (0.62, 0.06), (0.6, 0.1312)], 64), polished)
    g.add("knob", lathe([(0.05, 0.155), (0.05, 0.22), (0.12, 0.26), (0.12, 0.3), (0.1, 0.32), (0.0, 0.325)], 48), polished)
    g.add("collar", lathe([(0.12, 0.1588), (0.05, 0.16)], 48), polished)
    g.write(folder, "brushed-metal")

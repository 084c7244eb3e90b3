#!/usr/bin/env python3
"""usage: balls.py OUT    Writes rows of three balls that differ in one parameter, which rises from left to right: OUT/NAME.gltf, for bench_cycles.py."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from scenes.gltf import Gltf
from scenes.mesh import uv_sphere

GOLD, WHITE = (1.0, 0.77, 0.34), (1.0, 1.0, 1.0)
ROUGH = (0.25, 0.5, 1.0)


def body(roughness, base=WHITE, **volume):
    return dict(base=base, roughness=roughness, extensions={
        "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1, **volume}})


ROWS = {
    "gold": [dict(base=GOLD, metallic=1.0, roughness=r) for r in ROUGH],
    "plastic": [dict(base=(0.5, 0.1, 0.1), roughness=r) for r in ROUGH],
    "coats": [dict(base=(0.1, 0.2, 0.5), roughness=0.6, extensions={
        "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": r}}) for r in (0.0, 0.2, 0.5)],
    "sheen": [dict(base=(0.1, 0.1, 0.1), roughness=1.0, extensions={
        "KHR_materials_sheen": {"sheenColorFactor": WHITE, "sheenRoughnessFactor": r}}) for r in ROUGH],
    "anisotropy": [dict(base=GOLD, metallic=1.0, roughness=0.4, extensions={"KHR_materials_anisotropy": {"anisotropyStrength": s}})
                   for s in (0.0, 0.4, 0.8)],
    "thin-walls": [dict(base=WHITE, roughness=r, extensions={"KHR_materials_transmission": {"transmissionFactor": 1}}) for r in (0.0, 0.25, 0.5)],
    "glass-smooth": [body(0.0)] * 3,
    "glass-rough": [body(r) for r in (0.1, 0.3, 0.5)],
    "glass-absorbing": [body(0.0, attenuationDistance=1, attenuationColor=[c] * 3) for c in (0.9, 0.7, 0.5)],
    "glass-tinted": [body(0.0, base=(c, c, c)) for c in (0.9, 0.7, 0.5)],
}


def main():
    for name, row in ROWS.items():
        g = Gltf()
        for i, material in enumerate(row):
            g.add(f"ball {i}", uv_sphere(0.48, 96, 48), g.material(f"{name} {i}", **material), translation=(i - 1.0, 0.0, 0.0))
        g.perspective("camera", (0.0, 0.0, 6.0), (0.0, 0.0, 0.0), 29.0, 1.0)
        g.write(sys.argv[1], name)


if __name__ == "__main__":
    main() if len(sys.argv) == 2 else sys.exit(__doc__)

#!/usr/bin/env python3
"""usage: heights.py TRIANGLES OUT    Writes a rough matt landscape of so many triangles, OUT/heights.gltf, and an environment map of
ones for its sky, OUT/white.hdr: a large mesh for race.py."""
import json
import os
import sys

import numpy as np


def heights(n):
    """Returns (n + 1, n + 1) heights: nine octaves of value noise."""
    random = np.random.default_rng(1)
    y, x = np.mgrid[0:n + 1, 0:n + 1] / n
    total = np.zeros((n + 1, n + 1))
    for octave in range(9):
        cells = 2**octave
        values = 0.3 * cells**-0.9 * random.standard_normal((cells + 2, cells + 2))
        i, j = np.minimum((x * cells).astype(int), cells), np.minimum((y * cells).astype(int), cells)
        u, v = (s * s * (3 - 2 * s) for s in (x * cells - i, y * cells - j))
        total += (values[j, i] * (1 - u) + values[j, i + 1] * u) * (1 - v) + (values[j + 1, i] * (1 - u) + values[j + 1, i + 1] * u) * v
    return x, total, y


def main(triangles, out):
    n = round((triangles / 2)**0.5)
    x, h, y = heights(n)
    points = np.stack([2 * x - 1, h, 2 * y - 1], -1).reshape(-1, 3).astype("<f4")
    k = np.arange((n + 1)**2).reshape(n + 1, n + 1)
    a, b, c, d = (corner.ravel() for corner in (k[:-1, :-1], k[:-1, 1:], k[1:, :-1], k[1:, 1:]))
    corners = np.stack([a, c, b, b, c, d], 1).astype("<u4")
    matt = {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}, "doubleSided": True,
            "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}
    gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}], "extensionsUsed": ["KHR_materials_specular"],
            "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0.75, 0.8], "rotation": [-0.343, 0, 0, 0.939]}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.01}}], "materials": [matt],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
            "buffers": [{"uri": "heights.bin", "byteLength": points.nbytes + corners.nbytes}],
            "bufferViews": [{"buffer": 0, "byteLength": points.nbytes}, {"buffer": 0, "byteOffset": points.nbytes, "byteLength": corners.nbytes}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3",
                           "min": points.min(0).tolist(), "max": points.max(0).tolist()},
                          {"bufferView": 1, "componentType": 5125, "count": corners.size, "type": "SCALAR"}]}
    os.makedirs(out, exist_ok=True)
    with open(os.path.join(out, "heights.bin"), "wb") as file:
        file.write(points.tobytes() + corners.tobytes())
    with open(os.path.join(out, "heights.gltf"), "w") as file:
        json.dump(gltf, file)
    with open(os.path.join(out, "white.hdr"), "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n" + bytes([128, 128, 128, 129]) * (32 * 64))


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2]) if len(sys.argv) == 3 else sys.exit(__doc__)

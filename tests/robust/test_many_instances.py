# tier: full
"""A mesh of a hundred thousand triangles in ten thousand places: 10^9 triangles in less than 1 GB."""
import json
import math
import os
import struct
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cli"))
from support import Case, eclat  # noqa: E402

ROWS, COLUMNS, SIDE = 160, 316, 100


def ball():
    """A smooth, bumpy ball of 2 COLUMNS (ROWS - 1) triangles."""
    points, normals, corners = [], [], []
    for i in range(ROWS + 1):
        for k in range(COLUMNS + 1):
            theta, phi = math.pi * i / ROWS, 2 * math.pi * k / COLUMNS
            direction = (math.sin(theta) * math.cos(phi), math.cos(theta), math.sin(theta) * math.sin(phi))
            radius = 0.3 + 0.05 * math.sin(5 * phi) * math.sin(theta) ** 2
            points += [radius * x for x in direction]
            normals += direction
    for i in range(ROWS):
        for k in range(COLUMNS):
            a, b = i * (COLUMNS + 1) + k, (i + 1) * (COLUMNS + 1) + k
            corners += [a, b + 1, b] if i == 0 else [] if i == ROWS - 1 else [a, a + 1, b, a + 1, b + 1, b]
            corners += [a, a + 1, b] if i == ROWS - 1 else []
    return points, normals, corners


class ManyInstances(Case):
    def write(self):
        points, normals, corners = ball()
        parts = [struct.pack(f"<{len(points)}f", *points), struct.pack(f"<{len(normals)}f", *normals), struct.pack(f"<{len(corners)}I", *corners)]
        views, offset = [], 0
        for part in parts:
            views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(part)})
            offset += len(part)
        nodes = []
        for n in range(SIDE * SIDE):
            angle, x, z = 0.37 * n, n % SIDE - SIDE / 2, n // SIDE - SIDE / 2
            nodes.append({"mesh": 0, "translation": [x, 0.2 * math.sin(n), z], "rotation": [0, math.sin(angle), 0, math.cos(angle)],
                          "scale": [-1 if n % 3 == 0 else 1, 1, 1 + 0.2 * math.sin(3 * n)]})
        vertices = len(points) // 3
        document = {"asset": {"version": "2.0"}, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
                    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
                    "buffers": [{"uri": "many.bin", "byteLength": offset}], "bufferViews": views,
                    "accessors": [{"bufferView": 0, "componentType": 5126, "count": vertices, "type": "VEC3", "min": [-1, -1, -1], "max": [1, 1, 1]},
                                  {"bufferView": 1, "componentType": 5126, "count": vertices, "type": "VEC3"},
                                  {"bufferView": 2, "componentType": 5125, "count": len(corners), "type": "SCALAR"}]}
        with open(self.path("many.bin"), "wb") as file:
            file.write(b"".join(parts))
        with open(self.path("many.gltf"), "w", encoding="utf-8") as file:
            json.dump(document, file)
        return len(corners) // 3

    def test_a_billion_triangles(self):
        triangles = self.write()
        self.assertGreater(triangles, 100000)
        run = self.assert_ok(eclat("render", self.path("many.gltf"), "--json", "--quiet", "--size", "128x128", "--spp", "2", "--env", "1,1,1",
                                   "-o", self.path("many.png"), cwd=self.folder))
        report = json.loads(run.stdout)
        self.assertEqual((report["instances"], report["triangles"], report["stored_triangles"]),
                         (SIDE * SIDE, SIDE * SIDE * triangles, triangles))
        # With PoCL, the device's memory is the host's and counts twice here.
        self.assertLess(report["peak_memory_bytes"] + report["device_bytes"], 10 ** 9)
        self.assertEqual(report["invalid_samples"], 0)

    def test_written_out_it_is_refused_in_one_line(self):
        self.write()
        run = eclat("render", self.path("many.gltf"), "--accel", "bvh8", "--quiet", "--size", "8x8", "--spp", "1", cwd=self.folder)
        line = self.assert_one_error(run, 1)
        self.assertIn("10000 expanded instances", line)
        self.assertIn("--accel", line)


if __name__ == "__main__":
    unittest.main()

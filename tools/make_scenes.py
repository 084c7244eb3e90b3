#!/usr/bin/env python3
"""Makes the scenes under scenes/ from formulas and published data. Needs nothing but Python 3.

usage: make_scenes.py [--out FOLDER] [--check] [NAME ...]

NAME is a folder of scenes/; without one, all are made. --check writes nothing there. It makes the scenes in a temporary folder,
compares them with those in place, and checks the files against those rules of glTF 2.0 that a hand-written file can break.
"""
import argparse
import json
import os
import struct
import sys
import tempfile
import zlib

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from scenes import (brushed_metal, car_paint, cornell_box, curl, drink, furnace, glass, keyhole, ladder, lamps, pinlamp, prism,  # noqa: E402
                    ring, showcase, six_lamps, soap_film, spheres, stadium, terminator, toy, vase, veach_plates, velvet, wax)

SCENES = {"brushed-metal": brushed_metal, "car-paint": car_paint, "cornell-box": cornell_box, "curl": curl, "drink": drink,
          "furnace": furnace, "glass": glass, "keyhole": keyhole, "ladder": ladder, "lamps": lamps, "pinlamp": pinlamp, "prism": prism,
          "ring": ring, "showcase": showcase, "six-lamps": six_lamps, "soap-film": soap_film, "spheres": spheres, "stadium": stadium,
          "terminator": terminator, "toy": toy, "vase": vase, "veach-plates": veach_plates, "velvet": velvet, "wax": wax}
WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
CODE = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}


def read(path):
    with open(path, "rb") as f:
        return f.read()


def validate(path):
    """Checks the rules of glTF 2.0 on buffers, accessors, references and names. Returns the number of triangles."""
    folder = os.path.dirname(path)
    doc = json.loads(read(path))
    assert doc["asset"]["version"] == "2.0"
    data = [read(os.path.join(folder, b["uri"])) for b in doc["buffers"]]
    for b, bytes_ in zip(doc["buffers"], data):
        assert b["byteLength"] == len(bytes_), "buffer length"
    for v in doc["bufferViews"]:
        assert v["byteOffset"] % 4 == 0 and v["byteOffset"] + v["byteLength"] <= len(data[v["buffer"]]), "buffer view"

    def rows(index):
        a = doc["accessors"][index]
        v = doc["bufferViews"][a["bufferView"]]
        width, code = WIDTH[a["type"]], CODE[a["componentType"]]
        assert a["count"] * width * struct.calcsize(code) <= v["byteLength"], "accessor beyond its view"
        flat = struct.unpack_from(f"<{a['count'] * width}{code}", data[v["buffer"]], v["byteOffset"] + a.get("byteOffset", 0))
        return [flat[i:i + width] for i in range(0, len(flat), width)]

    used = set()

    def walk(x):
        if isinstance(x, dict):
            used.update(x.get("extensions", {}))
            for y in x.values():
                walk(y)
        elif isinstance(x, list):
            for y in x:
                walk(y)

    walk(doc)
    assert used == set(doc.get("extensionsUsed", [])), f"extensionsUsed: {used}"
    triangles = 0
    for mesh in doc["meshes"]:
        for p in mesh["primitives"]:
            position = doc["accessors"][p["attributes"]["POSITION"]]
            points = rows(p["attributes"]["POSITION"])
            for k in range(3):
                column = [q[k] for q in points]
                assert position["min"][k] == min(column) and position["max"][k] == max(column), "min and max"
            for name, a in p["attributes"].items():
                assert doc["accessors"][a]["count"] == len(points), name
                assert doc["bufferViews"][doc["accessors"][a]["bufferView"]]["target"] == 34962
                if name in ("NORMAL", "TANGENT"):
                    for n in rows(a):
                        assert abs(sum(x * x for x in n[:3]) - 1) < 1e-5, name
            indices = [i for (i,) in rows(p["indices"])]
            assert doc["bufferViews"][doc["accessors"][p["indices"]]["bufferView"]]["target"] == 34963
            assert max(indices) < len(points) and len(indices) % 3 == 0
            triangles += len(indices) // 3
            material = doc["materials"][p["material"]]
            stack = [material]
            while stack:
                x = stack.pop()
                for key, y in x.items():
                    if key.endswith("Texture"):
                        assert f"TEXCOORD_{y.get('texCoord', 0)}" in p["attributes"], f"{mesh['name']}: {key}"
                    if isinstance(y, dict):
                        stack.append(y)
    for image in doc.get("images", []):
        decode_png(read(os.path.join(folder, image["uri"])))
    for kind in ("nodes", "meshes", "materials", "cameras", "images"):
        names = [x["name"] for x in doc.get(kind, [])]
        assert len(set(names)) == len(names), f"{kind}: names are not unique"
    for node in doc["nodes"]:
        if "rotation" in node:
            assert abs(sum(x * x for x in node["rotation"]) - 1) < 1e-5
    return triangles


def decode_png(data):
    """Returns the header and the unfiltered bytes, which are the same for two versions of zlib even if their compression differs."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, header, packed = 8, None, b""
    while at < len(data):
        (length,), tag = struct.unpack_from(">I", data, at), data[at + 4:at + 8]
        body = data[at + 8:at + 8 + length]
        assert struct.unpack_from(">I", data, at + 8 + length)[0] == zlib.crc32(tag + body)
        header, packed = (body, packed) if tag == b"IHDR" else (header, packed + body if tag == b"IDAT" else packed)
        at += 12 + length
    return header, zlib.decompress(packed)


def same(made, kept):
    return decode_png(made) == decode_png(kept) if made[:4] == b"\x89PNG" else made == kept


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="folder of scenes/ (default: all)")
    parser.add_argument("--out", default=os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scenes"),
                        help="folder to write to (default: scenes/)")
    parser.add_argument("--check", action="store_true", help="compare with the files in place and validate them")
    options = parser.parse_args()
    for name in options.names:
        if name not in SCENES:
            parser.error(f"no scene is called {name}; there are {', '.join(sorted(SCENES))}")
    failed = False
    for name in options.names or sorted(SCENES):
        with tempfile.TemporaryDirectory() as temporary:
            target = os.path.join(temporary if options.check else options.out, name)
            SCENES[name].make(target)
            for file in sorted(os.listdir(target)):
                if options.check:
                    kept = os.path.join(options.out, name, file)
                    if not os.path.exists(kept) or not same(read(os.path.join(target, file)), read(kept)):
                        print(f"{name}/{file} differs from what tools/make_scenes.py makes", file=sys.stderr)
                        failed = True
                if file.endswith(".gltf"):
                    print(f"{name}/{file}: {validate(os.path.join(target, file))} triangles")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

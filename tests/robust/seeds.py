#!/usr/bin/env python3
"""Copies small .gltf and .glb files of the folders as seeds for fuzz_gltf, one file each, with buffers and images inside, so that mutants
still find them.

usage: seeds.py OUT FOLDER..."""
import base64
import json
import pathlib
import sys
import urllib.parse

MOST = 24000  # bytes: mutants of larger ones are slow


def embed(path):
    if path.suffix != ".gltf":
        return path.read_bytes()
    try:
        document = json.loads(path.read_text())
        for holder in document.get("buffers", []) + document.get("images", []):
            uri = holder.get("uri", "")
            if uri and not uri.startswith("data:"):
                data = (path.parent / urllib.parse.unquote(uri)).read_bytes()
                holder["uri"] = "data:;base64," + base64.b64encode(data).decode()
        return json.dumps(document, separators=(",", ":")).encode()
    except (ValueError, OSError, AttributeError, TypeError):
        return path.read_bytes()  # broken on purpose: copied unchanged


def main():
    out = pathlib.Path(sys.argv[1])
    out.mkdir(parents=True, exist_ok=True)
    count = 0
    for folder in sys.argv[2:]:
        for path in sorted(p for p in pathlib.Path(folder).rglob("*") if p.suffix in (".gltf", ".glb")):
            data = embed(path)
            if len(data) <= MOST:
                (out / f"{count:04}{path.suffix}").write_bytes(data)
                count += 1
    print(count, "seeds")


main()

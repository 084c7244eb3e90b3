"""Reads the part of glTF that races need: JSON and external buffers as numpy arrays, nodes with world matrices, and a copy with
only diffuse materials. untranslated() lists what the two sides of a race would render differently."""
import json
import os
import shutil
import urllib.parse

import numpy as np

COMPONENTS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
LAMP = "KHR_materials_emissive_strength"
SPECULAR = "KHR_materials_specular"


class Gltf:
    """A .gltf whose buffers and images are files beside it."""

    def __init__(self, path):
        self.path, self.folder = path, os.path.dirname(os.path.abspath(path))
        with open(path, encoding="utf-8") as file:
            self.json = json.load(file)
        self.buffers = [np.fromfile(self.file(b["uri"]), np.uint8) for b in self.json["buffers"]]

    def file(self, uri):
        return os.path.join(self.folder, urllib.parse.unquote(uri))

    def image(self, use):
        """Returns the path of the image that a material's texture uses."""
        return self.file(self.json["images"][self.json["textures"][use["index"]]["source"]]["uri"])

    def accessor(self, index):
        """Returns rows of numbers, as stored: (count, width)."""
        a = self.json["accessors"][index]
        view = self.json["bufferViews"][a["bufferView"]]
        kind, width = np.dtype(COMPONENTS[a["componentType"]]), WIDTHS[a["type"]]
        start, row = view.get("byteOffset", 0) + a.get("byteOffset", 0), width * kind.itemsize
        rows = np.lib.stride_tricks.as_strided(self.buffers[view["buffer"]][start:], (a["count"], row), (view.get("byteStride", row), 1))
        return rows.copy().view(kind)

    def nodes(self):
        """Yields (node, world matrix), depth first in the file's order."""
        stack = [(i, np.eye(4)) for i in reversed(self.json["scenes"][self.json.get("scene", 0)]["nodes"])]
        while stack:
            index, parent = stack.pop()
            node = self.json["nodes"][index]
            world = parent @ matrix(node)
            yield node, world
            stack += [(child, world) for child in reversed(node.get("children", []))]

    def material(self, primitive):
        return self.json["materials"][primitive["material"]] if "material" in primitive else {}


def matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    m = np.eye(4)
    m[:3, :3] = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                          [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                          [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]) * np.array(node.get("scale", [1, 1, 1]))
    m[:3, 3] = node.get("translation", [0, 0, 0])
    return m


def untranslated(gltf):
    """Returns names of features that the document uses and the translation leaves out."""
    translated = {LAMP, SPECULAR, "KHR_materials_ior", "KHR_materials_transmission", "KHR_materials_volume"}
    left = set(gltf.json.get("extensionsUsed", [])) - translated
    for m in gltf.json.get("materials", []):
        left |= {k for k in ("normalTexture", "emissiveTexture", "occlusionTexture") if k in m}
        left |= {"metallicRoughnessTexture"} & set(m.get("pbrMetallicRoughness", {}))
        left |= {"alphaMode"} if m.get("alphaMode", "OPAQUE") != "OPAQUE" else set()
    left |= {k for k in ("skins", "animations") if gltf.json.get(k)}
    return sorted(left)


def write_diffuse(gltf, folder):
    """Writes the document with only diffuse materials, and the files that it names, into `folder`. Returns its path."""
    document = json.loads(json.dumps(gltf.json))
    for m in document.setdefault("materials", []):
        surface = m.setdefault("pbrMetallicRoughness", {})
        surface.pop("metallicRoughnessTexture", None)
        surface.update(metallicFactor=0, roughnessFactor=1)
        m.pop("normalTexture", None)
        m["extensions"] = {k: v for k, v in m.get("extensions", {}).items() if k == LAMP} | {SPECULAR: {"specularFactor": 0}}
    used = set(document.get("extensionsUsed", []))
    document["extensionsUsed"] = sorted({x for x in used if not x.startswith("KHR_materials") or x == LAMP} | {SPECULAR})
    document.pop("extensionsRequired", None)
    for item in document["buffers"] + document.get("images", []):
        target = os.path.join(folder, urllib.parse.unquote(item["uri"]))
        os.makedirs(os.path.dirname(target), exist_ok=True)
        shutil.copyfile(gltf.file(item["uri"]), target)
    path = os.path.join(folder, "diffuse.gltf")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)
    return path

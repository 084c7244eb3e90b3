"""Scenes for tests of hard inputs, on top of cli/support.py: any vertices and vertex data, written as one .gltf or .glb. Standard library
only."""
import json
import math
import os
import struct
import zlib

from support import QUICK, Case, data_uri, eclat, read_exr, write_gltf

QUAD = [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, -1, 0, 1, 1, 0, -1, 1, 0]  # two triangles that face +z
UV = ("TEXCOORD_0", 2, [0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1])
NORMAL = ("NORMAL", 3, [0, 0, 1] * 6)
LAMP = {"emissiveFactor": [1, 1, 1]}
WHITE = {"pbrMetallicRoughness": {"metallicFactor": 0}}


class Scene:
    """A scene: add() meshes, then write(). Its camera at (0, 0, 3) looks along -z."""

    def __init__(self, *materials):
        self.buffer = bytearray()
        self.json = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "meshes": [], "bufferViews": [], "accessors": [],
            "nodes": [{"camera": 0, "translation": [0, 0, 3]}], "materials": [dict(m) for m in materials],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}]}

    @property
    def camera(self):
        return self.json["nodes"][0]

    def extend(self, name, extension=None):
        """Adds a name to extensionsUsed; with `extension`, also the extension's object in the document."""
        self.json.setdefault("extensionsUsed", []).append(name)
        if extension is not None:
            self.json.setdefault("extensions", {})[name] = extension
        return self

    def accessor(self, values, kind, width, code):
        data = struct.pack(f"<{len(values)}{code}", *values)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data)})
        self.buffer += data
        self.json["accessors"].append({
            "bufferView": len(self.json["bufferViews"]) - 1, "componentType": kind, "count": len(values) // width,
            "type": ["SCALAR", "VEC2", "VEC3", "VEC4"][width - 1]})
        return len(self.json["accessors"]) - 1

    def add(self, positions, material=0, indices=None, streams=(), **node):
        primitive = {"attributes": {"POSITION": self.accessor(positions, 5126, 3, "f")}, "material": material}
        for name, width, values in streams:
            primitive["attributes"][name] = self.accessor(values, 5126, width, "f")
        if indices:
            primitive["indices"] = self.accessor(indices, 5125, 1, "I")
        self.json["meshes"].append({"primitives": [primitive]})
        return self.node(mesh=len(self.json["meshes"]) - 1, **node)

    def node(self, **node):
        self.json["nodes"].append(node)
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)
        return self

    def nest(self, node, scale, depth):
        """Puts `depth` nodes that scale above one node."""
        roots, nodes = self.json["scenes"][0]["nodes"], self.json["nodes"]
        for _ in range(depth):
            nodes.append({"scale": [scale] * 3, "children": [node]})
            roots[roots.index(node)] = node = len(nodes) - 1
        return self

    def texture(self, png):
        self.json["images"] = [{"uri": "data:image/png;base64," + data_uri(png).split(",")[1]}]
        self.json["textures"] = [{"source": 0}]
        return self

    def write(self, path):
        document = dict(self.json, buffers=[{"byteLength": len(self.buffer), "uri": data_uri(bytes(self.buffer))}])
        return write_gltf(path, document)


def row_png(*texels):
    """A PNG of one row of texels."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(texels), 1, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(b"\0" + b"".join(map(bytes, texels)))) + chunk(b"IEND", b""))


def one_pixel_png(rgb):
    return row_png(rgb)


def write_exr(path, width, height, rgb):
    """Writes scan lines of 32-bit floats, uncompressed. rgb has 3 values a pixel, which may be NaN or infinite."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    channels = b"".join(name + struct.pack("<xiB3xii", 2, 0, 1, 1) for name in [b"B", b"G", b"R"]) + b"\0"
    head = (b"\x76\x2f\x31\x01" + struct.pack("<i", 2) + attribute("channels", "chlist", channels) +
            attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", box) +
            attribute("displayWindow", "box2i", box) + attribute("lineOrder", "lineOrder", b"\0") +
            attribute("pixelAspectRatio", "float", struct.pack("<f", 1)) +
            attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)) +
            attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0")
    size = 12 * width
    table = struct.pack(f"<{height}Q", *(len(head) + 8 * height + y * (8 + size) for y in range(height)))
    with open(path, "wb") as file:
        file.write(head + table)
        for y in range(height):
            row = rgb[3 * width * y:3 * width * (y + 1)]
            file.write(struct.pack("<ii", y, size) + b"".join(struct.pack(f"<{width}f", *row[c::3]) for c in [2, 1, 0]))
    return path


class Picture:
    def __init__(self, stats, channels, messages):
        self.stats, self.channels, self.messages = stats, channels, messages
        self.mean = stats["mean_luminance"]
        # standard error of the mean: pixels are independent
        self.se = self.mean * (stats["error"] or 0) / math.sqrt(stats["width"] * stats["height"])


class HardCase(Case):
    """Renders all scenes with one set of kernels (--effects all), compiled once. They are narrow: Intel's compiler needs 10 s of processor
    time for those, 82 s for four lanes. The bits are the same."""

    def render(self, scene, *options, invalid=0, size="16x16", spp="16", kernels=QUICK):
        path = scene if isinstance(scene, str) else scene.write(self.path("scene.gltf"))
        picture = self.path("picture.exr")
        run = self.assert_ok(eclat("render", path, *kernels, "--size", size, "--spp", spp, "--channels", "all", "--json", "-o", picture, *options, timeout=900))
        stats = json.loads(run.stdout)
        channels = read_exr(picture)[1]
        os.remove(picture)
        if invalid is not None:
            self.assertEqual(stats["invalid_samples"], invalid, run.stderr)
        for name, values in channels.items():
            self.assertTrue(all(map(math.isfinite, values)), f"{name} has NaN or infinity\n{run.stderr}")
        return Picture(stats, channels, run.stderr)

    def assert_same(self, a, b):
        for name in "RGB":
            self.assertEqual(a.channels[name], b.channels[name])

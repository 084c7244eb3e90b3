"""Runs eclat, makes small scenes, reads EXR headers and pixels. Standard library only."""
import base64
import json
import os
import shutil
import struct
import subprocess
import tempfile
import unittest
import zlib

ECLAT = os.environ.get("ECLAT", "eclat")
SOURCE = os.environ.get("ECLAT_SOURCE_DIR", os.path.join(os.path.dirname(__file__), "..", ".."))
SHARED = os.environ.get("ECLAT_SHARED", os.path.join(SOURCE, "..", "shared"))
CORNELL = os.path.join(SOURCE, "scenes", "cornell-box", "cornell-box.gltf")
RING = os.path.join(SOURCE, "scenes", "ring", "ring.gltf")

# Tests of one build share a cache of kernels, and leave the user's own cache alone.
LINE = 12 if os.path.exists("/usr/include/stb/stb_easy_font.h") else 0  # pixels of a name on a contact sheet
ENVIRONMENT = dict(os.environ)
ENVIRONMENT["XDG_CACHE_HOME"] = os.path.join(os.path.dirname(os.path.abspath(ECLAT)), "tests", "cache")
# No processes outlive a test; test_compile has its own settings. Wide kernels, which users get, take three times as long to compile and
# give the same bits: stat/test_same_bits, cli/test_render and the full tier use them. The quick tier renders only with the kernels that
# building has compiled. Renders of the full tier with NARROW do so too, where rendering takes less time than compiling wide kernels.
WIDE = {"ECLAT_COMPILE": "first"}
ENVIRONMENT["ECLAT_COMPILE"] = "narrow" if os.environ.get("ECLAT_TIER") == "quick" else "first"
ENVIRONMENT["ECLAT_KERNELS"] = os.path.join(os.path.dirname(os.path.abspath(ECLAT)), "eclat-kernels")

# NARROW: kernels for this scene only. QUICK: kernels with all effects. Every scene can share those, unless options (motion, instances)
# change them.
NARROW = ("--compile", "narrow")
QUICK = ("--effects", "all", *NARROW)


def eclat(*arguments, cwd=None, env=None, timeout=300, program=None, **options):
    """Runs eclat, or another program, to its end; stdout and stderr are text."""
    environment = dict(ENVIRONMENT, **(env or {}))
    options.setdefault("stdout", subprocess.PIPE)
    options.setdefault("stderr", subprocess.PIPE)
    return subprocess.run([program or ECLAT, *arguments], cwd=cwd, env=environment, timeout=timeout, stdin=subprocess.DEVNULL,
                          encoding="utf-8", errors="replace", **options)


class Case(unittest.TestCase):
    """A test with a folder of its own, and checks that many tests use."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="eclat-cli-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def assert_one_error(self, run, code):
        """Checks the exit code, that nothing is on stdout, and that stderr is exactly one line, an error. Returns it."""
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertEqual(run.stdout, "")
        lines = run.stderr.splitlines()
        self.assertEqual(len(lines), 1, run.stderr)
        self.assertTrue(lines[0].startswith("eclat: error: "), run.stderr)
        self.assertLess(len(lines[0]), 700)
        return lines[0]

    def assert_ok(self, run):
        self.assertEqual(run.returncode, 0, run.stderr)
        return run


def stand_in_renderer(folder, ending):
    """Writes a program `my-renderer SCENE OPTIONS` into a folder, and the Cornell box as scene.gltf. ending: shell words after its options."""
    path = os.path.join(folder, "my-renderer")
    with open(path, "w", encoding="utf-8") as file:
        file.write(f'#!/bin/sh\nscene=$1\nshift\nexec {ECLAT} render "$scene" "$@" {ending}\n')
    os.chmod(path, 0o700)
    shutil.copy(CORNELL, os.path.join(folder, "scene.gltf"))
    shutil.copy(CORNELL.replace(".gltf", ".bin"), folder)


# Scenes -------------------------------------------------------------------------------------------------------------

def quad_scene(uri=None, material=None):
    """Returns a glTF object and its buffer: a quad of 2 x 2 in the plane z = 0 that emits 1, and a camera before it. Positions come first
    in the buffer."""
    positions = struct.pack("<12f", -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0)
    indices = struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    buffer = positions + indices
    scene = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 3]}],
        "cameras": [{"type": "perspective", "name": "front",
                     "perspective": {"yfov": 0.8, "znear": 0.1, "aspectRatio": 1.5}}],
        "materials": [{"emissiveFactor": [1, 1, 1]} if material is None else material],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "buffers": [{"byteLength": len(buffer),
                     "uri": uri or "data:application/octet-stream;base64," + base64.b64encode(buffer).decode()}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                       "min": [-1, -1, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    }
    return scene, buffer


def move_node(scene, node, start, end):
    """Moves the node from start to end within a second. The scene has one buffer, as quad_scene's has."""
    data = struct.pack("<2f3f3f", 0, 1, *start, *end)
    scene["buffers"].append({"byteLength": len(data), "uri": data_uri(data)})
    scene["bufferViews"] += [{"buffer": 1, "byteLength": 8}, {"buffer": 1, "byteOffset": 8, "byteLength": 24}]
    scene["accessors"] += [{"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                           {"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3"}]
    scene["animations"] = [{"samplers": [{"input": 2, "output": 3}], "channels": [{"sampler": 0, "target": {"node": node, "path": "translation"}}]}]


def data_uri(buffer):
    return "data:application/octet-stream;base64," + base64.b64encode(buffer).decode()


def write_gltf(path, scene):
    with open(path, "w", encoding="utf-8") as file:
        json.dump(scene, file)
    return path


def write_glb(path, scene, buffer):
    scene = json.loads(json.dumps(scene))
    del scene["buffers"][0]["uri"]
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    buffer += b"\0" * (-len(buffer) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(buffer), 0x004E4942) + buffer
    with open(path, "wb") as file:
        file.write(struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks)
    return path


# EXR ----------------------------------------------------------------------------------------------------------------

def read_exr(path):
    """Returns (attributes, {channel: list of float}) of a scan-line file, ZIP or ZIPS; of a multi-part file the first part."""
    with open(path, "rb") as file:
        data = file.read()
    assert data[:4] == b"\x76\x2f\x31\x01", "not an EXR file"
    attributes, at = read_header(data, 8)
    many_parts = data[5] & 0x10
    while many_parts and data[at]:
        at = read_header(data, at)[1]
    x0, y0, x1, y1 = attributes["dataWindow"]
    return attributes, read_chunks(data, at + bool(many_parts), x1 - x0 + 1, y1 - y0 + 1, y0, attributes, 4 if many_parts else 0)


def read_header(data, at):
    attributes = {}
    while data[at]:
        name, at = text_at(data, at)
        kind, at = text_at(data, at)
        size, = struct.unpack_from("<i", data, at)
        attributes[name] = decode(kind, data[at + 4:at + 4 + size])
        at += 4 + size
    return attributes, at + 1


def text_at(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def decode(kind, value):
    if kind == "string":
        return value.decode()
    if kind == "chlist":
        channels, at = [], 0
        while value[at]:
            name, at = text_at(value, at)
            channels.append((name, struct.unpack_from("<i", value, at)[0]))
            at += 16
        return channels
    formats = {"int": "<i", "float": "<f", "double": "<d", "box2i": "<4i"}
    if kind not in formats:
        return value
    numbers = struct.unpack(formats[kind], value)
    return numbers if kind == "box2i" else numbers[0]


UINT, HALF, FLOAT = range(3)  # EXR's channel types
VALUE = {UINT: ("I", 4), HALF: ("e", 2), FLOAT: ("f", 4)}


def read_chunks(data, at, width, height, y0, attributes, skip):
    """skip: bytes before each block, which hold the number of its part."""
    compression = attributes["compression"][0]
    rows = {0: 1, 2: 1, 3: 16}[compression]
    count = -(-height // rows)
    planes = {name: [0.0] * (width * height) for name, _ in attributes["channels"]}
    for offset in struct.unpack_from(f"<{count}Q", data, at):
        offset += skip
        y, size = struct.unpack_from("<ii", data, offset)
        lines = min(rows, height - (y - y0))
        block = data[offset + 8:offset + 8 + size]
        assert len(block) == size, "a block ends behind the file's end"
        if size < lines * width * sum(VALUE[kind][1] for _, kind in attributes["channels"]):
            block = unzip(block)
        start = 0
        for line in range(lines):
            for name, kind in attributes["channels"]:
                code, bytes_ = VALUE[kind]
                first = (y - y0 + line) * width
                planes[name][first:first + width] = struct.unpack_from(f"<{width}{code}", block, start)
                start += width * bytes_
    return planes


def read_alike(a, b):
    """Returns the planes of two files. A channel that is stored as halves in one is rounded to halves in the other too: a picture, and a
    checkpoint, slice or merged file."""
    (left, mine), (right, theirs) = read_exr(a), read_exr(b)
    for attributes, planes in (right, mine), (left, theirs):
        for name, kind in attributes["channels"]:
            if kind == HALF and name in planes:
                planes[name] = [to_half(value) for value in planes[name]]
    return mine, theirs


def to_half(value):
    """Rounds to the nearest half. A value that is not 0 stays so, and a finite one stays finite."""
    return 2.0 ** -24 if 0 < value < 2.0 ** -24 else struct.unpack("<e", struct.pack("<e", min(value, 65504.0)))[0]


def unzip(block):
    """Decompresses a block: zlib, the byte predictor, then interleaving the two halves."""
    packed = bytearray(zlib.decompress(block))
    for i in range(1, len(packed)):
        packed[i] = (packed[i - 1] + packed[i] - 128) & 0xFF
    half = (len(packed) + 1) // 2
    woven = bytearray(len(packed))
    woven[0::2] = packed[:half]
    woven[1::2] = packed[half:]
    return bytes(woven)


def write_exr(path, width, height, planes, attributes=(), half=False):
    """Writes uncompressed scan lines of 32-bit floats, or of halves; attributes: (name, int or float)."""
    code, kind, size = ("e", 1, 2) if half else ("f", 2, 4)
    names = sorted(planes)
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iiii", kind, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = [("channels", "chlist", channels), ("compression", "compression", b"\0"), ("dataWindow", "box2i", window),
              ("displayWindow", "box2i", window), ("lineOrder", "lineOrder", b"\0"),
              ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
              ("screenWindowWidth", "float", struct.pack("<f", 1))]
    header += [(name, "int" if isinstance(value, int) else "double", struct.pack("<i" if isinstance(value, int) else "<d", value))
               for name, value in attributes]
    data = struct.pack("<ii", 20000630, 2)
    for name, type_, value in header:
        data += name.encode() + b"\0" + type_.encode() + b"\0" + struct.pack("<i", len(value)) + value
    data += b"\0"
    row = len(names) * width * size
    data += struct.pack(f"<{height}Q", *(len(data) + 8 * height + y * (8 + row) for y in range(height)))
    for y in range(height):
        data += struct.pack("<ii", y, row)
        for name in names:
            data += struct.pack(f"<{width}{code}", *planes[name][y * width:(y + 1) * width])
    with open(path, "wb") as file:
        file.write(data)
    return path


def png_size(path):
    with open(path, "rb") as file:
        head = file.read(24)
    assert head[:8] == b"\x89PNG\r\n\x1a\n", "not a PNG file"
    return struct.unpack(">II", head[16:24])

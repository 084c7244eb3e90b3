"""Reads the EXR files that eclat writes, and writes plain ones. Needs only NumPy."""
import struct
import zlib

import numpy

TYPES = {0: numpy.dtype("<u4"), 1: numpy.dtype("<f2"), 2: numpy.dtype("<f4")}
ROWS = {0: 1, 2: 1, 3: 16}  # in a block, by compression: none, ZIPS, ZIP


def read(path):
    """Returns (attributes, {channel: float32 array, rows from the top})."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError(f"{path} is no EXR file")
    attributes, at = header(data, 8)
    x0, y0, x1, y1 = attributes["dataWindow"]
    width, height = x1 - x0 + 1, y1 - y0 + 1
    rows = ROWS[attributes["compression"][0]]
    planes = {name: numpy.empty((height, width), TYPES[kind]) for name, kind in attributes["channels"]}
    row_bytes = width * sum(TYPES[kind].itemsize for _, kind in attributes["channels"])
    for offset in struct.unpack_from(f"<{-(-height // rows)}Q", data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        lines = min(rows, height - (y - y0))
        block = data[offset + 8:offset + 8 + size]
        block = numpy.frombuffer(block if size == lines * row_bytes else unzip(block), numpy.uint8).reshape(lines, row_bytes)
        start = 0
        for name, kind in attributes["channels"]:
            end = start + width * TYPES[kind].itemsize
            planes[name][y - y0:y - y0 + lines] = numpy.ascontiguousarray(block[:, start:end]).view(TYPES[kind])
            start = end
    return attributes, {name: plane.astype(numpy.float32) for name, plane in planes.items()}


def header(data, at):
    attributes = {}
    while data[at]:
        name, at = text(data, at)
        kind, at = text(data, at)
        size, = struct.unpack_from("<i", data, at)
        attributes[name] = decode(kind, data[at + 4:at + 4 + size])
        at += 4 + size
    return attributes, at + 1


def text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def decode(kind, value):
    if kind == "string":
        return value.decode("utf-8", "replace")
    if kind == "chlist":
        channels, at = [], 0
        while value[at]:
            name, at = text(value, at)
            channels.append((name, struct.unpack_from("<i", value, at)[0]))
            at += 16
        return channels
    if kind == "box2i":
        return struct.unpack("<4i", value)
    formats = {"int": "<i", "float": "<f", "double": "<d"}
    return struct.unpack(formats[kind], value)[0] if kind in formats else value


def unzip(block):
    """Undoes zlib, then the byte predictor, then interleaves the two halves again."""
    packed = numpy.frombuffer(zlib.decompress(block), numpy.uint8).copy()
    packed[1:] -= 128
    packed = numpy.cumsum(packed, dtype=numpy.uint8)
    half = (len(packed) + 1) // 2
    woven = numpy.empty_like(packed)
    woven[0::2], woven[1::2] = packed[:half], packed[half:]
    return woven


def write(path, rgb):
    """rgb: height x width x 3, rows from the top. Uncompressed floats."""
    height, width, _ = rgb.shape
    channels = b"".join(name + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    entries = ((b"channels", b"chlist", channels), (b"compression", b"compression", b"\0"), (b"dataWindow", b"box2i", box),
               (b"displayWindow", b"box2i", box), (b"lineOrder", b"lineOrder", b"\0"), (b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
               (b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)), (b"screenWindowWidth", b"float", struct.pack("<f", 1)))
    head = struct.pack("<ii", 20000630, 2) + b"".join(name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value for name, kind, value in entries) + b"\0"
    row = 12 * width
    begin = len(head) + 8 * height
    with open(path, "wb") as file:
        file.write(head + struct.pack(f"<{height}Q", *(begin + y * (8 + row) for y in range(height))))
        for y in range(height):
            file.write(struct.pack("<ii", y, row) + numpy.ascontiguousarray(rgb[y, :, ::-1].T, "<f4").tobytes())

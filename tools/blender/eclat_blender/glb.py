"""Reads and writes binary glTF, as a document and its buffer."""
import json
import struct


def read(path):
    """Returns (document, bytearray)."""
    with open(path, "rb") as file:
        data = file.read()
    at, document, buffer = 12, None, b""
    while at < len(data):
        size, kind = struct.unpack_from("<II", data, at)
        chunk = data[at + 8:at + 8 + size]
        if kind == 0x4E4F534A:
            document = json.loads(chunk)
        elif kind == 0x004E4942:
            buffer = chunk
        at += 8 + size
    return document, bytearray(buffer)


def write(path, document, buffer):
    if buffer:
        buffer += b"\0" * (-len(buffer) % 4)
        document["buffers"] = [{"byteLength": len(buffer)}]
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if buffer:
        chunks += struct.pack("<II", len(buffer), 0x004E4942) + bytes(buffer)
    with open(path, "wb") as file:
        file.write(struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks)


def empty():
    """Returns an empty document, for a scene without meshes."""
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": []}, bytearray()


def add_floats(document, buffer, values, kind, bounds=True):
    """values: an array of rows of float32. Returns the index of the accessor."""
    import numpy
    values = numpy.ascontiguousarray(values, "<f4")
    rows = values.reshape(len(values), -1)
    buffer += b"\0" * (-len(buffer) % 4)
    views, accessors = document.setdefault("bufferViews", []), document.setdefault("accessors", [])
    views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": values.nbytes})
    buffer += values.tobytes()
    accessor = {"bufferView": len(views) - 1, "componentType": 5126, "count": len(rows), "type": kind}
    if bounds:
        accessor.update(min=[float(v) for v in rows.min(0)], max=[float(v) for v in rows.max(0)])
    accessors.append(accessor)
    return len(accessors) - 1


def floats(document, buffer, index):
    """Returns the rows of an accessor of floats, which the exporter never interleaves."""
    import numpy
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    return numpy.frombuffer(bytes(buffer[begin:begin + 4 * width * accessor["count"]]), "<f4").reshape(-1, width)


def add_node(document, node, to_scene=True):
    document.setdefault("nodes", []).append(node)
    if to_scene:
        document["scenes"][document.get("scene", 0)].setdefault("nodes", []).append(len(document["nodes"]) - 1)
    return len(document["nodes"]) - 1


def use(document, extension):
    used = document.setdefault("extensionsUsed", [])
    if extension not in used:
        used.append(extension)

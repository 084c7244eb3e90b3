"""Reads all parts of an EXR file that Blender writes; support.read_exr reads only the first."""
import struct

import support


def read(path):
    """Returns (attributes of the first part, {channel: list of float}), with the channels of all parts by their full names."""
    with open(path, "rb") as file:
        data = file.read()
    many = data[5] & 0x10
    headers, at = [], 8
    while not headers or (many and data[at]):
        attributes, at = support.read_header(data, at)
        headers.append(attributes)
    at += 1 if many else 0
    planes = {}
    for attributes in headers:
        x0, y0, x1, y1 = attributes["dataWindow"]
        rows = {0: 1, 2: 1, 3: 16}[attributes["compression"][0]]
        prefix = attributes["name"] + "." if many and not all("." in name for name, _ in attributes["channels"]) else ""
        found = support.read_chunks(data, at, x1 - x0 + 1, y1 - y0 + 1, y0, attributes, 4 if many else 0)
        planes.update({prefix + name: plane for name, plane in found.items()})
        at += 8 * -(-(y1 - y0 + 1) // rows)
    return headers[0], planes


def size(path):
    with open(path, "rb") as file:
        data = file.read()
    x0, y0, x1, y1 = support.read_header(data, 8)[0]["dataWindow"]
    return x1 - x0 + 1, y1 - y0 + 1



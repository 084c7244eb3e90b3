"""Reads the sizes of a 64-bit ELF file's sections."""
import struct


def sections(path):
    """Returns {name: bytes}."""
    with open(path, "rb") as file:
        data = file.read()
    at, = struct.unpack_from("<Q", data, 40)
    size, count, names = struct.unpack_from("<HHH", data, 58)
    heads = [struct.unpack_from("<IIQQQQ", data, at + i * size) for i in range(count)]
    texts = heads[names][4]
    return {data[texts + name:data.index(b"\0", texts + name)].decode(): bytes_ for name, _, _, _, _, bytes_ in heads}

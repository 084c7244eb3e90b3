"""Writes 8-bit PNG files, and makes noise to fill them with. Needs no library; the only randomness is the seed."""
import math
import struct
import zlib


def encode(width, height, channels, pixel):
    """Encodes a picture. pixel(x, y) returns `channels` bytes (1 grey, 3 RGB, 4 RGBA)."""
    kind = {1: 0, 3: 2, 4: 6}[channels]
    raw = bytearray()
    previous = bytes(width * channels)
    for y in range(height):
        row = bytearray()
        for x in range(width):
            row += bytes(pixel(x, y))
        # Filter "up" or "sub", whichever has the smaller sum of differences, as the PNG specification suggests.
        sub = bytes((row[i] - (row[i - channels] if i >= channels else 0)) & 255 for i in range(len(row)))
        up = bytes((a - b) & 255 for a, b in zip(row, previous))
        cost = lambda data: sum(min(b, 256 - b) for b in data)
        kind_, data = min(((0, bytes(row)), (1, sub), (2, up)), key=lambda c: cost(c[1]))
        raw += bytes([kind_]) + data
        previous = bytes(row)

    def chunk(tag, data):
        return struct.pack(">I", len(data)) + tag + data + struct.pack(">I", zlib.crc32(tag + data))

    header = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(raw), 9)) + chunk(b"IEND", b"")


def srgb(linear):
    """Converts linear 0..1 to an sRGB byte."""
    c = min(max(linear, 0.0), 1.0)
    c = 12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055
    return int(c * 255 + 0.5)


def byte(x):
    return int(min(max(x, 0.0), 1.0) * 255 + 0.5)


def hash01(x, y, seed):
    """Returns a uniform number in 0..1 from integers: a 32-bit mix (lowbias32, C. Wellons)."""
    h = (x * 0x9E3779B1 ^ y * 0x85EBCA77 ^ seed * 0xC2B2AE3D) & 0xFFFFFFFF
    h ^= h >> 16
    h = h * 0x7FEB352D & 0xFFFFFFFF
    h ^= h >> 15
    h = h * 0x846CA68B & 0xFFFFFFFF
    h ^= h >> 16
    return h / 2.0 ** 32


def value_noise(x, y, period, seed):
    """Smooth noise on an integer lattice that repeats after `period` cells."""
    xi, yi = math.floor(x), math.floor(y)
    fx, fy = x - xi, y - yi
    fx, fy = fx * fx * (3 - 2 * fx), fy * fy * (3 - 2 * fy)
    at = lambda i, j: hash01((xi + i) % period, (yi + j) % period, seed)
    low = at(0, 0) + (at(1, 0) - at(0, 0)) * fx
    high = at(0, 1) + (at(1, 1) - at(0, 1)) * fx
    return low + (high - low) * fy


def cells(x, y, period, seed):
    """Worley cells on a repeating lattice. Returns (distance to the nearest point, to the second, the nearest cell's id 0..1)."""
    xi, yi = math.floor(x), math.floor(y)
    first = second = 9.0
    name = 0.0
    for j in (-1, 0, 1):
        for i in (-1, 0, 1):
            cx, cy = (xi + i) % period, (yi + j) % period
            px, py = xi + i + hash01(cx, cy, seed), yi + j + hash01(cx, cy, seed + 1)
            d = math.hypot(px - x, py - y)
            if d < first:
                first, second, name = d, first, hash01(cx, cy, seed + 2)
            elif d < second:
                second = d
    return first, second, name


def normal_map(width, height, height_at, strength):
    """Tangent-space normals (+Y up, glTF's convention) of a repeating height field height_at(x, y)."""
    heights = [[height_at(x, y) for x in range(width)] for y in range(height)]

    def pixel(x, y):
        dx = (heights[y][(x + 1) % width] - heights[y][x - 1]) * strength
        dy = (heights[(y + 1) % height][x] - heights[y - 1][x]) * strength  # rows run down, +Y runs up
        n = math.sqrt(dx * dx + dy * dy + 1)
        return byte(0.5 - 0.5 * dx / n), byte(0.5 + 0.5 * dy / n), byte(0.5 + 0.5 / n)

    return encode(width, height, 3, pixel)

"""Pictures for the screen: a reader of PNGs of 8 and 16 bits, and tone curves as published. Standard library only."""
import math
import struct
import zlib


def read_png(path):
    """Returns (width, height, channels, bits, rows of integers)."""
    with open(path, "rb") as file:
        data = file.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "not a PNG file"
    packed, at = b"", 8
    while at < len(data):
        size, name = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        if name == b"IHDR":
            width, height, bits, kind, *_ = struct.unpack(">IIBBBBB", body)
        packed += body if name == b"IDAT" else b""
        at += 12 + size
    channels = {2: 3, 6: 4}[kind]
    step, raw, rows = channels * bits // 8, zlib.decompress(packed), []
    above = bytearray(width * step)
    for y in range(height):
        start = y * (width * step + 1)
        above = unfilter(raw[start], bytearray(raw[start + 1:start + 1 + width * step]), above, step)
        rows.append(struct.unpack(f">{width * channels}{'H' if bits == 16 else 'B'}", above))
    return width, height, channels, bits, rows


def unfilter(kind, line, above, step):
    """Undoes a PNG filter: none, left, up, average or Paeth."""
    for i in range(len(line)):
        a, b, c = line[i - step] if i >= step else 0, above[i], above[i - step] if i >= step else 0
        paeth = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
        line[i] = (line[i] + (0, a, b, (a + b) // 2, paeth)[kind]) & 0xFF
    return line


def srgb(x):
    """The sRGB transfer function (IEC 61966-2-1)."""
    x = min(max(x, 0.0), 1.0)
    return 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055


def columns(matrix, rgb):
    """Multiplies as GLSL does by a mat3, whose columns are given."""
    return [sum(matrix[k][c] * rgb[k] for k in range(3)) for c in range(3)]


def none(rgb):
    return rgb


def neutral(rgb):
    """Khronos' neutral tone curve: github.com/KhronosGroup/ToneMapping, PBR_Neutral/pbrNeutral.glsl."""
    x = min(rgb)
    offset = x - 6.25 * x * x if x < 0.08 else 0.04
    rgb = [c - offset for c in rgb]
    peak = max(rgb)
    if peak < 0.76:
        return rgb
    d = 0.24
    new_peak = 1 - d * d / (peak + d - 0.76)
    g = 1 - 1 / (0.15 * (peak - new_peak) + 1)
    return [c * new_peak / peak * (1 - g) + new_peak * g for c in rgb]


# three.js r187, src/renderers/shaders/ShaderChunk/tonemapping_pars_fragment.glsl.js: ACESFilmicToneMapping, AgXToneMapping, CineonToneMapping

def aces(rgb):
    v = columns([[0.59719, 0.07600, 0.02840], [0.35458, 0.90834, 0.13383], [0.04823, 0.01566, 0.83777]], [c / 0.6 for c in rgb])
    v = [(c * (c + 0.0245786) - 0.000090537) / (c * (0.983729 * c + 0.4329510) + 0.238081) for c in v]
    return columns([[1.60475, -0.10208, -0.00327], [-0.53108, 1.10813, -0.07276], [-0.07367, -0.00605, 1.07602]], v)


def agx(rgb):
    v = columns([[0.6274, 0.0691, 0.0164], [0.3293, 0.9195, 0.0880], [0.0433, 0.0113, 0.8956]], rgb)
    v = columns([[0.856627153315983, 0.137318972929847, 0.11189821299995], [0.0951212405381588, 0.761241990602591, 0.0767994186031903],
                 [0.0482516061458583, 0.101439036467562, 0.811302368396859]], v)
    v = [min(max((math.log2(max(c, 1e-10)) + 12.47393) / (4.026069 + 12.47393), 0), 1) for c in v]
    v = [15.5 * x ** 6 - 40.14 * x ** 5 + 31.96 * x ** 4 - 6.868 * x ** 3 + 0.4298 * x ** 2 + 0.1191 * x - 0.00232 for x in v]
    v = columns([[1.1271005818144368, -0.1413297634984383, -0.14132976349843826], [-0.11060664309660323, 1.157823702216272, -0.11060664309660294],
                 [-0.016493938717834573, -0.016493938717834257, 1.2519364065950405]], v)
    v = [max(c, 0) ** 2.2 for c in v]
    return columns([[1.6605, -0.1246, -0.0182], [-0.5876, 1.1329, -0.1006], [-0.0728, -0.0083, 1.1187]], v)


def filmic(rgb):
    v = [max(c - 0.004, 0) for c in rgb]
    return [(c * (6.2 * c + 0.5) / (c * (6.2 * c + 1.7) + 0.06)) ** 2.2 for c in v]


CURVES = {"neutral": neutral, "none": none, "aces": aces, "agx": agx, "filmic": filmic}


def shown(curve, rgb, exposure=0.0):
    """Converts linear radiance to what a screen shows, each channel 0 to 1."""
    return [srgb(c) for c in CURVES[curve]([max(c, 0.0) * 2 ** exposure for c in rgb])]

"""The measured Cornell box: geometry, spectra and camera as published by the Cornell University Program of Computer Graphics
(https://www.graphics.cornell.edu/online/box/data.html), reduced to linear sRGB."""
import math

from scenes.gltf import Gltf
from scenes.mesh import polygon, ring

# Reflectance of the paints from 400 to 700 nm in steps of 4 nm, measured.
WHITE = """.343 .445 .551 .624 .665 .687 .708 .723 .715 .710 .745 .758 .739 .767 .777 .765 .751 .745 .748 .729 .745 .757 .753 .750 .746
.747 .735 .732 .739 .734 .725 .721 .733 .725 .732 .743 .744 .748 .728 .716 .733 .726 .713 .740 .754 .764 .752 .736 .734 .741
.740 .732 .745 .755 .751 .744 .731 .733 .744 .731 .712 .708 .729 .730 .727 .707 .703 .729 .750 .760 .751 .739 .724 .730 .740 .737"""
GREEN = """.092 .096 .098 .097 .098 .095 .095 .097 .095 .094 .097 .098 .096 .101 .103 .104 .107 .109 .112 .115 .125 .140 .160 .187 .229
.285 .343 .390 .435 .464 .472 .476 .481 .462 .447 .441 .426 .406 .373 .347 .337 .314 .285 .277 .266 .250 .230 .207 .186 .171
.160 .148 .141 .136 .130 .126 .123 .121 .122 .119 .114 .115 .117 .117 .118 .120 .122 .128 .132 .139 .144 .146 .150 .152 .157 .159"""
RED = """.040 .046 .048 .053 .049 .050 .053 .055 .057 .056 .059 .057 .061 .061 .060 .062 .062 .062 .061 .062 .060 .059 .057 .058 .058
.058 .056 .055 .056 .059 .057 .055 .059 .059 .058 .059 .061 .061 .063 .063 .067 .068 .072 .080 .090 .099 .124 .154 .192 .255
.287 .349 .402 .443 .487 .513 .558 .584 .620 .606 .609 .651 .612 .610 .650 .638 .627 .620 .630 .628 .642 .639 .657 .639 .635 .642"""
LIGHT = [(400, 0.0), (500, 8.0), (600, 15.6), (700, 18.4)]  # emission, linear between
LIGHT_REFLECTANCE = 0.78
BRIGHTNESS = 3.0
# CIE standard illuminant D65, 400 to 700 nm in steps of 10 nm (CIE 015).
D65 = [82.75, 91.49, 93.43, 86.68, 104.86, 117.01, 117.81, 114.86, 115.92, 108.81, 109.35, 107.80, 104.79, 107.69, 104.41, 104.05,
       100.00, 96.33, 95.79, 88.69, 90.01, 89.60, 87.70, 83.29, 83.70, 80.03, 80.21, 82.28, 78.28, 69.72, 71.61]


def matching(nm):
    """CIE 1931 colour matching functions, the multi-lobe fit of Wyman, Sloan and Shirley (JCGT 2(2), 2013)."""
    def lobe(mean, below, above):
        return math.exp(-0.5 * ((nm - mean) / (below if nm < mean else above)) ** 2)
    return (1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2),
            0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
            1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8))


def between(table, nm):
    for (x0, y0), (x1, y1) in zip(table, table[1:]):
        if x0 <= nm <= x1:
            return y0 + (y1 - y0) * (nm - x0) / (x1 - x0)
    raise ValueError(nm)


def linear_srgb(xyz):
    x, y, z = xyz
    return (3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z)


def integrate(power):
    """Returns XYZ of a spectrum over 400..700 nm, and the integral of y alone."""
    total = [0.0, 0.0, 0.0]
    flat = 0.0
    for nm in range(400, 701):
        cmf = matching(nm)
        total = [t + c * power(nm) for t, c in zip(total, cmf)]
        flat += cmf[1]
    return total, flat


def reflectance(values):
    """Returns the linear sRGB of a paint: its colour under D65 over that of a perfect white under D65. A grey paint stays grey."""
    table = [(400 + 4 * i, float(v)) for i, v in enumerate(values.split())]
    d65 = [(400 + 10 * i, v) for i, v in enumerate(D65)]
    paint, _ = integrate(lambda nm: between(table, nm) * between(d65, nm))
    white, _ = integrate(lambda nm: between(d65, nm))
    return [round(p / w, 4) for p, w in zip(linear_srgb(paint), linear_srgb(white))]


def adapted(xyz):
    """Adapts (Bradford) from 4000 K to D65, like a camera at its preset for fluorescent lamps. The light stays warm, not orange."""
    cone = ((0.8951, 0.2664, -0.1614), (-0.7502, 1.7135, 0.0367), (0.0389, -0.0685, 1.0296))
    back = ((0.9869929, -0.1470543, 0.1599627), (0.4323053, 0.5183603, 0.0492912), (-0.0085287, 0.0400428, 0.9684867))
    times = lambda m, v: [sum(a * b for a, b in zip(row, v)) for row in m]
    lamp, day = times(cone, (1.0098, 1.0, 0.6441)), times(cone, (0.95047, 1.0, 1.08883))
    return times(back, [c * d / a for c, d, a in zip(times(cone, xyz), day, lamp)])


def emission():
    """Returns the linear sRGB of the lamp. The published values have no unit. Here a flat spectrum of value 1 would have the luminance
    BRIGHTNESS, which exposes the picture well."""
    xyz, flat = integrate(lambda nm: between(LIGHT, nm))
    return [round(BRIGHTNESS * c / flat, 3) for c in linear_srgb(adapted(xyz))]


def metres(points):
    return [tuple(x / 1000.0 for x in p) for p in points]


# Corners in millimetres as published; each face is counter-clockwise as seen from inside the box.
FLOOR = [(552.8, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 559.2), (549.6, 0.0, 559.2)]
CEILING = [(556.0, 548.8, 0.0), (556.0, 548.8, 559.2), (0.0, 548.8, 559.2), (0.0, 548.8, 0.0)]
LAMP = [(343.0, 548.8, 227.0), (343.0, 548.8, 332.0), (213.0, 548.8, 332.0), (213.0, 548.8, 227.0)]
BACK = [(549.6, 0.0, 559.2), (0.0, 0.0, 559.2), (0.0, 548.8, 559.2), (556.0, 548.8, 559.2)]
RIGHT = [(0.0, 0.0, 559.2), (0.0, 0.0, 0.0), (0.0, 548.8, 0.0), (0.0, 548.8, 559.2)]
LEFT = [(552.8, 0.0, 0.0), (549.6, 0.0, 559.2), (556.0, 548.8, 559.2), (556.0, 548.8, 0.0)]
SHORT_BLOCK = ([(130.0, 65.0), (82.0, 225.0), (240.0, 272.0), (290.0, 114.0)], 165.0)  # (x, z) of the top's corners, height
TALL_BLOCK = ([(423.0, 247.0), (265.0, 296.0), (314.0, 456.0), (472.0, 406.0)], 330.0)


def block(corners, height):
    """Returns the top and four sides; the bottom stands on the floor."""
    out = polygon(*metres([(x, height, z) for x, z in corners]))
    for (x0, z0), (x1, z1) in zip(corners, corners[1:] + corners[:1]):
        out.append(polygon(*metres([(x0, 0.0, z0), (x1, 0.0, z1), (x1, height, z1), (x0, height, z0)])))
    return out


def two_triangles(corners):
    """Splits the left wall: its published corners do not lie in one plane, so each half gets its own normal."""
    a, b, c, d = metres(corners)
    return polygon(a, b, c).append(polygon(a, c, d))


def ceiling_around_lamp():
    """The ceiling has a hole in which the lamp sits: four trapezoids between the two rings of corners."""
    return ring(metres(CEILING), metres(LAMP))


def make(folder):
    g = Gltf()
    lambert = lambda name, color, **more: g.material(name, color, lambert=True, **more)
    white, green, red = (lambert(n, reflectance(s)) for n, s in (("white", WHITE), ("green", GREEN), ("red", RED)))
    lamp = lambert("lamp", (LIGHT_REFLECTANCE,) * 3, emission=emission())
    for name, shape, material in (("floor", polygon(*metres(FLOOR)), white), ("ceiling", ceiling_around_lamp(), white),
                                  ("back-wall", two_triangles(BACK), white), ("right-wall", polygon(*metres(RIGHT)), green),
                                  ("left-wall", two_triangles(LEFT), red), ("short-block", block(*SHORT_BLOCK), white),
                                  ("tall-block", block(*TALL_BLOCK), white), ("lamp", polygon(*metres(LAMP)), lamp)):
        shape.uvs = []
        g.add(name, shape, material)
    # Focal length 35 mm behind a 25 mm x 25 mm film.
    g.perspective("camera", (0.278, 0.273, -0.8), (0.278, 0.273, 0.0), math.degrees(2 * math.atan(12.5 / 35.0)), 1.0)
    g.write(folder, "cornell-box")

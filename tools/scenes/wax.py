"""A candle of wax that glows under its flame, a ball of jade and a cake of soap: light that goes in at one place and comes out at another."""
import math

from scenes.gltf import axis_angle
from scenes.mesh import box, icosphere, lathe
from scenes.stage import stage


def scatters(color, forward, attenuation, ior, roughness):
    """A body that light enters and leaves diffusely, and that scatters light inside."""
    return {"base": (1.0, 1.0, 1.0), "roughness": roughness, "ior": ior, "body": True, "attenuation": attenuation,
            "extensions": {"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1.0},
                           "KHR_materials_volume_scatter": {"multiscatterColorFactor": list(color), "scatterAnisotropy": forward}}}


def candle(radius, height, bowl):
    """A closed candle, with a hollow around the wick and a rounded rim."""
    rim = [(radius - 0.04 * (1 - math.cos(a)), height - 0.04 * (1 - math.sin(a))) for a in (math.pi / 2 * k / 6 for k in range(7))]
    hollow = [(radius * 0.72 * math.cos(a), height - bowl * math.sin(a)) for a in (math.pi / 2 * k / 8 for k in range(8))]
    return lathe([(0.0, 0.0), (radius, 0.0)] + rim + hollow + [(0.0, height - bowl)], 64)


def flame(y):
    """A flame in the shape of a drop."""
    return lathe([(0.0, y)] + [(0.035 * math.sin(math.pi * t) * (1 - 0.45 * t), y + 0.16 * t) for t in (k / 12 for k in range(1, 12))] + [(0.0, y + 0.16)], 24)


def make(folder):
    g = stage(backdrop=(0.3, 0.28, 0.27), key=11.0, fill=4.0, eye=(0.0, 1.15, 3.6), target=(0.0, 0.42, 0.0), yfov=24.0)
    wax = g.material("wax", **scatters((0.93, 0.8, 0.62), 0.4, ((0.35, 0.25, 0.15), 0.03), 1.43, 0.4))
    jade = g.material("jade", **scatters((0.5, 0.82, 0.6), 0.3, ((0.35, 0.4, 0.3), 0.04), 1.6, 0.15))
    soap = g.material("soap", **scatters((0.92, 0.75, 0.8), 0.7, ((0.5, 0.4, 0.42), 0.03), 1.46, 0.3))
    wick = g.material("wick", (0.02, 0.02, 0.02), lambert=True)
    fire = g.material("flame", (0.0, 0.0, 0.0), emission=(110.0, 52.0, 15.0), lambert=True)
    g.add("candle", candle(0.26, 0.75, 0.09), wax, translation=(-0.1, 0.002, -0.1))
    g.add("wick", lathe([(0.0, 0.62), (0.009, 0.62), (0.009, 0.74), (0.0, 0.74)], 12), wick, translation=(-0.1, 0.05, -0.1))
    g.add("fire", flame(0.78), fire, translation=(-0.1, 0.0, -0.1))
    g.add("ball", icosphere(0.22, 4), jade, translation=(0.52, 0.223, 0.12))
    g.add("cake", box((-0.2, 0.0, -0.13), (0.2, 0.12, 0.13)), soap, translation=(-0.66, 0.003, 0.3), rotation=axis_angle((0, 1, 0), 25))
    g.write(folder, "wax")

"""usage: channels.py PICTURE.exr OUT.png
Albedo, normal, depth, standard error and samples of an EXR file of eclat, side by side. Takes PyPI's OpenEXR, numpy and pillow."""
import sys

import numpy
import OpenEXR
from PIL import Image


def scaled(plane):
    """From 0 to the value that 1 pixel in 100 exceeds, as grey."""
    return numpy.repeat((plane / max(numpy.percentile(plane, 99), 1e-30))[..., None], 3, axis=2)


with OpenEXR.File(sys.argv[1], separate_channels=True) as file:
    plane = {name: channel.pixels for name, channel in file.channels().items()}


def three(name, axes):
    return numpy.stack([plane[f"{name}.{axis}"] for axis in axes], axis=2)


tiles = [three("albedo", "RGB"), three("normal", "XYZ") / 2 + 0.5, scaled(plane["depth.Z"]), scaled(plane["stderr.Y"]), scaled(plane["samples"])]
sheet = numpy.concatenate(tiles, axis=1).clip(0, 1) ** (1 / 2.2)
Image.fromarray((255 * sheet + 0.5).astype(numpy.uint8)).save(sys.argv[2])

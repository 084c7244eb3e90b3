"""usage: noise.py OUT.exr RENDER.exr RENDER.exr ...
The mean of renders that differ in their random numbers alone, with standard errors: a picture of any renderer that `eclat compare` tests against
noise. Takes PyPI's OpenEXR and numpy."""
import sys

import numpy
import OpenEXR


def read(path):
    with OpenEXR.File(path, separate_channels=True) as file:
        return numpy.stack([file.channels()[name].pixels.astype(numpy.float64) for name in "RGB"])


out, *paths = sys.argv[1:]
if len(paths) < 4:
    sys.exit("noise.py: an error is no more than a guess by fewer than 4 renders; 8 are good")
renders = numpy.stack([read(path) for path in paths])
planes = {name: renders.mean(0)[i] for i, name in enumerate("RGB")}
planes.update({f"stderr.{name}": (renders.std(0, ddof=1) / len(paths) ** 0.5)[i] for i, name in enumerate("RGB")})
header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, "eclat.replicates": len(paths)}
OpenEXR.File(header, {name: plane.astype(numpy.float32) for name, plane in planes.items()}).write(out)

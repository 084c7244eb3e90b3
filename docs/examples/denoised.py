"""usage: denoised.py PICTURE.exr OUT.png [STOPS]
The noisy, the denoised and the best picture in an EXR file of eclat, side by side. Takes PyPI's OpenEXR, numpy and pillow."""
import sys

import numpy
import OpenEXR
from PIL import Image

with OpenEXR.File(sys.argv[1], separate_channels=True) as file:
    plane = {name: channel.pixels for name, channel in file.channels().items()}

pictures = [numpy.stack([plane[layer + axis] for axis in "RGB"], axis=2) for layer in ("", "denoised.", "best.")]
sheet = numpy.concatenate(pictures, axis=1) * 2 ** float(sys.argv[3] if len(sys.argv) > 3 else 0)
Image.fromarray((255 * sheet.clip(0, 1) ** (1 / 2.2) + 0.5).astype(numpy.uint8)).save(sys.argv[2])

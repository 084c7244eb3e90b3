"""Mixes the layers of a picture with new weights."""
from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from typing import Union

from ._compare import Source, file_of
from ._job import run
from ._options import texts
from ._picture import Picture
from ._scene import some

Gain = Union[float, Sequence[float]]


def text_of(name: str, gain: Gain) -> str:
    return f"{name}=" + ",".join(repr(float(number)) for number in ([gain] if isinstance(gain, (int, float)) else gain))


def mix(picture: Source, gains: Mapping[str, Gain], *, exposure: float | None = None, tonemap: str | None = None) -> Picture:
    """Multiplies the light groups, or the direct and indirect light, of a picture or an EXR by these gains: {"lamp": 2, "sky": (0.5, 0.6, 0.8)}. Layers
    that are not named keep 1. The errors of the result are upper bounds. The result has layers too. Other options are those of `eclat mix`."""
    with tempfile.TemporaryDirectory(prefix="eclat-") as folder:
        inputs = [file_of(picture, folder, "picture.exr"), *(text_of(name, gain) for name, gain in gains.items())]
        return Picture(some(run("mix", inputs, texts("mix", {"exposure": exposure, "tonemap": tonemap}), wants_picture=True).picture))

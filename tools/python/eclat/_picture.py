"""A rendered picture: its pixels as NumPy arrays, its error, files, and how a notebook shows it."""
from __future__ import annotations

import base64
import ctypes as c
import html
import os
import tempfile
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _library as lib
from ._error import check
from ._job import PictureHandle, known
from ._library import library

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float32]


class Intervals(NamedTuple):
    """95 % confidence intervals, each height x width x 3."""
    low: Array
    high: Array


class Clean(NamedTuple):
    """A picture that a denoiser has worked on, and its distance from the converged one: as fractions, with a 95 % interval."""
    radiance: Array
    error: float
    low: float
    high: float | None
    """None: there is no bound, as of the picture itself."""


def view(handle: PictureHandle, channel: lib.eclat_channel, shape: tuple[int, int]) -> Array:
    """Returns the library's own plane, not copied; it lasts as long as the array."""
    floats = (c.c_float * (channel.stride * (shape[0] * shape[1] - 1) + 1)).from_address(channel.data)
    floats._eclat_picture = handle
    plane = np.frombuffer(floats, np.float32)[::channel.stride].reshape(shape)
    plane.flags.writeable = False
    return plane


class Picture:
    """A picture made by Scene.render or eclat.merge. Arrays are read-only, rows from the top, linear Rec. 709."""

    def __init__(self, handle: PictureHandle) -> None:
        self._handle = handle
        self._stated: lib.eclat_picture_error = library().eclat_picture_get_error(handle.address)

    @property
    def width(self) -> int:
        """In pixels."""
        return int(library().eclat_picture_width(self._handle.address))

    @property
    def height(self) -> int:
        """In pixels."""
        return int(library().eclat_picture_height(self._handle.address))

    @property
    def error(self) -> float | None:
        """Estimated distance from the converged picture: root mean square over the pixels, as a fraction of the mean luminance. None: not known."""
        return known(self._stated.error)

    @property
    def bound(self) -> float | None:
        """The distance is below this bound in at least 95 of 100 renders. None: there is no bound, see `why`."""
        return known(self._stated.error_bound)

    @property
    def why(self) -> str | None:
        """Why there is no bound; None: there is one."""
        return self._stated.why.decode() if self._stated.why else None

    @property
    def samples(self) -> float:
        """Samples per pixel, on average; channels["samples"] has those of each pixel."""
        return float(self._stated.samples_per_pixel)

    @cached_property
    def channels(self) -> Mapping[str, Array]:
        """Every channel that the picture has, by its name in an EXR, as "depth.Z" or "albedo.R": height x width, not copied."""
        of, shape = library(), (self.height, self.width)
        found = (of.eclat_picture_channel_at(self._handle.address, i) for i in range(of.eclat_picture_channel_count(self._handle.address)))
        return MappingProxyType({channel.name.decode(): view(self._handle, channel, shape) for channel in found})

    @cached_property
    def attributes(self) -> Mapping[str, str | float]:
        """Attributes of the picture, as in an EXR: "eclat.command" is the command that makes it again, "eclat.seed", "eclat.imageSha256", ..."""
        of = library()
        found = (of.eclat_picture_attribute_at(self._handle.address, i) for i in range(of.eclat_picture_attribute_count(self._handle.address)))
        return MappingProxyType({a.name.decode(): a.number if a.text is None else a.text.decode(errors="replace") for a in found})

    def layer(self, name: str) -> Array:
        """Returns the channels of one layer, such as "normal", "albedo" or "stderr": height x width x number of channels, in the order R G B or X Y Z.
        Raises KeyError if the picture has no such layer."""
        names = [f"{name}.{letter}" for letters in ("RGB", "XYZ") for letter in letters if f"{name}.{letter}" in self.channels]
        if not names:
            raise KeyError(f"no layer {name}; the channels are {', '.join(self.channels)}")
        return self._stack(names[:3])

    def _stack(self, names: list[str]) -> Array:
        stacked = np.stack([self.channels[name] for name in names], axis=-1)
        stacked.flags.writeable = False
        return stacked

    @cached_property
    def radiance(self) -> Array:
        """Height x width x 3."""
        return self._stack(["R", "G", "B"])

    @cached_property
    def alpha(self) -> Array:
        """Height x width: the share of samples that met a surface."""
        return self.channels["A"]

    @cached_property
    def stderr(self) -> Array | None:
        """Standard errors of `radiance`, height x width x 3. None: not known, as with a single replicate."""
        return self.layer("stderr") if "stderr.R" in self.channels else None

    @cached_property
    def intervals(self) -> Intervals | None:
        """95 % confidence intervals of `radiance`. None: not known."""
        return Intervals(self.layer("low95"), self.layer("high95")) if "low95.R" in self.channels else None

    @cached_property
    def denoised(self) -> Clean | None:
        """The denoised picture, if the option `denoise` was given. None: it was not asked for, or could not be judged."""
        return self._clean("denoised")

    @cached_property
    def best(self) -> Clean | None:
        """A blend of the denoised picture and this one: for each tile the one that is nearer to the truth. With `denoise`, `png` shows this."""
        return self._clean("best")

    def _clean(self, name: str) -> Clean | None:
        known_of: lib.eclat_denoised = library().eclat_picture_get_denoised(self._handle.address)
        if known_of.why is not None:
            return None
        stated: lib.eclat_stated_error = getattr(known_of, name)
        return Clean(self.layer(name), float(stated.error), float(stated.low95), known(stated.high95))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes an .exr, with the channels of the option `channels`, or a .png. The file gets its name only once it is complete."""
        err = lib.eclat_error()
        check(library().eclat_picture_write(self._handle.address, os.fsencode(path), err), err)

    def png(self) -> bytes:
        """Returns a PNG file, tone-mapped by the options `exposure` and `tonemap`."""
        with tempfile.TemporaryDirectory(prefix="eclat-") as folder:
            path = Path(folder, "picture.png")
            self.save(path)
            return path.read_bytes()

    @property
    def caption(self) -> str:
        """Returns error, bound and samples in words."""
        if self.error is None:
            stated = "error not known"
        elif self.bound is None:
            stated = f"error at least {100 * self.error:.3g} %, no bound: {self.why}"
        else:
            stated = f"error {100 * self.error:.3g} % (95 % bound {100 * self.bound:.3g} %)"
        return f"{stated}, {self.samples:.4g} samples a pixel"

    def __repr__(self) -> str:
        return f"<eclat.Picture {self.width}x{self.height}, {self.caption}>"

    def _repr_png_(self) -> bytes:
        return self.png()

    def _repr_html_(self) -> str:
        source = base64.b64encode(self.png()).decode()
        caption = html.escape(self.caption)
        return (f'<figure style="margin: 0"><img src="data:image/png;base64,{source}" width="{self.width}" height="{self.height}" alt="{caption}">'
                f"<figcaption>{caption}</figcaption></figure>")

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """np.asarray(picture) is its radiance."""
        return np.array(self.radiance, dtype) if copy else np.asarray(self.radiance, dtype)

"""Compares two pictures: how far apart they are, and whether noise alone explains it."""
from __future__ import annotations

import json
import os
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Union

from ._error import Error
from ._job import run
from ._options import texts
from ._picture import Picture

File = Union[str, "os.PathLike[str]"]
Source = Union[File, Picture]


@dataclass(frozen=True)
class Comparison:
    """The difference of picture a from the reference b."""
    error: float                     # root mean square difference of luminance, as a fraction of b's mean luminance
    error_of_noise: float | None  # the part that noise alone explains; None: a picture has no standard errors
    rmse: float
    relmse: float
    mape: float
    psnr: float | None            # in dB; None: the pictures are equal
    flip: float                      # how different they look: 0 is equal, 1 is as different as possible
    ssim: float | None            # structural similarity, 1 is equal; None: the pictures are smaller than its windows
    p: float | None               # probability that noise alone makes so large a difference; None: neither picture has standard errors
    differ: bool                     # by more than noise, or, without standard errors, by more than rounding
    report: dict[str, Any] = field(repr=False, compare=False)  # everything that `eclat compare --json` reports

    def __str__(self) -> str:
        verdict = "more than noise explains" if self.differ and self.p is not None else "different" if self.differ else \
            "no more than noise explains" if self.p is not None else "equal but for rounding"
        return f"{100 * self.error:.3g} % apart, {verdict}" + ("" if self.p is None else f" (p = {self.p:.2g})")


def file_of(picture: Source, folder: str, name: str) -> str:
    if not isinstance(picture, Picture):
        return os.fspath(picture)
    path = Path(folder, name)
    picture.save(path)
    return str(path)


def compare(a: Source, b: Source, *, diff: File | None = None, html: File | None = None, mask: File | None = None, tonemap: str | None = None,
            exposure: float | None = None, fit_exposure: bool = False, estimate_noise: bool = False) -> Comparison:
    """Compares a with the reference b: pictures, or files, also from other renderers: EXR, Radiance, PNG, JPEG, WebP. diff: a .png to write, a map of
    the error. html: a page to write, with both pictures. mask: a picture that is white where they are compared. Other options are those of
    `eclat compare`."""
    named = {"diff": diff, "html": html, "mask": mask, "tonemap": tonemap, "exposure": exposure, "fit_exposure": fit_exposure, "estimate_noise": estimate_noise}
    with tempfile.TemporaryDirectory(prefix="eclat-") as folder:
        result = run("compare", [file_of(a, folder, "a.exr"), file_of(b, folder, "b.exr")], [("json", None), *texts("compare", named)])
    report = json.loads(result.reports[-1])
    for picture, side in ((a, "a"), (b, "b")):
        if isinstance(picture, Picture) and picture.stderr is not None and not report[side]["standard_errors"]:
            raise Error(f"the option channels of picture {side} leaves out stderr, without which noise counts as a difference; add 'stderr' to it", "usage")
    test = report.get("noise_test") or {}
    return Comparison(report["error"], report.get("error_of_noise"), report["rmse"], report["relmse"], report["mape"], report["psnr"],
                      report["flip"], report["ssim"], test.get("p"), bool(report["differ"]), report)

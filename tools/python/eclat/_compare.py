"""Two pictures side by side: how far apart they are, and whether noise alone explains it."""
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

Source = Union[str, "os.PathLike[str]", Picture]


@dataclass(frozen=True)
class Comparison:
    """Of a against the reference b."""
    error: float                     # root mean square difference of luminance, as a fraction of b's mean luminance
    error_of_noise: float | None  # what noise alone makes of it; None: a picture without standard errors
    rmse: float
    relmse: float
    mape: float
    psnr: float | None            # in dB; None: the pictures are equal
    p: float | None               # that noise alone makes so large a difference; None: neither picture has standard errors
    differ: bool                     # by more than noise, or, without standard errors, by more than rounding
    report: dict[str, Any] = field(repr=False, compare=False)  # everything that `eclat compare --json` tells

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


def compare(a: Source, b: Source, *, diff: str | os.PathLike[str] | None = None) -> Comparison:
    """Compares a with the reference b: pictures, or .exr files, those of other renderers too. diff: a .png to be written, a map of the error."""
    with tempfile.TemporaryDirectory(prefix="eclat-") as folder:
        result = run("compare", [file_of(a, folder, "a.exr"), file_of(b, folder, "b.exr")], [("json", None), *texts("compare", {"diff": diff})])
    report = json.loads(result.reports[-1])
    for picture, side in ((a, "a"), (b, "b")):
        if isinstance(picture, Picture) and picture.stderr is not None and not report[side]["standard_errors"]:
            raise Error(f"the option channels of picture {side} leaves out stderr, without which noise counts as a difference; add 'stderr' to it", "usage")
    test = report.get("noise_test") or {}
    return Comparison(report["error"], report.get("error_of_noise"), report["rmse"], report["relmse"], report["mape"], report["psnr"],
                      test.get("p"), bool(report["differ"]), report)

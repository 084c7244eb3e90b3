"""Failures and warnings of the library as Python exceptions and warnings."""
from __future__ import annotations

from . import _library as lib


class Error(Exception):
    """What failed, where, and how to fix it, in one line. kind: "usage" (an option or argument is wrong), "host memory", "device memory", "device"
    or "other"."""

    def __init__(self, text: str, kind: str = "other") -> None:
        super().__init__(text)
        self.kind = kind


class Warning(UserWarning):
    """What a picture lacks, or what was done instead of what was asked for."""


def check(code: int, err: lib.eclat_error) -> None:
    if code != lib.OK:
        raise Error(err.text.decode(errors="replace"), "usage" if code == lib.USAGE else lib.ERROR_KINDS[err.kind])

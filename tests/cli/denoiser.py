"""Intel's Open Image Denoise for tests: ECLAT_OIDN, or the system's, or PyPI's, fetched once into the build folder."""
import ctypes
import os
import unittest

from pypi import fetch

PACKAGE = "pyoidn==2.5.1.0"


def is_of_system():
    try:
        ctypes.CDLL("libOpenImageDenoise.so.2")
    except OSError:
        return False
    return True


def environment():
    """What eclat needs to find it; skips where it cannot be had."""
    if os.environ.get("ECLAT_OIDN") or is_of_system():
        return {}
    return {"ECLAT_OIDN": os.path.join(fetch("oidn", PACKAGE, "--no-deps"), "pyoidn")}  # the library alone is used


def environment_or_none():
    """For tests of which most go without."""
    try:
        return {"ECLAT_OIDN": os.environ["ECLAT_OIDN"]} if os.environ.get("ECLAT_OIDN") else environment()
    except unittest.SkipTest:
        return {}

"""Finds Intel's Open Image Denoise for tests: in ECLAT_OIDN, in the system, or from PyPI, downloaded once into the build folder."""
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
    """The environment variables by which eclat finds the library. Skips the test where there is none."""
    if os.environ.get("ECLAT_OIDN") or is_of_system():
        return {}
    return {"ECLAT_OIDN": os.path.join(fetch("oidn", PACKAGE, "--no-deps"), "pyoidn")}  # no dependencies: only the library is used


def environment_or_none():
    """For modules most of whose tests need no library: None where there is none."""
    try:
        return {"ECLAT_OIDN": os.environ["ECLAT_OIDN"]} if os.environ.get("ECLAT_OIDN") else environment()
    except unittest.SkipTest:
        return {}

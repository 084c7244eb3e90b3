"""Intel's Open Image Denoise for tests: ECLAT_OIDN, or the system's, or PyPI's, fetched once into the build folder."""
import ctypes
import fcntl
import os
import subprocess
import sys
import unittest

from support import ECLAT

PACKAGE = "pyoidn==2.5.1.0"


def is_of_system():
    try:
        ctypes.CDLL("libOpenImageDenoise.so.2")
    except OSError:
        return False
    return True


def fetch():
    """Its folder, without what it depends on: the library alone is used."""
    folder = os.path.join(os.path.dirname(os.path.abspath(ECLAT)), "tests", "oidn")
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "lock"), "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        found = os.path.join(folder, "pyoidn")
        if not os.path.isdir(found):
            done = subprocess.run([sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--target", folder, PACKAGE], capture_output=True,
                                  encoding="utf-8", errors="replace", stdin=subprocess.DEVNULL, timeout=600, check=False)
            if done.returncode:
                lines = (done.stdout + done.stderr).strip().splitlines()
                raise unittest.SkipTest("no Open Image Denoise: pip: " + (lines[-1] if lines else f"exit code {done.returncode}"))
        return found


def environment():
    """What eclat needs to find it; skips where it cannot be had."""
    if os.environ.get("ECLAT_OIDN") or is_of_system():
        return {}
    return {"ECLAT_OIDN": fetch()}


def environment_or_none():
    """For tests of which most go without."""
    try:
        return {"ECLAT_OIDN": os.environ["ECLAT_OIDN"]} if os.environ.get("ECLAT_OIDN") else environment()
    except unittest.SkipTest:
        return {}

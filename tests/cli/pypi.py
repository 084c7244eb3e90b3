"""Downloads packages from PyPI that tests read files with, once, into the build folder."""
import fcntl
import os
import subprocess
import sys
import unittest

from support import ECLAT, SOURCE


def fetch(name, package, *options):
    """Returns the folder that has the package. options: pip's. Skips the test where pip cannot get it."""
    folder = os.path.join(os.path.dirname(os.path.abspath(ECLAT)) if os.path.dirname(ECLAT) else os.path.join(SOURCE, "build"), "tests", name)
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "lock"), "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        there = os.path.join(folder, "there")
        if not os.path.exists(there):
            done = subprocess.run([sys.executable, "-m", "pip", "install", "-q", *options, "--target", folder, package], capture_output=True, encoding="utf-8",
                                  errors="replace", stdin=subprocess.DEVNULL, timeout=600, check=False)
            if done.returncode:
                lines = (done.stdout + done.stderr).strip().splitlines()
                raise unittest.SkipTest(f"no {package}: pip: " + (lines[-1] if lines else f"exit code {done.returncode}"))
            with open(there, "w", encoding="utf-8"):
                pass
        return folder

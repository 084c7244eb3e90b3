"""Makes a wheel of this build, and virtual environments that have the wheel but nothing of the build or the source."""
import fcntl
import glob
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

from support import ECLAT, ENVIRONMENT, SOURCE

BUILD = os.path.dirname(os.path.abspath(ECLAT))
PROJECT = os.path.join(SOURCE, "tools", "python")


def last_line(run):
    lines = [line for line in (run.stdout + run.stderr).splitlines() if line.strip()]
    return lines[-1].strip() if lines else f"exit code {run.returncode}"


def run(*words, env=None, cwd=None):
    return subprocess.run(words, env=env or ENVIRONMENT, cwd=cwd, capture_output=True, encoding="utf-8", errors="replace", timeout=1800,
                          stdin=subprocess.DEVNULL)


def outside(**more):
    """Environment variables of a user who has neither the build nor the source, and has chosen no driver."""
    names = ("PYTHONPATH", "LD_LIBRARY_PATH", "OCL_ICD_VENDORS", "OPENCL_VENDOR_PATH", "ECLAT", "ECLAT_SOURCE_DIR", "ECLAT_DEVICE")
    kept = {name: value for name, value in ENVIRONMENT.items() if name not in names}
    return dict(kept, PYTHONNOUSERSITE="1", PIP_DISABLE_PIP_VERSION_CHECK="1", **more)


class Environment:
    """A virtual environment in a folder of its own."""

    def __init__(self, case):
        self.folder = tempfile.mkdtemp(prefix="eclat-python-")
        case.addClassCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        made = run(sys.executable, "-m", "venv", self.folder)
        if made.returncode:
            raise unittest.SkipTest("no virtual environments, as by python3-venv: " + last_line(made))
        self.python = self.program("python")

    def program(self, name):
        return os.path.join(self.folder, "bin", name)

    def pip(self, *words):
        """Skips where the packages cannot be downloaded. tools/python must not fail for another reason."""
        done = run(self.program("pip"), *words, env=outside(ECLAT_BUILD=BUILD))
        if done.returncode and "tools/python:" not in done.stdout + done.stderr:
            raise unittest.SkipTest(f"pip {words[0]}: {last_line(done)}")
        assert done.returncode == 0, done.stdout + done.stderr

    def packages(self):
        """Returns the folder of the installed packages."""
        return run(self.python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))", env=outside()).stdout.strip()


def inputs():
    """Files from which the wheel is made."""
    yield from (os.path.join(BUILD, name) for name in ("libeclat.so", "eclat", "eclat-compile"))
    yield from (os.path.join(SOURCE, name) for name in ("CMakeLists.txt", "host/lib/install.cmake", "host/include/eclat/eclat.h"))
    for folder, _, names in sorted(os.walk(PROJECT)):
        yield from (os.path.join(folder, name) for name in sorted(names) if not name.endswith(".pyc"))


def digest():
    found = hashlib.sha256()
    for path in inputs():
        with open(path, "rb") as file:
            found.update(file.read())
    return found.hexdigest()[:16]


def make(environment):
    """Returns the path of a wheel, made once for all tests of this build."""
    wheels = os.path.join(BUILD, "tests", "wheels")
    os.makedirs(wheels, exist_ok=True)
    with open(os.path.join(wheels, "lock"), "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        out = os.path.join(wheels, digest())
        if not glob.glob(os.path.join(out, "*.whl")):
            environment.pip("wheel", "-q", "--no-deps", "-w", out, PROJECT)
        path, = glob.glob(os.path.join(out, "*.whl"))
        return path


def run_tests(case, environment, file, **env):
    """Runs tests/python/FILE with the Python of an environment; its eclat command is compared with the library."""
    path = os.path.join(SOURCE, "tests", "python", file)
    helpers = os.path.join(SOURCE, "tests", "cli")
    done = run(environment.python, path, "-v", cwd=environment.folder,
               env=outside(ECLAT=os.path.abspath(ECLAT), ECLAT_SOURCE_DIR=os.path.abspath(SOURCE), ECLAT_TEST_HELPERS=helpers, **env))
    case.assertEqual(done.returncode, 0, done.stdout + done.stderr)
    case.assertRegex(done.stderr, r"Ran [1-9]")

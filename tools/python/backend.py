"""Makes the wheel: hatchling adds the Python package, tools/build builds the library and programs, and auditwheel adds the shared libraries that not
every Linux has. $ECLAT_BUILD names the build folder, relative to the root of the repository; what is already built there is used again."""
from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import option_types
from hatchling import build as hatchling
from hatchling.builders.hooks.plugin.interface import BuildHookInterface

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BUILD = ROOT / os.environ.get("ECLAT_BUILD", "build")
# The parts of what `cmake --install` installs that go into the package, all in one folder, where the linker finds them.
PARTS = ["bin/eclat", "**/eclat-compile", "**/libeclat.so.0"]
# Besides linked libraries: Debian packages that are compiled in, and whose licence must be passed on.
COMPILED_IN = ["libjs-chart.js", "libtinygltf-dev", "nlohmann-json3-dev"]


def run(*command: str | Path, **options: Any) -> str:
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, encoding="utf-8", check=False, **options)
    if done.returncode:
        sys.exit(f"tools/python: {Path(command[0]).name} failed with exit code {done.returncode}")
    return done.stdout


class BuiltParts(BuildHookInterface):  # type: ignore[type-arg]
    """Puts the library and the programs into the package."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        self.installed = tempfile.TemporaryDirectory(prefix="eclat-wheel-")
        prefix = Path(self.installed.name)
        run(ROOT / "tools" / "build", "eclat", "libeclat", env=dict(os.environ, ECLAT_BUILD=str(BUILD), ECLAT_TOOL="tools/python"))
        run("cmake", "--install", BUILD, "--prefix", prefix)
        for part in PARTS:
            path, = prefix.glob(part)
            build_data["force_include"][str(path.resolve())] = f"eclat/{path.name}"
        hints = prefix / "option_types.py"
        hints.write_text(option_types.write(HERE / "eclat", next(prefix.glob("**/libeclat.so.0"))), encoding="utf-8")
        build_data["force_include"][str(hints)] = "eclat/_option_types.py"
        build_data["pure_python"] = False
        build_data["tag"] = "py3-none-linux_x86_64"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        self.installed.cleanup()


def package_of(library: str) -> str:
    """Returns the Debian package that a library is from."""
    return run("dpkg-query", "-S", f"*/{library}").split(":")[0]


def add_licences(wheel: Path) -> None:
    """Adds eclat's licence, those of the libraries that auditwheel has put into the wheel, and those of what is compiled in."""
    folder = next(wheel.glob("*.dist-info")) / "licenses"
    bundled = folder / "bundled"
    bundled.mkdir(parents=True)
    shutil.copy(ROOT / "LICENSE", folder)
    if not shutil.which("dpkg-query"):
        print("tools/python: this is not Debian, so the wheel lacks the licences of the libraries in it; add them before you distribute it", file=sys.stderr)
        return
    libraries = [re.sub(r"-[0-9a-f]{8}(?=\.so)", "", path.name) for path in (wheel / "eclat.libs").iterdir()]
    for package in sorted({*map(package_of, libraries), *COMPILED_IN}):
        shutil.copy(Path("/usr/share/doc", package, "copyright"), bundled / package)


def build_wheel(wheel_directory: str, config_settings: dict[str, Any] | None = None, metadata_directory: str | None = None) -> str:
    with tempfile.TemporaryDirectory(prefix="eclat-wheel-") as work:
        plain, whole = Path(work, "plain"), Path(work, "whole")
        name = hatchling.build_wheel(str(plain), config_settings, metadata_directory)
        tools = dict(os.environ, PATH=os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]]))
        run(sys.executable, "-m", "auditwheel", "repair", "--wheel-dir", whole, plain / name, env=tools)
        run(sys.executable, "-m", "wheel", "unpack", "--dest", whole, *whole.glob("*.whl"))
        tree = next(path for path in whole.iterdir() if path.is_dir())
        add_licences(tree)
        run(sys.executable, "-m", "wheel", "pack", "--dest-dir", wheel_directory, tree)
        return next(whole.glob("*.whl")).name


def build_sdist(sdist_directory: str, config_settings: dict[str, Any] | None = None) -> str:
    raise UnsupportedOperation("the source of eclat is its repository; make a wheel there with `pip wheel tools/python`")


class UnsupportedOperation(Exception):
    """The exception that PEP 517 requires if there is no source distribution."""


get_requires_for_build_wheel = hatchling.get_requires_for_build_wheel

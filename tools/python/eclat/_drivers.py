"""Tells the OpenCL loader about the implementation of the extra eclat[cpu], which pip has installed, besides the drivers of the system. Tells eclat
about the denoiser of the extra eclat[denoise]."""
from __future__ import annotations

import hashlib
import os
import tempfile
from importlib import metadata, util
from pathlib import Path

SYSTEM = Path("/etc/OpenCL/vendors")
# If one of them is set, the user has chosen the drivers.
CHOICES = ("OCL_ICD_VENDORS", "OPENCL_VENDOR_PATH", "OCL_ICD_FILENAMES")


def find_runtime() -> Path | None:
    """Returns Intel's runtime for CPUs; it finds its own parts beside itself."""
    try:
        files = metadata.files("intel-opencl-rt") or []
    except metadata.PackageNotFoundError:
        return None
    places = [Path(str(file.locate())).resolve() for file in files if file.name == "libintelocl.so"]
    return next((place for place in places if place.exists()), None)


def write_folder(files: dict[str, str], parent: Path) -> Path:
    """Returns a folder with these files. Its name is their digest, so that an existing one need not be checked."""
    folder = parent / hashlib.sha256(repr(sorted(files.items())).encode()).hexdigest()[:16]
    if not folder.is_dir():
        parent.mkdir(parents=True, exist_ok=True)
        new = Path(tempfile.mkdtemp(prefix="new-", dir=parent))
        for name, text in files.items():
            (new / name).write_text(text, encoding="utf-8")
        try:
            new.rename(folder)
        except OSError:  # another process was first
            for name in files:
                (new / name).unlink()
            new.rmdir()
    return folder


def announce_denoiser() -> None:
    """Sets ECLAT_OIDN of this process to where pip has put Open Image Denoise, unless it is set. It is read when a picture is denoised."""
    found = util.find_spec("pyoidn")
    if found is not None and found.origin and not os.environ.get("ECLAT_OIDN"):
        os.environ["ECLAT_OIDN"] = str(Path(found.origin).parent)


def announce() -> None:
    """Sets OCL_ICD_VENDORS of this process to a folder with all drivers, unless the user has chosen drivers or there is no runtime to add. The
    loader looks there when a device is first requested."""
    announce_denoiser()
    runtime = find_runtime()
    if runtime is None or any(os.environ.get(name) for name in CHOICES):
        return
    files = {file.name: file.read_text(encoding="utf-8", errors="surrogateescape") for file in SYSTEM.glob("*.icd")}
    files["~intel-opencl-rt.icd"] = f"{runtime}\n"
    cache = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    try:
        folder = write_folder(files, Path(cache, "eclat", "drivers"))
    except OSError:  # there is no home folder to write to
        folder = write_folder(files, Path(tempfile.gettempdir(), f"eclat-drivers-{os.getuid()}"))
    os.environ["OCL_ICD_VENDORS"] = str(folder)

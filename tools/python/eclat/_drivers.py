"""Shows the OpenCL loader the implementation of the extra eclat[cpu], which lies where pip has put it, beside the drivers of the system; and eclat
the denoiser of the extra eclat[denoise]."""
from __future__ import annotations

import hashlib
import os
import tempfile
from importlib import metadata, util
from pathlib import Path

SYSTEM = Path("/etc/OpenCL/vendors")
# Who sets one of them has chosen the drivers.
CHOICES = ("OCL_ICD_VENDORS", "OPENCL_VENDOR_PATH", "OCL_ICD_FILENAMES")


def find_runtime() -> Path | None:
    """Intel's runtime for processors; it finds its own parts beside itself."""
    try:
        files = metadata.files("intel-opencl-rt") or []
    except metadata.PackageNotFoundError:
        return None
    places = [Path(str(file.locate())).resolve() for file in files if file.name == "libintelocl.so"]
    return next((place for place in places if place.exists()), None)


def write_folder(files: dict[str, str], parent: Path) -> Path:
    """A folder with these files, whose name is their digest, so that one that is there needs no other look."""
    folder = parent / hashlib.sha256(repr(sorted(files.items())).encode()).hexdigest()[:16]
    if not folder.is_dir():
        parent.mkdir(parents=True, exist_ok=True)
        new = Path(tempfile.mkdtemp(prefix="new-", dir=parent))
        for name, text in files.items():
            (new / name).write_text(text, encoding="utf-8")
        try:
            new.rename(folder)
        except OSError:  # somebody else was first
            for name in files:
                (new / name).unlink()
            new.rmdir()
    return folder


def announce_denoiser() -> None:
    """Sets ECLAT_OIDN of this process to where pip has put Open Image Denoise, unless it was chosen; looked at when a picture is denoised."""
    found = util.find_spec("pyoidn")
    if found is not None and found.origin and not os.environ.get("ECLAT_OIDN"):
        os.environ["ECLAT_OIDN"] = str(Path(found.origin).parent)


def announce() -> None:
    """Sets OCL_ICD_VENDORS of this process to a folder with all drivers, unless drivers were chosen or there is no runtime to add. The loader
    looks there when the first device is asked for."""
    announce_denoiser()
    runtime = find_runtime()
    if runtime is None or any(os.environ.get(name) for name in CHOICES):
        return
    files = {file.name: file.read_text(encoding="utf-8", errors="surrogateescape") for file in SYSTEM.glob("*.icd")}
    files["~intel-opencl-rt.icd"] = f"{runtime}\n"
    cache = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    try:
        folder = write_folder(files, Path(cache, "eclat", "drivers"))
    except OSError:  # no home to write to
        folder = write_folder(files, Path(tempfile.gettempdir(), f"eclat-drivers-{os.getuid()}"))
    os.environ["OCL_ICD_VENDORS"] = str(folder)

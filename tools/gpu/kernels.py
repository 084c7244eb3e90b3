"""The kernels of a render as eclat hands them to an OpenCL driver: sources with their options."""
import glob
import os
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BUILD = os.environ.get("ECLAT_BUILD", os.path.join(ROOT, "build"))
ECLAT = os.environ.get("ECLAT", os.path.join(BUILD, "eclat"))
SMALL = ["--size", "16x16", "--spp", "1", "-q"]

# What --every renders: as few programs as contain everything. Only twolevel has instances; elsewhere they are written out.
EVERY = [["--integrator", "path", "--accel", accel] for accel in ("bvh2", "bvh8", "grid", "kdtree", "none", "twolevel")] + \
        [["--integrator", "whitted", "--accel", "bvh2"], ["--integrator", "raster"]]


# Options that only the driver of this machine gets (host/cl/workarounds.c).
OF_POCL = {"-D_OPENCL_H_", "-DEC_OWN_BUILTINS"}


class NoKernels(Exception):
    pass


class Source:
    """A file, its name in messages, and the list of its build options."""

    def __init__(self, path, label):
        with open(path, encoding="utf-8") as file:
            first = file.readline()
        self.path, self.label = path, label
        self.options = [option for option in first.removeprefix("// options: ").split() if option not in OF_POCL]


def of_scene(words, folder):
    """Returns one source for each lane width. words: SCENE and options."""
    run = os.path.join(folder, str(len(os.listdir(folder))))
    environment = dict(os.environ, ECLAT_DUMP_KERNELS=run, ECLAT_COMPILE="first", XDG_CACHE_HOME=os.path.join(folder, "cache"))
    environment.setdefault("ECLAT_DEVICE_TYPE", "gpu")
    try:
        done = subprocess.run([ECLAT, "render", words[0], *SMALL, *words[1:], "-o", run + ".exr"], env=environment, capture_output=True,
                              encoding="utf-8", errors="replace", stdin=subprocess.DEVNULL, check=False)
    except OSError as error:
        raise NoKernels(f"cannot run {ECLAT}: {error.strerror}; tools/build builds it") from error
    found = sorted(glob.glob(os.path.join(run, "*.cl")))
    if done.returncode or not found:
        raise NoKernels((done.stderr.strip().splitlines() or ["eclat has compiled nothing"])[-1])
    name = " ".join([os.path.splitext(os.path.basename(words[0]))[0], *words[1:]])
    return [Source(path, f"{os.path.basename(path)} of {name}") for path in found]


def every(words, folder):
    return [source for options in EVERY for source in of_scene([*words, "--effects", "all", *options], folder)]

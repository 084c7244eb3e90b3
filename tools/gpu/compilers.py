"""Finds the compilers: those of the system, else those in BUILD/gpu-compilers, into which missing ones are downloaded."""
import fcntl
import glob
import os
import shutil
import subprocess
import sys

from kernels import BUILD

FOLDER = os.path.join(BUILD, "gpu-compilers")
PTXAS = "nvidia-cuda-nvcc-cu12==12.9.86"
CLANG = ["clang-15", "libclang-common-15-dev", "libclang-cpp15", "libllvm15", "libclc-15", "libclc-15-dev"]
PACKAGES = {
    "clang": CLANG,
    "libclc": CLANG,
    "llvm-spirv": ["llvm-spirv-15", "libllvmspirvlib15"],
    "spirv-val": ["spirv-tools"],
    "ocloc": ["intel-opencl-icd", "libigc1", "libigdfcl1", "libigdgmm12", "libopencl-clang14", "libllvmspirvlib14", "libllvm14"],
}
NEEDS = {"sm": ["clang", "libclc", "ptxas"], "gfx": ["clang", "libclc"], "spirv": ["clang", "llvm-spirv", "spirv-val"], "intel": ["ocloc"]}


def needs_of(target):
    return next((NEEDS[kind] for kind in NEEDS if target.startswith(kind)), NEEDS["intel"])


class Tools:
    """Paths of the tools that are there, and the environment that they run in."""

    def __init__(self):
        self.paths = {}
        bin_ = os.path.join(FOLDER, "usr", "bin")
        libraries = glob.glob(os.path.join(FOLDER, "usr", "lib", "*-linux-gnu"))
        self.environment = dict(os.environ, LD_LIBRARY_PATH=os.pathsep.join(libraries + [os.environ.get("LD_LIBRARY_PATH", "")]).strip(os.pathsep))
        for tool, program in [("clang", "clang-15"), ("llvm-spirv", "llvm-spirv-15"), ("spirv-val", "spirv-val"), ("ocloc", "ocloc")]:
            self.paths[tool] = shutil.which(program) or shutil.which(program, path=bin_)
        self.paths["ptxas"] = os.environ.get("PTXAS") or shutil.which("ptxas") or \
            next(iter(glob.glob(os.path.join(FOLDER, "nvidia", "*", "bin", "ptxas"))), None)
        self.paths["libclc"] = next((folder for folder in ("/usr/lib/clc", os.path.join(FOLDER, "usr", "lib", "clc"))
                                     if os.path.exists(os.path.join(folder, "nvptx64--nvidiacl.bc"))), None)

    def lacks(self, names):
        return [name for name in names if not self.paths[name]]

    def run(self, tool, *arguments):
        return subprocess.run([self.paths[tool], *arguments], env=self.environment, capture_output=True, encoding="utf-8", errors="replace",
                              stdin=subprocess.DEVNULL, check=False)


def last_line(run):
    return ((run.stdout + run.stderr).strip().splitlines() or [f"exit code {run.returncode}"])[-1]


def call(command, why):
    """Runs a command. Returns '' or why it failed."""
    try:
        run = subprocess.run(command, cwd=FOLDER, capture_output=True, encoding="utf-8", errors="replace", stdin=subprocess.DEVNULL, check=False)
    except OSError as error:
        return f"{why}: {command[0]}: {error.strerror}"
    return f"{why}: {last_line(run)}" if run.returncode else ""


def fetch_debian(packages):
    for package in packages:
        trouble = call(["apt-get", "download", "-q", package], f"cannot fetch {package}")
        for file in sorted(glob.glob(os.path.join(FOLDER, "*.deb"))):
            trouble = trouble or call(["dpkg", "-x", file, FOLDER], f"cannot unpack {package}")
            os.remove(file)
        if trouble:
            return trouble
    return ""


def fetch(tool):
    if tool == "ptxas":
        return call([sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--target", FOLDER, PTXAS], f"cannot fetch {PTXAS}")
    return fetch_debian(PACKAGES[tool])


def find(names, say):
    """Returns (Tools, {target: why it is not available})."""
    why = {}
    wanted = sorted({tool for target in names for tool in needs_of(target)})
    os.makedirs(FOLDER, exist_ok=True)
    with open(os.path.join(FOLDER, "lock"), "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        for tool in Tools().lacks(wanted):
            if os.environ.get("ECLAT_SKIP_INSTALL"):
                why[tool] = f"there is no {tool}, and ECLAT_SKIP_INSTALL is set"
            elif Tools().lacks([tool]):  # else it came with another one
                say(f"fetching {tool} into {FOLDER}")
                why[tool] = fetch(tool) or f"there is no {tool}"
    tools = Tools()
    lacks = {target: tools.lacks(needs_of(target)) for target in names}
    return tools, {target: why[missing[0]] for target, missing in lacks.items() if missing}

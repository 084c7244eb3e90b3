"""Runs eclat with one fault injected by fault_shim.c, and checks the files that it leaves."""
import concurrent.futures
import os
import shutil
import struct
import subprocess
import tempfile
import zlib

from support import ECLAT, ENVIRONMENT, Case, eclat, quad_scene, read_exr, write_gltf

SHIM = os.environ["ECLAT_FAULT_SHIM"]
OPTIONS = ["--size", "8x8", "--max-depth", "3"]  # batches of one sample each, up to 16 samples


def spread(count, most):
    """Numbers 1 … count; if there are more than `most`, that many of them, first and last included."""
    if count <= most:
        return list(range(1, count + 1))
    return sorted({1 + round(i * (count - 1) / (most - 1)) for i in range(most)})


def at_once(function, jobs):
    """Runs two at a time, since a tiny render mostly waits for a thread to start. Raises the first exception."""
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        return list(pool.map(lambda job: function(*job), jobs))


def check_png(path):
    with open(path, "rb") as file:
        data = file.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "not a PNG file"
    at, kind = 8, b""
    while kind != b"IEND":
        size, = struct.unpack_from(">I", data, at)
        kind = data[at + 4:at + 8]
        assert zlib.crc32(data[at + 4:at + 8 + size]) == struct.unpack_from(">I", data, at + 8 + size)[0], "damaged"
        at += 12 + size
    assert at == len(data), "something behind the end"


class FaultCase(Case):
    def setUp(self):
        super().setUp()
        if os.access("/dev/shm", os.W_OK):  # files are flushed to disk, which may take longer than the renders
            self.folder = tempfile.mkdtemp(prefix="eclat-robust-", dir="/dev/shm")
            self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.scene = write_gltf(self.path("quad.gltf"), quad_scene()[0])
        os.mkdir(self.path("old"))
        for name in ["a.exr", "a.png"]:
            with open(self.path("old", name), "w", encoding="utf-8") as file:
                file.write("the file of yesterday")

    def new_folder(self, name, old=True):
        folder = self.path(name)
        if old:
            shutil.copytree(self.path("old"), folder)
        else:
            os.mkdir(folder)
        return folder

    def prepare(self, name, *options, spp=4, old=True, quiet=True, env=None, **faults):
        """Returns (arguments, environment, folder) of a render into a folder of its own. old: the folder has files with the outputs' names."""
        folder = self.new_folder(name, old)
        environment = dict({"LD_PRELOAD": SHIM, "FAULT_FOLDER": folder + "/", "FAULT_COUNTS": folder + ".counts"}, **(env or {}))
        environment.update({"FAULT_" + key.upper(): str(value) for key, value in faults.items()})
        outputs = ["-o", os.path.join(folder, "a.exr"), "-o", os.path.join(folder, "a.png")]
        return ["render", self.scene, *OPTIONS, *["--quiet"] * quiet, "--spp", str(spp), *outputs, *options], environment, folder

    def run_with(self, name, *options, **more):
        """Runs such a render; returns (result, folder)."""
        arguments, environment, folder = self.prepare(name, *options, **more)
        return eclat(*arguments, env=environment, timeout=600), folder

    def start(self, name, *options, **more):
        """Starts such a render as the leader of a process group; returns (process, folder)."""
        arguments, environment, folder = self.prepare(name, *options, **more)
        process = subprocess.Popen([ECLAT, *arguments], env=dict(ENVIRONMENT, **environment), stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8", start_new_session=True)
        return process, folder

    def no_cache(self):
        """Environment without any compiled kernels."""
        return {"XDG_CACHE_HOME": self.path("nothing-compiled")}

    def count_calls(self, *options, **more):
        """Counts the calls of a render without a fault."""
        run, folder = self.run_with("counted", *options, **more)
        self.assertEqual(self.check_files(folder), {"a.exr": "new", "a.png": "new"}, run.stderr)
        return self.counts(folder)

    @staticmethod
    def counts(folder):
        """Counts the calls of the render into this folder."""
        with open(folder + ".counts", encoding="utf-8") as file:
            return {call: int(count) for call, count in (line.split() for line in file)}

    def check_files(self, folder):
        """Returns {name: "old" or "new"}. Fails if a file is neither the old one nor complete, or if there is another file."""
        found = {}
        for name in sorted(os.listdir(folder)):
            path = os.path.join(folder, name)
            self.assertIn(name, ["a.exr", "a.png"], "left behind")
            with open(path, "rb") as file:
                if file.read(64) == b"the file of yesterday":
                    found[name] = "old"
                    continue
            check_png(path) if name == "a.png" else read_exr(path)
            found[name] = "new"
        return found

    def check_error(self, run):
        """Checks exit code 1 and one line that tells what to do; lines of a compiler's log may follow it."""
        self.assertEqual(run.returncode, 1, run.stderr)
        lines = [line for line in run.stderr.splitlines() if not line.startswith("  ")]
        self.assertEqual(len(lines), 1, run.stderr)
        self.assertTrue(lines[0].startswith("eclat: error: "), lines[0])
        self.assertLess(len(lines[0]), 700)
        self.assertIn("; ", lines[0])
        return lines[0]

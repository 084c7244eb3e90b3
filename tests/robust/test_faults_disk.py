# tiers: quick, full
"""Full and failing disks, and processes killed while they write: the old file or the complete new one remains, nothing else."""
import json
import os
import resource
import shutil
import subprocess
import unittest

from faults import FaultCase, at_once, spread
from support import CORNELL, ECLAT, ENVIRONMENT, eclat, read_exr
from tiers import full

ENOSPC, EIO, SIGKILL = 28, 5, 9
CALLS = ["open", "pwrite", "write", "fsync", "close", "linkat", "rename"]
NAMED = {"no_tmpfile": 1}  # as on a file system where every file has a name


@full
class Calls(FaultCase):
    def each_call(self, most, variants):
        """Yields (call, n, before, named). before: there are files with the outputs' names; named: the temporary file has a name."""
        for old, named in variants:
            counts = self.count_calls(old=old, **(NAMED if named else {}))
            shutil.rmtree(self.path("counted"))
            for call in CALLS:
                for n in spread(counts.get(call, 0), most):
                    yield call, n, old, named

    def fail(self, call, n, old, named):
        code = ENOSPC if n % 2 else EIO
        run, folder = self.run_with(f"{call}{n}{old}{named}", old=old, call=call, at=n, code=code, **(NAMED if named else {}))
        with self.subTest(call=call, n=n, old=old, named=named):
            files = self.check_files(folder)
            if run.returncode == 0:  # there was another way, or only flushing the folder failed
                self.assertIn(call, ["open", "close", "fsync"])
                self.assertEqual(files, {"a.exr": "new", "a.png": "new"})
            else:
                self.assertRegex(self.check_error(run), rf"cannot write '{folder}/a\.(exr|png)': .*; ")
                self.assertNotEqual(files, {"a.exr": "new", "a.png": "new"})
        return call, run.returncode

    def test_a_call_that_fails(self):
        met = at_once(self.fail, self.each_call(4, [(True, False), (False, False), (True, True)]))
        for call in CALLS:
            self.assertIn((call, 1), met)

    def kill(self, call, n, old, named):
        run, folder = self.run_with(f"{call}{n}{old}{named}", old=old, call=call, at=n, signal=SIGKILL, **(NAMED if named else {}))
        with self.subTest(call=call, n=n, old=old, named=named):
            self.assertEqual(run.returncode, -SIGKILL)
            strays = [name for name in os.listdir(folder) if name not in ["a.exr", "a.png"]]
            for name in strays:
                self.assertRegex(name, r"^\.eclat-\d+-[0-9a-f]{8}\.tmp$")
                os.remove(os.path.join(folder, name))
            if not named:  # except while a nameless file replaces another
                self.assertTrue(not strays or call == "rename", strays)
            self.check_files(folder)
            return len(strays)

    def test_killed_as_it_writes(self):
        strays = at_once(self.kill, self.each_call(6, [(True, False), (False, True)]))
        self.assertGreater(len(strays), 40)
        self.assertGreater(sum(strays), 5)  # temporary files with names stay


class Disks(FaultCase):
    """Renders on file systems of their own, where user namespaces or root allow that."""

    def in_mount(self, mount, *options, stdout=subprocess.PIPE):
        """Renders into a folder that the shell command `mount` prepares; copies the folder's contents out afterwards."""
        inside, outside = self.path("inside"), self.path("outside")
        for folder in [inside, outside]:
            shutil.rmtree(folder, ignore_errors=True)
            os.mkdir(folder)
        script = f'in=$1; out=$2; shift 2; {{ {mount}; }} || exit 77; "$@"; code=$?; cp -a "$in/." "$out"; exit $code'
        command = [ECLAT, "render", CORNELL, "--size", "64x64", "--spp", "4", "--channels", "all", "--quiet", "-o", inside + "/a.exr", "-o", inside + "/a.png"]
        run = subprocess.run(["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", script, "sh", inside, outside, *command, *options],
                             env=ENVIRONMENT, stdin=subprocess.DEVNULL, stdout=stdout, stderr=subprocess.PIPE, encoding="utf-8", timeout=600)
        if run.returncode == 77 or "unshare:" in run.stderr:
            self.skipTest("no mounts here: " + run.stderr)
        return run, outside

    def test_a_disk_too_small(self):
        run, outside = self.in_mount('mount -t tmpfs -o size=64k none "$in" && cp old/a.exr "$in" 2>/dev/null || echo yesterday >"$in/a.exr"')
        self.assertEqual(run.returncode, 1)
        self.assertRegex(run.stderr, r"(?m)^eclat: warning: '.*/a.exr' may need up to .*, but its disk has .* left$")
        self.assertRegex(run.stderr, r"(?m)^eclat: error: cannot write '.*/a.exr': No space left on device; free some space or choose another disk$")
        self.assertEqual(len(run.stderr.splitlines()), 2, run.stderr)
        with open(outside + "/a.exr", encoding="utf-8") as file:
            self.assertEqual(file.read(), "yesterday\n")
        self.assertEqual(sorted(os.listdir(outside)), ["a.exr", "a.png"])  # the PNG had room

    def test_a_read_only_disk_is_noticed_before_the_render(self):
        run, outside = self.in_mount('mount --bind "$in" "$in" && mount -o remount,bind,ro "$in"', "--spp", "1000000")
        self.assertIn("Read-only file system; choose a file and folder that you may write to", self.check_error(run))
        self.assertEqual(os.listdir(outside), [])

    def test_a_limit_on_the_size_of_files(self):
        big = ["render", CORNELL, "--size", "512x512", "--spp", "2", "--quiet", "-o"]
        self.assert_ok(eclat(*big, self.path("a.png")))  # compiles the kernels, which PoCL writes to files
        run = eclat(*big, self.path("a.exr"), preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4 << 20, 4 << 20)))
        self.assertRegex(self.check_error(run), r"a.exr': File too large; raise the limit on the size of files \(ulimit -f\)")
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.png", "old", "quad.gltf"])

    def test_a_limit_where_no_driver_catches_its_signal(self):
        """LLVM, which PoCL contains, catches SIGXFSZ; eclat must not depend on that."""
        self.assert_ok(eclat("render", self.scene, "--size", "8x8", "--spp", "2", "-o", self.path("a.exr")))
        run = eclat("compare", self.path("a.exr"), self.path("a.exr"), "--diff", self.path("map.png"),
                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20, 20)))
        self.assertRegex(self.check_error(run), r"map.png': File too large; raise the limit")
        self.assertFalse(os.path.exists(self.path("map.png")))

    def test_what_cannot_be_written_is_noticed_before_the_render(self):
        with open(self.path("file"), "w", encoding="utf-8"):
            pass
        for place in ["missing/a.exr", "old.exr/", "file/a.exr", "folder.exr"]:
            if place == "folder.exr":
                os.mkdir(self.path(place))
            run, _ = self.run_with(place.replace("/", "_") + "_run", "-o", self.path(place), spp=1000000)
            with self.subTest(place=place):
                self.assertIn(place, run.stderr)
                self.assertIn(run.returncode, [1, 2])
                self.assertEqual(len(run.stderr.splitlines()), 1)
                with open(self.path(place.replace("/", "_") + "_run.counts"), encoding="utf-8") as file:
                    self.assertNotIn("clCreateContext", file.read())

    def test_a_report_that_finds_no_room(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            run = eclat("render", self.scene, "--size", "8x8", "--spp", "2", "--json", "--quiet", "-o", self.path("a.exr"), stdout=full)
        self.assertEqual([run.returncode, len(run.stderr.splitlines())], [1, 1])
        self.assertIn("cannot write the result to standard output: No space left on device", run.stderr)
        read_exr(self.path("a.exr"))


if __name__ == "__main__":
    unittest.main()

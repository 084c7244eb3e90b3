# tiers: quick, full
"""A picture in strips whose render is stopped or killed, or meets a full disk: complete strips or nothing, never an incomplete file."""
import json
import os
import re
import shutil
import signal
import tempfile
import unittest

from faults import FaultCase, at_once
from support import eclat, read_exr
from tiers import full

ENOSPC, SIGINT, SIGKILL = 28, int(signal.SIGINT), int(signal.SIGKILL)
SIDE = 448  # large enough for more than two strips, however much memory the process needs besides
TALL = ["--channels", "all", "--size", f"{SIDE}x{SIDE}"]


class Strips(FaultCase):
    """The first test makes shared data: the whole picture, the memory of a few strips, and counts of calls."""
    memory, calls = None, None

    @classmethod
    def setUpClass(cls):
        cls.whole = tempfile.mkdtemp(prefix="eclat-robust-")
        cls.addClassCleanup(shutil.rmtree, cls.whole, ignore_errors=True)

    def setUp(self):
        super().setUp()
        if Strips.memory:
            return
        run, folder = self.run_with("whole", *TALL, spp=2)
        self.assertEqual(run.returncode, 0, run.stderr)
        shutil.copytree(folder, self.whole, dirs_exist_ok=True)
        run, _ = self.run_with("least", *TALL, "--memory", "1M", spp=2)
        # the memory of the process itself varies by 2 MB
        Strips.memory = ["--memory", f"{int(re.search(r'give ([0-9]+)M', run.stderr).group(1)) + 4}M"]

    def in_strips(self, name, *options, **faults):
        return self.run_with(name, *TALL, *self.memory, *options, spp=2, **faults)

    def count_in_strips(self):
        if Strips.calls:
            return Strips.calls
        run, folder = self.in_strips("counted", "--json")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertGreater(json.loads(run.stdout)["strips"], 2)
        Strips.calls = self.counts(folder)
        return Strips.calls

    def test_killed_at_any_write(self):
        counts = self.count_in_strips()

        def kill(call, n):
            run, folder = self.in_strips(f"{call}{n}", call=call, at=n, signal=SIGKILL)
            self.assertEqual(run.returncode, -SIGKILL)
            self.assertEqual(self.check_files(folder), {"a.exr": "old", "a.png": "old"})
        at_once(kill, [("pwrite", n) for n in {1, 2, 5, counts["pwrite"] // 2, counts["pwrite"]}])

    def test_a_disk_that_is_full_spoils_one_file_only(self):
        counts = self.count_in_strips()
        for call, n, bad, good in [("pwrite", counts["pwrite"] // 2, "a.exr", "a.png"), ("write", 1, "a.png", "a.exr")]:
            run, folder = self.in_strips(call, call=call, at=n, code=ENOSPC)
            self.assertRegex(self.check_error(run), rf"cannot write '{folder}/{bad}': No space left on device; ")
            self.assertEqual(self.check_files(folder), {bad: "old", good: "new"})
            with open(os.path.join(folder, good), "rb") as one, open(os.path.join(self.whole, good), "rb") as other:
                self.assertTrue(good == "a.exr" or one.read() == other.read())

    @full
    def test_a_disk_that_is_full_ends_the_render_where_no_file_is_left(self):
        counts = self.count_in_strips()
        arguments, environment, folder = self.prepare("full", *TALL, *self.memory, spp=2, call="pwrite", at=counts["pwrite"] // 2, code=ENOSPC)
        png = arguments.index(os.path.join(folder, "a.png"))
        run = eclat(*arguments[:png - 1], *arguments[png + 1:], env=environment)
        self.assertRegex(self.check_error(run), rf"error: cannot write '{folder}/a.exr': No space left on device; ")
        self.assertEqual(self.check_files(folder), {"a.exr": "old", "a.png": "old"})

    @full
    def test_ctrl_c_keeps_the_strips_that_are_complete(self):
        counts = self.count_in_strips()
        _, whole = read_exr(os.path.join(self.whole, "a.exr"))
        kept = set()

        def stop(n):
            run, folder = self.in_strips(f"stop{n}", "--json", call="pwrite", at=n, signal=SIGINT)
            files = self.check_files(folder)
            self.assertEqual((run.returncode, files), (0, {"a.exr": "new", "a.png": "new"}), run.stderr)
            attributes, planes = read_exr(os.path.join(folder, "a.exr"))
            report = json.loads(run.stdout)
            rows = [planes["samples"][SIDE * y:SIDE * (y + 1)] for y in range(SIDE)]
            done = sum(row == [2.0] * SIDE for row in rows)
            kept.add(done)
            self.assertTrue(rows[done:] == [[0.0] * SIDE] * (SIDE - done))
            self.assertEqual(done % 16, 0)
            for name in ["R", "G", "B", "stderr.R", "stderr.Y", "A", "albedo.R", "depth.Z"]:
                self.assertTrue(planes[name][:SIDE * done] == whole[name][:SIDE * done], name)
                self.assertEqual(set(planes[name][SIDE * done:]), {0.0} if done < SIDE else set(), name)
            if done == SIDE:
                return
            self.assertEqual(set(planes["heavy"][SIDE * done:]), {1.0})
            self.assertGreater(min(planes["high95.R"][SIDE * done:]), 1e38)
            self.assertEqual(set(planes["low95.G"][SIDE * done:]), {0.0})
            self.assertEqual((attributes["eclat.stoppedBy"], report["stopped_by"]), ("user", "user"))
            self.assertEqual((attributes["eclat.error"], report["error"], report["relmse"]), (float("inf"), None, None))
            self.assertRegex(run.stderr, rf"warning: the strips from row {done} on are incomplete")
        at_once(stop, [(n,) for n in [2, 3, counts["pwrite"] // 4, counts["pwrite"] // 3]])
        self.assertTrue(any(0 < done < SIDE for done in kept), kept)

    def test_ctrl_c_in_the_first_strip_leaves_nothing(self):
        run, folder = self.in_strips("first", call="clEnqueueReadBuffer", at=1, signal=SIGINT)
        self.assertEqual((run.returncode, run.stderr), (1, "eclat: error: interrupted before there was a picture; nothing is written\n"))
        self.assertEqual(self.check_files(folder), {"a.exr": "old", "a.png": "old"})

    def test_a_device_that_fails_leaves_what_is_complete(self):
        counts = self.count_in_strips()
        run, folder = self.in_strips("device", call="clEnqueueMapBuffer", at=counts["clEnqueueMapBuffer"] * 2 // 3, code=-5)
        self.assertEqual(run.returncode, 1)
        self.assertRegex(run.stderr, r"\Aeclat: warning: the strips from row \d+ on are incomplete.*\n"
                         rf"eclat: error: the render failed after \d+ of {SIDE} rows: .*; the picture so far is written\n\Z")
        self.assertEqual(self.check_files(folder), {"a.exr": "new", "a.png": "new"})
        attributes, planes = read_exr(os.path.join(folder, "a.exr"))
        self.assertEqual(attributes["eclat.stoppedBy"], "device")
        self.assertEqual(set(planes["samples"]), {0.0, 2.0})


if __name__ == "__main__":
    unittest.main()

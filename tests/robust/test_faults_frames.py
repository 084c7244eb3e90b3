# tier: full
"""An OpenCL call or a write fails once during a sequence: at most one frame is lost, no file is damaged, and the same command makes the
missing frames, to the same bits."""
import json
import os
import unittest

from faults import FaultCase, at_once, spread
from support import eclat, read_exr
from test_motion import GLOW, GREY, Builder

FRAMES = 4
CALLS = ["clEnqueueNDRangeKernel", "clCreateBuffer", "clEnqueueReadBuffer", "clEnqueueMapBuffer", "clEnqueueWriteBuffer", "clCreateKernel", "clFinish"]


class Frames(FaultCase):
    most = 5

    def setUp(self):
        super().setUp()
        b = Builder()
        b.add(GREY, scale=[4, 4, 4], translation=[0, 0, -1])
        b.animate(b.add(GLOW), "translation", [(-1, 0, 0), (1, 0, 0)])
        b.camera(2)
        self.scene = b.write(self.path("slide.gltf"))
        run, folder, counts = self.sequence("whole")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.counts, self.wanted = counts, self.hashes(folder)
        self.assertEqual(len(self.wanted), FRAMES)

    def new_folder(self, name, old=True):
        folder = self.path(name)
        os.makedirs(folder, exist_ok=True)
        return folder

    def sequence(self, name, **faults):
        """Returns (result, folder, counts of calls)."""
        arguments, environment, folder = self.prepare(name, old=False, **faults)
        arguments = arguments[:arguments.index("-o")] + ["--frames", f"0:{FRAMES - 1}", "--json", "-o", os.path.join(folder, "f.%d.exr")]
        run = eclat(*arguments, env=environment, timeout=600)
        with open(folder + ".counts", encoding="utf-8") as file:
            return run, folder, {call: int(count) for call, count in (line.split() for line in file)}

    def hashes(self, folder):
        return {name: read_exr(os.path.join(folder, name))[0]["eclat.imageSha256"] for name in os.listdir(folder)}

    def fail_once(self, call, n):
        run, folder, _ = self.sequence(f"{call}{n}", call=call, at=n, code=-5)
        with self.subTest(call=call, n=n):
            there = self.hashes(folder)
            for name, sha in there.items():
                self.assertEqual(sha, self.wanted[name], name)
            if run.returncode == 0:
                self.assertEqual(len(there), FRAMES)
                return 0
            rows = [json.loads(line) for line in run.stdout.splitlines()]
            states = [row.get("state") for row in rows[:-1]]
            if rows:
                self.assertEqual((states.count("failed"), states.count("rendered")), (1, FRAMES - 1), run.stderr)
                self.assertEqual(len(there), FRAMES - 1)
            again, _, _ = self.sequence(f"{call}{n}")
            self.assertEqual(again.returncode, 0, again.stderr)
            self.assertEqual(self.hashes(folder), self.wanted)
            return len(rows) and 1 + states.index("failed")

    def test_one_call_fails(self):
        jobs = [(call, n) for call in CALLS for n in spread(self.counts.get(call, 0), self.most)]
        self.assertGreater(len(jobs), 20)
        failed = set(at_once(self.fail_once, jobs))
        self.assertGreaterEqual(failed, {1, 2, 3, 4})  # each frame was lost once


if __name__ == "__main__":
    unittest.main()

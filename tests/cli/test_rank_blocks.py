# tier: full
"""Ranks with short batches send the sum of 128 or 2048 batches instead of each batch; the bits stay the same. Skips without mpirun, or
where eclat was built without MPI."""
import json
import os
import signal
import unittest

import test_ranks
from polling import GUARD, poll_writes
from support import CORNELL, Case, eclat, read_exr

SIZE = ["--size", "8x8"]
# Batches are quick and the job is long: a block of 8192 samples, from the 6144th on, must be done within 3 s for ranks to take it, and two
# of its pieces, which are as large here, must be done before the rest.
JOB = [CORNELL, *SIZE, "--max-depth", "1"]
MANY = [*JOB, "--spp", "300000"]  # the last batch is cut
PIXELS = 8 * 8


def bytes_of_each(report):
    """Bytes that reached rank 0 for a pixel of 64 samples that another rank took; most batches have 64."""
    return 64 * report["received_bytes"] / (PIXELS * report["other_ranks_samples_per_pixel"])


class RankBlocks(Case):
    rendered, render = test_ranks.Ranks.rendered, test_ranks.Ranks.render
    render_with = test_ranks.Ranks.render_with
    start = test_ranks.Ranks.start
    wait_for = test_ranks.Ranks.wait_for

    @classmethod
    def setUpClass(cls):
        if why := test_ranks.without_mpi():
            raise unittest.SkipTest(why)

    def render_on(self, ranks, *job, env=None):
        run = self.assert_ok(test_ranks.mpirun(ranks, "render", *job, "--json", "-q", "-o", self.path("b.exr"), env=env))
        return json.loads(run.stdout), read_exr(self.path("b.exr"))[1]

    def assert_same(self, one, other):
        self.assertEqual({key: one[0][key] for key in test_ranks.RESULT}, {key: other[0][key] for key in test_ranks.RESULT})
        self.assertEqual(one[1], other[1])

    def test_traffic(self):
        """A batch sent alone has 24 bytes a pixel; a sum of 128 batches has 108 / 128 for each. The first and the last batches are sent
        alone, and all others until the ranks know their pace."""
        job = [*MANY[:-1], "1200000"]  # long enough to go on after the last rank has begun
        whole = self.render(*job)
        report, planes = self.render_on(5, *job, env={"ECLAT_RANK_FANOUT": "2"})
        self.assert_same(whole, (report, planes))
        self.assertGreater(report["other_ranks_samples_per_pixel"], 8192)
        self.assertLess(bytes_of_each(report), 24 / 1.5)

    def test_first_hits(self):
        """A denoiser needs first hits of all samples: 32 more bytes a pixel for each batch, and twice that for each sum."""
        job = [*MANY[:-1], "1200000", "--denoise=atrous", "--channels", "all"]
        whole = self.render(*job)
        report, planes = self.render_on(3, *job)
        self.assert_same(whole, (report, planes))
        self.assertLess(bytes_of_each(report), 56 / 1.5)

    def test_until_an_error(self):
        """One certain batch ends the job, wherever batches were rendered. The error is looked at when all replicates have a quarter of a power
        of two, and no block goes beyond such a point. From 32768 samples on, 128 batches or more lie between two looks."""
        past = self.render(*JOB, "--spp", "49152")[0]["error_bound"]
        job = [*JOB, "--adaptive=off", "--error", f"{100 * past}%"]
        whole = self.render(*job)
        self.assertEqual(whole[0]["stopped_by"], "error")
        self.assertGreater(whole[0]["samples_per_pixel"], 32768)
        self.assertEqual(whole[0]["samples_per_pixel"] % 8192, 0)
        self.assert_same(whole, self.render_on(3, *job))
        kept = self.path("kept.exr")
        self.render_on(3, *job, "--spp", "523", "--checkpoint", kept)
        self.assertEqual(whole[0]["image_sha256"], self.render_on(2, "--resume", kept, "--error", f"{100 * past}%", "--spp", "4000000")[0]["image_sha256"])

    def test_resume(self):
        """A job is stopped again and again, at any batch, and resumed on other numbers of ranks."""
        job, kept = [*MANY[:-1], "600000"], self.path("kept.exr")
        whole = self.render(*job)
        now, stops = job, 0
        for ranks in [2, 3]:
            process = self.start(ranks, *now, "--checkpoint", kept, "--every", "0.1s", "-q", "-o", self.path("b.exr"))
            poll_writes(kept, process, 4)
            stops += process.poll() is None
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=GUARD)
            now = ["--resume", kept]
        self.assertGreater(stops, 0)
        self.assert_same(whole, self.render_on(3, "--resume", kept))

    def test_several_devices(self):
        job = [*MANY, "--device", "all"]
        env = {"POCL_DEVICES": "basic basic"}
        whole = self.render(*MANY)
        self.assert_same(whole, self.render_on(2, *job, env=env))

    def test_a_device_that_fails(self):
        """A device fails in the middle of a block: others take over its piece."""
        if "ECLAT_FAULT_SHIM" not in os.environ:
            self.skipTest("no ECLAT_FAULT_SHIM")
        fault = f"LD_PRELOAD={os.environ['ECLAT_FAULT_SHIM']} FAULT_CALL=clEnqueueNDRangeKernel FAULT_AT=2500 FAULT_LOST=1"
        run = self.render_with(fault, MANY, {"ECLAT_RANK_FANOUT": "1"})  # the render continues with the last rank
        self.assertRegex(run.stderr, "warning: from rank 1: .* has failed, and the others take over its work: .*CL_OUT_OF_RESOURCES")

    def test_a_rank_that_is_killed(self):
        """With a launcher that keeps the others alive, they see at once that the rank has ended, even those behind it in a chain, and take
        over its piece."""
        job = [*MANY[:-1], "600000"]
        whole = self.render(*job)
        process = self.start(3, *job, "--checkpoint", self.path("kept.exr"), "--every", "0.3s", "--json", "-o", self.path("b.exr"),
                             launcher=["--enable-recovery", "-x", "ECLAT_RANK_FANOUT=1"], env=test_ranks.NEVER_LOST)
        self.wait_for(self.path("kept.exr"), process)
        os.kill(test_ranks.Ranks.ranks_of(self, process)[1], signal.SIGKILL)
        output, error = process.communicate(timeout=GUARD)
        self.assertIn("rank 1 is lost", error)
        self.assertEqual(whole[0]["image_sha256"], json.loads(output)["image_sha256"])

    def test_a_limit_of_time(self):
        report, _ = self.render_on(3, *JOB, "--time", "1.5s", env=test_ranks.NEVER_LOST)
        self.assertEqual(report["stopped_by"], "time")
        whole, _ = self.render(*JOB, "--spp", str(report["samples_per_pixel"]))
        self.assertEqual(whole["image_sha256"], report["image_sha256"])

    def test_a_plan(self):
        """The model includes blocks, except at the beginning and the end, and where a block takes long, as it does for a picture of one row
        of tiles."""
        plan = json.loads(self.assert_ok(eclat("render", CORNELL, "--size", "20x18", "--wave", "4096", "--spp", "16000000", "--plan", "1000", "--json", "-q")).stdout)
        rows = {row["ranks"]: row for row in plan["plan"]}
        self.assertEqual(rows[1]["received_bytes"], 0)
        each = {ranks: row["received_bytes"] / (20 * 18 * plan["batches"] * (1 - 1 / ranks)) for ranks, row in rows.items() if ranks > 1}
        self.assertLess(each[8], 24 / 2.5)
        self.assertGreaterEqual(min(each.values()), 108 / 2048)
        self.assertLessEqual(max(each.values()), 24)
        self.assertGreater(plan["add_block_seconds"], 0)
        slow = json.loads(self.assert_ok(eclat("render", CORNELL, "--size", "256x256", "--spp", "64", "--plan", "4", "--json", "-q")).stdout)
        self.assertAlmostEqual(slow["plan"][1]["received_bytes"], 256 * 256 * 24 * 32 / 2, delta=1)


if __name__ == "__main__":
    unittest.main()

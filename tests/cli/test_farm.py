"""The scripts for Slurm and for machines reached by ssh, with stand-ins for both: the bits of one render."""
import os
import signal
import subprocess
import time
import unittest

from support import CORNELL, ECLAT, ENVIRONMENT, SOURCE, Case, eclat, read_exr

SIZE = ["--size", "20x18"]
JOB = ["--spp", "48", "--batch", "4"]


class Farm(Case):
    def setUp(self):
        super().setUp()
        self.environment = dict(ENVIRONMENT, ECLAT=os.path.abspath(ECLAT), BATCH="4")

    def run_script(self, name, *arguments, **environment):
        return subprocess.run([os.path.join(SOURCE, "tools", "farm", name), *arguments], cwd=self.folder, stdin=subprocess.DEVNULL,
                              env=dict(self.environment, **environment), capture_output=True, encoding="utf-8", timeout=300)

    def assert_one_render(self, path):
        self.assert_ok(eclat("render", CORNELL, *SIZE, *JOB, "-q", "-o", self.path("whole.exr")))
        self.assertEqual(read_exr(self.path("whole.exr"))[1], read_exr(path)[1])

    def task(self, number, tasks=5, **more):
        return self.run_script("array.sbatch", CORNELL, "48", *SIZE, SLURM_ARRAY_TASK_ID=str(number), SLURM_ARRAY_TASK_COUNT=str(tasks), **more)

    def test_an_array_job(self):
        for number in [3, 0, 4, 1]:
            self.assert_ok(self.task(number))
        self.assert_ok(self.task(2, tasks=1, TASKS="5"))  # submitted again, alone
        slices = sorted(os.listdir(self.folder))
        self.assertEqual(slices, ["cornell-box.0-8.exr", "cornell-box.16-28.exr", "cornell-box.28-36.exr", "cornell-box.36-48.exr", "cornell-box.8-16.exr"])
        self.assert_ok(eclat("merge", *map(self.path, slices), "-q", "-o", self.path("all.exr")))
        self.assert_one_render(self.path("all.exr"))

    def test_a_task_that_is_run_again(self):
        big = [CORNELL, "8000", "--size", "64x64", "--max-depth", "3"]
        process = subprocess.Popen([os.path.join(SOURCE, "tools", "farm", "array.sbatch"), *big, "--every", "0.05s"], cwd=self.folder,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   env=dict(self.environment, SLURM_ARRAY_TASK_ID="1", SLURM_ARRAY_TASK_COUNT="2"))
        kept = self.path("cornell-box.4000-8000.checkpoint.exr")
        deadline = time.monotonic() + 60
        while not os.path.exists(kept) and time.monotonic() < deadline:
            time.sleep(0.02)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(60), 143)
        self.assertEqual(os.listdir(self.folder), [os.path.basename(kept)])
        before = max(read_exr(kept)[1]["samples"])
        self.assertGreater(before, 0)
        resumed = self.run_script("array.sbatch", *big, SLURM_ARRAY_TASK_ID="1", SLURM_ARRAY_TASK_COUNT="2", ECLAT=self.wrapper())
        self.assert_ok(resumed)
        self.assertIn("--resume cornell-box.4000-8000.checkpoint.exr", resumed.stdout)

    def wrapper(self):
        """Says what it was asked for, and writes what a render would have."""
        path = self.path("wrapper")
        with open(path, "w", encoding="utf-8") as file:
            file.write('#!/bin/sh\necho "$@"\nfor last; do :; done\n: >"$last"\n')
        os.chmod(path, 0o755)
        return path

    def test_a_farm(self):
        with open(self.path("ssh"), "w", encoding="utf-8") as file:  # one of the machines is down
            file.write('#!/bin/sh\n[ "$1" != down ] || exit 255\nshift\nexec sh -c "$*"\n')
        os.chmod(self.path("ssh"), 0o755)
        run = self.run_script("farm", "here down there", CORNELL, "48", "all.exr", *SIZE, FARM_SSH=self.path("ssh"), SLICES="5")
        self.assert_ok(run)
        self.assertIn("farm: down failed at samples", run.stderr)
        self.assert_one_render(self.path("all.exr"))
        os.remove(self.path("all.exr"))
        run = self.run_script("farm", "down", CORNELL, "48", "all.exr", *SIZE, FARM_SSH=self.path("ssh"), SLICES="2")
        self.assertEqual(run.returncode, 1)
        self.assertIn("farm: no machine could render a slice", run.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)), ["ssh", "whole.exr"])


if __name__ == "__main__":
    unittest.main()

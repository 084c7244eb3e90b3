# tier: quick
"""The scripts for Slurm and for machines reached by ssh, with stand-ins for both: the picture has the bits of one render."""
import glob
import os
import signal
import subprocess
import unittest

from polling import GUARD, poll_writes
from support import CORNELL, ECLAT, ENVIRONMENT, SOURCE, Case, eclat, read_alike, read_exr

SIZE = ["--size", "20x18"]
JOB = ["--spp", "47"]  # the last batch, 44:48, is cut


class Farm(Case):
    def setUp(self):
        super().setUp()
        self.environment = dict(ENVIRONMENT, ECLAT=os.path.abspath(ECLAT), STEP="8")

    def run_script(self, name, *arguments, **environment):
        return subprocess.run([os.path.join(SOURCE, "tools", "farm", name), *arguments], cwd=self.folder, stdin=subprocess.DEVNULL,
                              env=dict(self.environment, **environment), capture_output=True, encoding="utf-8", timeout=GUARD)

    def assert_one_render(self, path):
        self.assert_ok(eclat("render", CORNELL, *SIZE, *JOB, "--channels", "all", "-q", "-o", self.path("whole.exr")))
        self.assertEqual(*read_alike(self.path("whole.exr"), path))

    def task(self, number, tasks=5, **more):
        return self.run_script("array.sbatch", CORNELL, "47", *SIZE, SLURM_ARRAY_TASK_ID=str(number), SLURM_ARRAY_TASK_COUNT=str(tasks), **more)

    def test_an_array_job(self):
        for number in [3, 0, 4, 1]:
            self.assert_ok(self.task(number))
        self.assert_ok(self.task(2, tasks=1, TASKS="5"))  # this task is submitted again, alone
        with open(self.path("cornell-box.8.checkpoint.exr"), "w", encoding="utf-8"):
            pass  # the checkpoint of a task that is to run again is no slice
        slices = sorted(os.path.basename(path) for path in glob.glob(self.path("cornell-box.*-*.exr")))
        self.assertEqual(slices, ["cornell-box.0-8.exr", "cornell-box.16-24.exr", "cornell-box.24-32.exr", "cornell-box.32-47.exr", "cornell-box.8-16.exr"])
        self.assert_ok(eclat("merge", *map(self.path, slices), "-q", "-o", self.path("all.exr")))
        self.assert_one_render(self.path("all.exr"))

    def test_numbers_that_are_no_tasks(self):
        for variables, says in [({"TASK_ID": "7", "TASK_COUNT": "1", "TASK_MIN": "7"}, "count from 0"),
                                ({"TASK_ID": "1", "TASK_COUNT": "16", "TASK_MIN": "1"}, "count from 0"),
                                ({"TASK_ID": "2", "TASK_COUNT": "2", "TASK_MIN": "0"}, "count from 0"), ({}, "a task of an array")]:
            run = self.run_script("array.sbatch", CORNELL, "47", **{"SLURM_ARRAY_" + key: value for key, value in variables.items()})
            self.assertEqual((run.returncode, run.stdout), (2, ""))
            self.assertIn(says, run.stderr)
        for arguments, says in [((CORNELL,), "usage:"), ((CORNELL, "--size"), "not a number of samples a pixel"),
                                ((CORNELL, "0"), "not a number of samples a pixel")]:
            self.assertIn(says, self.run_script("array.sbatch", *arguments, SLURM_ARRAY_TASK_ID="0", SLURM_ARRAY_TASK_COUNT="1").stderr)
        self.assertIn("name the program", self.task(0, ECLAT="no-such-eclat").stderr)
        self.assertEqual(os.listdir(self.folder), [])

    def test_a_task_that_is_run_again(self):
        """A task that is interrupted leaves a checkpoint. One that runs out of time also puts itself into the queue again."""
        big = [CORNELL, "8000000", "--size", "32x32", "--max-depth", "3"]
        task = {"SLURM_ARRAY_JOB_ID": "77", "SLURM_ARRAY_TASK_ID": "1", "SLURM_ARRAY_TASK_COUNT": "2"}
        kept, asked, before = self.path("cornell-box.4000000.checkpoint.exr"), self.path("asked"), 0
        self.program("scontrol", f'echo "$@" >{asked}')
        path = self.folder + ":" + os.environ["PATH"]
        # a task that goes on would write once a minute
        often = self.program("often", f"exec '{os.path.abspath(ECLAT)}' \"$@\" --every 0.1s")
        for number, code in [(signal.SIGTERM, 143), (signal.SIGUSR1, 0)]:
            process = subprocess.Popen([os.path.join(SOURCE, "tools", "farm", "array.sbatch"), *big], cwd=self.folder,
                                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                       env=dict(self.environment, ECLAT=often, PATH=path, **task))
            poll_writes(kept, process)
            process.send_signal(number)
            self.assertEqual(process.wait(GUARD), code)
            samples = sum(read_exr(kept)[1]["samples"])
            self.assertGreater(samples, before)
            before = samples
            self.assertEqual(os.path.exists(asked), number == signal.SIGUSR1)
            self.assertEqual(glob.glob(self.path("cornell-box.*-*.exr")) + glob.glob(self.path("*.part.exr")), [])
        with open(asked, encoding="utf-8") as file:
            self.assertEqual(file.read(), "requeue 77_1\n")
        wrapper = self.program("wrapper", 'echo "$@"; for last; do :; done; : >"$last"')  # writes a file in place of a render
        resumed = self.run_script("array.sbatch", *big, ECLAT=wrapper, **task)
        self.assert_ok(resumed)
        self.assertIn("--resume cornell-box.4000000.checkpoint.exr", resumed.stdout)
        self.assertEqual(glob.glob(self.path("cornell-box.*.exr")), [self.path("cornell-box.4000000-8000000.exr")])

    def test_time_that_is_too_short(self):
        """A task that has rendered nothing is not put into the queue for ever."""
        self.program("scontrol", "echo asked >&2")
        sleeper = self.program("sleeper", 'trap "exit 0" TERM; kill -USR1 $PPID; tail --pid=$$ -f /dev/null & wait')
        run = self.run_script("array.sbatch", CORNELL, "47", ECLAT=sleeper, PATH=self.folder + ":" + os.environ["PATH"], SLURM_ARRAY_JOB_ID="77",
                              SLURM_ARRAY_TASK_ID="0", SLURM_ARRAY_TASK_COUNT="1")
        self.assertEqual(run.returncode, 2)
        self.assertIn("give more --time", run.stderr)
        self.assertNotIn("asked", run.stderr)

    def program(self, name, script):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\n" + script + "\n")
        os.chmod(self.path(name), 0o755)
        return self.path(name)

    def test_a_farm(self):
        self.program("ssh", '[ "$1" != down ] || exit 255\nshift\nexec sh -c "$*"')  # one of the machines is down
        run = self.run_script("farm", "down here there", CORNELL, "47", "all.exr", *SIZE, FARM_SSH=self.path("ssh"), SLICES="5")
        self.assert_ok(run)
        self.assertIn("farm: down failed at samples", run.stderr)
        self.assert_one_render(self.path("all.exr"))
        os.remove(self.path("all.exr"))
        run = self.run_script("farm", "down", CORNELL, "47", "all.exr", *SIZE, FARM_SSH=self.path("ssh"), SLICES="2")
        self.assertEqual(run.returncode, 1)
        self.assertIn("farm: no machine could render a slice", run.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)), ["all.exr.farm", "ssh", "whole.exr"])

    def test_bad_arguments_leave_no_files(self):
        """Bad arguments are refused before any file is made that would disturb the right command."""
        wrong = [("", "47", {}, "no hosts"), (" ", "47", {}, "no hosts")]
        wrong += [("here", spp, {}, f"'{spp}' is not a number of samples") for spp in ["0", "00", "abc", "", "4.5"]]
        wrong += [("here", "47", {name: value}, name) for name, value in [("STEP", "0"), ("STEP", "8x"), ("SLICES", "x")]]
        for hosts, spp, variables, says in wrong:
            run = self.run_script("farm", hosts, CORNELL, spp, "all.exr", *SIZE, FARM_SSH="false", **variables)
            self.assertEqual((run.returncode, run.stdout), (1, ""), run.stderr)
            self.assertRegex(run.stderr, r"\Afarm: .*\n\Z")
            self.assertIn(says, run.stderr)
        self.assertEqual(os.listdir(self.folder), [])
        os.makedirs(self.path("all.exr.farm", "todo"))  # of an earlier command that failed: the new one begins again
        with open(self.path("all.exr.farm", "job"), "w", encoding="utf-8") as file:
            file.write("another\n")
        run = self.run_script("farm", "down", CORNELL, "47", "all.exr", *SIZE, FARM_SSH="false", SLICES="2")
        self.assertIn("farm: no machine could render a slice", run.stderr)
        self.assertEqual(len(os.listdir(self.path("all.exr.farm", "todo"))), 2)

    def test_a_farm_is_resumed(self):
        """The machine renders two slices and disappears; the same command renders the other three."""
        farm = ["farm", "here", CORNELL, "47", "all.exr", *SIZE, "--seed", "0"]
        stop = dict(FARM_SSH=self.path("ssh"), SLICES="5")
        self.program("ssh", 'shift\n[ ! -e gone ] || exit 255\necho >>rendered\n[ "$(wc -l <rendered)" != 2 ] || : >gone\nexec sh -c "$*"')
        self.assertEqual(self.run_script(*farm, **stop).returncode, 1)
        other = self.run_script(*farm[:-1], "1", **stop)
        self.assertIn("farm: all.exr.farm belongs to another job", other.stderr)
        os.remove(self.path("gone"))
        self.assert_ok(self.run_script(*farm, **stop))
        with open(self.path("rendered"), encoding="utf-8") as file:
            self.assertEqual(len(file.readlines()), 5)
        self.assert_one_render(self.path("all.exr"))
        self.assertFalse(os.path.exists(self.path("all.exr.farm")))


if __name__ == "__main__":
    unittest.main()

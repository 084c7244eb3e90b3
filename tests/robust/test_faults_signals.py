# tiers: quick, full
"""Signals at any moment: a picture of the complete batches, or the old file; never an incomplete one."""
import glob
import os
import random
import signal
import unittest

from faults import FaultCase, at_once, spread
from polling import GUARD, poll_until
from support import eclat, read_exr
from tiers import full

ENOUGH = ["--size", "24x24"]
INTERRUPTED = "eclat: error: interrupted before there was a picture; nothing is written\n"


class Signals(FaultCase):
    def at_random(self, count, numbers):
        """Calls from the first to slightly beyond the last of a render, with a signal for each."""
        dice = random.Random(20)
        counts = self.count_calls(*ENOUGH, spp=128)
        calls = dice.choices(list(counts), list(counts.values()), k=count)
        return [(i, call, dice.randrange(1, 2 + round(1.2 * counts[call])), dice.choice(numbers)) for i, call in enumerate(calls)]

    def send(self, i, call, n, number):
        run, folder = self.run_with(f"run{i}", *ENOUGH, spp=128, call=call, at=n, signal=int(number))
        return run.returncode, run.stderr, folder

    def check_interrupted(self, code, error, folder, number):
        files = self.check_files(folder)
        if code == 0:
            self.assertEqual([files, error], [{"a.exr": "new", "a.png": "new"}, ""])
            attributes, planes = read_exr(os.path.join(folder, "a.exr"))
            self.assertIn(attributes["eclat.stoppedBy"], ["user", "spp"])
            self.assertEqual(set(planes["samples"]), {float(attributes["eclat.samplesPerPixel"])})
            return "user" == attributes["eclat.stoppedBy"]
        self.assertIn((code, error), [(-number, ""), (1, INTERRUPTED)])
        self.assertEqual(files, {"a.exr": "old", "a.png": "old"})
        return code

    @full
    def test_asked_to_stop_at_random_calls(self):
        def stop(i, call, n, number):
            code, error, folder = self.send(i, call, n, number)
            with self.subTest(call=call, n=n, signal=number):
                return self.check_interrupted(code, error, folder, number)
        ends = at_once(stop, self.at_random(40, [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]))
        self.assertGreater(len(set(ends)), 1, ends)

    def test_asked_to_stop_at_any_call(self):
        counts = self.count_calls(*ENOUGH, spp=128)

        def stop(call, n, number):
            run, folder = self.run_with(f"{call}{n}", *ENOUGH, spp=128, call=call, at=n, signal=number)
            with self.subTest(call=call, n=n, signal=number):
                return self.check_interrupted(run.returncode, run.stderr, folder, number)
        calls = ["clGetDeviceInfo", "clCreateContext", "clBuildProgram", "clEnqueueNDRangeKernel", "clEnqueueReadBuffer", "pwrite"]
        ends = at_once(stop, [(call, n, signal.SIGINT) for call in calls for n in spread(counts[call], 4)])
        for end in [True, False]:  # a signal at the start may still kill the process: that depends on which thread is faster
            self.assertIn(end, ends)

    @full
    def test_killed_at_random_calls(self):
        def kill(i, call, n, number):
            code, _, folder = self.send(i, call, n, number)
            with self.subTest(call=call, n=n):
                for name in set(os.listdir(folder)) - {"a.exr", "a.png"}:
                    self.assertRegex(name, r"^\.eclat-\d+-[0-9a-f]{8}\.tmp$")
                    os.remove(os.path.join(folder, name))
                self.check_files(folder)
                self.assertIn(code, [0, -signal.SIGKILL])
                return code
        self.assertEqual(set(at_once(kill, self.at_random(40, [signal.SIGKILL]))), {0, -signal.SIGKILL})

    def test_the_second_signal_ends_even_a_device_that_hangs(self):
        hangs = self.path("it-hangs")
        process, folder = self.start("hangs", call="clEnqueueNDRangeKernel", at=30, hang=hangs)
        poll_until(lambda: os.path.exists(hangs), process)
        # SIGINT and SIGTERM arrive together: two requests to stop
        for number in [signal.SIGSTOP, signal.SIGINT, signal.SIGTERM, signal.SIGCONT]:
            process.send_signal(number)
        poll_until(lambda: not self.pending(process), process)
        self.assertIsNone(process.poll())
        poll_until(lambda: process.send_signal(signal.SIGTERM), process, pause=0.2)
        process.communicate(timeout=GUARD)
        self.assertEqual(process.returncode, -signal.SIGTERM)
        self.assertEqual(self.check_files(folder), {"a.exr": "old", "a.png": "old"})

    @staticmethod
    def pending(process):
        """Returns whether the process has signals that none of its threads has taken."""
        with open(f"/proc/{process.pid}/status", encoding="ascii") as file:
            return any(line.startswith("ShdPnd:") and int(line.split()[1], 16) for line in file)

    @staticmethod
    def children(process):
        found = []
        for path in glob.glob(f"/proc/{process.pid}/task/*/children"):
            try:
                with open(path, encoding="ascii") as file:
                    found += file.read().split()
            except OSError:
                pass
        return found

    def test_ctrl_c_while_the_driver_runs_a_program_of_its_own(self):
        """A terminal sends SIGINT to the linker that PoCL has started, too. PoCL calls abort() when it dies."""
        cache = self.path("cache")
        os.mkdir(cache)
        process, folder = self.start("links", "--accel", "bvh8", "--lanes", "1", env={"XDG_CACHE_HOME": cache, "POCL_CACHE_DIR": cache})
        children = poll_until(lambda: self.children(process), process, pause=0.002)
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGINT)
        _, error = process.communicate(timeout=GUARD)
        if not children and process.returncode == 0:
            self.skipTest("this driver starts no program")
        self.assertEqual([process.returncode, self.check_files(folder)], [0, {"a.exr": "new", "a.png": "new"}], error)

    def test_a_reader_that_is_gone(self):
        reader, writer = os.pipe()
        os.close(reader)
        arguments, environment, folder = self.prepare("pipe", quiet=False)
        run = eclat(*arguments, env=environment, stdout=writer)
        os.close(writer)
        self.assertEqual(run.returncode, 1)
        self.assertIn("eclat: error: cannot write the result to standard output: Broken pipe", run.stderr)
        self.assertEqual(self.check_files(folder), {"a.exr": "new", "a.png": "new"})


if __name__ == "__main__":
    unittest.main()

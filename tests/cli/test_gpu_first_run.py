# tiers: quick, full
"""tools/gpu_first_run, tried on a CPU that is treated as a graphics card."""
import os
import re
import signal
import subprocess
import sys
import unittest

from polling import poll_until
from support import ECLAT, ENVIRONMENT, SOURCE, Case
from tiers import full

TOOL = os.path.join(SOURCE, "tools", "gpu_first_run")


def run(*arguments, cwd=None, **environment):
    return subprocess.run([sys.executable, TOOL, *arguments], env=dict(ENVIRONMENT, **environment), capture_output=True, encoding="utf-8", cwd=cwd,
                          stdin=subprocess.DEVNULL, timeout=1800, check=False)


class FirstRun(Case):
    def read(self):
        with open(self.path("gpu-first-run.md"), encoding="utf-8") as file:
            return file.read()

    def test_wrong_usage_is_one_line(self):
        done = run("--nonsense")
        self.assertEqual((done.returncode, done.stdout, len(done.stderr.splitlines())), (2, "", 1), done.stderr)

    def test_without_a_device_it_still_writes_why(self):
        done = run("--quick", "--eclat", ECLAT, cwd=self.folder, OCL_ICD_VENDORS=self.folder)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("Failed: Devices.", done.stdout)
        self.assertIn("no OpenCL driver is installed", self.read())

    def test_what_is_known_is_written_before_what_may_hang(self):
        program = self.path("eclat")
        with open(program, "w", encoding="utf-8") as file:
            file.write(f'#!/bin/sh\ncase "$1" in selftest) exec tail -f /dev/null;; *) exec "{os.path.abspath(ECLAT)}" "$@";; esac\n')
        os.chmod(program, 0o755)
        command = [sys.executable, TOOL, "--quick", "--eclat", program]
        with subprocess.Popen(command, env=ENVIRONMENT, cwd=self.folder, stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True) as process:
            try:
                poll_until(lambda: os.path.exists(self.path("gpu-first-run.md")), process)
            finally:
                os.killpg(process.pid, signal.SIGKILL)
        text = self.read()
        self.assertIn("This did not finish; last in progress: self-test.", text)
        self.assertIn("## Devices", text)

    @full
    def test_a_processor_as_if_it_were_a_card(self):
        done = run("--quick", "--eclat", ECLAT, cwd=self.folder, ECLAT_DEVICE_TYPE="gpu")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        text = self.read()
        self.assertIn("Everything passed.", text)
        self.assertRegex(text, r"(?m)^ +\* +\d+ .* GPU ")
        self.assertRegex(text, r"all \d+ rows passed")
        self.assertEqual(len(re.findall(r"(?m)^\| [a-z-]+ \| same bits \| 0 % \|.* [\d.]+ ms of \d+ \|$", text)), 5)
        self.assertEqual(len(re.findall(r"(?m)^\| [a-z-]+ \| same bits \| \d+\.\d{3} \|$", text)), 2)
        self.assertEqual(os.listdir(self.folder), ["gpu-first-run.md"])


if __name__ == "__main__":
    unittest.main()

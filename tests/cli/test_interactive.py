# tier: quick
"""What a person at a terminal sees: the progress line, and Ctrl-C."""
import os
import pty
import re
import signal
import subprocess
import unittest

from polling import GUARD
from support import CORNELL, ECLAT, ENVIRONMENT, Case, eclat, png_size


class Progress(Case):
    def on_terminal(self, *options):
        """Runs with stderr on a pseudo-terminal; (exit code, stdout, stderr)."""
        master, slave = pty.openpty()
        process = subprocess.Popen([ECLAT, "render", CORNELL, *options], cwd=self.folder, env=ENVIRONMENT, stderr=slave,
                                   stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, encoding="utf-8")
        os.close(slave)
        shown = b""
        while True:
            try:
                piece = os.read(master, 4096)
            except OSError:  # Linux's way to say that the other side is closed
                break
            if not piece:
                break
            shown += piece
        os.close(master)
        return process.wait(timeout=GUARD), process.communicate()[0], shown.decode()

    def test_bar_on_a_terminal_and_gone_at_the_end(self):
        code, out, shown = self.on_terminal("--size", "64x64", "--time", "2")
        self.assertEqual(code, 0, shown)
        self.assertRegex(shown, r"\r(\[=* *\] )?\d+ %.* left.* spp .* samples/s  error ")
        self.assertTrue(re.search(r"\r +\r\Z", shown), repr(shown[-200:]))
        self.assertNotIn("\r", out)
        for line in re.findall(r"\r([^\r\n]*)(?=\r(?!\n))", shown): # what ends the line is a message
            self.assertLess(len(line), 80)

    def test_quiet_on_a_terminal(self):
        code, out, shown = self.on_terminal("--size", "16x16", "--spp", "8", "--quiet")
        self.assertEqual((code, out, shown), (0, "", ""))

    def test_no_bar_in_a_pipe(self):
        run = self.assert_ok(eclat("render", CORNELL, "--size", "32x32", "--time", "1", cwd=self.folder))
        self.assertNotIn("\r", run.stderr)
        for line in run.stderr.splitlines():
            self.assertTrue(line.startswith("eclat: "), line)
        self.assertRegex(run.stderr, r"(?m)^eclat: rendering 32x32 pixels on .* until 1 s$")


class Interrupt(Case):
    def start(self):
        """A render that would take a minute, under way."""
        process = subprocess.Popen(
            [ECLAT, "render", CORNELL, "--size", "64x64", "--time", "1m", "-o", "a.exr", "-o", "a.png"], cwd=self.folder,
            env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, encoding="utf-8")
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.kill)
        for line in process.stderr:
            if line.startswith("eclat: rendering"):
                return process
        self.fail("never began to render")

    def test_first_signal_stops_cleanly_and_writes_the_picture(self):
        for number in [signal.SIGINT, signal.SIGTERM]:
            with self.subTest(signal=number):
                process = self.start()
                process.send_signal(number)
                out, _ = process.communicate(timeout=GUARD)
                self.assertEqual(process.returncode, 0)
                self.assertIn("interrupted; this is the image so far", out)
                self.assertEqual(png_size(self.path("a.png")), (64, 64))
                self.assertEqual(sorted(os.listdir(self.folder)), ["a.exr", "a.png"])

    def test_signals_that_are_ignored_stay_ignored(self):
        run = eclat("render", CORNELL, "--size", "16x16", "--spp", "4", "-o", self.path("a.png"),
                    preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        self.assert_ok(run)


if __name__ == "__main__":
    unittest.main()

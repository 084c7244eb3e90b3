# tier: quick
"""Output on a terminal: the progress line, colours, and Ctrl-C."""
import os
import pty
import re
import signal
import subprocess
import unittest

from polling import GUARD
from support import CORNELL, ECLAT, ENVIRONMENT, Case, eclat, png_size


def on_terminal(*arguments, **settings):
    """Runs with stderr on a pseudo-terminal; returns (exit code, stdout, stderr)."""
    master, slave = pty.openpty()
    process = subprocess.Popen([ECLAT, *arguments], stderr=slave, stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, encoding="utf-8", **settings)
    os.close(slave)
    shown = b""
    while True:
        try:
            piece = os.read(master, 4096)  # a read may return part of one write
        except OSError:  # Linux reports the closed other side so
            break
        if not piece:
            break
        shown += piece
    os.close(master)
    return process.wait(timeout=GUARD), process.communicate()[0], shown.decode()


class Progress(Case):
    def on_terminal(self, *options):
        return on_terminal("render", CORNELL, *options, cwd=self.folder, env=ENVIRONMENT)

    def test_bar_on_a_terminal_and_gone_at_the_end(self):
        code, out, shown = self.on_terminal("--size", "64x64", "--time", "2")
        self.assertEqual(code, 0, shown)
        self.assertRegex(shown, r"\r(\[=* *\] )?\d+ %.* left.* spp .* samples/s  error ")
        self.assertTrue(re.search(r"\r +\r\Z", shown), repr(shown[-200:]))
        self.assertNotIn("\r", out)
        for line in re.findall(r"\r([^\r\n]*)(?=\r(?!\n))", shown):  # text before a line break is a message
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


class Colour(Case):
    """Only the words error, warning and note are coloured, and only on a terminal."""

    def on_terminal(self, *arguments, **env):
        environment = {name: value for name, value in ENVIRONMENT.items() if name not in ("NO_COLOR", "TERM")}
        code, _, shown = on_terminal(*arguments, env=dict(environment, **env))
        return code, shown.replace("\r\n", "\n")

    def test_an_error_is_red_on_a_terminal(self):
        code, shown = self.on_terminal("rendr", TERM="xterm")
        self.assertEqual(code, 2)
        self.assertTrue(shown.startswith("eclat: \033[1;31merror: \033[0munknown command"), repr(shown))
        self.assertEqual(shown.count("\033"), 2)

    def test_none_where_it_is_refused_or_unknown(self):
        plain = eclat("rendr").stderr
        self.assertNotIn("\033", plain)
        for env in ({"TERM": "xterm", "NO_COLOR": "1"}, {"TERM": "dumb"}):
            self.assertEqual(self.on_terminal("rendr", **env), (2, plain), env)
        # no-color.org: only a value that is not empty counts
        self.assertNotEqual(self.on_terminal("rendr", TERM="xterm", NO_COLOR="")[1], plain)

    def test_a_file_cannot_colour(self):
        shown = self.on_terminal("info", self.path("\033[32mgreen.gltf"), TERM="xterm")[1]
        self.assertIn("?[32mgreen", shown)
        self.assertEqual(shown.count("\033"), 2)


class Interrupt(Case):
    def start(self):
        """Starts a render that would take a minute."""
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

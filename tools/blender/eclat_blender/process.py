"""A running eclat process: its messages, its intermediate pictures, its result."""
import os
import signal
import subprocess
import tempfile
from typing import NamedTuple, Optional

from . import exr
from .trouble import Trouble


class Shot(NamedTuple):
    """An intermediate or final picture."""
    attributes: dict
    planes: dict

    @property
    def samples(self):
        return self.attributes.get("eclat.samplesPerPixel", 0)

    def figures(self):
        """"96 samples, error 2.31 %, 95 % bound 2.40 %"."""
        error, bound = self.attributes.get("eclat.error"), self.attributes.get("eclat.errorBound")
        parts = [f"{self.samples:.4g} samples"]
        parts.append(f"error {100 * error:.3g} %" if is_known(error) else "error not known")
        parts.append(f"95 % bound {100 * bound:.3g} %" if is_known(bound) else "no bound")
        return ", ".join(parts)


def is_known(value):
    return value is not None and value < float("inf")


class Process:
    """command: program and words, without outputs. every: seconds between intermediate pictures."""

    def __init__(self, command, folder, every=1.0, environment=None):
        self.final, self.way = os.path.join(folder, "picture.exr"), os.path.join(folder, "snapshot.exr")
        self.messages = tempfile.TemporaryFile()
        self.seen = None
        self.told = 0
        self.was_stopped = False
        words = [*command, f"--output={self.final}", f"--snapshot={self.way}", f"--every={every:g}s"]
        try:
            self.process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=self.messages, env=environment)
        except OSError as why:
            raise Trouble(f"'{command[0]}' cannot be started: {why.strerror}") from why

    def is_running(self):
        return self.process.poll() is None

    def wait(self, seconds):
        """Waits until it ends, but no longer than that."""
        try:
            self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            pass

    def stop(self):
        """Asks it to end with the picture so far."""
        if not self.was_stopped and self.is_running():
            self.process.send_signal(signal.SIGINT)
        self.was_stopped = True

    def kill(self):
        if self.is_running():
            self.process.kill()
        self.process.wait()
        self.messages.close()

    def lines(self):
        size = os.fstat(self.messages.fileno()).st_size
        text = os.pread(self.messages.fileno(), size, 0).decode("utf-8", "replace")
        return [line[len("eclat: "):] if line.startswith("eclat: ") else line for line in text.splitlines()]

    def news(self):
        """Returns the lines that are new since the last call."""
        found = self.lines()
        new, self.told = found[self.told:], len(found)
        return new

    def look(self) -> Optional[Shot]:
        """Returns the latest intermediate picture, or None if it was returned before."""
        try:
            status = os.stat(self.way)
            if (status.st_ino, status.st_mtime_ns) == self.seen:
                return None
            self.seen = status.st_ino, status.st_mtime_ns
            return Shot(*exr.read(self.way))
        except FileNotFoundError:
            return None

    def result(self) -> Optional[Shot]:
        """Call once it has ended. Returns the picture; None if it was stopped before there was one."""
        if os.path.exists(self.final):
            return Shot(*exr.read(self.final))
        if self.was_stopped:
            return None
        failures = [line[len("error: "):] for line in self.lines() if line.startswith("error: ")]
        raise Trouble(failures[-1] if failures else f"eclat ended with code {self.process.returncode} and no message")

    def warnings(self):
        return [line[len("warning: "):] for line in self.lines() if line.startswith("warning: ")]

"""Renders one scene from changing viewpoints. Each render is a process of its own, which the next render ends. Nothing here waits."""
import os
import shutil
import tempfile

from .process import Process
from .trouble import Trouble

COARSE = 4 # pixels along each axis that one pixel of the first picture covers


class Session:
    def __init__(self, program, environment=None):
        self.program, self.environment = program, environment
        self.folder = tempfile.mkdtemp(prefix="eclat-viewport-")
        self.shown = None    # what is being rendered: scene, view, size, samples
        self.process = None
        self.left = []       # (size, samples) of the pictures still to be rendered, the next one first
        self.number = 0
        self.status = ""

    def show(self, scene, view, size, samples):
        """scene, view: words of the command line. Starts again if anything has changed."""
        if (scene, view, size, samples) == self.shown:
            return
        self.shown = scene, view, size, samples
        coarse = tuple(max(1, -(-side // COARSE)) for side in size)
        self.left = [(coarse, min(samples, 8)), (size, samples)]
        self.begin()

    def begin(self):
        self.end()
        if not self.left:
            return
        size, samples = self.left.pop(0)
        self.number += 1
        place = os.path.join(self.folder, str(self.number))
        os.mkdir(place)
        words = [self.program, "render", *self.shown[0], *self.shown[1], f"--size={size[0]}x{size[1]}", f"--spp={samples}", "--channels=A"]
        self.process = Process(words, place, every=0.3, environment=self.environment)

    def poll(self):
        """Returns a new picture, or None. Raises Trouble once if the program fails."""
        process = self.process
        if process is None:
            return None
        if process.is_running():
            shot = process.look()
        else:
            try:
                shot = process.result()
            except Trouble:
                self.left = []
                raise
            finally:
                self.begin()
        if shot:
            self.status = shot.figures()
        elif process is self.process:
            self.status = (process.lines() or [self.status])[-1]
        return shot

    @property
    def is_busy(self):
        return self.process is not None

    def end(self):
        if self.process:
            self.process.kill()
            self.process = None
            shutil.rmtree(os.path.join(self.folder, str(self.number)), ignore_errors=True)

    def close(self):
        self.left = []
        self.end()
        shutil.rmtree(self.folder, ignore_errors=True)

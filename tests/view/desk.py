"""A screen without a monitor, eclat's window on it, and a hand. Xvfb with Mesa's software OpenGL; xdotool; ImageMagick's import;
openbox where windows are to be minimised."""
import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from support import CORNELL, ECLAT, ENVIRONMENT, Case

TOOLS = ["Xvfb", "xdotool", "import", "convert", "xrdb", "xprop", "xrandr", "setxkbmap", "openbox"]


def why_not():
    """What is missing for these tests; None: nothing."""
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if missing:
        return "not installed: " + ", ".join(missing)
    run = subprocess.run([ECLAT, "view", "no-such-scene.gltf"], env=dict(ENVIRONMENT, DISPLAY=""), capture_output=True, text=True, check=False)
    return "eclat was built without its preview window" if "without its preview" in run.stderr else None


class Screen:
    """An X server of its own, on a display number that it chooses. dpi: what desktops tell of dense monitors; managed: by openbox, else
    windows have neither frames nor icons."""

    def __init__(self, size="1280x1024", dpi=None, managed=False):
        read, write = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", size + "x24", "-nolisten", "tcp", "-noreset"],
                                       pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            self.display = ":" + pipe.readline().strip()
        self.environment = dict(ENVIRONMENT, DISPLAY=self.display)
        self.manager = None
        if dpi:
            subprocess.run(["xrdb", "-merge", "-"], input=f"Xft.dpi: {dpi}\n", text=True, env=self.environment, check=True)
        if managed:
            self.manager = subprocess.Popen(["openbox", "--config-file", "/dev/null"], env=self.environment, stdout=subprocess.DEVNULL,
                                            stderr=subprocess.DEVNULL)
            until = time.monotonic() + 20
            while "window id" not in self.run("xprop", "-root", "_NET_SUPPORTING_WM_CHECK"):
                assert time.monotonic() < until, "openbox does not manage windows"
                time.sleep(0.05)

    def run(self, *arguments):
        return subprocess.run(arguments, env=self.environment, capture_output=True, text=True, check=True).stdout

    def close(self):
        if self.manager:
            self.manager.terminate()
            self.manager.wait()
        self.server.terminate()
        self.server.wait()


class Window:
    """eclat view, started; its folder is the current one."""

    def __init__(self, screen, folder, *arguments, prefix=(), env=None):
        self.screen = screen
        self.environment = dict(ENVIRONMENT, DISPLAY=screen.display, LIBGL_ALWAYS_SOFTWARE="1", **(env or {}))
        self.out = open(os.path.join(folder, "out.txt"), "w+", encoding="utf-8")
        self.err = open(os.path.join(folder, "err.txt"), "w+", encoding="utf-8")
        self.folder = folder
        self.process = subprocess.Popen([*prefix, ECLAT, "view", *arguments], cwd=folder, env=self.environment, stdin=subprocess.DEVNULL,
                                        stdout=self.out, stderr=self.err)
        self.id = None

    def text(self, which="out"):
        with open(os.path.join(self.folder, which + ".txt"), encoding="utf-8") as file:
            return file.read()

    def tool(self, *arguments):
        return subprocess.run(["xdotool", *map(str, arguments)], env=self.environment, capture_output=True, text=True, check=False).stdout

    def wait_until(self, what, seconds=120, every=0.1):
        """what() until it is true; its last value."""
        until = time.monotonic() + seconds
        while True:
            value = what()
            if value or time.monotonic() > until or self.process.poll() is not None:
                return value
            time.sleep(every)

    def appear(self):
        found = self.wait_until(lambda: self.tool("search", "--onlyvisible", "--name", " - eclat"))
        assert found, self.text("err")
        self.id = found.split()[0]
        self.tool("windowfocus", "--sync", self.id)
        return self

    def size(self):
        lines = self.tool("getwindowgeometry", "--shell", self.id).split()
        values = dict(line.split("=") for line in lines)
        return int(values["WIDTH"]), int(values["HEIGHT"])

    def key(self, *names):
        """By the server, as a keyboard does it; events sent to the window itself carry no time, and some get lost."""
        for name in names:
            self.tool("key", name)

    def hold(self, name, seconds):
        self.tool("keydown", name)
        time.sleep(seconds)
        self.tool("keyup", name)

    def drag(self, button, x0, y0, x1, y1):
        self.tool("mousemove", "--window", self.id, x0, y0, "mousedown", button)
        for step in range(1, 6):
            self.tool("mousemove", "--window", self.id, x0 + (x1 - x0) * step // 5, y0 + (y1 - y0) * step // 5)
        self.tool("mouseup", button)

    def screenshot(self, name="shot.png"):
        path = os.path.join(self.folder, name)
        subprocess.run(["import", "-window", self.id, path], env=self.environment, check=True)
        return path

    def save(self):
        """Taps S and waits for the command that repeats the picture."""
        before = self.text().count("\n")
        self.key("s")
        self.wait_until(lambda: self.text().count("\n") > before, 30)
        lines = self.text().splitlines()
        assert len(lines) > before, self.text("err")
        return lines[-1]

    def picture(self, crop=None):
        return pixels(self.screenshot(), crop)

    def used(self):
        """(seconds of processor time, times that any thread went to sleep or was put there)"""
        switches = 0
        with open(f"/proc/{self.process.pid}/stat", encoding="utf-8") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        for task in os.listdir(f"/proc/{self.process.pid}/task"):
            with open(f"/proc/{self.process.pid}/task/{task}/status", encoding="utf-8") as file:
                switches += sum(int(line.split()[1]) for line in file if "ctxt_switches" in line)
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK"), switches

    def uses(self, seconds):
        before = self.used()
        time.sleep(seconds)
        return tuple(b - a for a, b in zip(before, self.used()))

    def rest(self, seconds=60):
        """Until nothing goes on."""
        assert self.wait_until(lambda: not any(self.uses(0.2)), seconds, 0), "the window finds no rest"  # a compiler need not wait for anything

    def close(self):
        """By Q; the exit code."""
        try:
            self.key("q")
            return self.process.wait(60)
        finally:
            self.kill()

    def kill(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGKILL)
            self.process.wait()
        self.out.close()
        self.err.close()


def pixels(path, crop=None):
    """(width, height, bytes) of a PNG, three a pixel; crop: as ImageMagick takes it."""
    command = ["convert", path, *(["-crop", crop, "+repage"] if crop else []), "-depth", "8", "ppm:-"]
    data = subprocess.run(command, capture_output=True, check=True).stdout
    _, width, height, _, body = data.split(None, 4) if data[:2] == b"P6" else (None,) * 5
    width, height = int(width), int(height)
    return width, height, data[-3 * width * height:]


def mean_difference(a, b):
    """Of two pictures of one size, in steps of 256."""
    assert a[:2] == b[:2], (a[:2], b[:2])
    return sum(abs(x - y) for x, y in zip(a[2], b[2])) / len(a[2])


class ViewCase(Case):
    @classmethod
    def setUpClass(cls):
        reason = why_not()
        if reason:
            raise unittest.SkipTest(reason)

    def setUp(self):
        """A screen each: a key that is down as its window goes would type into the next one."""
        super().setUp()
        self.screen = None
        self.use_screen()
        self.scene = shutil.copy(CORNELL, self.path("box.gltf"))
        shutil.copy(os.path.join(os.path.dirname(CORNELL), "cornell-box.bin"), self.folder)

    def use_screen(self, *arguments, **options):
        """Another one than before."""
        if self.screen:
            self.screen.close()
        else:
            self.addCleanup(lambda: self.screen.close())
        self.screen = Screen(*arguments, **options)

    def open(self, *arguments, **options):
        window = Window(self.screen, tempfile.mkdtemp(dir=self.folder), *arguments, **options)
        self.addCleanup(window.kill)
        return window.appear()

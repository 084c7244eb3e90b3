"""A virtual screen, eclat's window on it, and simulated input. Uses Xvfb with Mesa's software OpenGL; xdotool; ImageMagick's import;
openbox to minimise windows; Xorg with its dummy driver for several monitors."""
import glob
import os
import re
import shlex
import shutil
import signal
import subprocess
import tempfile
import unittest

from polling import GUARD, over_a_while, poll_until
from support import CORNELL, ECLAT, ENVIRONMENT, Case, eclat, read_exr

TOOLS = ["Xvfb", "xdotool", "import", "convert", "xrdb", "xprop", "xrandr", "xwininfo", "setxkbmap", "openbox"]


def why_not():
    """Returns what is missing for these tests, or None."""
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if missing:
        return "not installed: " + ", ".join(missing)
    run = subprocess.run([ECLAT, "view", "no-such-scene.gltf"], env=dict(ENVIRONMENT, DISPLAY=""), capture_output=True, text=True, check=False)
    return "this eclat has no preview window" if "this eclat has no preview window" in run.stderr else None


class Screen:
    """An X server of its own, on a display number that it chooses. dpi: as a desktop states it for a dense monitor; managed: by openbox;
    otherwise windows have neither frames nor icons."""

    def __init__(self, size="1280x1024", dpi=None, managed=False):
        self.start(["Xvfb", "-screen", "0", size + "x24"], dpi, managed)

    def start(self, server, dpi=None, managed=False):
        read, write = os.pipe()
        self.server = subprocess.Popen([*server, "-displayfd", str(write), "-nolisten", "tcp", "-noreset"], pass_fds=[write],
                                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            self.display = ":" + pipe.readline().strip()
        self.environment = dict(ENVIRONMENT, DISPLAY=self.display)
        self.manager = None
        if dpi:
            subprocess.run(["xrdb", "-merge", "-"], input=f"Xft.dpi: {dpi}\n", text=True, env=self.environment, check=True)
        if managed:
            self.manage()

    def manage(self):
        self.manager = subprocess.Popen(["openbox", "--config-file", "/dev/null"], env=self.environment, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        manages = poll_until(lambda: "window id" in self.run("xprop", "-root", "_NET_SUPPORTING_WM_CHECK"), self.manager)
        assert manages, "openbox does not manage windows"

    def run(self, *arguments):
        return subprocess.run(arguments, env=self.environment, capture_output=True, text=True, check=True).stdout

    def close(self):
        if self.manager:
            self.manager.terminate()
            self.manager.wait()
        self.server.terminate()
        self.server.wait()


XORG = """
Section "ServerFlags"
    Option "AutoAddDevices" "false"
    Option "AutoAddGPU" "false"
EndSection
Section "Device"
    Identifier "card"
    Driver "dummy"
    VideoRam 65536
EndSection
Section "Screen"
    Identifier "screen"
    Device "card"
    SubSection "Display"
        Depth 24
        Virtual 2048 1024
    EndSubSection
EndSection
"""


class Monitors(Screen):
    """One server with several outputs, DUMMY0 and so on, from left to right; self.places: (x, y, width, height) of each."""

    def __init__(self, *sizes, managed=False):
        self.folder = tempfile.mkdtemp(prefix="eclat-xorg-")
        config = os.path.join(self.folder, "xorg.conf")
        with open(config, "w", encoding="utf-8") as file:
            file.write(XORG)
        self.start(["Xorg", "-config", config, "-logfile", os.path.join(self.folder, "log"), "-sharevts", "-novtswitch"])
        self.places = []
        try:
            for i, size in enumerate(sizes):
                self.add(i, *size)
        except subprocess.CalledProcessError:
            self.close()
            raise
        if managed:
            self.manage()

    def add(self, i, width, height):
        """Sets a mode that no real monitor could show; the dummy accepts any."""
        mode = f"dummy{width}x{height}"
        self.places.append((sum(place[2] for place in self.places), 0, width, height))
        self.run("xrandr", "--newmode", mode, "50", *(str(width + k) for k in [0, 8, 16, 24]), *(str(height + k) for k in range(4)))
        self.run("xrandr", "--addmode", f"DUMMY{i}", mode)
        self.output(i, True)

    def output(self, i, on):
        x, y, width, height = self.places[i]
        self.run("xrandr", "--output", f"DUMMY{i}", *(["--mode", f"dummy{width}x{height}", "--pos", f"{x}x{y}"] if on else ["--off"]))
        self.run("xrandr")  # updates the list of connected outputs: a dummy is connected while it has a mode

    def close(self):
        super().close()
        shutil.rmtree(self.folder, ignore_errors=True)


class Window:
    """A running eclat view; its folder is the current one."""

    def __init__(self, screen, folder, *arguments, prefix=(), env=None):
        self.screen = screen
        self.environment = dict(ENVIRONMENT, DISPLAY=screen.display, LIBGL_ALWAYS_SOFTWARE="1", **(env or {}))
        self.out = open(os.path.join(folder, "out.txt"), "w+", encoding="utf-8")
        self.err = open(os.path.join(folder, "err.txt"), "w+", encoding="utf-8")
        self.folder = folder
        self.process = subprocess.Popen([*prefix, ECLAT, "view", *arguments], cwd=folder, env=self.environment, stdin=subprocess.DEVNULL,
                                        stdout=self.out, stderr=self.err)
        self.name = os.path.basename(arguments[0]) + " - eclat"
        self.id = None

    def text(self, which="out"):
        with open(os.path.join(self.folder, which + ".txt"), encoding="utf-8") as file:
            return file.read()

    def tool(self, *arguments):
        return subprocess.run(["xdotool", *map(str, arguments)], env=self.environment, capture_output=True, text=True, check=False).stdout

    def wait_until(self, what, pause=0.1):
        """Calls what() until it returns something true; returns its last value."""
        return poll_until(what, self.process, pause)

    def appear(self):
        found = self.wait_until(lambda: self.tool("search", "--onlyvisible", "--name", self.name))
        assert found, self.text("err")
        self.id = found.split()[0]
        self.tool("windowfocus", "--sync", self.id)
        return self

    def place(self):
        """Returns (x, y, width, height) on the screen, without the frame."""
        text = self.screen.run("xwininfo", "-id", self.id)
        return tuple(int(re.search(rf"{what}: *(-?\d+)", text)[1]) for what in ["left X", "left Y", "Width", "Height"])

    def size(self):
        return self.place()[2:]

    def move(self, x, y):
        """Moves the window and waits until it is there. xdotool's --sync returns after any move, even the first placement by a window
        manager."""
        self.tool("windowmove", self.id, x, y)
        assert self.wait_until(lambda: self.place()[:2] == (x, y)), f"it does not move to {x}, {y}: {self.place()}"

    def key(self, *names):
        """Sends keys through the server, as a keyboard does: events sent to the window itself have no time, and some get lost. Presses last
        as long as a person's, since GLFW takes a press within 20 ms of a release as auto-repeat."""
        for name in names:
            subprocess.run(["xdotool", "key", "--delay", "60", name], env=self.environment, check=True)

    def hold(self, name, crop=None):
        """Holds a key until the picture of a window at rest changes; crop: a part without changing text."""
        before = self.picture(crop)
        self.tool("keydown", name)
        self.wait_until(lambda: mean_difference(self.picture(crop), before) > 4)
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
        self.wait_until(lambda: self.text().count("\n") > before)
        lines = self.text().splitlines()
        assert len(lines) > before, self.text("err")
        return lines[-1]

    def picture(self, crop=None):
        return pixels(self.screenshot(), crop)

    def used(self):
        """Returns (seconds of processor time, number of times that threads went to sleep or were interrupted)."""
        switches = 0
        with open(f"/proc/{self.process.pid}/stat", encoding="utf-8") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        for status in self.statuses():
            switches += sum(int(value) for name, value in status.items() if "ctxt_switches" in name)
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK"), switches

    def uses(self, seconds):
        """Returns the difference of used() over so many seconds."""
        before, after = over_a_while(self.used, seconds)
        return tuple(b - a for a, b in zip(before, after))

    def rest(self):
        """Waits until nothing runs; a thread that waits for a processor counts as running."""
        def rests():
            return not any(self.uses(0.2)) and all(status["State"].startswith("S") for status in self.statuses())
        assert self.wait_until(rests, 0), "the window finds no rest"  # no pause: even a compiler may seem idle briefly

    def close(self):
        """Presses Q; returns the exit code."""
        try:
            self.key("q")
            return self.process.wait(GUARD)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"Q does not end it; the keyboard is with {self.tool('getwindowfocus').strip()}, not {self.id}?\n"
                                 + "\n".join(self.threads()) + "\n" + self.text("err")) from None
        finally:
            self.kill()

    def statuses(self):
        """Returns the kernel's status of each thread: {name: value}."""
        for task in sorted(glob.glob(f"/proc/{self.process.pid}/task/*"), key=len):
            try:
                with open(task + "/status", encoding="utf-8") as file:
                    status = dict(re.split(r":\s*", line.rstrip(), maxsplit=1) for line in file)
                with open(task + "/wchan", encoding="utf-8") as file:
                    yield status | {"waits for": file.read()}
            except (FileNotFoundError, ProcessLookupError):
                pass  # the thread has ended meanwhile

    def threads(self):
        """Returns a line for each thread: its state, and what it waits for in the kernel."""
        return [" ".join(status[name] for name in ("Name", "State", "waits for")) for status in self.statuses()]

    def kill(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGKILL)
            self.process.wait()
        self.out.close()
        self.err.close()


def pixels(path, crop=None):
    """Returns (width, height, bytes) of a PNG, three a pixel; crop: as ImageMagick takes it."""
    command = ["convert", path, *(["-crop", crop, "+repage"] if crop else []), "-depth", "8", "ppm:-"]
    data = subprocess.run(command, capture_output=True, check=True).stdout
    _, width, height, _, body = data.split(None, 4) if data[:2] == b"P6" else (None,) * 5
    width, height = int(width), int(height)
    return width, height, data[-3 * width * height:]


def mean_difference(a, b):
    """Mean difference of two pictures of one size, in steps of 256."""
    assert a[:2] == b[:2], (a[:2], b[:2])
    return sum(abs(x - y) for x, y in zip(a[2], b[2])) / len(a[2])


class ViewCase(Case):
    @classmethod
    def setUpClass(cls):
        reason = why_not()
        if reason:
            raise unittest.SkipTest(reason)

    def setUp(self):
        """Each test has a screen of its own: a key still pressed when its window closes would type into the next window."""
        super().setUp()
        self.screen = None
        self.use_screen()
        self.scene = shutil.copy(CORNELL, self.path("box.gltf"))
        shutil.copy(os.path.join(os.path.dirname(CORNELL), "cornell-box.bin"), self.folder)

    def use_screen(self, *arguments, **options):
        """Waits for a picture that differs from the previous one."""
        if self.screen:
            self.screen.close()
        else:
            self.addCleanup(lambda: self.screen.close())
        self.screen = Screen(*arguments, **options)

    def open(self, *arguments, **options):
        window = Window(self.screen, tempfile.mkdtemp(dir=self.folder), *arguments, **options)
        self.addCleanup(window.kill)
        return window.appear()

    def repeat(self, command, folder):
        """Runs the command that the window printed, in another folder; returns {name: path} of its pictures."""
        words = shlex.split(command)
        self.assertEqual(words[:2], ["eclat", "render"])
        os.makedirs(folder, exist_ok=True)
        self.assert_ok(eclat(*words[1:], cwd=folder))
        return {name: os.path.join(folder, name) for name in os.listdir(folder)}

    def assert_repeats(self, window, command):
        words = shlex.split(command)
        attributes, planes = read_exr(os.path.join(window.folder, next(path for o, path in zip(words, words[1:]) if o == "-o" and path.endswith(".exr"))))
        pictures = self.repeat(command, tempfile.mkdtemp(dir=self.folder))
        for name, path in pictures.items():
            if name.endswith(".png"):
                with open(path, "rb") as a, open(os.path.join(window.folder, name), "rb") as b:
                    self.assertEqual(a.read(), b.read())
            else:
                theirs, again = read_exr(path)
                for channel in planes:
                    self.assertEqual(planes[channel], again[channel], channel)
                for key in theirs:
                    if key.startswith("eclat.camera.") or key in ("eclat.imageSha256", "eclat.replicates", "eclat.samplesPerPixel"):
                        self.assertEqual(attributes[key], theirs[key], key)
        self.assertEqual(len(pictures), 2)
        self.assertEqual(attributes["eclat.command"], command)
        return attributes

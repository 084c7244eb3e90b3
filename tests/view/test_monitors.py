# tier: full
"""The preview window with several monitors: Xorg's dummy driver has several outputs; with openbox, and without any window manager."""
import shutil
import subprocess
import unittest

from virtual_screen import Monitors, ViewCase

SIZES = (640, 480), (800, 600)


def why_not():
    if not shutil.which("Xorg"):
        return "not installed: Xorg"
    try:
        Monitors(*SIZES).close()
    except (subprocess.CalledProcessError, OSError, ValueError) as error:
        return f"no Xorg with two dummy outputs: {error}"
    return None


class Unmanaged(ViewCase):
    managed = False

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        reason = why_not()
        if reason:
            raise unittest.SkipTest(reason)

    def use_screen(self):
        self.screen = Monitors(*SIZES, managed=self.managed)
        self.addCleanup(self.screen.close)
        self.left, self.right = self.screen.places

    def assert_place(self, window, place, why):
        self.assertTrue(window.wait_until(lambda: window.place() == place), f"{why}: {window.place()}, not {place}")

    def is_on(self, window, monitors):
        """Returns whether the window is wholly on one of them."""
        x, y, width, height = window.place()
        return any(left <= x and x + width <= left + wide and top <= y and y + height <= top + high for left, top, wide, high in monitors)

    def assert_works(self, window):
        """Checks that the window draws, and that a saved picture has the window's size."""
        width, height = window.size()
        self.assertTrue(window.wait_until(lambda: f"--size={width}x{height} " in window.save(), 0.5), window.text())
        self.assertGreater(len(set(window.picture(f"{width // 2}x{height // 3}+{width // 4}+{height // 4}")[2])), 8)

    def test_opens_wholly_on_one(self):
        for size in ["300x200", "700x560", "5000x400"]:
            window = self.open(self.scene, "--size", size, "--spp", "1")
            self.assertTrue(window.wait_until(lambda w=window: self.is_on(w, self.screen.places)), f"{size}: {window.place()}")
            self.assertEqual(window.close(), 0)

    def test_full_screen_is_all_of_the_monitor_that_it_is_on(self):
        window = self.open(self.scene, "--size", "200x150", "--spp", "1")
        for monitor, x in [(self.right, 700), (self.left, 300), (self.right, 560)]:  # most of the last one is on the right monitor
            window.move(x, 90)
            window.rest()
            before = window.place()
            window.key("F11")
            self.assert_place(window, monitor, "full screen")
            self.assert_works(window)
            window.key("F11")
            self.assert_place(window, before, "and back")
        self.assertEqual(window.close(), 0)

    def test_full_screen_stays_while_one_works_on_another(self):
        window = self.open(self.scene, "--size", "200x150", "--spp", "1")
        window.move(700, 90)
        window.key("F11")
        self.assert_place(window, self.right, "full screen")
        other = self.open(shutil.copy(self.scene, self.path("other.gltf")), "--size", "200x150", "--spp", "1")
        other.move(50, 90)
        other.tool("windowfocus", "--sync", other.id)
        other.rest()
        self.assertEqual(window.place(), self.right)
        self.assertIn("IsViewable", self.screen.run("xwininfo", "-id", window.id))
        self.assertEqual(other.close(), 0)
        window.tool("windowfocus", "--sync", window.id)
        self.assertEqual(window.close(), 0)

    def test_a_monitor_that_goes_takes_no_window_with_it(self):
        window = self.open(self.scene, "--size", "200x150", "--spp", "1")
        for full in [False, True]:
            window.move(1200, 300)
            window.rest()
            if full:
                window.key("F11")
                self.assert_place(window, self.right, "full screen")
            self.screen.output(1, False)
            self.assertTrue(window.wait_until(lambda: self.is_on(window, [self.left]) and window.size() == (200, 150)),
                            f"full {full}: {window.place()}")
            self.assert_works(window)
            window.key("F11")
            self.assert_place(window, self.left, "full screen on what is left")
            self.screen.output(1, True)
            window.rest()
            self.assertEqual(window.place(), self.left)
            window.key("F11")
            self.assertTrue(window.wait_until(lambda: window.size() == (200, 150) and self.is_on(window, self.screen.places)), window.place())
        self.assertEqual(window.close(), 0)


class Managed(Unmanaged):
    managed = True


if __name__ == "__main__":
    unittest.main()

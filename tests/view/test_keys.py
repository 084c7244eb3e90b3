# tier: full
"""Every key in the window's help has its effect, in the picture or in the command that repeats it."""
import json
import os
import re

import denoiser
from virtual_screen import ViewCase, mean_difference
from support import ENVIRONMENT, read_exr, write_exr, write_gltf

TALL = [0.3685, 0.165, 0.3515]  # the middle of the Cornell box's tall block


class Keys(ViewCase):
    def start(self, *arguments):
        self.window = self.open(self.scene, *arguments)
        self.window.rest()
        self.window.key("i", "i")
        self.picture = self.settled()

    def settled(self):
        self.window.rest()
        return self.window.picture()

    def press(self, *names):
        """Returns how much the picture differs from the previous one, and keeps the new one."""
        before = self.picture
        self.window.key(*names)
        self.picture = self.settled()
        return mean_difference(before, self.picture)

    def mean(self):
        return sum(self.picture[2]) / len(self.picture[2])

    def point(self, x, y):
        self.window.tool("mousemove", "--window", self.window.id, x, y)
        self.window.rest()

    def target(self):
        return [float(x) for x in re.search(r"--look-at=(\S+)", self.window.save())[1].split(",")]

    def test_keys_show_what_they_do(self):
        with open(self.scene, encoding="utf-8") as file:
            scene = json.load(file)
        scene["nodes"].append(dict(scene["nodes"][8], translation=[0.4, 0.4, -0.5]))
        scene["scenes"][0]["nodes"].append(len(scene["nodes"]) - 1)
        write_gltf(self.scene, scene)
        sky = write_exr(self.path("sky.exr"), 8, 4, {c: [float((i * k) % 7 // 3) for i in range(32)] for c, k in [("R", 1), ("G", 3), ("B", 5)]})
        self.start("--size", "160x90", "--spp", "4", "--env", sky)
        first, mean = self.picture, self.mean()
        self.press("E")
        self.assertGreater(self.mean(), 1.05 * mean)
        self.press("e", "e")
        self.assertLess(self.mean(), 0.95 * mean)
        self.press("E")
        self.assertEqual(self.picture, first)
        for keys, back in [("t", "t t t t"), ("period", "comma"), ("c", "c"), ("3", "1"), ("2", "1"), ("h", "h"), ("i", "i i")]:
            self.assertGreater(self.press(*keys.split()), 0.5, keys)
            self.press(*back.split())
            self.assertLess(mean_difference(self.picture, first), 0.01, back)
        self.press("x")
        self.assertGreater(self.press("1"), 1)
        self.press("1", "x")
        self.assertEqual(self.picture, first)
        self.point(20, 45)
        for keys in ["Tab", "v", "v"]:  # wipe, side by side, single
            self.assertGreater(self.press(keys), 1, keys)
        self.assertEqual(self.picture, first)
        self.press("Tab", "Tab", "Tab")  # map of the samples, then another integrator
        self.assertGreater(self.press("g"), 1)
        self.press("v", "v")
        for keys in ["w", "a", "d", "Up", "Down", "Left", "Right", "Prior", "Next", "s"]:
            before = self.picture
            self.window.hold(keys)
            self.picture = self.settled()
            self.assertGreater(mean_difference(before, self.picture), 0.5, keys)
        self.press("E", "t", "period", "r")
        self.assertEqual(self.picture, first)
        idle = self.window.used()[0]
        self.window.key("F5")
        self.assertTrue(self.window.wait_until(lambda: self.window.used()[0] > idle + 0.05), "nothing is loaded again")
        self.assertEqual(self.settled(), first)
        self.assertIn("--spp=4 ", self.window.save())
        self.assertGreater(self.press("m"), 0.3)
        self.assertIn("--spp=16 ", self.window.save())
        self.assertEqual(self.window.close(), 0)

    def test_n_denoises(self):
        """The command that repeats the picture has the option, and its files contain the best layers."""
        ENVIRONMENT.update(denoiser.environment())
        self.start("--size", "160x120", "--spp", "32")
        first = self.picture
        self.assertGreater(self.press("n"), 0.3)
        command = self.window.save()
        self.assertIn("--denoise ", command)
        self.assertIn("best.R", read_exr(os.path.join(self.window.folder, "box.exr"))[1])
        self.press("n")
        self.assertEqual(self.picture, first)
        self.assertNotIn("--denoise", self.window.save())
        self.assertEqual(self.window.close(), 0)

    def test_f_frames_selection_cursor_or_all(self):
        self.start("--size", "200x200", "--spp", "1")
        everything = [0.278, 0.2744, 0.2796]
        for place, click, expected in [((80, 110), False, TALL), ((198, 2), False, everything), ((80, 110), True, TALL)]:
            self.press("r")
            self.point(*place)
            if click:
                self.window.tool("click", 1)
                self.point(198, 2)
            self.press("f")
            for a, b in zip(self.target(), expected):
                self.assertAlmostEqual(a, b, delta=1e-3, msg=f"{place} {click}")
        self.press("r")
        self.point(0, 0)  # from the block to the wall's corner
        self.press("f")
        self.assertGreater(abs(self.target()[2] - TALL[2]), 0.01)
        self.press("r")
        self.window.tool("mousemove", "--window", self.window.id, 80, 110, "click", 1, "mousemove", 198, 2)  # without a pause
        self.press("f")
        self.assertAlmostEqual(self.target()[2], TALL[2], delta=1e-3)
        self.window.tool("click", 1)  # over the background
        self.press("r")
        self.point(40, 105)
        self.press("v", "v")  # beside another picture it is half as wide; the resting mouse is now over the block
        self.window.tool("click", 1)
        self.point(198, 2)
        self.press("v", "f")
        self.assertAlmostEqual(self.target()[2], TALL[2], delta=1e-3)
        self.window.tool("click", 1)  # over the background
        self.window.rest()
        self.press("r", "f")
        self.assertAlmostEqual(self.target()[0], everything[0], delta=1e-3)
        self.assertEqual(self.window.close(), 0)

    def test_every_change_is_in_the_second_save_too(self):
        self.start("--size", "64x48", "--spp", "2")
        self.window.save()
        again = self.window.save()
        self.assertIn("-2.exr", again)
        self.assertTrue(os.path.exists(os.path.join(self.window.folder, "box-2.png")))
        self.assertEqual(self.window.close(), 0)

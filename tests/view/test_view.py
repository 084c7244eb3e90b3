# tiers: quick, full
"""The preview window with simulated input: start, orbit, compare with eclat render, save and repeat, reload, resize, close."""
import os
import re
import subprocess
import unittest

from virtual_screen import ViewCase, mean_difference, pixels
from polling import GUARD
from support import CORNELL, ENVIRONMENT, eclat, png_size, write_exr
from tiers import full

SIZE = ["--size", "200x150"]
PLAIN = "200x90+0+0"  # above the overlay's lines


class View(ViewCase):
    @full
    def test_shows_what_render_makes_after_an_orbit_and_repeats_it(self):
        window = self.open(self.scene, *SIZE, "--spp", "64")
        window.drag(1, 100, 75, 130, 60)
        command = window.save()
        self.assertRegex(command, r"--eye=\S+ --look-at=\S+ --up=0,1,0 --fov=\S+ ")
        self.assert_repeats(window, command)
        # The screen shows that picture, too, except for the noise of other samples.
        settled = re.sub(r"--spp=\d+", "--spp=64", command) + " --seed 5"
        reference = self.repeat(settled, self.path("other-seed"))["box.png"]
        window.tool("mousemove", "--window", window.id, 190, 140)
        window.key("i", "i")  # no lines over the picture
        shot = None

        def near():
            nonlocal shot
            shot = pixels(window.screenshot(), PLAIN)
            return mean_difference(shot, pixels(reference, PLAIN)) < 8
        self.assertTrue(window.wait_until(near), mean_difference(shot, pixels(reference, PLAIN)))
        unmoved = self.path("unmoved.png")
        self.assert_ok(eclat("render", self.scene, *SIZE, "--spp", "64", "-o", unmoved))
        self.assertGreater(mean_difference(shot, pixels(unmoved, PLAIN)), 16)
        self.assertEqual(window.close(), 0)
        self.assertEqual(window.text("err"), "")

    @full
    def test_keys_change_the_picture_and_the_command(self):
        window = self.open(self.scene, *SIZE, "--spp", "8", "--sampler", "independent", "--rr", "0.7")
        plain = window.save()
        self.assertIn("--sampler=independent", plain)
        self.assertNotIn("--eye", plain)
        self.assert_repeats(window, plain)
        window.key("E", "E", "E", "t", "2")
        window.tool("mousemove", "--window", window.id, 100, 70, "click", 4)
        changed = window.wait_until(lambda: (lambda c: c if "whitted" in c else None)(window.save()), 0.5)
        for word in ["--exposure=1", "--tonemap=none", "--integrator=whitted", "--eye="]:
            self.assertIn(word, changed)
        self.assertNotIn("--rr", changed)  # the path tracer's
        self.assert_repeats(window, changed)
        window.key("r", "1")
        again = window.wait_until(lambda: (lambda c: c if "whitted" not in c else None)(window.save()), 0.5)
        strip = re.compile(r" -o \S+| --spp=\d+")
        self.assertEqual(strip.sub("", again).split()[:-1], strip.sub("", plain).split()[:-1])
        self.assertEqual(window.close(), 0)

    @full
    def test_environment_effects_and_rungs_repeat_too(self):
        sky = write_exr(self.path("sky.exr"), 8, 4, {"R": [float(i % 5) for i in range(32)], "G": [float(i % 3) for i in range(32)],
                                                      "B": [float(i % 7) for i in range(32)]})
        window = self.open(self.scene, *SIZE, "--spp", "4", "--env", sky)
        window.save()
        window.key("period", "period", "period")
        turned = window.wait_until(lambda: (lambda c: c if "--env-rotate=15" in c else None)(window.save()), 0.5)
        self.assert_repeats(window, turned)
        window.key("3", "x", "1", "x")
        lost = window.wait_until(lambda: (lambda c: c if "--integrator=raster" in c and "--without" in c else None)(window.save()), 0.5)
        self.assertIn("--without=emission", lost)
        self.assert_repeats(window, lost)
        self.assertEqual(window.close(), 0)

    @full
    def test_flying_and_panning_move_the_eye(self):
        window = self.open(self.scene, *SIZE, "--spp", "4")
        window.rest()
        eyes = {None}
        for move in [lambda: window.hold("w", PLAIN), lambda: window.drag(2, 100, 75, 120, 75), lambda: window.hold("s", PLAIN)]:
            def moves():
                window.key("r")  # where the scene fills the view: from far away, all pictures are alike
                window.rest()
                move()  # again if the first S came too late, since the picture changed for another reason
                window.rest()
                eye = re.search(r"--eye=(\S+)", window.save())
                return eye and eye[1] not in eyes and not eyes.add(eye[1])
            self.assertTrue(window.wait_until(moves), eyes)
        self.assertEqual(window.close(), 0)

    @full
    def test_reloads_and_keeps_the_picture_of_a_broken_file(self):
        window = self.open(self.scene, *SIZE, "--spp", "16")
        window.drag(1, 100, 75, 120, 70)
        before = window.save()
        camera = re.search(r"--eye.*?--fov=\S+", before)[0]
        window.rest()
        whole, lit = window.picture(), pixels(window.screenshot(), PLAIN)
        with open(self.scene, encoding="utf-8") as file:
            text = file.read()
        with open(self.scene, "w", encoding="utf-8") as file:
            file.write(text[:len(text) // 2])
        self.assertTrue(window.wait_until(lambda: mean_difference(window.picture(), whole) > 2), "not told of")
        broken = pixels(window.screenshot(), "200x40+0+70")
        self.assertIsNone(window.process.poll())
        self.assertGreater(len(set(broken[2])), 8)  # the picture stays
        dark = re.sub(r'"emissiveFactor":\s*\[[^]]*\]', '"emissiveFactor":[0,0,0.05]', text)
        self.assertNotEqual(dark, text)
        with open(self.scene, "w", encoding="utf-8") as file:
            file.write(dark)
        red = lambda picture: sum(picture[2][::3])  # the new lamp is black; the white message disappears with the old picture
        self.assertTrue(window.wait_until(lambda: red(pixels(window.screenshot(), PLAIN)) < 0.2 * red(lit), 0.5))
        window.rest()
        after = window.save()
        self.assertIn(camera, after)
        self.assert_repeats(window, after)
        self.assertEqual(window.close(), 0)

    @full
    def test_resize_and_limits(self):
        window = self.open(self.scene, *SIZE, "--error", "20%")
        self.assertEqual(window.size(), (200, 150))
        window.tool("windowsize", "--sync", window.id, 180, 160)
        command = window.wait_until(lambda: (lambda c: c if "180x160" in c else None)(window.save()), 0.5)
        attributes = self.assert_repeats(window, command)
        self.assertEqual(png_size(os.path.join(window.folder, re.search(r"-o (\S+\.png)", command)[1])), (180, 160))
        self.assertIn("eclat.camera.eye", attributes)
        window.rest()
        self.assertEqual(window.close(), 0)

    @full
    def test_second_pictures(self):
        other = self.path("other.exr")
        self.assert_ok(eclat("render", self.scene, *SIZE, "--spp", "4", "--env", "0,3,0", "-o", other))
        window = self.open(self.scene, *SIZE, "--spp", "16", "--against", other)
        window.save()
        window.tool("mousemove", "--window", window.id, 100, 60)
        seen = []
        for keys in [["v"], ["Tab"], ["Tab"], ["Tab"], ["v"]]:
            window.key(*keys)
            window.rest()
            seen.append(window.picture("90x60+108+50"))
        for i, a in enumerate(seen):
            for b in seen[:i]:
                self.assertGreater(mean_difference(a, b), 2, f"picture {i}")
        green = seen[3][2]
        self.assertGreater(sum(green[1::3]), 1.5 * sum(green[0::3]))  # --against
        self.assertEqual(window.close(), 0)

    def test_scripted_move_is_measured(self):
        script = self.path("move.txt")
        with open(script, "w", encoding="utf-8") as file:
            file.write("wait 0.2\nturn 30 5 1   # degrees\ndolly 0.8 0.5\nsettle\nkey Save\nquit\n")
        window = self.open(self.scene, *SIZE, "--spp", "8", "--script", script, "--stats")
        self.assertEqual(window.process.wait(GUARD), 0, window.text("err"))
        text = window.text()
        self.assertRegex(text, r"(?m)^first light  [\d.]+ s$")
        self.assertRegex(text, r"(?m)^frames       \d+ in [\d.]+ s of camera moves, median [\d.]+ ms, 95 % under [\d.]+ ms, worst [\d.]+ ms$")
        self.assertGreater(int(re.search(r"pictures     (\d+)", text)[1]), 3)
        self.assert_repeats(window, text.splitlines()[0])


class Leaks(ViewCase):
    @unittest.skipUnless(os.environ.get("ECLAT_TEN_WINDOWS"), "ECLAT_TEN_WINDOWS is not set")
    @full
    def test_ten_windows_leave_nothing_behind(self):
        script = self.path("close.txt")
        with open(script, "w", encoding="utf-8") as file:
            file.write("turn 20 5 0.1\nkey v\nkey Save\nsettle\nkey 3\nwait 0.2\nquit\n")
        run = subprocess.run([os.environ["ECLAT_TEN_WINDOWS"], CORNELL, script, self.path("a.exr")], capture_output=True, text=True, timeout=GUARD, check=False,
                             env=dict(ENVIRONMENT, DISPLAY=self.screen.display, LIBGL_ALWAYS_SOFTWARE="1", LSAN_OPTIONS="exitcode=0"))
        self.assertEqual((run.returncode, run.stdout.splitlines()[-1]), (0, "ten windows"), run.stderr[-4000:])
        # Drivers keep some memory until the process ends. Memory allocated by or for eclat has one of its functions on the stack.
        ours = [leak for leak in run.stderr.split("\n\n") if "leak of" in leak and re.search(r" in (ec_|eclat_|main)\w*", leak)]
        self.assertEqual(ours, [])


class Refusals(ViewCase):
    def test_without_display_or_with_bad_input(self):
        run = eclat("view", CORNELL, env={"DISPLAY": "", "WAYLAND_DISPLAY": ""})
        self.assertIn("no preview window", self.assert_one_error(run, 1))
        run = eclat("view", CORNELL, env={"DISPLAY": self.screen.display, "LIBGL_ALWAYS_SOFTWARE": "1", "LIBGL_DRIVERS_PATH": "/nowhere"})
        run.stderr = "".join(line + "\n" for line in run.stderr.splitlines() if not line.startswith("libGL error:"))  # Mesa's own message
        self.assertIn("OpenGL", self.assert_one_error(run, 1))
        for arguments, says, code in [(["no.gltf"], "no.gltf", 1), ([CORNELL, "--script", "no.txt"], "no.txt", 1),
                                      ([CORNELL, "--script", self.folder], self.folder, 1),
                                      ([CORNELL, "--against", "no.exr"], "no.exr", 1), ([CORNELL, "--json"], "--json", 2),
                                      ([CORNELL, "--adaptive"], "--adaptive is for 'eclat render'", 2)]:
            run = eclat("view", *arguments, env={"DISPLAY": self.screen.display, "LIBGL_ALWAYS_SOFTWARE": "1"})
            self.assertIn(says, self.assert_one_error(run, code))


if __name__ == "__main__":
    unittest.main()

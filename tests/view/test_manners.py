# tier: full
"""The preview window in its environment: at rest, minimised, on several and on dense monitors, on other keyboards, when something fails."""
import os
import re
import shutil
import signal
import subprocess
import unittest

from virtual_screen import ViewCase, mean_difference
from polling import GUARD
from support import quad_scene, write_exr, write_gltf

SIZE = ["--size", "200x150"]


class Rest(ViewCase):
    def test_nothing_wakes_it_but_events(self):
        window = self.open(self.scene, *SIZE, "--spp", "4")
        window.rest()
        processor, switches = window.uses(4)
        self.assertEqual(switches, 0)
        self.assertLessEqual(processor, 0.02)
        # Changed files wake it: here by a rename over the file, as editors write.
        before = window.picture("200x60+0+0")
        with open(self.scene, encoding="utf-8") as file:
            text = file.read()
        with open(self.path("new"), "w", encoding="utf-8") as file:
            file.write(re.sub(r'"emissiveFactor":\s*\[[^]]*\]', '"emissiveFactor":[0,0,0.05]', text))
        os.rename(self.path("new"), self.scene)
        self.assertTrue(window.wait_until(lambda: mean_difference(window.picture("200x60+0+0"), before) > 10))
        window.rest()
        window.process.send_signal(signal.SIGINT)
        self.assertEqual(window.process.wait(GUARD), 0)

    def test_minimised_it_renders_nothing(self):
        self.use_screen(managed=True)
        window = self.open(self.scene, *SIZE, "--error", "0.1%")
        self.assertTrue(window.wait_until(lambda: window.uses(0.5)[0] > 0.04), "it does not render")
        window.tool("windowminimize", window.id)
        self.assertTrue(window.wait_until(lambda: "HIDDEN" in self.screen.run("xprop", "-id", window.id, "_NET_WM_STATE")))
        window.rest()
        self.assertEqual(window.uses(2), (0, 0))
        window.tool("windowactivate", window.id)
        self.assertTrue(window.wait_until(lambda: window.uses(0.5)[0] > 0.04), "it does not go on")
        self.assertEqual(window.close(), 0)


class Monitors(ViewCase):
    """Xvfb has one output, so GLFW knows one monitor. openbox divides it into two for windows and full screen."""

    def test_full_screen_is_that_of_the_monitor_it_is_on(self):
        self.use_screen("900x300", managed=True)
        self.screen.run("xrandr", "--setmonitor", "left", "600/150x300/75+0+0", "screen")
        self.screen.run("xrandr", "--setmonitor", "right", "300/75x300/75+600+0", "none")
        window = self.open(self.scene, *SIZE, "--spp", "2")
        window.move(650, 50)
        window.key("F11")
        self.assertTrue(window.wait_until(lambda: window.place() == (600, 0, 300, 300)), window.place())
        self.assertIn("--size=300x300", window.wait_until(lambda: (lambda c: c if "300x300" in c else None)(window.save()), 0.5) or "")
        window.key("F11")
        self.assertTrue(window.wait_until(lambda: window.place() == (650, 50, 200, 150)), window.place())
        self.assertEqual(window.close(), 0)

    def test_text_is_as_dense_as_the_monitor(self):
        heights = []
        for dpi in [96, 192]:
            self.use_screen(dpi=dpi)
            window = self.open(self.scene, "--size", "800x400", "--spp", "1")
            window.rest()
            lines = window.picture("700x400+0+0")
            window.key("i", "i")
            window.rest()
            plain = window.picture("700x400+0+0")
            row = 3 * 700
            changed = [y for y in range(400) if lines[2][y * row:(y + 1) * row] != plain[2][y * row:(y + 1) * row]]
            heights.append(changed[-1] - changed[0])
            self.assertEqual(window.close(), 0)
        self.assertGreater(heights[1], 1.8 * heights[0])  # also more rows, since fewer characters fit into one


class Keyboards(ViewCase):
    def eye(self, window):
        window.rest()
        return [float(x) for x in re.search(r"--eye=([^ ]+)", window.save())[1].split(",")]

    def test_letters_are_where_the_keyboard_has_them(self):
        self.screen.run("setxkbmap", "fr")
        window = self.open(self.scene, *SIZE, "--spp", "1")
        window.rest()
        window.hold("a")  # Q on a US keyboard
        self.assertGreater(self.eye(window)[0], 0.279)  # the camera looks along +z: left is +x
        window.key("E", "E", "E")
        self.assertIn("--exposure=1 ", window.save())
        window.key("super+q")  # for the window manager
        shown = window.picture()
        window.key("question")
        window.rest()
        self.assertGreater(mean_difference(window.picture(), shown), 5)
        self.assertEqual(window.close(), 0)

    def test_other_letters_are_taken_by_their_places(self):
        self.screen.run("setxkbmap", "ru")
        window = self.open(self.scene, *SIZE, "--spp", "1")
        window.rest()
        window.hold("Cyrillic_ef")  # A on a US keyboard
        window.key("Cyrillic_U", "Cyrillic_U", "Cyrillic_U", "Cyrillic_e", "Cyrillic_u")  # E three times, a letter without effect, e
        window.rest()
        window.key("Cyrillic_yeru")  # S
        window.wait_until(lambda: "\n" in window.text())
        self.assertIn("--exposure=0.666666667", window.text())
        self.assertGreater(float(re.search(r"--eye=([^,]+)", window.text())[1]), 0.279)
        window.key("Cyrillic_shorti")  # Q
        self.assertEqual(window.process.wait(GUARD), 0)


class Broken(ViewCase):
    def test_files_that_go_are_told_of_and_come_back(self):
        sky = write_exr(self.path("sky.exr"), 2, 2, {"R": [1.0] * 4, "G": [1.0] * 4, "B": [1.0] * 4})
        window = self.open(self.scene, *SIZE, "--spp", "4", "--env", sky)
        window.rest()
        plain = window.picture()

        def differs():
            return mean_difference(window.picture(), plain)
        for spoil in [lambda: None, lambda: os.mkdir(self.scene), lambda: shutil.copy(__file__, self.scene)]:
            os.rename(self.scene, self.path("kept"))
            spoil()
            self.assertTrue(window.wait_until(lambda: differs() > 2))
            self.assertGreater(len(set(window.picture("200x20+0+55")[2])), 8)  # the last picture stays
            if os.path.isdir(self.scene):
                os.rmdir(self.scene)
            os.rename(self.path("kept"), self.scene)
            self.assertTrue(window.wait_until(lambda: window.rest() or differs() < 1))
        shutil.copy(write_exr(self.path("green.exr"), 2, 2, {"R": [0.0] * 4, "G": [9.0] * 4, "B": [0.0] * 4}), sky)
        self.assertTrue(window.wait_until(lambda: differs() > 5))
        self.assertEqual(window.close(), 0)

    def test_a_lost_texture_keeps_the_picture_and_is_told_of(self):
        scene, _ = quad_scene(material={"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}})
        attributes = scene["meshes"][0]["primitives"][0]["attributes"]
        attributes["TEXCOORD_0"] = attributes["POSITION"]
        scene["accessors"].append(dict(scene["accessors"][0], type="VEC2"))
        scene["accessors"][2].pop("min"), scene["accessors"][2].pop("max")
        attributes["TEXCOORD_0"] = 2
        scene.update(textures=[{"source": 0}], images=[{"uri": "red.png"}])
        path, red = write_gltf(self.path("red.gltf"), scene), self.path("red.png")
        subprocess.run(["convert", "-size", "2x2", "xc:#c00000", red], check=True)
        arguments = [path, *SIZE, "--spp", "1", "--integrator", "raster"]
        window = self.open(*arguments)
        window.rest()
        window.key("i", "i")
        window.rest()
        plain, low = window.picture(), window.picture("60x40+70+100")

        def tells():
            return mean_difference(window.picture("200x40+0+0"), (200, 40, plain[2][:3 * 200 * 40])) > 1
        for spoil in [lambda: os.truncate(red, 40), lambda: os.remove(red)]:
            with open(red, "rb") as file:
                whole = file.read()
            spoil()
            self.assertTrue(window.wait_until(tells), "not told of")
            window.rest()
            self.assertEqual(window.picture("60x40+70+100"), low)
            with open(red, "wb") as file:
                file.write(whole)
            self.assertTrue(window.wait_until(lambda: window.picture() == plain))
        self.assertEqual(window.close(), 0)
        os.remove(red)
        window = self.open(*arguments)  # then it shows white, and says so
        window.key("i", "i")
        window.rest()
        self.assertTrue(tells(), "not told of at first")
        self.assertNotEqual(window.picture("60x40+70+100"), low)
        with open(red, "wb") as file:
            file.write(whole)
        self.assertTrue(window.wait_until(lambda: window.picture() == plain))
        self.assertEqual(window.close(), 0)

    def test_effects_that_were_left_out_stay_so_over_a_scene_without_them(self):
        window = self.open(self.scene, *SIZE, "--spp", "1", "--integrator", "raster", "--without", "emission")
        window.rest()
        with open(self.scene, encoding="utf-8") as file:
            text = file.read()
        for changed, says in [(re.sub(r'"emissiveFactor":\s*\[[^]]*\]', '"emissiveFactor":[0,0,0]', text), False), (text, True)]:
            with open(self.scene, "w", encoding="utf-8") as file:
                file.write(changed)
            self.assertTrue(window.wait_until(lambda: ("--without=emission" in window.save()) == says, 0.5), window.text())
        self.assertEqual(window.close(), 0)

    def test_a_folder_that_is_a_link_to_another_is_followed(self):
        for name, light in [("one", "[9,9,9]"), ("two", "[0,0,0.05]")]:
            shutil.copytree(self.folder, self.path(name), ignore=shutil.ignore_patterns("*.txt", "one", "tmp*"))
            with open(self.path(name, "box.gltf"), encoding="utf-8") as file:
                text = file.read()
            with open(self.path(name, "box.gltf"), "w", encoding="utf-8") as file:
                file.write(re.sub(r'"emissiveFactor":\s*\[[^]]*\]', f'"emissiveFactor":{light}', text))
        os.mkdir(self.path("links"))
        os.symlink("one", self.path("now"))
        os.symlink("../now", self.path("links", "shown"))
        window = self.open(self.path("links", "shown", "box.gltf"), *SIZE, "--spp", "1", "--integrator", "raster")
        window.rest()
        lit = window.picture("200x60+0+0")
        os.symlink("two", self.path("next"))
        os.rename(self.path("next"), self.path("now"))
        self.assertTrue(window.wait_until(lambda: mean_difference(window.picture("200x60+0+0"), lit) > 5))
        self.assertEqual(window.close(), 0)

    def test_a_lost_device_is_told_of_and_closes(self):
        window = self.open(self.scene, *SIZE, "--spp", "100000", "--replicates", "4",
                           env={"LD_PRELOAD": os.environ["ECLAT_FAULT_SHIM"], "FAULT_CALL": "clEnqueueNDRangeKernel", "FAULT_AT": "3000", "FAULT_LOST": "1"})
        window.rest()
        self.assertGreater(len(set(window.picture("200x60+0+40")[2])), 8)  # the part that was complete
        command = window.save()
        self.assertRegex(command, r"--spp=\d+ --replicates=4 ")
        self.assertEqual(window.close(), 0)

    def test_sizes_that_are_none(self):
        script = self.path("save.txt")
        wide = write_exr(self.path("wide.exr"), 500, 3, {c: [0.5] * 1500 for c in "RGB"})
        with open(script, "w", encoding="utf-8") as file:
            file.write("key v\nkey Tab\nkey Tab\nkey Tab\nsettle\nkey Save\nquit\n")
        for size, saved in [("1x1", "1x1"), ("20000x20", "1280x1")]:
            run = subprocess.run([os.environ["ECLAT"], "view", self.scene, "--size", size, "--spp", "2", "--against", wide, "--script", script],
                                 env=dict(self.screen.environment, LIBGL_ALWAYS_SOFTWARE="1"), cwd=self.folder, capture_output=True, text=True,
                                 timeout=GUARD, check=False)
            self.assertEqual((run.returncode, run.stderr), (0, ""))
            self.assertIn("--size=" + saved, run.stdout)


if __name__ == "__main__":
    unittest.main()

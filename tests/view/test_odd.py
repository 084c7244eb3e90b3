# tier: full
"""The preview window with unusual input: extreme scrolling, scripts that wait, dozens of cameras, places that cannot be written to."""
import json
import os
import shutil
import subprocess

from virtual_screen import ViewCase, mean_difference
from polling import GUARD
from support import ECLAT, eclat, move_node, quad_scene, read_exr, write_exr, write_gltf

SIZE = ["--size", "200x150"]
SMALL = ["--size", "16x16", "--spp", "1", "--integrator", "raster"]


def moving_quad():
    """The object moves one unit to the right and half a unit up within a second."""
    scene, _ = quad_scene()
    move_node(scene, 0, (0, 0, 0), (1, 0.5, 0))
    return scene


class Odd(ViewCase):
    def script(self, scene, lines, *arguments):
        """Runs a script to its end."""
        path = self.path("script.txt")
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(lines))
        return subprocess.run([ECLAT, "view", scene, "--script", path, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=GUARD,
                              check=False, env=dict(self.screen.environment, LIBGL_ALWAYS_SOFTWARE="1"))

    def change_scene(self, change):
        with open(self.scene, encoding="utf-8") as file:
            scene = json.load(file)
        change(scene)
        return write_gltf(self.scene, scene)

    def lower(self, window):
        """The picture without the overlay's lines."""
        window.rest()
        return window.picture("200x100+0+0")

    def test_a_wheel_turned_sideways_moves_nothing(self):
        window = self.open(self.scene, *SIZE, "--spp", "2")
        window.tool("mousemove", "--window", window.id, 100, 70, "click", "--repeat", 5, 6, "click", 7)
        window.rest()
        self.assertNotIn("--eye", window.save())
        self.assertEqual(window.close(), 0)

    def test_extreme_distances(self):
        window = self.open(self.scene, *SIZE, "--spp", "2")
        window.key("i", "i")
        first = self.lower(window)
        window.tool("mousemove", "--window", window.id, 100, 70)
        for button, clicks in [(4, 300), (5, 1200)]:
            window.tool("click", "--repeat", clicks, "--delay", 1, button)
            window.rest()
            self.assert_repeats(window, window.save())
        window.key("r")
        self.assertEqual(self.lower(window), first)
        self.assertEqual(window.close(), 0)

    def test_any_of_many_cameras(self):
        def change(scene):
            node = next(n for n in scene["nodes"] if "camera" in n)
            for i in range(80):
                scene["nodes"].append(dict(node, translation=[0.278 + 0.001 * i, 0.273, -0.8]))
                scene["scenes"][0]["nodes"].append(len(scene["nodes"]) - 1)
        self.change_scene(change)
        window = self.open(self.scene, *SIZE, "--spp", "2", "--camera", "70")
        window.rest()
        self.assertIn("--camera=70 ", window.save())
        window.key("c")
        window.rest()
        command = window.save()
        self.assertIn("--camera=71 ", command)
        self.assert_repeats(window, command)
        window.key("r")
        window.rest()
        self.assertIn("--camera=70 ", window.save())
        self.assertEqual(window.close(), 0)

    def test_a_camera_that_will_not_do_is_told_of_and_left_again(self):
        def change(scene):
            node = next(n for n in scene["nodes"] if "camera" in n)
            scene["cameras"].append({"type": "orthographic", "orthographic": {"xmag": 0.3, "ymag": 0.3, "znear": 0.01, "zfar": 10}})
            scene["nodes"].append(dict(node, camera=1))
            scene["scenes"][0]["nodes"].append(len(scene["nodes"]) - 1)
        self.change_scene(change)
        window = self.open(self.scene, *SIZE, "--spp", "2", "--fstop", "8", "--focus", "1")
        window.key("i", "i")
        first = self.lower(window)
        window.key("c")
        self.assertGreater(mean_difference(self.lower(window), first), 1)  # the message says why
        window.key("c")
        self.assertEqual(self.lower(window), first)
        self.assertEqual(window.close(), 0)
        run = self.script(self.scene, ["settle", "key c", "settle", "key Save", "quit"], *SIZE, "--spp", "2", "--fstop", "8", "--focus", "1")
        self.assertIn("orthographic", self.assert_one_error(run, 1))

    def test_blurred_scenes_by_integrators_that_do_not_blur(self):
        scene = moving_quad()
        window = self.open(write_gltf(self.path("moves.gltf"), scene), *SIZE, "--spp", "4", "--shutter", "0.5:1")
        window.rest()
        commands = [window.save()]
        for key in ["2", "3"]:
            window.key(key)
            window.rest()
            commands.append(window.save())
        for command, words in zip(commands, ["--shutter=0.5:1 ", "--at=0.75 --integrator=whitted", "--integrator=raster"]):
            self.assertTrue(all(word in command for word in words.split()), command)
            self.assert_repeats(window, command)
        self.assertEqual(window.close(), 0)

    def test_commands_say_what_of_the_file_is_shown(self):
        scene = moving_quad()
        scene["scenes"].append({"name": "both", "nodes": [0, 1, 2]})
        scene["nodes"].append({"mesh": 0, "translation": [0.5, 0.5, -1]})
        scene["materials"].append({"emissiveFactor": [1, 0, 0]})
        scene["extensionsUsed"] = ["KHR_materials_variants"]
        scene["extensions"] = {"KHR_materials_variants": {"variants": [{"name": "white"}, {"name": "the red one"}]}}
        scene["meshes"][0]["primitives"][0]["extensions"] = {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [1]}]}}
        shown = ["--scene", "both", "--variant", "the red one", "--at", "0.5"]
        window = self.open(write_gltf(self.path("some of all.gltf"), scene), *SIZE, "--spp", "4", *shown)
        window.rest()
        command = window.save()
        for word in ["--scene=both", "'--variant=the red one'", "--at=0.5"]:
            self.assertIn(word, command)
        self.assert_repeats(window, command)
        self.assertEqual(window.close(), 0)

    def test_more_effects_than_digits(self):
        scene, _ = quad_scene()
        effects = {"KHR_materials_clearcoat": {"clearcoatFactor": 1}, "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1]},
                   "KHR_materials_iridescence": {"iridescenceFactor": 1}, "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5},
                   "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_unlit": {}}
        scene["materials"] += [{"extensions": {name: values}, "pbrMetallicRoughness": {"metallicFactor": 0}} for name, values in effects.items()]
        scene["materials"].append({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}})
        for i in range(1, 8):
            scene["meshes"].append({"primitives": [dict(scene["meshes"][0]["primitives"][0], material=i)]})
            scene["scenes"][0]["nodes"].append(len(scene["nodes"]))
            scene["nodes"].append({"mesh": i, "translation": [0.1 * i, 0, -0.1 * i]})
        scene["extensionsUsed"] = [*effects, "KHR_lights_punctual"]
        scene["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}
        scene["nodes"][1]["extensions"] = {"KHR_lights_punctual": {"light": 0}}
        window = self.open(write_gltf(self.path("all.gltf"), scene), *SIZE, "--spp", "2", "--integrator", "raster")
        window.rest()
        window.key("x", "1", "0", "1")
        window.rest()
        self.assertEqual(window.save().count("--without="), 2)
        self.assertEqual(window.close(), 0)

    def test_exposure_ends_where_the_program_takes_no_more(self):
        window = self.open(self.scene, *SIZE, "--spp", "2")
        window.rest()
        window.tool("key", "--delay", 1, *["E"] * 320)
        window.rest()
        command = window.save()
        self.assertIn("--exposure=100 ", command)
        self.assert_repeats(window, command)
        self.assertEqual(window.close(), 0)

    def test_the_second_picture_matches_its_label(self):
        window = self.open(self.scene, *SIZE, "--spp", "1")
        window.key("i", "i")
        window.rest()
        window.tool("mousemove", "--window", window.id, 2, 75)
        window.rest()
        crop = "190x90+10+0"
        plain = window.picture(crop)
        window.key("v")  # the error, which is unknown after one sample
        window.rest()
        self.assertEqual(window.picture(crop), plain)

        def is_even():
            values = window.picture(crop)[2]
            return values == values[:3] * (len(values) // 3)
        window.key("Tab", "i", "i", "i")  # the number of samples
        self.assertTrue(window.wait_until(is_even), "not as many samples everywhere")
        window.tool("keydown", "d")
        self.assertTrue(window.wait_until(lambda: not is_even(), 0.05), "samples of another camera")
        window.tool("keyup", "d")
        window.rest()
        self.assertTrue(window.wait_until(is_even), "not as many samples everywhere, again")
        self.assertEqual(window.close(), 0)

    def test_a_script_settles_on_what_its_keys_asked_for(self):
        run = self.script(self.scene, ["settle", "key 3", "settle", "key Save", "key v", "key Tab", "key Tab", "settle", "key 1", "settle", "key Save",
                                       "quit"], *SIZE, "--spp", "64")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        raster, path = run.stdout.splitlines()
        self.assertIn("--integrator=raster --spp=64 ", raster)
        self.assertIn("--spp=64 ", path)
        self.assertNotIn("--integrator", path)

    def test_what_is_saved_is_what_was_shown(self):
        run = self.script(self.scene, ["settle", "key M", "wait 0.2", "key Save", "key e", "turn 40 0 0.2", "quit"], "--size", "200x150", "--spp",
                          "64")
        self.assertEqual((run.returncode, run.stderr, run.stdout.count("\n")), (0, "", 1))
        self.assertNotIn("--eye", run.stdout)
        self.assertNotIn("--exposure", run.stdout)
        # The picture is so large that its first sample takes longer than the frame between the two steps.
        run = self.script(self.scene, ["key Save", "turn 40 0 0", "settle", "quit"], "--size", "2400x1800", "--spp", "1")
        self.assertIn("moved", self.assert_one_error(run, 1))
        self.assertEqual(run.stdout, "")

    def test_a_picture_that_is_asked_for_as_one_leaves_is_waited_for(self):
        window = self.open(self.scene, "--size", "300x200", "--spp", "64")
        window.key("s", "q")
        self.assertEqual((window.process.wait(GUARD), window.text("err")), (0, ""))
        self.assertIn("--size=300x200", window.text())

    def test_few_samples_have_an_error_too(self):
        files = {}
        for spp in [1, 4]:
            run = self.script(self.scene, ["settle", "key Save"], "--size", "16x16", "--spp", str(spp), "-o", self.path(f"{spp}.exr"))
            self.assertEqual((run.returncode, run.stderr), (0, ""))
            files[spp] = read_exr(self.path(f"{spp}.exr"))[0]
        self.assertEqual(files[1]["eclat.relMSE"], float("inf"))
        self.assertEqual((files[1]["eclat.replicates"], files[4]["eclat.replicates"]), (1, 4))
        self.assertLess(files[4]["eclat.error"], 10)

    def test_the_camera_that_a_changed_file_left_behind_repeats_too(self):
        def stand(*place):  # near the centre, floats have more digits than in the file's coordinates
            self.change_scene(lambda scene: next(n for n in scene["nodes"] if "camera" in n).update(translation=place))
        stand(0.2781234567, 0.2731234567, -0.8)
        window = self.open(self.scene, *SIZE, "--spp", "1")
        before = window.save()
        stand(0.2, 0.3, -0.9)
        after = window.wait_until(lambda: (lambda c: c if "--eye" in c else None)(window.save()), 0.5)
        self.assertNotIn("--eye", before)
        self.assert_repeats(window, after)
        self.assertEqual(window.close(), 0)

    def test_a_script_acts_like_keys(self):
        run = self.script(self.scene, ["# " + "a long word " * 30, "turn 90 0 0", "key x", "key 1", "key x", "settle", "key Save"], *SMALL)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        for word in ["--eye=", "--integrator=raster", "--without=emission"]:
            self.assertIn(word, run.stdout)

    def test_names_that_look_like_options(self):
        shutil.copy(self.scene, self.path("-box.gltf"))
        run = self.script("--size=16x16", ["settle", "key Save"], *SMALL[2:], "--", "-box.gltf")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assert_ok(eclat(*run.stdout.split()[1:], cwd=self.folder))

    def test_what_could_not_be_saved_is_told_of_at_the_end(self):
        os.mkdir(self.path("away"))
        name = self.path("away", "a.exr")
        window = self.open(self.scene, *SIZE, "--spp", "2", "-o", name)
        window.rest()
        plain = window.picture("200x60+0+0")
        os.rmdir(self.path("away"))
        window.key("s")
        self.assertTrue(window.wait_until(lambda: mean_difference(window.picture("200x60+0+0"), plain) > 1))
        self.assertEqual(window.close(), 1)
        self.assertRegex(window.text("err"), rf"\Aeclat: error: .*{name}.*\n\Z")
        window = self.open(self.scene, *SIZE, "--spp", "2")  # if the problem has gone meanwhile, there is no message
        self.assertEqual((window.save() != "", window.close()), (True, 0))
        run = self.script(self.scene, ["quit"], "-o", name)
        self.assertIn(name, self.assert_one_error(run, 1))  # at once, not after an hour

    def test_a_picture_without_colours_stands_beside_nothing(self):
        depth = write_exr(self.path("depth.exr"), 2, 2, {"Z": [1.0] * 4})
        self.assertIn("no channels R, G, B", self.assert_one_error(self.script(self.scene, ["quit"], "--against", depth), 1))

    def test_commands_are_as_long_as_they_must_be(self):
        def deep(name, last):
            folder = self.path(name, *["d" * 250] * 14)
            os.makedirs(folder)
            return os.path.join(folder, last)
        scene = shutil.copy(self.scene, deep("in", "box.gltf"))
        shutil.copy(self.path("cornell-box.bin"), os.path.dirname(scene))
        sky = shutil.copy(write_exr(self.path("sky.exr"), 2, 2, {c: [1.0] * 4 for c in "RGB"}), deep("sky", "sky.exr"))
        outputs = [word for i in range(4) for word in ["-o", deep(f"out{i}", f"{i}." + ["exr", "png"][i % 2])]]
        run = self.script(scene, ["settle", "key Save", "quit"], *SIZE, "--spp", "2", "--env", sky, *outputs)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        words = run.stdout.split()
        self.assertEqual(words[-8:], outputs)
        self.assertGreater(len(run.stdout), 16384)

"""The package except for pictures: scenes, options, messages, progress, interruption, studies, frames."""
import io
import json
import logging
import os
import signal
import struct
import sys
import threading
import unittest
from concurrent.futures import ThreadPoolExecutor
from contextlib import redirect_stderr
from unittest import mock

import eclat
from package_case import CORNELL, SMALL, Case, support

from polling import poll_until

LONG = {"spp": 1000000, "size": (64, 64)}


class Scenes(Case):
    def test_load(self):
        scene = eclat.load(CORNELL)
        self.assertEqual((scene.info["triangles"], len(scene.info["cameras"])), (38, 1))
        self.assertIn("38 triangles", repr(scene))
        self.assertEqual(scene.info["effects"], eclat.info(CORNELL)["effects"])
        self.assertNotIn("emission", [each["name"] for each in eclat.info(CORNELL, without="emission")["effect_list"] if each["called_for"]])

    def test_what_cannot_be_loaded(self):
        self.assertIn("nothing.gltf", self.error_of(eclat.load, self.folder / "nothing.gltf"))
        broken = self.folder / "broken.gltf"
        broken.write_text('{"asset": ')
        self.assertIn("broken.gltf", self.error_of(eclat.load, broken))
        self.assertIn("broken.gltf", self.error_of(eclat.cost, broken))

    def test_names_that_are_no_text(self):
        path = os.path.join(os.fsencode(self.folder), b"\xff.gltf")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(support.quad_scene()[0], file)
        self.assertEqual(eclat.load(os.fsdecode(path)).info["triangles"], 2)

    def test_devices(self):
        found = eclat.devices()
        self.assertEqual([device.index for device in found], list(range(len(found))))
        self.assertEqual(sum(device.is_default for device in found), 1)
        self.assertTrue(found[0].name and found[0].platform and found[0].memory_bytes > 0)
        picture = eclat.load(CORNELL).render(spp=1, size=(8, 8), device=0)
        self.assertEqual(picture.attributes["eclat.device"], found[0].name)


class Options(Case):
    def test_unknown_ones(self):
        render = eclat.load(CORNELL).render
        for name, told in (("adaptve", "did you mean adaptive"), ("lightchoice", "did you mean light_choice"), ("qqq", "no option qqq"),
                           ("json", "Python"), ("output", "save"), ("frames", "render_frames")):
            with self.assertRaisesRegex(TypeError, told):
                render(**{name: "1"})
        with self.assertRaisesRegex(TypeError, "no option spp"):
            eclat.cost(CORNELL, spp=3)
        with self.assertRaisesRegex(TypeError, "eye cannot be"):
            render(eye=object())

    def test_wrong_values_have_the_library_s_message(self):
        render = eclat.load(CORNELL).render
        for words, options in ((["--spp", "-1"], {"spp": -1}), (["--size", "0x3"], {"size": (0, 3)}), (["--integrator", "none"], {"integrator": "none"}),
                               (["--eye", "1,2"], {"eye": (1, 2)})):
            run = support.eclat("render", CORNELL, *words)
            told = self.error_of(render, kind="usage", **options)
            self.assertIn(told, run.stderr)
        self.assertIn("no such device", self.error_of(render, device="no such device"))


class Messages(Case):
    def test_warnings_and_the_log(self):
        path = support.write_gltf(self.folder / "odd.gltf", support.quad_scene(material={"pbrMetallicRoughness": {"roughnessFactor": 3}})[0])
        with self.assertWarnsRegex(eclat.Warning, "out of glTF's range") as caught:
            scene = eclat.load(path)
        self.assertEqual(caught.filename, __file__)  # the caller's line
        with self.assertLogs("eclat", logging.INFO) as logged, self.assertWarns(eclat.Warning) as caught:
            scene.render(spp=1, size=(8, 8))
        self.assertEqual(caught.filename, __file__)
        self.assertIn("rendering 8x8 pixels", "".join(logged.output))


class Progress(Case):
    def test_a_callback_in_the_caller_s_thread(self):
        told = []
        eclat.load(CORNELL).render(spp=64, size=(24, 16), progress=lambda progress: told.append((threading.get_ident(), progress)))
        self.assertEqual({thread for thread, _ in told}, {threading.get_ident()})
        fractions = [progress.fraction for _, progress in told]
        self.assertEqual(fractions, sorted(fractions))
        self.assertLessEqual(fractions[-1], 1)
        self.assertTrue(all(progress.error is None or progress.error > 0 for _, progress in told))
        self.assertIn("spp", told[0][1].text)

    def test_false_keeps_the_picture_so_far(self):
        picture = eclat.load(CORNELL).render(**LONG, progress=lambda progress: progress.samples < 16)
        self.assertEqual(picture.attributes["eclat.stoppedBy"], "user")
        self.assertLessEqual(16, picture.samples)
        self.assertLess(picture.samples, LONG["spp"])
        self.assertGreater(picture.error, 0)

    def test_a_slow_callback_sees_the_latest(self):
        """Reports arrive while the caller is busy; afterwards it gets one of them, not all."""
        counts, scene = [], eclat.load(CORNELL)

        def look(progress):
            counts.append(progress.samples)
            if len(counts) == 1:
                poll_until(lambda: len([thread for thread in threading.enumerate() if thread.name == "eclat"]) == 0)  # the render is over
        scene.render(spp=64, size=(24, 16), progress=look)
        self.assertLessEqual(len(counts), 2)

    def test_what_a_callback_raises_ends_the_render(self):
        def fail(progress):
            raise ZeroDivisionError("mine")
        with self.assertRaisesRegex(ZeroDivisionError, "mine"):
            eclat.load(CORNELL).render(**LONG, progress=fail)

    def test_a_bar(self):
        with redirect_stderr(io.StringIO()) as told:
            eclat.load(CORNELL).render(spp=64, size=(24, 16), progress=True)
        self.assertIn("spp", told.getvalue())
        self.assertIn("tqdm", sys.modules)
        with redirect_stderr(io.StringIO()) as told, mock.patch.dict(sys.modules, {"tqdm.auto": None}):
            eclat.load(CORNELL).render(spp=64, size=(24, 16), progress=True)
        self.assertIn("spp", told.getvalue())

    def test_other_threads_go_on(self):
        counts, end = [0], threading.Event()

        def count():
            while not end.is_set():
                counts[0] += 1
        thread = threading.Thread(target=count)
        thread.start()
        seen = set()

        def look(progress):
            seen.add(counts[0])
            return len(seen) < 3
        eclat.load(CORNELL).render(**LONG, progress=look)
        end.set()
        thread.join()
        self.assertGreaterEqual(len(seen), 3)  # one more report may arrive while the third is being answered


class Threads(Case):
    def test_renders_side_by_side(self):
        scene = eclat.load(CORNELL)
        alone = [scene.render(**SMALL, seed=seed).attributes["eclat.imageSha256"] for seed in range(3)]
        with ThreadPoolExecutor() as pool:
            together = pool.map(lambda seed: scene.render(**SMALL, seed=seed).attributes["eclat.imageSha256"], range(3))
            self.assertEqual(list(together), alone)


class Interruption(Case):
    def interrupt(self, **options):
        """Ctrl-C at the second report of progress, while the thread waits inside the library."""
        threads, reports = threading.active_count(), []

        def press(progress):
            reports.append(progress)
            if len(reports) == 2:
                os.kill(os.getpid(), signal.SIGINT)
        with self.assertRaises(KeyboardInterrupt):
            eclat.load(CORNELL).render(**LONG, progress=press, **options)
        self.assertEqual(threading.active_count(), threads)

    def test_ctrl_c(self):
        self.interrupt()
        self.assertEqual(eclat.load(CORNELL).render(**SMALL).samples, 16)

    def test_files_are_whole(self):
        checkpoint = self.folder / "kept.exr"
        self.interrupt(checkpoint=checkpoint, every="1h")
        self.assertEqual([name for name in os.listdir(self.folder) if name != "kept.exr"], [])
        with self.assertWarnsRegex(eclat.Warning, "missing"):
            kept = eclat.merge([checkpoint], partial=True).samples
        on = eclat.load(CORNELL).render(spp=int(kept) + 8, resume=checkpoint)
        self.assertEqual(on.samples, kept + 8)

    def test_while_nothing_is_reported(self):
        """The signal interrupts a thread that waits without a callback."""
        scene, log = eclat.load(CORNELL), logging.getLogger("eclat")
        begun = logging.Handler()
        begun.emit = lambda record: threading.Thread(target=os.kill, args=(os.getpid(), signal.SIGINT)).start()
        log.addHandler(begun)
        self.addCleanup(log.removeHandler, begun)
        self.addCleanup(log.setLevel, log.level)
        log.setLevel(logging.INFO)
        with self.assertRaises(KeyboardInterrupt):
            scene.render(**LONG)


class Studies(Case):
    def test_cost(self):
        page = self.folder / "study.html"
        report = eclat.load(CORNELL).cost(budget=4, size=(16, 16), html=page)
        self.assertEqual((report["width"], report["budget_seconds"]), (16, 4))
        self.assertTrue(report["rungs"])
        self.assertIn("<html", page.read_text(encoding="utf-8"))

    def test_frames(self):
        scene, buffer = support.quad_scene()
        times = struct.pack("<8f", 0, 1, 0, 0, 0, 0.5, 0, 0)
        scene["buffers"].append({"byteLength": len(times), "uri": support.data_uri(times)})
        scene["bufferViews"] += [{"buffer": 1, "byteLength": 8}, {"buffer": 1, "byteOffset": 8, "byteLength": 24}]
        scene["accessors"] += [{"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                               {"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3"}]
        scene["animations"] = [{"samplers": [{"input": 2, "output": 3}], "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]
        path = support.write_gltf(self.folder / "moves.gltf", scene)
        reports = eclat.load(path).render_frames((0, 1), self.folder / "f.%d.exr", fps=1, spp=4, size=(8, 8))
        self.assertTrue((self.folder / "f.0.exr").exists() and (self.folder / "f.1.exr").exists())
        self.assertGreaterEqual(len(reports), 2)
        self.assertTrue(eclat.compare(self.folder / "f.0.exr", self.folder / "f.1.exr").differ)


    def test_orbit_and_sheet(self):
        path = support.write_gltf(self.folder / "a.gltf", support.quad_scene(material={"emissiveFactor": [1, 1, 1], "doubleSided": True})[0])
        reports = eclat.load(path).render_orbit(3, self.folder / "o.%d.png", sheet=self.folder / "sheet.png", spp=1, size=(8, 8))
        self.assertEqual([report.get("frame_degrees") for report in reports[:3]], [0, 120, 240])
        self.assertTrue(all((self.folder / name).exists() for name in ("o.0.png", "o.1.png", "o.2.png", "sheet.png")))

    def test_many_scenes(self):
        paths = [support.write_gltf(self.folder / f"{name}.gltf", support.quad_scene()[0]) for name in "abc"]
        reports = eclat.render_all([eclat.load(paths[0]), *paths[1:]], self.folder / "{name}.exr", spp=1, size=(8, 8), shard=(1, 2))
        self.assertEqual([report.get("name") for report in reports[:-1]], [str(paths[0]), str(paths[2])])
        self.assertEqual(reports[-1]["rendered"], 2)
        self.assertFalse((self.folder / "b.exr").exists())
        with self.assertRaisesRegex(eclat.Error, "1 of 4 pictures failed"):
            eclat.render_all([*paths, self.folder / "missing.gltf"], self.folder / "{name}.exr", spp=1, size=(8, 8))
        self.assertTrue((self.folder / "b.exr").exists())

    def test_scenarios(self):
        support.write_gltf(self.folder / "a.gltf", support.quad_scene()[0])
        file = self.folder / "config.json"
        file.write_text(json.dumps({"scenarios": [{"name": "first", "model": "a.gltf"}]}), encoding="utf-8")
        reports = eclat.render_scenarios(file, self.folder / "out", spp=1, size=(8, 8))
        self.assertEqual(reports[0]["name"], "first")
        self.assertTrue((self.folder / "out" / "index.html").exists())


if __name__ == "__main__":
    unittest.main()

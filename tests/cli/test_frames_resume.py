# tiers: quick, full
"""Frames that are there already: done ones are skipped, and other files are refused."""
import os
import signal
import subprocess
import unittest

from polling import GUARD, poll_until
from support import ECLAT, ENVIRONMENT, eclat, read_exr
from test_frames import LAMP, SMALL, FramesCase, rows_of
from test_motion import Builder
from tiers import full


class Going(FramesCase):
    def frames(self, *options, scene=None):
        return rows_of(self.render(scene or self.sliding(), "--frames", "0:3", "-o", "f.%04d.exr", *options))

    def test_what_is_done_is_skipped(self):
        first, _ = self.frames()
        before = {name: os.stat(self.path(name)).st_mtime_ns for name in os.listdir(self.folder) if name.endswith(".exr")}
        self.assertEqual(sorted(before), [f"f.000{k}.exr" for k in range(4)])
        os.remove(self.path("f.0002.exr"))
        rows, last = self.frames()
        self.assertEqual([row["state"] for row in rows], ["skipped", "skipped", "rendered", "skipped"])
        self.assertEqual((last["rendered"], last["skipped"]), (1, 3))
        self.assertEqual(rows[2]["image_sha256"], first[2]["image_sha256"])
        for name in before:
            self.assertEqual(os.stat(self.path(name)).st_mtime_ns == before[name], name != "f.0002.exr")

    @full
    def test_others_are_refused_before_anything_is_rendered(self):
        scene = self.sliding()
        self.frames(scene=scene)
        os.remove(self.path("f.0000.exr"))
        common = ["--frames", "0:3", "-o", "f.%04d.exr"]
        for says, *options in (("--spp is 4 there and 8 here", "--spp", "8"), ("--seed is not given there and 1 here", "--seed", "1"),
                               ("moment is 0.041666666666666664 s there", "--fps", "12"), ("--env is not given there and 1,1,1 here", "--env", "1,1,1")):
            with self.subTest(says):
                self.refuse(scene, "'f.0001.exr' already exists: " + says, *common, *options, code=1)
                self.refuse(scene, "(3 frames in all); --overwrite", *common, *options, code=1)
                self.assertFalse(os.path.exists(self.path("f.0000.exr")))
        _, last = self.frames("--spp", "8", "--overwrite", scene=scene)
        self.assertEqual(last["rendered"], 4)
        self.assertEqual(read_exr(self.path("f.0001.exr"))[0]["eclat.samplesPerPixel"], 8)

    def test_a_changed_scene_is_another(self):
        scene = self.sliding()
        self.frames(scene=scene)
        with open(scene, encoding="utf-8") as file:
            text = file.read()
        with open(scene, "w", encoding="utf-8") as file:
            file.write(text.replace("0.6", "0.7"))
        self.refuse(scene, "the scene's files differ", "--frames", "0:3", "-o", "f.%04d.exr", code=1)

    def test_what_does_not_matter_is_not_compared(self):
        scene = self.sliding()
        self.frames(scene=scene)
        _, last = self.frames("--lanes", "4", "--wave", "2048", "--accel", "kdtree", "--effects", "all", "--memory", "2G", scene=scene)
        self.assertEqual(last["skipped"], 4)

    def test_damaged_and_foreign_files(self):
        scene = self.sliding()
        self.frames("-o", "f.%d.png", scene=scene)
        for name in ("f.0001.exr", "f.2.png"):
            with open(self.path(name), "rb") as file:
                whole = file.read()
            for bytes_there in (whole[:100], b"", b"nothing"):
                with open(self.path(name), "wb") as file:
                    file.write(bytes_there)
                self.refuse(scene, f"'{name}' already exists: it is not a frame", "--frames", "0:3", "-o", "f.%04d.exr",
                            "-o", "f.%d.png", code=1)
            with open(self.path(name), "wb") as file:
                file.write(whole)
        self.assertEqual(self.frames("-o", "f.%d.png", scene=scene)[1]["skipped"], 4)

    @full
    def test_damaged_frames_are_rendered_again(self):
        scene, outputs = self.sliding(), ["-o", "f.%d.png"]
        hashes = [row["image_sha256"] for row in self.frames(*outputs, scene=scene)[0]]
        names = ["f.0000.exr", "f.0001.exr", "f.0002.exr", "f.3.png"]
        whole = {}
        for name in names:
            with open(self.path(name), "rb") as file:
                whole[name] = file.read()
        part, flipped = len(whole[names[0]]) // 8, bytearray(whole[names[1]])
        flipped[-part] ^= 1
        damaged = [whole[names[0]][:-part] + b"\xff" * part, bytes(flipped), whole[names[2]][:-part],
                   whole[names[3]][:-30]]
        for name, content in zip(names, damaged):
            with open(self.path(name), "wb") as file:
                file.write(content)
        run = self.render(scene, "--frames", "0:3", "-o", "f.%04d.exr", *outputs)
        self.assertEqual(rows_of(run)[1]["rendered"], 4)
        self.assertEqual(run.stderr.splitlines(), [f"eclat: warning: '{name}' is damaged: frame {i} is rendered again"
                                                   for i, name in enumerate(names)])
        self.assertEqual([read_exr(self.path(name))[0]["eclat.imageSha256"] for name in names[:3]], hashes[:3])
        self.assertEqual(self.frames(*outputs, scene=scene)[1]["skipped"], 4)

    def test_pictures_alone_know_what_they_are_of(self):
        scene = self.sliding()
        rows_of(self.render(scene, "--frames", "0:1", "-o", "p.%d.png"))
        self.assertEqual(rows_of(self.render(scene, "--frames", "0:2", "-o", "p.%d.png"))[1]["skipped"], 2)
        self.refuse(scene, "--exposure is not given there and 1 here", "--frames", "0:2", "-o", "p.%d.png", "--exposure", "1", code=1)

    def test_a_picture_that_is_missing_beside_another(self):
        scene = self.sliding()
        self.frames(scene=scene)
        _, last = self.frames("-o", "f.%d.png", scene=scene)
        self.assertEqual(last["rendered"], 4)

    @full
    def test_killed_and_gone_on_with(self):
        scene, command = self.sliding(), ["--frames", "0:11", "--spp", "64", "-o", "k.%02d.exr"]
        whole, _ = rows_of(self.render(scene, *command[:-1], "whole.%02d.exr"))
        kills, done = 0, 0
        while kills < 3:
            process = subprocess.Popen([ECLAT, "render", scene, *SMALL, *command], cwd=self.folder, env=ENVIRONMENT)
            poll_until(lambda: len([name for name in os.listdir(self.folder) if name.startswith("k.")]) > done + 1, process)
            process.send_signal(signal.SIGKILL)
            process.wait()
            kills += 1
            done = len([name for name in os.listdir(self.folder) if name.startswith("k.")])
        rows, last = rows_of(self.render(scene, *command))
        self.assertEqual(last["skipped"], done)
        self.assertGreaterEqual(done, 2)
        for row in whole:
            number = row["frame"]
            self.assertEqual(read_exr(self.path(f"k.{number:02d}.exr"))[0]["eclat.imageSha256"], row["image_sha256"])

    def test_interrupted(self):
        scene, command = self.sliding(), ["--frames", "0:40", "--spp", "256", "--size", "32x32", "-o", "i.%02d.exr"]
        process = subprocess.Popen([ECLAT, "render", scene, "-q", *command], cwd=self.folder, env=ENVIRONMENT, stderr=subprocess.PIPE, encoding="utf-8")
        poll_until(lambda: os.path.exists(self.path("i.01.exr")), process)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=GUARD)
        self.assertEqual(process.returncode, 1)
        self.assertRegex(said, r"interrupted: (\d+) of 41 frames are done; the same command renders the others")
        there = [name for name in os.listdir(self.folder) if name.startswith("i.")]
        for name in there:
            self.assertEqual(read_exr(self.path(name))[0]["eclat.stoppedBy"], "spp")

    def test_a_frame_that_fails_leaves_the_others(self):
        b = Builder()
        b.animate(b.add(LAMP), "translation", [(0, 0, 0), (0, 0, 0), (float("nan"), 0, 0), (1, 0, 0), (1, 0, 0)],
                  times=(0.0, 0.5, 1.0, 1.5, 2.0))
        b.camera(2)
        scene = b.write(self.path("broken.gltf"))
        run = eclat("render", scene, *SMALL, "--frames", "0:2", "--fps", "1", "--json", "-o", "x.%d.exr", cwd=self.folder)
        self.assertEqual(run.returncode, 1)
        rows, last = rows_of(run)
        self.assertEqual([row["state"] for row in rows], ["rendered", "failed", "rendered"])
        self.assertIn("NaN", rows[1]["error"])
        self.assertEqual((last["rendered"], last["failed"]), (2, 1))
        self.assertIn("eclat: error: frame 1: ", run.stderr)
        self.assertIn("1 of 3 frames failed; once that is fixed, the same command renders only those", run.stderr.splitlines()[-1])
        self.assertEqual(sorted(name for name in os.listdir(self.folder) if name.endswith("exr")), ["x.0.exr", "x.2.exr"])


if __name__ == "__main__":
    unittest.main()

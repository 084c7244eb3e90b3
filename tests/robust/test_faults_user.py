# tier: quick
"""Situations of an ordinary user: folders and files of others, caches of others, full disks, no home. These runs change to another user
where they would run as root, who may do anything."""
import os
import shutil
import subprocess
import tempfile
import unittest

import support
from support import ENVIRONMENT, Case, eclat, move_node, quad_scene, write_gltf

USER = 54321 if os.geteuid() == 0 else os.geteuid()  # a user without a name in the system
AS_USER = {"user": USER, "group": USER, "extra_groups": []} if os.geteuid() == 0 else {}
SMALL = ("--size", "8x8", "--spp", "2", "--integrator", "raster", "-q")


@unittest.skipIf(subprocess.run([support.ECLAT, "--version"], env=ENVIRONMENT, stdout=subprocess.PIPE, check=False, **AS_USER).returncode,
                 "skipped: others than root cannot reach the program")
class UserCase(Case):
    @classmethod
    def setUpClass(cls):
        """Makes the caches, so that kernels are compiled once."""
        cls.pocl = tempfile.mkdtemp(prefix="eclat-user-")
        cls.addClassCleanup(shutil.rmtree, cls.pocl)
        cls.hand_over(cls.pocl)

    def setUp(self):
        super().setUp()
        self.scene = write_gltf(self.path("scene.gltf"), quad_scene()[0])
        self.out = self.make("out")
        self.locked = self.make("locked", 0o755)
        self.hand_over(self.folder)

    def make(self, name, mode=None):
        """Makes a folder of the user's own. With a mode it belongs to somebody else, or, where that is impossible, has no permissions."""
        os.mkdir(self.path(name))
        if mode is None:
            self.hand_over(self.path(name))
        else:
            self.close(self.path(name), mode)
        return self.path(name)

    @staticmethod
    def hand_over(path):
        if AS_USER:
            os.chown(path, USER, USER)

    def close(self, path, mode=0o600):
        os.chmod(path, mode if AS_USER else mode >> 3)
        self.addCleanup(os.chmod, path, 0o700)
        return path

    def run_as_user(self, *arguments, env=None, **options):
        return eclat(*arguments, env={"HOME": self.folder, "POCL_CACHE_DIR": self.pocl, **(env or {})}, cwd=self.out, **AS_USER, **options)

    def refuse(self, *arguments, says=(), **options):
        """Checks for one line, and that nothing is written."""
        line = self.assert_one_error(self.run_as_user(*arguments, **options), 1)
        for word in says:
            self.assertIn(word, line)
        self.assertEqual(os.listdir(self.out), [])


class Files(UserCase):
    def test_folders_of_others(self):
        there = os.path.join(self.locked, "a.")
        moving, _ = quad_scene()
        move_node(moving, 0, (0, 0, 0), (1, 0, 0))
        moving = write_gltf(self.path("moving.gltf"), moving)
        for command in [["render", self.scene, *SMALL, "-o", there + "png"], ["render", self.scene, *SMALL, "-o", "a.exr", "-o", there + "exr"],
                        ["render", self.scene, *SMALL, "-o", "a.png", "--checkpoint", there + "exr"],
                        ["render", self.scene, *SMALL, "-o", "a.png", "--snapshot", there + "exr"],
                        ["render", moving, *SMALL, "--fps", "2", "--frames", "0:1", "-o", there + "%04d.png"],
                        ["cost", self.scene, "--json", there + "json"]]:
            with self.subTest(command=command):
                self.refuse(*command, says=("cannot write '" + there, "Permission denied; "))
                self.assertEqual(os.listdir(self.locked), [])

    def test_files_of_others(self):
        with open(self.path("data.bin"), "wb") as file:
            file.write(quad_scene()[1])
        data = self.close(self.path("data.bin"))
        mine = write_gltf(self.path("mine.gltf"), quad_scene(uri="data.bin")[0])
        theirs = self.close(write_gltf(self.path("theirs.gltf"), quad_scene()[0]))
        for command, name in [(["render", theirs, *SMALL], theirs), (["info", mine], data), (["render", self.scene, *SMALL, "--env", data], data),
                              (["render", "--resume", data], data), (["merge", data, "-o", "a.exr"], data), (["compare", data, data], data),
                              (["render", "--scenarios", theirs, "--out", "a"], theirs)]:
            with self.subTest(command=command):
                self.refuse(*command, says=(name, "ermission"))

    def test_a_folder_that_is_gone(self):
        self.make("gone")
        words = 'cd "$1" && rmdir "$1" && exec "$2" render "$3" --spp 2 -o a.png', "sh", self.path("gone"), support.ECLAT, self.scene
        line = self.assert_one_error(self.run_as_user("-c", *words, program="/bin/sh"), 1)
        self.assertIn("cannot write 'a.png'", line)

    @unittest.skipUnless(AS_USER, "skipped: only root mounts a small disk")
    def test_a_full_disk(self):
        disk = self.make("disk")
        if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size=8k,mode=0700,uid={USER}", "tmpfs", disk], stderr=subprocess.PIPE, check=False).returncode:
            self.skipTest("no disk may be mounted here")
        self.addCleanup(subprocess.run, ["umount", "-l", disk], check=False)
        run = self.run_as_user("render", self.scene, *SMALL, "--size", "256x256", "-o", os.path.join(disk, "a.exr"))
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertIn("No space left on device", run.stderr.splitlines()[-1])
        self.assertEqual(os.listdir(disk), [])

    def test_a_full_standard_output(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            run = self.run_as_user("info", self.scene, stdout=full)
        self.assertEqual([run.returncode, run.stderr], [1, "eclat: error: cannot write the result to standard output: No space left on device\n"])


class Caches(UserCase):
    """Without a cache, renders only take longer. Where a driver needs one, the message says how to provide it."""

    def render(self, **env):
        self.assert_ok(self.run_as_user("render", self.scene, *SMALL, "-o", "a.png", env=env))
        self.assertEqual(os.listdir(self.out), ["a.png"])

    def test_kernels_of_others(self):
        for name, make in [("not-mine", lambda path: os.mkdir(path, 0o700)), ("to-others", lambda path: os.symlink(self.locked, path)),
                           ("to-nowhere", lambda path: os.symlink("nowhere", path)), ("to-itself", lambda path: os.symlink("eclat", path))]:
            with self.subTest(name):
                cache = self.make(name)
                make(os.path.join(cache, "eclat"))
                self.render(XDG_CACHE_HOME=cache)
        self.render(XDG_CACHE_HOME=self.locked, TMPDIR=self.locked)
        self.render(XDG_CACHE_HOME="", HOME="/nonexistent")

    def test_a_driver_without_a_folder(self):
        """The message comes at the start, or during compilation. Only PoCL needs the folder."""
        for env in [{"POCL_CACHE_DIR": self.locked}, {"POCL_CACHE_DIR": "", "XDG_CACHE_HOME": "", "HOME": "/nonexistent"}]:
            run = self.run_as_user("render", self.scene, *SMALL, "-o", "a.png", env=env)
            if run.returncode == 0:
                self.skipTest("this driver needs no folder")
            self.assertRegex(run.stderr, r"^eclat: error: .*; .*POCL_CACHE_DIR=FOLDER names.*\n(  Device .* failed to build the program\n)?$")
            self.assertEqual([run.returncode, os.listdir(self.out), os.listdir(self.locked)], [1, [], []])


if __name__ == "__main__":
    unittest.main()

"""Debian systems for trying packages, made by tools/release/chroots.py; tests skip where there is none."""
import glob
import importlib.machinery
import importlib.util
import os
import shutil
import sys
import unittest

import support

RELEASE = os.path.join(os.path.realpath(support.SOURCE), "tools", "release")
sys.path.insert(0, RELEASE)
os.environ.setdefault("ECLAT_BUILD", os.path.dirname(os.path.abspath(support.ECLAT)))

import chroots  # noqa: E402 (the folder of tools/release is added above)

CORNELL = "scenes/cornell-box/cornell-box.gltf"


def tool(name):
    """Loads a program of tools/release as a module."""
    loader = importlib.machinery.SourceFileLoader("release_" + name, os.path.join(RELEASE, name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


def packages(suite):
    """Returns the folder with the packages for a suite. ECLAT_PACKAGES names a folder with existing ones for each suite."""
    made_before = os.environ.get("ECLAT_PACKAGES")
    return os.path.join(made_before, suite) if made_before else tool("packages").packages(suite)


class Case(unittest.TestCase):
    """A test on Debian; skips with a reason where no Debian can be made."""

    def run(self, result=None):
        method = getattr(self, self._testMethodName)

        def guarded():
            try:
                method()
            except chroots.Unavailable as why:
                self.skipTest(str(why))
        setattr(self, self._testMethodName, guarded)
        return super().run(result)

    def fresh(self, suite, name):
        """A minimal Debian without further packages."""
        chroot = chroots.Chroot(f"{name}-{os.getpid()}", chroots.base(suite))
        self.addCleanup(chroot.remove)
        scene = os.path.dirname(CORNELL)
        shutil.copytree(os.path.join(support.SOURCE, scene), chroot.inside("root", scene))
        return chroot

    def copy(self, chroot, *files):
        """Copies files into /root."""
        for file in files:
            shutil.copy(file, chroot.inside("root"))

    def ok(self, chroot, *words):
        run = chroot.run(*words)
        print(f"$ {' '.join(words)}\n{run.stdout}{run.stderr}", flush=True)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return run.stdout

    def one_error(self, chroot, *words):
        run = chroot.run(*words)
        print(f"$ {' '.join(words)}\n{run.stdout}{run.stderr}", flush=True)
        self.assertEqual((run.returncode, run.stdout), (1, ""), run.stderr)
        self.assertRegex(run.stderr, r"\Aeclat: error: .*\n\Z")
        return run.stderr

    def assert_renders(self, chroot, program="eclat"):
        """Renders the Cornell box; it must have this machine's bits."""
        words = ["render", CORNELL, "--size", "48x48", "--spp", "16"]
        self.ok(chroot, "sh", "-c", f"cd /root && {program} {' '.join(words)} -o picture.exr -o picture.png")
        here = chroot.inside("root", "here.exr")
        self.assertEqual(support.eclat("render", support.CORNELL, *words[2:], "-q", "-o", here).returncode, 0)
        there, mine = (support.read_exr(file)[0]["eclat.imageSha256"] for file in (chroot.inside("root", "picture.exr"), here))
        self.assertEqual(there, mine)
        self.assertEqual(support.png_size(chroot.inside("root", "picture.png")), (48, 48))


def made(folder, pattern):
    files = glob.glob(os.path.join(folder, pattern))
    assert len(files) == 1, f"{pattern} in {folder}: {files}"
    return files[0]

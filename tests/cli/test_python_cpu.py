# tier: full
"""eclat[cpu]: the wheel with Intel's runtime from pip, without root, without a variable and without another driver, gives the same bits."""
import json
import os
import shlex
import shutil
import unittest

import support
import wheel
from support import CORNELL, SOURCE

SIZE = ("--size", "24x16", "--spp", "16")
# Leaves only the drivers that pip has installed, as on a machine that has none.
ALONE = "import sys, pathlib, eclat._drivers as drivers\ndrivers.SYSTEM = pathlib.Path('/nonexistent')\n"
RENDER = f"import eclat, os\nprint([device.platform for device in eclat.devices()])\n" \
         f"picture = eclat.load({CORNELL!r}).render(spp=16, size=(24, 16), device='Intel' if len(eclat.devices()) > 1 else 0)\n" \
         f"print(picture.attributes['eclat.imageSha256'])\n"
COMMAND = f"sys.argv = ['eclat', 'render', {CORNELL!r}, *{SIZE!r}, '--channels', 'all', '-o', 'c.exr']\nfrom eclat._program import main\nmain()\n"


class Processor(support.Case):
    @classmethod
    def setUpClass(cls):
        cls.venv = wheel.Environment(cls)
        cls.venv.pip("install", "-q", wheel.make(cls.venv) + "[cpu]")

    def python(self, code, **env):
        done = wheel.run(self.venv.python, "-c", code, env=wheel.outside(**env), cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.splitlines()

    def test_the_only_driver(self):
        run = self.assert_ok(support.eclat("render", CORNELL, *SIZE, "--channels", "all", "-q", "-o", self.path("a.exr")))
        self.assertEqual(run.stderr, "")
        attributes, planes = support.read_exr(self.path("a.exr"))
        platforms, digest = self.python(ALONE + RENDER)
        self.assertEqual((platforms, digest), ("['Intel(R) OpenCL']", attributes["eclat.imageSha256"]))
        # The command finds the same driver.
        self.python(ALONE + COMMAND)
        mine = support.read_exr(self.path("c.exr"))
        self.assertIn("Intel", mine[0]["eclat.device.platform"])
        self.assertEqual(mine[1], planes)

    def test_with_nothing_else_in_reach(self):
        """In a namespace where source, build and drivers are empty folders."""
        folders = [path for path in (wheel.BUILD, os.path.abspath(SOURCE), "/etc/OpenCL/vendors") if os.path.isdir(path)]
        hide = " && ".join(f"mount -t tmpfs none {shlex.quote(path)}" for path in folders)
        if wheel.run("unshare", "-m", "sh", "-c", hide).returncode:
            self.skipTest("only root may hide folders")
        shutil.copytree(os.path.dirname(CORNELL), self.path("scene"))
        shown = "import eclat; print([device.platform for device in eclat.devices()]); " \
                "print(eclat.load('scene/cornell-box.gltf').render(spp=16, size=(24, 16)).attributes['eclat.imageSha256'])"
        done = wheel.run("unshare", "-m", "sh", "-c", f"{hide} && exec {self.venv.python} -c {shlex.quote(shown)}", cwd=self.folder,
                         env=wheel.outside(XDG_CACHE_HOME=self.path("cache")))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.splitlines(), ["['Intel(R) OpenCL']", self.python(RENDER)[1]])

    def test_system_drivers_stay_available(self):
        built = [device["platform"] for device in json.loads(support.eclat("devices", "--json", env={"OCL_ICD_VENDORS": ""}).stdout)["devices"]]
        platforms, _ = self.python(RENDER)
        self.assertEqual(platforms, str([*built, "Intel(R) OpenCL"]))
        listed = wheel.run(self.venv.program("eclat"), "devices", env=wheel.outside())
        self.assertEqual(listed.stdout.count("\n"), len(built) + 3)

    def test_who_has_chosen_drivers_keeps_them(self):
        done = wheel.run(self.venv.program("eclat"), "devices", env=wheel.outside(OCL_ICD_VENDORS=self.folder))
        self.assertIn("pip install eclat[cpu]", self.assert_one_error(done, 1))

    def test_without_a_home(self):
        platforms, _ = self.python(ALONE + RENDER, XDG_CACHE_HOME="/proc/nobody", TMPDIR=self.folder)
        self.assertEqual(platforms, "['Intel(R) OpenCL']")
        self.assertTrue(os.path.isdir(self.path(f"eclat-drivers-{os.getuid()}")))


if __name__ == "__main__":
    unittest.main()

# tier: full
"""eclat[cpu]: the wheel with Intel's runtime by pip, without root, without a variable and without another driver: the same bits."""
import json
import os
import unittest

import support
import wheel
from support import CORNELL

SIZE = ("--size", "24x16", "--spp", "16")
# Nothing but what pip has brought: as on a machine that has no driver.
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
        # The command finds the same one.
        self.python(ALONE + COMMAND)
        mine = support.read_exr(self.path("c.exr"))
        self.assertIn("Intel", mine[0]["eclat.device.platform"])
        self.assertEqual(mine[1], planes)

    def test_beside_those_of_the_system(self):
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

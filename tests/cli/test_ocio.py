# tiers: quick, full
"""--ocio: pictures for the screen by OpenColorIO's views, against closed forms of a config of our own, and against OpenColorIO's library
where it is installed."""
import os
import random
import sys
import unittest

import pypi
from screen import read_png
from support import Case, eclat, quad_scene, read_exr, write_exr, write_gltf
from tiers import full

CONFIG = """ocio_profile_version: 2
roles: {default: linear, scene_linear: linear}
file_rules: [!<Rule> {name: Default, colorspace: default}]
displays:
  plain:
    - !<View> {name: power, colorspace: power}
    - !<View> {name: swapped, colorspace: swapped}
  other:
    - !<View> {name: as it is, colorspace: linear}
colorspaces:
  - !<ColorSpace> {name: linear, aliases: [lin_rec709], encoding: scene-linear}
  - !<ColorSpace> {name: power, from_scene_reference: !<ExponentTransform> {value: [2, 2, 2, 1], direction: inverse}}
  - !<ColorSpace> {name: swapped, from_scene_reference: !<MatrixTransform> {matrix: [0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0, 0, 0, 0, 0, 0, 1]}}
"""
VIEWS = {("plain", "power"): lambda r, g, b: (r ** .5, g ** .5, b ** .5), ("plain", "swapped"): lambda r, g, b: (g, b, r / 2), ("other", "as it is"): lambda r, g, b: (r, g, b)}


class Ocio(Case):
    def setUp(self):
        super().setUp()
        self.scene = write_gltf(self.path("scene.gltf"), quad_scene()[0])
        with open(self.path("config.ocio"), "w", encoding="utf-8") as file:
            file.write(CONFIG)
        run = eclat("render", self.scene, "--size", "4x4", "--spp", "1", "--ocio", "config.ocio", "-q", "-o", "try.png", cwd=self.folder)
        if "built without OpenColorIO" in run.stderr:
            self.assert_one_error(run, 1)
            self.skipTest("built without OpenColorIO")

    def render(self, *options):
        """Returns colours from 2^-9 to 2^4 from all around: their radiance, and what the screen shows, in 16 bits."""
        dice = random.Random(26)
        colors = [[2 ** dice.uniform(-9, 4) for _ in range(32 * 16)] for _ in "RGB"]
        sky = write_exr(self.path("sky.exr"), 32, 16, dict(zip("RGB", colors)))
        self.assert_ok(eclat("render", self.scene, "--size", "40x24", "--spp", "8", "--fov", "140", "--env", sky, "--png-depth", "16", *options, "-q", "-o", "a.exr", "-o", "a.png", cwd=self.folder))
        planes = read_exr(self.path("a.exr"))[1]
        width, _, channels, bits, rows = read_png(self.path("a.png"))
        self.assertEqual((width, channels, bits), (40, 3, 16))
        return list(zip(planes["R"], planes["G"], planes["B"])), [tuple(row[3 * x:3 * x + 3]) for row in rows for x in range(width)]

    def assert_shown(self, pixels, there, view, exposure=0, tolerance=2):
        for rgb, shown in zip(pixels, there):
            for a, b in zip(shown, view(*(c * 2 ** exposure for c in rgb))):
                self.assertLessEqual(abs(a - 65535 * min(max(b, 0), 1)), tolerance, (rgb, shown))

    def test_views_of_a_config(self):
        for (display, view), shows in VIEWS.items():
            self.assert_shown(*self.render("--ocio", "config.ocio", "--ocio-display", display, "--ocio-view", view, "--exposure", "-2"), shows, -2)
        self.assert_shown(*self.render("--ocio", "config.ocio"), VIEWS["plain", "power"])

    @full
    def test_a_config_of_aces(self):
        """Compares with PyOpenColorIO for the same floats. This config knows linear Rec. 709 by its name."""
        sys.path.append(pypi.fetch("opencolorio", "opencolorio==2.6.0"))
        import PyOpenColorIO as ocio  # pylint: disable=import-outside-toplevel
        config = ocio.Config.CreateFromBuiltinConfig("cg-config-v1.0.0_aces-v1.3_ocio-v2.1")
        with open(self.path("aces.ocio"), "w", encoding="utf-8") as file:
            file.write(config.serialize())
        for display, view in [("sRGB - Display", "ACES 1.0 - SDR Video"), ("Rec.1886 Rec.709 - Display", "Un-tone-mapped")]:
            processor = config.getProcessor("Linear Rec.709 (sRGB)", display, view, ocio.TRANSFORM_DIR_FORWARD).getDefaultCPUProcessor()
            shown = self.render("--ocio", "aces.ocio", "--ocio-display", display, "--ocio-view", view)
            self.assert_shown(*shown, lambda *rgb, p=processor: p.applyRGB(list(rgb)), tolerance=16)

    def test_refused(self):
        for options, code, says in [(["--ocio", "config.ocio", "--tonemap", "agx"], 2, "leave one out"), (["--ocio-view", "power"], 2, "belongs to --ocio"),
                                    (["--ocio", "config.ocio", "--ocio-display", "none"], 1, "it has plain, other"), (["--ocio", "config.ocio", "--ocio-view", "none"], 1, "it has power, swapped"),
                                    (["--ocio", "config.ocio", "--ocio-space", "none"], 1, "it has linear"), (["--ocio", "nowhere.ocio"], 1, "nowhere.ocio")]:
            self.assertIn(says, self.assert_one_error(eclat("render", self.scene, *options, "-o", "b.png", cwd=self.folder), code))
        self.assertFalse(os.path.exists(self.path("b.png")))


if __name__ == "__main__":
    unittest.main()

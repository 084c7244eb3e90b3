# tier: quick
"""--eye, --look-at, --up, --fov, --parallel and --screen-window: a camera from the command line."""
import json
import math
import struct
import unittest

from support import Case, data_uri, eclat, quad_scene, read_exr, write_gltf

SMALL = ["--size", "36x24", "--spp", "4", "--integrator", "raster", "-q"]


def corner_scene():
    """The emitting quad [-1, 1]^2 in z = 0, moved to (10, 20, 30). Its camera, 3 m before it, is turned a quarter about its axis."""
    scene, _ = quad_scene()
    scene["nodes"][0]["translation"] = [10, 20, 30]
    scene["nodes"][1]["translation"] = [10, 20, 33]
    scene["nodes"][1]["rotation"] = [0, 0, math.sqrt(0.5), math.sqrt(0.5)]
    return scene


class Viewpoint(Case):
    def setUp(self):
        super().setUp()
        self.scene = write_gltf(self.path("quad.gltf"), corner_scene())

    def render(self, *options):
        out = self.path("out.exr")
        self.assert_ok(eclat("render", self.scene, *SMALL, "-o", out, "--env", "0,0,0", *options))
        return read_exr(out)

    def lit(self, *options):
        """Returns the box of pixels that see light: left, top, right, bottom."""
        values = self.render(*options)[1]["G"]
        xs = [i % 36 for i, v in enumerate(values) if v > 0.5]
        ys = [i // 36 for i, v in enumerate(values) if v > 0.5]
        return min(xs), min(ys), max(xs) + 1, max(ys) + 1

    def test_eye_look_at_and_up(self):
        # Half a picture is 12 pixels = tan 45 degrees: at 2 m a metre is 6 pixels.
        self.assertEqual(self.lit("--eye", "10,20,32", "--look-at=10,20,30", "--fov", "90"), (12, 6, 24, 18))
        # The eye is a metre to the right and looks straight on: everything moves 6 pixels to the left.
        self.assertEqual(self.lit("--eye=11,20,32", "--look-at=11,20,30", "--fov=90"), (6, 6, 18, 18))
        # With +x up, what was right is below.
        self.assertEqual(self.lit("--eye=11,20,32", "--look-at=11,20,30", "--fov=90", "--up=1,0,0"), (12, 12, 24, 24))

    def test_parallel_rays(self):
        # 8 m are 24 pixels, at any distance.
        for eye in ["10,20,32", "10,20,90"]:
            self.assertEqual(self.lit("--eye", eye, "--look-at", "10,20,30", "--parallel", "8"), (15, 9, 21, 15))

    def test_what_is_not_given_stays(self):
        stored = self.render()[1]
        attributes, same = self.render("--eye=10,20,33", "--up=-1,0,0")  # looks at the middle, as the file's camera does
        self.assertEqual(same, stored)
        self.assertIn("command line", attributes["eclat.camera"])
        for name, value in {"eye": "10,20,33", "lookAt": "10,20,30", "up": "-1,0,0"}.items():
            self.assertEqual([round(float(x), 4) + 0 for x in attributes[f"eclat.camera.{name}"].split(",")],
                             [float(x) for x in value.split(",")])
        self.assertAlmostEqual(float(attributes["eclat.camera.fov"]), math.degrees(0.8), 4)
        turned = self.render("--fov", "20")[1]
        self.assertNotEqual(turned["G"], stored["G"])

    def test_the_attributes_make_the_same_camera(self):
        attributes, first = self.render("--eye=9.1,20.3,31.7", "--look-at=10.2,20,30", "--fov=77.7")
        again = [f"--{option}={attributes['eclat.camera.' + name]}"
                 for option, name in [("eye", "eye"), ("look-at", "lookAt"), ("up", "up"), ("fov", "fov")]]
        second = self.render(*again)[1]
        worst = max(abs(a - b) for a, b in zip(first["G"], second["G"]))
        self.assertLess(worst, 0.26)  # at an edge, at most one of a pixel's four samples differs

    def test_nonsense_is_refused(self):
        for options, says in {("--eye", "1,2"): "not three numbers", ("--eye", "1,2,nan"): "not three numbers",
                              ("--eye", "1,2,3,4"): "not three numbers", ("--up", "0,0,0"): "not a direction",
                              ("--fov", "180"): "--fov", ("--fov", "0"): "--fov", ("--parallel", "0"): "--parallel"}.items():
            self.assertIn(says, self.assert_one_error(eclat("render", self.scene, *options), 2))
        run = eclat("render", self.scene, *SMALL, "--eye=1,2,3", "--look-at=1,2,3", cwd=self.folder)
        self.assertIn("two different points", self.assert_one_error(run, 1))

    def test_a_screen_window_shows_another_part(self):
        """At 2 m and 90 degrees, half a height, which is the unit of the image plane, is 2 m. Every integrator: tiles, rays, and the file's
        own camera."""
        at = ["--eye", "10,20,32", "--look-at=10,20,30", "--fov", "90"]
        for integrator in ("raster", "whitted", "path"):
            with self.subTest(integrator):
                view = [*at, "--integrator", integrator]
                self.assertEqual(self.lit(*view, "--screen-window=-1.5,1.5,-1,1"), (12, 6, 24, 18))
                # the lens is shifted to the right and down
                self.assertEqual(self.lit(*view, "--screen-window=-1,2,-1.5,0.5"), (6, 0, 18, 12))
                self.assertEqual(self.lit(*view, "--screen-window=-0.5,1,-0.5,0.5"), (0, 0, 24, 24))  # a crop, twice as large
                self.assertEqual(self.lit(*view, "--screen-window=-3,3,-1,1"), (15, 6, 21, 18))  # pixels twice as wide as high

    def test_a_screen_window_of_parallel_rays_and_of_no_size(self):
        """With parallel rays, half a height is 2 m too. Without --size, pixels are square."""
        view = ["--eye", "10,20,32", "--look-at=10,20,30", "--parallel", "4"]
        self.assertEqual(self.lit(*view, "--screen-window=0,3,-1,1"), (0, 6, 6, 18))
        out = self.path("out.exr")
        self.assert_ok(eclat("render", self.scene, "--spp", "1", "--integrator", "raster", "-q", "-o", out, "--screen-window=0,3,-1,1"))
        attributes = read_exr(out)[0]
        self.assertEqual(attributes["dataWindow"], (0, 0, 767, 511))
        self.assertEqual(attributes["eclat.screenWindow"], "0,3,-1,1")

    def test_the_whole_view_as_a_window_has_the_same_bits(self):
        whole, window = (self.render("--integrator", "path", *options)[1] for options in ([], ["--screen-window=-1.5,1.5,-1,1"]))
        self.assertEqual(whole["R"], window["R"])


if __name__ == "__main__":
    unittest.main()

# tier: quick
"""--light: the built-in studio and sky, instead of a file."""
import json
import math
import unittest

from support import QUICK, Case, eclat, quad_scene, read_exr, write_gltf

SMALL = (*QUICK, "--size", "24x16")


class Light(Case):
    def setUp(self):
        super().setUp()
        self.scene = write_gltf(self.path("dark.gltf"), quad_scene(material={"pbrMetallicRoughness": {"metallicFactor": 0}})[0])

    def render(self, name, *options, spp=8):
        run = self.assert_ok(eclat("render", self.scene, *SMALL, "--spp", str(spp), *options, "--json", "-o", self.path(name), cwd=self.folder))
        return json.loads(run.stdout), run.stderr

    def planes(self, name):
        return read_exr(self.path(name))[1]

    def test_a_scene_without_light_is_in_the_studio(self):
        report, told = self.render("a.exr", spp=64)
        self.assertRegex(told, "note: the scene has no light; the built-in studio lights it")
        self.assertEqual(report["environment"], "studio")
        named, told = self.render("b.exr", "--light", "studio", spp=64)
        self.assertNotIn("note: the scene has no light", told)
        self.assertEqual(report["image_sha256"], named["image_sha256"])
        planes = self.planes("a.exr")
        middle = planes["G"][24 * 8 + 12]  # white, facing +z, where the irradiance is pi to within a tenth
        self.assertEqual(planes["R"], planes["G"])
        self.assertTrue(0.8 < middle < 1.2, middle)
        run = self.assert_ok(eclat("info", self.scene))
        self.assertIn("none at all: a render uses the built-in studio", run.stdout)

    def test_the_sun_is_where_it_is_said_to_be(self):
        for azimuth, elevation in [(30, 45), (-100, 10)]:
            a, e = math.radians(azimuth), math.radians(elevation)
            eye = [0, 50, 0]
            at = [eye[0] + math.sin(a) * math.cos(e), eye[1] + math.sin(e), eye[2] + math.cos(a) * math.cos(e)]
            report, _ = self.render("sun.exr", "--light", f"sky:{azimuth},{elevation}", "--eye", ",".join(map(repr, map(float, eye))), "--look-at",
                                    ",".join(map(repr, at)), "--fov", "6")
            g = self.planes("sun.exr")["G"]
            brightest = g.index(max(g))
            self.assertTrue(abs(brightest % 24 - 11.5) <= 2 and abs(brightest // 24 - 7.5) <= 2, (azimuth, brightest % 24, brightest // 24))
            self.assertGreater(max(g), 1000 * sorted(g)[len(g) // 4])
            self.assertEqual(report["environment"], f"sky:{azimuth},{elevation}")

    def test_lights_are_of_the_job(self):
        """Slices of one job under the sky can be merged; slices under different skies cannot."""
        for name, light, samples in [("a", "sky:30,45", "0:8"), ("b", "sky:30,45", "8:16"), ("c", "sky:31,45", "8:16"), ("d", "studio", "8:16")]:
            self.render(name + ".exr", "--light", light, "--samples", samples, spp=16)
        whole, _ = self.render("whole.exr", "--light", "sky:30,45", spp=16)
        run = self.assert_ok(eclat("merge", self.path("a.exr"), self.path("b.exr"), "--json", "-o", self.path("all.exr")))
        self.assertEqual(json.loads(run.stdout)["image_sha256"], whole["image_sha256"])
        for other in "cd":
            self.assert_one_error(eclat("merge", self.path("a.exr"), self.path(other + ".exr"), "-q", "-o", self.path("all.exr")), 1)

    def test_a_bad_sky_is_refused(self):
        line = self.assert_one_error(eclat("render", self.scene, *SMALL, "--light", "sky:10,120", "-o", self.path("a.exr")), 1)
        self.assertIn("sky:AZIMUTH,ELEVATION needs two numbers in degrees, the second from 0 to 90", line)


if __name__ == "__main__":
    unittest.main()

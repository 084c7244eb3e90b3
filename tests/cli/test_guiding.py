# tiers: quick, full
"""--guiding: the picture is the one that path tracing alone converges to, sooner; its bits are the same however a job is shared out; without
anything that bends light nothing changes."""
import json
import os
import unittest

from support import CORNELL, QUICK, RING, SHARED, SOURCE, Case, eclat
from tiers import full

LADDER = os.path.join(SOURCE, "scenes", "ladder", "ladder.gltf")
JOB = [RING, "--size", "24x18", "--guiding", "--lanes", "4"]
SUN = os.path.join(SHARED, "assets", "env", "polyhaven", "qwantani_afternoon_puresky_1k.hdr")


def scene(name):
    return os.path.join(SOURCE, "scenes", name, name + ".gltf")


class Guiding(Case):
    def render(self, *job, name="a.exr"):
        run = self.assert_ok(eclat("render", *job, "--json", "-q", "-o", self.path(name)))
        return json.loads(run.stdout)

    def assert_same_picture(self, job, samples, fewer=1.0, extra=()):
        """Both agree within their noise: in the mean, in blocks, in pixels. error^2 is so many times smaller with guiding."""
        without = self.render(*job, "--spp", str(samples), name="without.exr")
        guided = self.render(*job, "--spp", str(samples), "--guiding", "--seed", "2", *extra, name="with.exr")
        run = self.assert_ok(eclat("compare", self.path("without.exr"), self.path("with.exr"), "--json"))
        self.assertGreater(json.loads(run.stdout)["noise_test"]["p"], 1e-3)
        self.assertLess(guided["error"] ** 2 * fewer, without["error"] ** 2)

    def test_ring(self):
        """A ring's caustic, which paths from the camera seldom find by the surface's own directions."""
        self.assert_same_picture([RING, "--size", "32x32"], 128, fewer=3)

    def test_with_light_paths(self):
        self.assert_same_picture([RING, "--size", "32x32"], 128, fewer=6, extra=["--light-paths", "0.25"])

    def test_bits(self):
        """Whatever order, width, structure or share."""
        whole = self.render(*JOB, "--spp", "32")
        self.assertGreater(whole["guide_seconds"], 0)
        for other in [["--lanes", "1"], ["--wave", "4096"], ["--accel", "kdtree"]]:
            with self.subTest(other=other):
                self.assertEqual(self.render(*JOB, "--spp", "32", *other)["image_sha256"], whole["image_sha256"])

    @full
    def test_more_bits(self):
        whole = self.render(*JOB, "--spp", "32")["image_sha256"]
        for other in [["--lanes", "8"], ["--compile", "beside"], ["--effects", "all"]]:
            with self.subTest(other=other):
                self.assertEqual(self.render(*JOB, "--spp", "32", *other)["image_sha256"], whole)

    def test_slices_and_resume(self):
        whole = self.render(*JOB, "--spp", "32")["image_sha256"]
        for a, b in [(0, 16), (16, 32)]:
            self.assert_ok(eclat("render", *JOB, "--spp", "32", "--samples", f"{a}:{b}", "-q", "-o", self.path(f"{a}.exr")))
        merged = self.assert_ok(eclat("merge", self.path("0.exr"), self.path("16.exr"), "--json", "-o", self.path("m.exr")))
        self.assertEqual(json.loads(merged.stdout)["image_sha256"], whole)
        self.render(*JOB, "--spp", "16", "--checkpoint", self.path("c.exr"))
        self.assertEqual(self.render(*JOB, "--spp", "32", "--resume", self.path("c.exr"))["image_sha256"], whole)

    def test_nothing_to_learn(self):
        """A box of diffuse walls: no other bit."""
        job = [CORNELL, "--size", "20x18", "--spp", "8", *QUICK]
        self.assertEqual(self.render(*job)["image_sha256"], self.render(*job, "--guiding")["image_sha256"])

    def test_refused(self):
        for other, word in [(["--sample", "bsdf"], "--sample"), (["--integrator", "whitted"], "--integrator")]:
            with self.subTest(other=other):
                line = self.assert_one_error(eclat("render", RING, "--guiding", *other, "-o", self.path("a.exr")), 2)
                self.assertIn("--guiding", line)
                self.assertIn(word, line)

    def test_info(self):
        run = self.assert_ok(eclat("info", RING, "--guiding"))
        self.assertRegex(run.stdout, r"path-guiding +--guiding, by light paths to \d+ bodies")
        self.assertNotRegex(self.assert_ok(eclat("info", RING)).stdout, r"\n *path-guiding ")

    @full
    def test_with_other_options(self):
        """Clamp and adaptive sampling know it, since each sample is a camera path's."""
        self.assert_same_picture([RING, "--size", "32x32", "--adaptive"], 128, fewer=3)
        loss = self.render(RING, "--size", "32x32", "--spp", "64", "--guiding", "--clamp", "100")["clamp"]
        self.assertIsNotNone(loss)

    @full
    def test_scenes(self):
        for name, samples, fewer in [("ladder", 128, 1.2), ("glass", 64, 0.7), ("drink", 64, 0.7), ("prism", 128, 0.7), ("lamps", 64, 0.05),
                                     ("showcase", 64, 0.7), ("veach-plates", 64, 0.3), ("spheres", 64, 0.2), ("soap-film", 64, 0.05),
                                     ("brushed-metal", 64, 0.3), ("vase", 64, 0.3)]:
            with self.subTest(scene=name):
                self.assert_same_picture([scene(name), "--size", "48x48"], samples, fewer)

    @full
    def test_looks(self):
        for options in [["--fstop", "0.5", "--focus", "3"], ["--filter", "blackman-harris"], ["--max-depth", "4"], ["--light-choice", "power"],
                        ["--scattering", "multiple"], ["--sampler", "independent"], ["--terminator", "smooth"], ["--rr", "0.7"]]:
            with self.subTest(options=options):
                self.assert_same_picture([LADDER, "--size", "32x32", *options], 128, 0.8)

    @full
    @unittest.skipUnless(os.path.exists(SUN), "no map with a sun")
    def test_sun_through_a_vase(self):
        """Path tracing alone meets that light so seldom that its noise is not known: means are compared no further than light paths' own."""
        job = [scene("vase"), "--env", SUN, "--size", "48x48", "--spp", "64", "--light-paths", "0.25"]
        without, guided = self.render(*job, name="without.exr"), self.render(*job, "--guiding", "--seed", "2", name="with.exr")
        self.assertLess(abs(without["mean_luminance"] - guided["mean_luminance"]), 0.1 * guided["mean_luminance"])


if __name__ == "__main__":
    unittest.main()

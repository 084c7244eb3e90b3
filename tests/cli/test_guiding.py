# tiers: quick, full, long
"""--guiding: the picture converges to that of path tracing alone, sooner. Its bits do not depend on how a job is divided. Nothing changes
in a scene where nothing reflects or refracts specularly."""
import os
import unittest

from other_way import OtherWay, scene
from support import CORNELL, QUICK, RING, SHARED, eclat
from tiers import full, long

LADDER = scene("ladder")
JOB = [RING, "--size", "24x18", "--guiding", "--light-paths", "0"]
SUN = os.path.join(SHARED, "assets", "env", "polyhaven", "qwantani_afternoon_puresky_1k.hdr")


class Guiding(OtherWay):
    WAY = ["--guiding"]

    @full
    def test_ring(self):
        """The ring's caustic: camera paths seldom find it by sampling the BSDF."""
        self.assert_same_picture([RING, "--size", "32x32"], 128, fewer=3)

    @full
    def test_with_light_paths(self):
        self.assert_same_picture([RING, "--size", "32x32"], 128, fewer=6, extra=["--light-paths", "0.25"])

    @full
    def test_bits(self):
        """Bits do not depend on order, width, structure or slices. Narrow kernels have one lane."""
        whole = self.assert_same_bits(JOB, [["--lanes", "8"], ["--wave", "4096"], ["--accel", "kdtree"]])
        self.assertGreater(whole["guide_seconds"], 0)

    @long
    def test_bits_with_all_effects_and_other_lanes(self):
        self.assert_same_bits(JOB, [["--effects", "all", "--lanes", "4"], ["--lanes", "4"]])

    @full
    def test_slices_and_resume(self):
        self.assert_slices_and_resume(JOB)

    def test_a_diffuse_scene_is_unchanged(self):
        """A box of diffuse walls: no bit changes."""
        job = [CORNELL, "--size", "20x18", "--spp", "8", *QUICK]
        self.assertEqual(self.render(*job)["image_sha256"], self.render(*job, "--guiding")["image_sha256"])

    def test_refused(self):
        self.assert_refused([(["--sample", "bsdf"], "--sample"), (["--integrator", "whitted"], "--integrator")])

    def test_info(self):
        self.assert_info(r"path-guiding +--guiding, by light paths to \d+ bodies")

    @full
    def test_with_other_options(self):
        """--clamp and --adaptive work with it, since each sample is still one camera path's."""
        # with 128 samples the noise without guiding is not normal yet
        self.assert_same_picture([RING, "--size", "32x32", "--adaptive"], 512, fewer=3)
        loss = self.render(RING, "--size", "32x32", "--spp", "64", "--guiding", "--clamp", "100")["clamp"]
        self.assertIsNotNone(loss)

    @long
    def test_scenes(self):
        for name, samples, fewer in [("ladder", 128, 0.9), ("glass", 64, 0.7), ("drink", 64, 0.7), ("prism", 128, 0.7), ("lamps", 64, 0.05),
                                     ("showcase", 64, 0.7), ("veach-plates", 64, 0.3), ("spheres", 64, 0.2), ("soap-film", 64, 0.05),
                                     ("brushed-metal", 64, 0.3), ("vase", 64, 0.3)]:
            with self.subTest(scene=name):
                self.assert_same_picture([scene(name), "--size", "48x48"], samples, fewer)

    @long
    def test_other_render_options(self):
        for options in [["--fstop", "0.5", "--focus", "3"], ["--filter", "blackman-harris"], ["--max-depth", "4"], ["--light-choice", "power"],
                        ["--scattering", "multiple"], ["--sampler", "independent"], ["--terminator", "smooth"], ["--rr", "0.7"]]:
            with self.subTest(options=options):
                self.assert_same_picture([LADDER, "--size", "32x32", *options], 128, 0.8)

    @full
    @unittest.skipUnless(os.path.exists(SUN), "no map with a sun")
    def test_sun_through_a_vase(self):
        """Path tracing alone finds this light so seldom that its noise is unknown: only means are compared, both with light paths."""
        job = [scene("vase"), "--env", SUN, "--size", "48x48", "--spp", "64", "--light-paths", "0.25"]
        without, guided = self.render(*job, name="without.exr"), self.render(*job, "--guiding", "--seed", "2", name="with.exr")
        self.assertLess(abs(without["mean_luminance"] - guided["mean_luminance"]), 0.1 * guided["mean_luminance"])


if __name__ == "__main__":
    unittest.main()

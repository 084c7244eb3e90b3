# tiers: quick, full, long
"""Pictures larger than memory, in strips of rows: the bits of the whole picture, and options that strips exclude."""
import json
import os
import re
import unittest

from support import CORNELL, RING, SOURCE, Case, eclat, read_exr
from tiers import full, long

PINLAMP = os.path.join(SOURCE, "scenes", "pinlamp", "pinlamp.gltf")


class Strips(Case):
    def run_to(self, name, *options, scene=CORNELL, **more):
        return eclat("render", scene, "--json", "-q", *options, "-o", self.path(name + ".exr"), "-o", self.path(name + ".png"), **more)

    def render(self, name, *options, **more):
        return json.loads(self.assert_ok(self.run_to(name, *options, **more)).stdout)

    def least(self, *options, scene=CORNELL):
        """Returns the megabytes that the program asks for when memory is too small."""
        run = eclat("render", scene, "-q", *options, "--memory", "1M", "-o", self.path("none.exr"))
        line = self.assert_one_error(run, 1)
        self.assertFalse(os.path.exists(self.path("none.exr")))
        return int(re.search(r"give (\d+)M or more", line).group(1))

    def in_strips(self, name, *options, scene=CORNELL):
        """Renders in strips. The least memory varies between runs by a few MB, or by a compiler that has run: tries again where it was too
        little, or enough for the whole picture."""
        for _ in range(4):
            run = self.run_to(name, *options, "--memory", f"{self.least(*options, scene=scene) + 2}M", scene=scene)
            if run.returncode == 0 and json.loads(run.stdout)["strips"] > 1:
                return json.loads(run.stdout)
        self.fail(run.stderr or "always rendered whole")

    def assert_same(self, whole, strips):
        a, b = self.path(whole + ".exr"), self.path(strips + ".exr")
        (attributes, left), (others, right) = read_exr(a), read_exr(b)
        self.assertEqual(sorted(left), sorted(right))
        for name in left:
            self.assertTrue(left[name] == right[name], name)  # assertEqual would take hours to describe the difference
        for name in ["error", "errorBound", "errorBoundWhy", "relMSE", "heavyPixels", "imageSha256", "replicates", "samplesPerPixel", "stoppedBy", "invalid", "wave", "kernels", "clamp.luminance", "clamp.missing",
                     "clamp.missingStderr", "clamp.noise", "clamp.bias", "clamp.error"]:
            self.assertEqual(attributes.get("eclat." + name), others.get("eclat." + name), name)
        with open(self.path(whole + ".png"), "rb") as one, open(self.path(strips + ".png"), "rb") as other:
            self.assertEqual(one.read(), other.read())

    def test_the_bits_of_the_whole(self):
        """Odd sizes: tiles and blocks of an EXR end anywhere. One batch, and several."""
        self.assert_bits_of_the_whole(["--size", "301x355", "--spp", "1"], ["--size", "97x450", "--spp", "19"])

    @full
    def test_the_bits_with_other_options(self):
        """A batch that is cut; sums of other kinds; other integrators."""
        self.assert_bits_of_the_whole(["--size", "90x403", "--spp", "41", "--filter", "blackman-harris"], ["--size", "150x420", "--spp", "9", "--clamp", "0.5"],
                                      ["--size", "120x403", "--spp", "17", "--channels", "default,direct,indirect,uv", "--light-groups", "all"],
                                      ["--size", "200x420", "--spp", "2", "--integrator", "whitted"], ["--size", "200x420", "--spp", "2", "--integrator", "raster"])

    def assert_bits_of_the_whole(self, *jobs):
        for i, options in enumerate(jobs):
            with self.subTest(options=options):
                whole = self.render(f"whole{i}", *options)
                strips = self.in_strips(f"strips{i}", *options)
                self.assert_same(f"whole{i}", f"strips{i}")
                self.assertEqual(whole["strips"], 1)
                for name in ["error", "error_bound", "relmse", "mean_luminance", "heavy_pixels", "image_sha256", "samples", "rays", "invalid_samples", "stopped_by"]:
                    self.assertEqual(whole[name], strips[name], name)

    @full
    def test_light_that_may_be_missing(self):
        """The prediction of missing light uses tiles of the whole picture, and so do its flags."""
        options = ["--size", "200x500", "--spp", "9", "--light-paths", "0"]
        self.assertIn("mirror", self.render("whole", *options, scene=PINLAMP)["error_bound_why"])
        self.in_strips("strips", *options, scene=PINLAMP)
        self.assert_same("whole", "strips")

    @full
    def test_light_paths(self):
        """Each strip takes its rows of the light that light paths add to the whole picture."""
        options = ["--size", "97x450", "--spp", "9", "--light-paths", "0.25"]
        self.render("whole", *options, scene=RING)
        self.in_strips("strips", *options, scene=RING)
        self.assert_same("whole", "strips")

    @full
    def test_guiding(self):
        """The guide is that of the whole picture."""
        options = ["--size", "97x450", "--spp", "9", "--guiding"]
        self.render("whole", *options, scene=RING)
        self.in_strips("strips", *options, scene=RING)
        self.assert_same("whole", "strips")

    def assert_lanes_and_waves(self, scene):
        options = ["--size", "128x600", "--spp", "4"]
        self.render("whole", *options, "--lanes", "4", "--wave", "9999", scene=scene)
        self.in_strips("strips", *options, "--lanes", "1", "--wave", "70000", scene=scene)
        _, planes = read_exr(self.path("strips.exr"))
        _, other = read_exr(self.path("whole.exr"))
        self.assertTrue(planes == other)

    @full
    def test_lanes_and_waves(self):
        self.assert_lanes_and_waves(CORNELL)

    @long
    def test_lanes_and_waves_with_a_caustic(self):
        self.assert_lanes_and_waves(RING)

    def test_what_fits_is_rendered_whole(self):
        report = self.render("whole", "--size", "64x64", "--spp", "1", "--memory", "2G")
        self.assertEqual(report["strips"], 1)
        self.assertNotIn("eclat.strips", read_exr(self.path("whole.exr"))[0])

    def test_options_that_strips_exclude(self):
        for options, name in [(["--adaptive"], "--adaptive"), (["--error", "5"], "--error"), (["--time", "10s"], "--time"), (["--spp", "4", "--time", "9s"], "--time"),
                              (["--checkpoint", self.path("c.exr")], "--checkpoint"), (["--spp", "32", "--samples", "0:16"], "--samples")]:
            run = eclat("render", CORNELL, "--size", "4096x4096", "-q", "--memory", "400M", *options, "-o", self.path("a.exr"))
            line = self.assert_one_error(run, 1)
            self.assertIn(f"in strips, but {name} needs the picture whole", line)
            self.assertRegex(line, r"4096x4096 pixels need [\d.]+ MB, but [\d.]+ MB are free")
            self.assertEqual(os.listdir(self.folder), [])

    @full
    def test_slices_whose_sums_wait(self):
        """74 batches wait for left neighbours in other slices, 24 bytes a pixel each: more than the picture itself."""
        job = ["--size", "256x256", "--spp", "256", "--replicates", "8", "--integrator", "raster"]
        path = self.path("s.exr")
        self.assert_ok(eclat("render", CORNELL, "-q", *job, "--samples", "0:16", "-o", path))  # compiles the kernels
        least = [float(re.search(r"need ([\d.]+) MB", self.assert_one_error(eclat("render", CORNELL, "-q", *job, "--samples", samples, "--memory", "1M", "-o", path), 1)).group(1))
                 for samples in ["0:224", "16:240"]]
        self.assertGreater(least[1] - least[0], 70 * 24 * 65536 / 1e6)
        run = self.assert_ok(eclat("render", CORNELL, "-q", "--json", *job, "--samples", "16:240", "--memory", f"{300 + int(least[1])}M", "-o", path))
        self.assertLess(json.loads(run.stdout)["peak_memory_bytes"], 1e6 * (300 + least[1]))

    def test_amounts(self):
        for text in ["4", "G", "-1G", "0M", "1K", "4X", "4GBs", "1e30G", "nan", "4 G", ""]:
            run = eclat("render", CORNELL, "--memory", text, cwd=self.folder)
            self.assertIn("--memory", self.assert_one_error(run, 2))
        for text in ["4G", "4GB", "4Gi", "4GiB", "0.5g", "2000M", "1T"]:
            run = eclat("render", "none.gltf", "--memory", text, cwd=self.folder)
            self.assertIn("none.gltf", self.assert_one_error(run, 1))


if __name__ == "__main__":
    unittest.main()

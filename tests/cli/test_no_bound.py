# tiers: quick, full
"""A scene whose light may be missing states no bound of its error. Every output says so and why, however the samples were taken."""
import json
import os
import re
import unittest

from support import CORNELL, SOURCE, WIDE, Case, eclat, read_alike, read_exr
from tiers import full

PINLAMP = os.path.join(SOURCE, "scenes", "pinlamp", "pinlamp.gltf")
SIZE = ["--size", "24x20"]
ALONE = ["--light-paths", "0"]  # light paths would find the light


class NoBound(Case):
    def render(self, *options, scene=PINLAMP, output="out.exr", env=None):
        alone = [] if "--integrator" in options else ALONE
        run = self.assert_ok(eclat("render", scene, *SIZE, *alone, *options, "-o", output, cwd=self.folder, env=env))
        return run, read_exr(self.path(output))

    def assert_open(self, report):
        self.assertIsNone(report["error_bound"])
        self.assertRegex(report["error_bound_why"], r'^rare bright paths decide \(12 samples hold .* of the noise; paths through "mirror" to "lamp" ')
        self.assertGreater(report["error_unmet"], report["error"])
        self.assertEqual(report["quality"], "not to be relied on")

    def test_text_json_and_attributes_say_why(self):
        run, (attributes, planes) = self.render("--spp", "64")
        self.assertRegex(run.stdout, r'(?m)^result   not to be relied on: error at least \S+ %: no bound, since rare bright paths decide ')
        self.assertRegex(run.stdout, r'(?m)^helps    some \S+.* samples a pixel; or a rougher "mirror"')
        run, _ = self.render("--spp", "64", "--json")
        report = json.loads(run.stdout)
        self.assert_open(report)
        self.assertEqual(attributes["eclat.errorBoundWhy"], report["error_bound_why"])
        self.assertNotIn("eclat.errorBound", attributes)
        self.assertEqual(planes["heavy"].count(1), report["heavy_pixels"])

    def test_an_error_is_not_met_and_the_render_says_so(self):
        run, _ = self.render("--error", "60%", "--spp", "256", "--adaptive=off", env=WIDE)
        self.assertRegex(run.stderr, r'would be enough for --error 0\.6, but there is no bound: rare bright paths \(through "mirror" to "lamp"\)')
        self.assertEqual(len(re.findall("would be enough for", run.stderr)), 1)
        self.assertRegex(run.stdout, r"(?m)^forecast .* cannot be predicted")
        self.assertRegex(run.stdout, r"(?m)^stopped  all samples are taken$")

    def test_slices_and_resumed_renders_say_the_same(self):
        run, (attributes, _) = self.render("--spp", "64", "--channels", "all")
        self.render("--spp", "64", "--samples", "0:32", output="a.exr")
        self.render("--spp", "64", "--samples", "32:64", output="b.exr")
        merge = self.assert_ok(eclat("merge", "b.exr", "a.exr", "--json", "-o", "all.exr", cwd=self.folder))
        self.assertEqual(json.loads(merge.stdout)["error_bound_why"], attributes["eclat.errorBoundWhy"])
        self.assertEqual(read_exr(self.path("all.exr"))[0]["eclat.errorBoundWhy"], attributes["eclat.errorBoundWhy"])
        self.assertEqual(*read_alike(self.path("out.exr"), self.path("all.exr")))
        text = self.assert_ok(eclat("merge", "b.exr", "a.exr", "-o", "all.exr", cwd=self.folder)).stdout
        self.assertRegex(text, r"(?m)^error at least .* no bound, since ")

    @full
    def test_any_wave_width_and_structure_say_the_same(self):
        """test_strips.py has the test for strips."""
        _, (attributes, whole) = self.render("--spp", "16", "--size", "96x300")
        for options in (["--wave", "4096"], ["--lanes", "1"], ["--accel", "kdtree"]):
            with self.subTest(options=options):
                run, (others, planes) = self.render("--spp", "16", "--size", "96x300", *options)
                self.assertEqual(others["eclat.errorBoundWhy"], attributes["eclat.errorBoundWhy"])
                self.assertEqual(planes["heavy"], whole["heavy"])

    def test_compare_repeats_it(self):
        self.render("--spp", "16", output="a.exr")
        self.render("--spp", "16", "--seed", "2", output="b.exr")
        run = eclat("compare", "a.exr", "b.exr", cwd=self.folder)
        self.assertRegex(run.stdout, r"(?m)^no bound  A may lack light that shows in no standard error: rare bright paths decide")
        self.assertRegex(run.stdout, r"(?m)^no bound  B ")

    def test_light_that_is_found_has_a_bound(self):
        run, (attributes, _) = self.render("--spp", "64", "--json", scene=CORNELL)
        report = json.loads(run.stdout)
        self.assertIsNone(report["error_bound_why"])
        self.assertGreater(report["error_bound"], report["error"])
        self.assertIn("eclat.errorBound", attributes)
        self.assertNotIn("eclat.errorBoundWhy", attributes)

    def test_only_paths_are_looked_at(self):
        """Ray trees and rasterised pictures have no random paths."""
        for integrator in ("whitted", "raster"):
            run, _ = self.render("--spp", "16", "--json", "--integrator", integrator)
            self.assertIsNone(json.loads(run.stdout)["error_bound_why"])


if __name__ == "__main__":
    unittest.main()

# tier: quick
"""eclat mix: layers with new weights. The mix is the picture that a render with such lamps gives; its errors are bounds; with all gains 1
it is the old picture."""
import json
import math
import os
import shutil
import unittest

from support import CORNELL, SOURCE, Case, eclat, read_exr, write_gltf

LAMPS = os.path.join(SOURCE, "scenes", "six-lamps", "six-lamps.gltf")
GROUPS = ["--light-groups", "bulb-over-table,uplight-disc", "--size", "24x16", "--spp", "64", "-q"]


class Mix(Case):
    def render(self, name, *options, scene=LAMPS):
        self.assert_ok(eclat("render", scene, *options, "-o", name, cwd=self.folder))

    def mix(self, name, *gains):
        return json.loads(self.assert_ok(eclat("mix", name, *gains, "--json", "-o", "m.exr", cwd=self.folder)).stdout)

    def p_value(self, name):
        run = eclat("compare", "m.exr", name, "--json", cwd=self.folder)
        self.assertIn(run.returncode, (0, 1), run.stderr)  # equal, or different beyond noise
        return json.loads(run.stdout)["noise_test"]["p"]

    def brighter(self):
        """The scene with three times the light of the bulb over the table."""
        with open(LAMPS, encoding="utf-8") as file:
            scene = json.load(file)
        shutil.copy(LAMPS.replace(".gltf", ".bin"), self.folder)
        bulb = next(m for m in scene["materials"] if m["name"] == "bulb-over-table")
        bulb["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] *= 3
        return write_gltf(self.path("brighter.gltf"), scene)

    def test_gains_of_one_are_the_picture(self):
        """Bit for bit, errors included, under any names. A mix of a mix that undoes the gains too."""
        self.render("a.exr", *GROUPS, "--channels", "default,direct,indirect")
        _, planes = read_exr(self.path("a.exr"))
        for gains in ([], ["uplight-disc=1"], ["bulb-over-table=1,1,1"], ["direct=1"]):
            self.mix("a.exr", *gains)
            _, mixed = read_exr(self.path("m.exr"))
            for name in mixed:
                self.assertEqual(mixed[name], planes[name], (gains, name))
        self.mix("a.exr", "rest=4")
        os.rename(self.path("m.exr"), self.path("b.exr"))
        self.mix("b.exr", "rest=0.25")
        _, mixed = read_exr(self.path("m.exr"))
        self.assertTrue(all(mixed[c] == planes[c] for c in "RGB"))

    def test_a_mix_is_the_picture_with_another_lamp(self):
        """A lamp of three times the light, rendered with other random numbers, differs by noise only; with a gain of 1.5 it differs by
        more. The stated error is at least the render's, to the precision that eight replicates allow."""
        self.render("a.exr", *GROUPS)
        self.render("b.exr", "--size", "24x16", "--spp", "64", "-q", "--seed", "2", scene=self.brighter())
        report = self.mix("a.exr", "bulb-over-table=3")
        self.assertGreater(self.p_value("b.exr"), 1e-3)
        error = read_exr(self.path("b.exr"))[0]["eclat.error"]
        self.assertLess(0.7 * error, report["error"])
        self.assertLess(report["error"], 3 * error)
        self.mix("a.exr", "bulb-over-table=1.5")
        self.assertLess(self.p_value("b.exr"), 1e-6)

    def test_errors_are_the_least_bound(self):
        """Computes the bound of host/jobs/mix_job.c again, pixel by pixel. It never exceeds the sum of the layers' errors."""
        self.render("a.exr", *GROUPS)
        gains = {"bulb-over-table": 2, "rest": 1, "uplight-disc": 0.5}
        self.mix("a.exr", *(f"{name}={gain}" for name, gain in gains.items()))
        _, planes = read_exr(self.path("a.exr"))
        _, mixed = read_exr(self.path("m.exr"))
        for i, error in enumerate(mixed["stderr.G"]):
            layers = [(gain, planes[f"light.{name}.stderr.G"][i]) for name, gain in gains.items()]
            bounds = [b * planes["stderr.G"][i] + sum(abs(gain - b) * s for gain, s in layers) for b in (0, 0.5, 1, 2)]
            self.assertTrue(math.isclose(error, min(bounds), rel_tol=1e-5, abs_tol=1e-12))

    def test_refused(self):
        self.render("a.exr", "--size", "8x8", "--spp", "8", "-q", scene=CORNELL)
        self.render("b.exr", *GROUPS)
        for words, says, code in [((), "mix needs a picture", 2), (("b.exr",), "mix needs -o", 2), (("a.exr", "rest=2", "-o", "m.exr"), "has no light groups", 1),
                                  (("b.exr", "direct=2", "-o", "m.exr"), "has no direct and indirect light", 1), (("b.exr", "sun=2", "-o", "m.exr"), "where NAME is one of bulb-over-table", 2),
                                  (("b.exr", "rest", "-o", "m.exr"), "names no layer", 2), (("b.exr", "rest=-1", "-o", "m.exr"), "a gain is a number", 2),
                                  (("b.exr", "rest=1,2", "-o", "m.exr"), "a gain is a number", 2), (("b.exr", "rest=0x1", "-o", "m.exr"), "a gain is a number", 2),
                                  (("b.exr", "rest=1", "rest=2", "-o", "m.exr"), "one gain for each", 2),
                                  (("b.exr", "rest=1", "-o", "b.exr"), "b.exr", 1), (("none.exr", "-o", "m.exr"), "none.exr", 1)]:
            with self.subTest(words=words):
                self.assertIn(says, self.assert_one_error(eclat("mix", *words, cwd=self.folder), code))
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.exr", "b.exr"])


if __name__ == "__main__":
    unittest.main()

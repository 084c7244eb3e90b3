# tiers: quick, full, long
"""eclat cost: the budget, the table, the JSON, and what Ctrl-C leaves."""
import json
import math
import os
import re
import signal
import subprocess
import tempfile
import unittest

import denoiser
from polling import GUARD
from support import CORNELL, ECLAT, ENVIRONMENT, RING, SOURCE, Case, eclat, quad_scene, write_gltf
from tiers import full, long

SMALL = ("--size", "32x32")
PATH = "path"


def rung_of(report, name):
    return next(r for r in report["rungs"] if r["id"] == name)


def study_that_measures(rung, budget, *arguments):
    """Returns standard output and the JSON. Doubles the budget, in seconds, where it was too small on this machine."""
    for doubled in range(6):
        with tempfile.TemporaryDirectory(prefix="eclat-cli-") as folder:
            path = os.path.join(folder, "out.json")
            run = eclat("cost", *arguments, "--budget", str(budget << doubled), "--json", path)
            if run.returncode:
                raise AssertionError(run.stderr)
            with open(path, encoding="utf-8") as file:
                report = json.load(file)
        if rung_of(report, rung)["state"] != "budget too small":
            break
    return run.stdout, report


class Denoiser(Case):
    def assert_rung_and_words(self, size, points):
        """Raises the budget until the denoiser's curve has so many points."""
        oidn = denoiser.environment()
        scene = os.path.join(SOURCE, "scenes", "velvet", "velvet.gltf")
        for budget in (12, 24, 48, 96):
            run = self.assert_ok(eclat("cost", scene, "--size", size, "--budget", str(budget), "--json", self.path("c.json"), env=oidn))
            with open(self.path("c.json"), encoding="utf-8") as file:
                report = json.load(file)
            rung = rung_of(report, "denoise")
            if rung["state"] == "measured" and len(rung["curve"]) >= points and report["denoiser"]:
                break
        self.assertGreater(rung["denoise_seconds"], 0)
        self.assertFalse(rung["biased"] or rung["light_not_met"])
        self.assertRegex(report["denoiser"], "^(pays down to an error of|pays at every error|does not pay)")
        self.assertIn("denoiser " + report["denoiser"], " ".join(run.stdout.split()))
        self.assertRegex(run.stdout, r"best of both, --denoise .* fades")

    @full
    def test_rung_and_words(self):
        """With a denoiser, the study has a rung for it, whose bias fades; the report says where it pays."""
        self.assert_rung_and_words("24x24", 3)

    @long
    def test_rung_of_more_points(self):
        self.assert_rung_and_words("32x32", 5)


class NoDenoiser(Case):
    def test_a_library_that_is_named_but_not_there(self):
        """Without the library, the study leaves the rung out."""
        scene = os.path.join(SOURCE, "scenes", "velvet", "velvet.gltf")
        self.assert_ok(eclat("cost", scene, *SMALL, "--budget", "2", "--json", self.path("c.json"), env={"ECLAT_OIDN": self.path("nowhere")}))
        with open(self.path("c.json"), encoding="utf-8") as file:
            self.assertNotIn("denoise", [rung["id"] for rung in json.load(file)["rungs"]])


@long
class Caustics(Case):
    def test_light_paths_are_traced(self):
        """In the ring, most of whose noise is a caustic, light paths remove noise but no light."""
        report = study_that_measures("light-paths", 15, RING, *SMALL)[1]
        base, found = rung_of(report, PATH), rung_of(report, "light-paths")
        self.assertLess(found["variance"], base["variance"])
        self.assertLess(abs(found["bias_squared"]), 4 * found["bias_squared_se"])
        self.assertTrue(rung_of(report, "light-paths-guiding"))


class FullStudy(Case):
    """One study, long enough to reach rungs that leave light out."""

    @classmethod
    def setUpClass(cls):
        cls.table, cls.report = study_that_measures("raster", 15, CORNELL, *SMALL)

    @full
    def test_every_rung_is_measured_or_says_why_not(self):
        expected = ["path", "sample-light", "sample-bsdf", "sample-hemisphere", "sampler-independent", "raster", "whitted", "light", "rr-0.8",
                    "rr-0.5", "rr-off", "clamp-1", "clamp-10", "clamp-100", "fast-math", "no-indirect", "no-lamps-3", "accel-bvh8", "accel-bvh2", "accel-kdtree", "accel-grid",
                    "lanes-1", "lanes-4", "lanes-8", "lanes-16"]
        for name in expected:
            self.assertTrue(rung_of(self.report, name))
        for rung in self.report["rungs"]:
            with self.subTest(rung=rung["id"]):
                if rung["state"] != "measured":
                    self.assertEqual(rung["state"], "budget too small")
                    self.assertIn("budget too small", rung["note"])
                    self.assertNotIn("efficiency", rung)
                elif rung["group"] in ("accelerator", "lanes"):
                    self.assertTrue(rung["same_bits"])
                else:
                    self.check_curve(rung)
        base = rung_of(self.report, PATH)
        self.assertEqual((base["state"], base["relative_time"]), ("measured", 1))
        self.assertEqual(sum(r["invalid_values"] for r in self.report["rungs"] if r["state"] == "measured" and r["id"] != "fast-math"), 0)

    @full
    def test_biased_by_design(self):
        """Direct light from a point, without shadows, gives another picture; more time does not help."""
        raster = rung_of(self.report, "raster")
        self.assertEqual(raster["state"], "measured")
        self.assertTrue(raster["biased"])
        self.assertGreater(raster["error_floor"], 0.1)
        self.assertTrue(all(t["never"] and t["seconds"] is None for t in raster["time_to"]))

    @full
    def test_unbiased_by_design(self):
        """Each check fails by chance once in 30 000."""
        for rung in self.report["rungs"]:
            if rung.get("unbiased_by_design") and rung["id"] in ("path", "sample-light", "rr-0.8", "sampler-independent"):
                self.assertLess(abs(rung["bias_squared"]), 4 * rung["bias_squared_se"], rung["id"])

    @full
    def test_table(self):
        self.assertIn("best by evidence: *", self.table)
        self.assertNotIn("\033", self.table)
        for rung in self.report["rungs"]:
            self.assertIn(rung["name"][:24] if rung["state"] == "measured" else rung["label"].split()[0], self.table)
            if rung["state"] == "measured":
                self.assertIn(rung["group_title"], self.table)
        for line in self.table.splitlines():
            self.assertLessEqual(len(line), 100, line)
        self.assertIn(" ".join(self.report["result"].split()), " ".join(self.table.split()))

    @full
    def test_the_headline_and_the_table_say_the_same(self):
        """The best of a column is the default, unless another is better by more than three standard errors. The headline names the best of
        its column."""
        ids = {rung["id"]: rung for rung in self.report["rungs"]}
        base = ids[PATH]
        for column, best in self.report["best"].items():
            if not column.startswith("to ") or best is None or best == PATH:
                continue
            index = ["to 5 %", "to 2 %", "to 1 %", "to 0.5 %"].index(column)
            if "time_to" in ids[best]:
                self.assertLess(ids[best]["time_to"][index]["seconds"], base["time_to"][index]["seconds"])
        goal = re.match(r"An error of ([\d.]+) % at 32x32 pixels takes", self.report["result"])
        self.assertTrue(goal, self.report["result"])
        best = ids[self.report["best"][f"to {goal[1]} %"]]
        if best is base:
            self.assertRegex(self.report["result"], "It is the best of [0-9]+ ways")
        else:
            self.assertIn(f"With {best['label']} it takes", self.report["result"])

    @full
    def test_scattering_is_no_matter_where_all_is_matt(self):
        self.assertNotIn("scattering-multiple", [r["id"] for r in self.report["rungs"]])

    def check_curve(self, rung):
        self.assertGreaterEqual(len(rung["curve"]), 1)
        for index, point in enumerate(rung["curve"]):
            self.assertEqual(point["samples_per_pixel"], 1 << index)
            self.assertGreaterEqual(point["pictures"], 2)
            seconds = rung["seconds_per_sample"] * 32 * 32 * (1 << index) + rung.get("denoise_seconds", 0)
            self.assertAlmostEqual(point["seconds"], seconds, delta=1e-6 * point["seconds"])
            if point["error"] is not None:
                self.assertAlmostEqual(point["error"], math.sqrt(point["mse"]), delta=1e-9)
        if rung["biased"]:
            self.assertAlmostEqual(rung["error_floor"], math.sqrt(rung["bias_squared"]), delta=1e-9)
            self.assertGreater(rung["bias_squared"], 3 * rung["bias_squared_se"])
        else:
            self.assertIsNone(rung["error_floor"])


class Study(Case):
    def test_budget_far_too_small(self):
        run = self.assert_ok(eclat("cost", CORNELL, *SMALL, "--json", self.path("out.json"), "--budget", "0.5s"))
        with open(self.path("out.json"), encoding="utf-8") as file:
            report = json.load(file)
        late = [r for r in report["rungs"] if r["state"] != "measured"]
        self.assertTrue(late)
        for rung in late:
            self.assertRegex(rung["note"], r"budget too small.*(--budget \d+m|about)")
        self.assertIn("budget too small", run.stdout)

    @full
    def test_pictures_fit_the_budget(self):
        """Without --size, pictures are smaller where time is short, and the report says so."""
        run = self.assert_ok(eclat("cost", CORNELL, "--json", self.path("out.json"), "--budget", "1s"))
        with open(self.path("out.json"), encoding="utf-8") as file:
            report = json.load(file)
        self.assertEqual((report["width"], report["height"]), (64, 64))
        self.assertIn("note: pictures of 64x64 pixels instead of 256x256, so that the budget covers more rungs; --size sets another size", run.stderr)

    def test_reference_from_a_file(self):
        self.assert_ok(eclat("render", CORNELL, *SMALL, "--spp", "256", "-o", self.path("ref.exr"), cwd=self.folder))
        _, report = study_that_measures(PATH, 3, CORNELL, "--reference", self.path("ref.exr"))
        self.assertEqual((report["width"], report["height"]), (32, 32))
        self.assertEqual(report["reference"]["samples_per_pixel"], 256)
        self.assertGreater(report["reference"]["error"], 0)
        base = rung_of(report, PATH)
        self.assertFalse(base["light_not_met"])

    def test_reference_of_another_size(self):
        self.assert_ok(eclat("render", CORNELL, "--size", "16x16", "--spp", "4", "-o", self.path("ref.exr"), cwd=self.folder))
        run = eclat("cost", CORNELL, *SMALL, "--reference", self.path("ref.exr"), "--budget", "2s", cwd=self.folder)
        self.assertIn("is 16x16 pixels and the study 32x32", run.stderr)
        self.assertEqual(run.returncode, 1)

    @long
    def test_seed_changes_the_figures(self):
        first, second = (rung_of(study_that_measures(PATH, 3, CORNELL, *SMALL, "--seed", seed)[1], PATH)
                         for seed in ("1", "2"))
        self.assertEqual({first["state"], second["state"]}, {"measured"})
        self.assertNotEqual(first["curve"][0]["mse"], second["curve"][0]["mse"])

    def test_interrupt_writes_what_is_known(self):
        process = subprocess.Popen([ECLAT, "cost", CORNELL, *SMALL, "--budget", "1m", "--json", "cut.json", "-o", "cut.html"],
                                   cwd=self.folder, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8")
        self.addCleanup(process.kill)
        process.stderr.readline()
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=GUARD)
        self.assertEqual(process.returncode, 0)
        with open(self.path("cut.json"), encoding="utf-8") as file:
            report = json.load(file)
        self.assertTrue(report["interrupted"])
        self.assertIn("interrupted after", out)
        states = {r["state"] for r in report["rungs"]}
        self.assertIn("interrupted", states)
        self.assertLess(states, {"interrupted", "measured", "budget too small"})
        self.assertTrue(os.path.exists(self.path("cut.html")))

    @long
    def test_scattering(self):
        """Rough metal has a rung. White of roughness 1, seen head-on in a white sky, returns 1 - ln 2 by single scattering (Heitz 2014),
        and nearly everything by multiple scattering: the floor is what single scattering loses."""
        plate = {"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 1}}
        document, _ = quad_scene(material=plate)
        document["cameras"][0]["perspective"]["yfov"] = 0.01
        scene = write_gltf(self.path("plate.gltf"), document)
        _, report = study_that_measures("scattering-multiple", 15, scene, "--env", "1,1,1", "--size", "8x8")
        again = rung_of(report, "scattering-multiple")
        self.assertEqual((again["state"], again["group"], again["settings"]["scattering"]), ("measured", "scattering", "multiple"), again["note"])
        self.assertTrue(again["biased"])
        self.assertAlmostEqual(again["error_floor"], 0.996 / (1 - math.log(2)) - 1, delta=0.02)

    def test_usage(self):
        for arguments, message in [(["-o", "a.png"], "NAME.html"), (["--budget", "0"], "more than 0"), ([], "needs a SCENE"),
                                   (["--bugdet", "3"], "did you mean '--budget'")]:
            with self.subTest(arguments=arguments):
                scene = [CORNELL] if arguments else []
                self.assertIn(message, self.assert_one_error(eclat("cost", *scene, *arguments, cwd=self.folder), 2))


if __name__ == "__main__":
    unittest.main()

# tiers: quick, full, long
"""--clamp: the light that it removes is counted pixel by pixel; the bits do not depend on how a job is divided; without it nothing changes."""
import json
import math
import statistics
import unittest

from support import CORNELL, QUICK, RING, Case, eclat, read_alike, read_exr
from test_ranks import mpirun, without_mpi
from tiers import full, long

JOB = [CORNELL, "--size", "20x18", *QUICK]
CUT = ["clamped.Y", "clamped.stderr"]


def luminance(planes):
    return [0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in zip(planes["R"], planes["G"], planes["B"])]


class Clamp(Case):
    def render(self, *options, name="a.exr", job=JOB):
        run = self.assert_ok(eclat("render", *job, *options, "--json", "-q", "-o", self.path(name)))
        return json.loads(run.stdout), *read_exr(self.path(name))

    def assert_same(self, whole, other):
        self.assertEqual(whole[0]["image_sha256"], other[0]["image_sha256"])
        self.assertEqual(whole[0]["clamp"], other[0]["clamp"])
        self.assertEqual(whole[2], other[2])

    def assert_is_what_is_missing(self, job):
        """Renders the same samples with and without a clamp. A pixel may differ by rounding only, 2^-24 of its luminance each: a mean a
        batch in the film, the scaled light, and its sum. 1e-6 is 16 roundings."""
        _, _, free = self.render(*job)
        _, _, clamped = self.render(*job, "--clamp", "0.5")
        lost = 0
        for y, kept, cut, spread in zip(luminance(free), luminance(clamped), *(clamped[name] for name in CUT)):
            self.assertAlmostEqual(kept + cut, y, delta=1e-6 * y + 1e-30)
            self.assertGreaterEqual(spread, 0)
            lost += cut
        self.assertGreater(lost, 0.02 * sum(luminance(free)))

    @full
    def test_picture_and_cut_are_the_whole_light(self):
        for job in [["--spp", "64"], ["--spp", "301", "--sampler", "independent"], ["--spp", "20", "--replicates", "1"],
                    ["--spp", "48", "--adaptive=off", "--filter", "blackman-harris", "--accel", "bvh2"]]:
            with self.subTest(job=job):
                self.assert_is_what_is_missing(job)

    def test_figures(self):
        """The report states what the channels hold."""
        report, attributes, planes = self.render("--spp", "64", "--clamp", "0.5")
        clamp, pixels = report["clamp"], len(planes["R"])
        mean, cut = sum(luminance(planes)) / pixels, sum(planes["clamped.Y"]) / pixels
        noise = sum(s * s for s in planes["clamped.stderr"]) / pixels
        self.assertEqual(clamp["limit"], 0.5)
        power = math.log2(clamp["luminance"] / 0.5)
        self.assertAlmostEqual(4 * power, round(4 * power), delta=1e-5)  # 0.5 times 2^(k / 4) …
        self.assertAlmostEqual(power, math.log2(mean + cut), delta=0.375)  # … near the picture's mean
        self.assertAlmostEqual(clamp["missing"], cut / (cut + mean), delta=1e-6)
        bias = math.sqrt(sum(c * c for c in planes["clamped.Y"]) / pixels - noise) / mean
        self.assertAlmostEqual(clamp["bias"], bias, delta=1e-5 * bias)
        self.assertAlmostEqual(clamp["bias_most"], math.hypot(clamp["bias"], math.sqrt(noise) / mean), delta=1e-5 * bias)
        self.assertEqual(clamp["noise"], report["error"])
        self.assertAlmostEqual(clamp["error"], math.hypot(clamp["noise"], clamp["bias"]), delta=1e-12)
        self.assertGreater(clamp["missing_stderr"], 0)
        for name, key in [("limit", "limit"), ("luminance", "luminance"), ("missing", "missing"), ("missingStderr", "missing_stderr"),
                          ("noise", "noise"), ("bias", "bias"), ("biasMost", "bias_most"), ("error", "error")]:
            # rounding of decimal digits
            self.assertAlmostEqual(attributes["eclat.clamp." + name], clamp[key], delta=1e-15 + 1e-14 * clamp[key])

    def test_words(self):
        run = self.assert_ok(eclat("render", *JOB, "--spp", "64", "--clamp", "0.5", "-o", self.path("a.exr")))
        self.assertRegex(run.stdout, r"clamped  [\d.]+ % of the light is missing \(standard error [\d.]+ %\); noise [\d.]+ %, bias [\d.]+ %, together [\d.]+ %\n")
        run = self.assert_ok(eclat("render", *JOB, "--spp", "1", "--clamp", "0.5", "-o", self.path("a.exr")))
        self.assertIn("clamped  how much light is missing is not known\n", run.stdout)

    def test_few_samples_decide(self):
        """A caustic: little noise is left, but how much light was cut off is hardly known, and the picture is not called good."""
        job = [RING, "--size", "32x32", "--spp", "64", "--clamp", "4", "-o", self.path("a.exr")]
        run = self.assert_ok(eclat("render", *job))
        self.assertRegex(run.stdout, r"bias up to [\d.]+ %, together up to [\d.]+ %\n")
        report = json.loads(self.assert_ok(eclat("render", *job, "--json", "-q")).stdout)
        self.assertLess(report["error_bound"], 0.3)
        self.assertEqual(report["quality"], "a rough preview")
        self.assertLess(report["clamp"]["bias"], math.sqrt(0.5) * report["clamp"]["bias_most"])

    @long
    def test_standard_error(self):
        """Over independent renders of one limit (another seed may round to another limit), the spread of the removed light, and of its
        share of all light, matches the stated errors. A variance of 20 values has a relative error of 32 %: one in 10 000 is under 0.2 or
        over 2.5 times its expectation."""
        job = ["--spp", "16", "--sampler", "independent", "--clamp", "1"]
        renders = [self.render(*job, "--seed", str(seed)) for seed in range(30)]
        limit = statistics.mode(report["clamp"]["luminance"] for report, _, _ in renders)
        renders = [(report["clamp"], planes) for report, _, planes in renders if report["clamp"]["luminance"] == limit]
        self.assertGreaterEqual(len(renders), 20)
        shares = statistics.variance(c["missing"] for c, _ in renders) / statistics.mean(c["missing_stderr"] ** 2 for c, _ in renders)
        cuts = statistics.variance(sum(p["clamped.Y"]) for _, p in renders) / statistics.mean(sum(s * s for s in p["clamped.stderr"]) for _, p in renders)
        for ratio in shares, cuts:
            self.assertLess(0.2, ratio)
            self.assertLess(ratio, 2.5)

    def test_off_by_default(self):
        report, attributes, planes = self.render("--spp", "16")
        self.assertIsNone(report["clamp"])
        self.assertFalse([name for name in planes if name in CUT] + [name for name in attributes if "clamp" in name])

    @full
    def test_direct_light_stays(self):
        """Paths of two segments see emission, and light reflected once: neither is clamped. A limit above all radiance cuts nothing off."""
        for more, clamp in [(["--max-depth", "2"], "0.01"), ([], "1000000")]:
            free, _, planes = self.render("--spp", "32", *more)
            clamped, _, others = self.render("--spp", "32", *more, "--clamp", clamp)
            self.assertEqual(set(others["clamped.Y"] + others["clamped.stderr"]), {0.0})
            self.assertEqual((clamped["clamp"]["missing"], clamped["clamp"]["bias"]), (0, 0))
            self.assertEqual(free["rays"], clamped["rays"])  # the count leaves the pilot's rays out
            if more:
                self.assertEqual(free["image_sha256"], clamped["image_sha256"])
            for y, other in zip(luminance(planes), luminance(others)):
                self.assertAlmostEqual(y, other, delta=1e-6 * y)

    @full
    def test_same_bits(self):
        job = ["--spp", "101", "--clamp", "1"]
        whole = self.render(*job)
        for more in [["--lanes", "1"], ["--lanes", "16"], ["--wave", "777"], ["--accel", "bvh2"]]:
            self.assert_same(whole, self.render(*job, "--effects", "needed", *more))

    @long
    def test_slices(self):
        _, attributes, _ = self.render("--spp", "101", "--clamp", "1", "--channels", "all", name="whole.exr")
        for i, part in enumerate(["0:26", "26:64", "64:101"]):
            self.render("--spp", "101", "--clamp", "1", "--samples", part, name=f"s{i}.exr")
        merged = self.path("all.exr")
        run = self.assert_ok(eclat("merge", *(self.path(f"s{i}.exr") for i in [2, 0, 1]), "--json", "-o", merged))
        others, _ = read_exr(merged)
        self.assertEqual(*read_alike(self.path("whole.exr"), merged))
        for name in ["limit", "luminance", "missing", "missingStderr", "noise", "bias", "error"]:
            self.assertEqual(attributes["eclat.clamp." + name], others["eclat.clamp." + name])
        self.assertAlmostEqual(json.loads(run.stdout)["clamp"]["missing"], attributes["eclat.clamp.missing"], delta=1e-14)
        words = self.assert_ok(eclat("merge", merged, "-o", self.path("again.exr"))).stdout
        self.assertIn("clamped: ", words)
        self.render("--spp", "101", "--samples", "64:101", name="s2.exr")
        self.assertIn("--clamp is 1 there and off here", self.assert_one_error(eclat("merge", self.path("s0.exr"), self.path("s2.exr"), "-o", merged), 1)
                      .replace("off there and 1 here", "1 there and off here"))

    @full
    def test_resume(self):
        whole = self.render("--spp", "101", "--clamp", "1")
        kept = self.path("kept.exr")
        self.render("--spp", "41", "--clamp", "1", "--checkpoint", kept)
        run = self.assert_ok(eclat("render", "--resume", kept, "--spp", "101", "--json", "-q", "-o", self.path("b.exr")))
        self.assert_same(whole, (json.loads(run.stdout), *read_exr(self.path("b.exr"))))

    @full
    def test_adaptive(self):
        """Adaptive sampling uses the clamped picture. The missing light is a mean over each pixel's own samples."""
        job = ["--spp", "200", "--adaptive", "--clamp", "1"]
        whole = self.render(*job)
        self.assertGreater(len(set(whole[2]["samples"])), 1)
        self.assert_same(whole, self.render(*job, "--effects", "needed", "--lanes", "1", "--wave", "999"))
        uniform = self.render("--spp", "200", "--clamp", "1")[0]["clamp"]
        spread = math.hypot(uniform["missing_stderr"], whole[0]["clamp"]["missing_stderr"])
        self.assertLess(abs(whole[0]["clamp"]["missing"] - uniform["missing"]), 5 * spread)

    @long
    def test_devices(self):
        """Two of PoCL's single-threaded devices, where the driver has them."""
        whole = self.render("--spp", "101", "--clamp", "1")
        run = eclat("render", *JOB, "--spp", "101", "--clamp", "1", "--device", "all", "--json", "-q", "-o", self.path("b.exr"), env={"POCL_DEVICES": "basic basic"})
        report = json.loads(self.assert_ok(run).stdout)
        if "devices" not in report:
            self.skipTest("no second device")
        self.assert_same(whole, (report, *read_exr(self.path("b.exr"))))

    @unittest.skipIf(without_mpi(), "no MPI")
    @long
    def test_ranks(self):
        for job in [["--spp", "101", "--clamp", "1"], ["--spp", "200", "--adaptive", "--clamp", "1"]]:
            whole = self.render(*job)
            run = self.assert_ok(mpirun(3, "render", *JOB, *job, "--json", "-q", "-o", self.path("b.exr")))
            self.assert_same(whole, (json.loads(run.stdout), *read_exr(self.path("b.exr"))))

    @full
    def test_a_job_with_a_clamp_is_another_job(self):
        kept = self.path("kept.exr")
        self.render("--spp", "16", "--clamp", "1", "--checkpoint", kept)
        run = eclat("render", "--resume", kept, "--spp", "32", "--clamp", "2", "-o", self.path("b.exr"))
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("--clamp", run.stderr)


if __name__ == "__main__":
    unittest.main()

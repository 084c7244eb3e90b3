# tiers: quick, full, long
"""--denoise: the report states what the channels hold, R, G and B stay as they are, the PNG shows the best picture, and every omission is
reported."""
import json
import math
import os
import random
import struct
import unittest

import denoiser
from denoise_seeds import Truth
from support import CORNELL, QUICK, SOURCE, Case, eclat, read_exr
from test_frames import FramesCase
from tiers import full, long

JOB = [CORNELL, "--size", "48x40", *QUICK]
# A room with texture and gloss but no caustics, where denoising pays.
SMOOTH = [os.path.join(SOURCE, "scenes", "velvet", "velvet.gltf"), "--size", "64x48", *QUICK]
WIDER = ["--effects", "needed", "--lanes", "8"]  # QUICK has one lane
LAYERS = [*(f"{layer}.{c}" for layer in ("denoised", "best") for c in "RGB"), "denoised.stderr"]


def half(x):
    return struct.unpack("e", struct.pack("e", x))[0]


def luminance(planes, layer=""):
    return [0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in zip(*(planes[layer + c] for c in "RGB"))]


def distance(a, b):
    """Distance of a and b relative to the mean of b."""
    return math.sqrt(sum((x - y) ** 2 for x, y in zip(a, b)) / len(b)) / (sum(b) / len(b))


class Denoise(Case):
    @classmethod
    def setUpClass(cls):
        cls.oidn = denoiser.environment()

    def render(self, *options, name="a.exr", job=JOB, denoise=("--denoise",), env=None):
        words = ["render", *job, *denoise, *options, "--json", "-q", "-o", self.path(name)]
        run = self.assert_ok(eclat(*words, env=dict(self.oidn, **(env or {}))))
        return json.loads(run.stdout), *read_exr(self.path(name))

    def test_layers_and_figures(self):
        report, attributes, planes = self.render("--spp", "64")
        for name in LAYERS:
            self.assertIn(name, planes)
        clean, best = report["denoised"], report["best"]
        for one in (clean, best):
            self.assertLessEqual(one["low95"], one["error"])
            self.assertLessEqual(one["error"], one["high95"])
        self.assertAlmostEqual(math.hypot(clean["bias"], clean["noise"]), clean["error"], delta=1e-9)
        self.assertEqual(clean["tiles"], 9)
        self.assertGreater(best["tiles_off"], 0)  # tiles at the edges of the lamp
        self.assertTrue(0 <= best["off_x"] < 48 and 0 <= best["off_y"] < 40)
        self.assertLess(best["error"], 1.25 * min(clean["error"], report["error"]))  # 1920 pixels do not tell it more precisely
        for key in ("error", "low95", "high95"):
            self.assertAlmostEqual(attributes["eclat.denoised." + key], clean[key], delta=1e-12)
            self.assertAlmostEqual(attributes["eclat.best." + key], best[key], delta=1e-12)
        self.assertRegex(attributes["eclat.denoised.library"], r"^Open Image Denoise 2\.")

    def test_radiance_stays_as_it_is(self):
        """R, G, B, their errors and the digest are those of a render with as many replicates and without --denoise, which has none of the
        layers."""
        plain, _, without = self.render("--spp", "32", "--replicates", "8", denoise=())
        report, _, planes = self.render("--spp", "32")
        self.assertIsNone(plain["denoised"])
        self.assertIsNone(plain["best"])
        self.assertEqual(plain["image_sha256"], report["image_sha256"])
        self.assertEqual(plain["error"], report["error"])
        for name in set(without) - {"A"}:  # A comes from first hits, of which --denoise takes more
            self.assertEqual(without[name], planes[name], name)
        self.assertEqual(sorted(set(planes) - set(without)), sorted(LAYERS))
        self.assertEqual(self.render("--spp", "32", "--replicates", "8", denoise=("--denoise=off",))[2], without)

    @full
    def test_same_bits(self):
        """Repeated, and with one thread, other lanes and other waves."""
        _, _, whole = self.render("--spp", "32")
        for options, env in (([], {}), ([], {"OMP_NUM_THREADS": "1"}), (["--wave", "500", *WIDER], {})):
            with self.subTest(options=options, env=env):
                self.assertEqual(self.render("--spp", "32", *options, name="b.exr", env=env)[2], whole)

    @full
    def test_atrous(self):
        """The built-in filter needs no library, and its arithmetic is exact: one thread and kernels of other widths give the same bits."""
        nothing = {"ECLAT_OIDN": self.path("nowhere")}
        report, attributes, planes = self.render("--spp", "16", job=SMOOTH, denoise=("--denoise=atrous",), env=nothing)
        self.assertEqual(report["denoise"], "atrous")
        self.assertEqual(attributes["eclat.denoised.library"], "a-trous filter")
        self.assertLess(report["best"]["error"], report["error"])
        for options, env in ((WIDER, nothing), ([], {**nothing, "POCL_MAX_PTHREAD_COUNT": "1"})):
            _, _, other = self.render("--spp", "16", *options, job=SMOOTH, denoise=("--denoise=atrous",), env=env)
            for layer in LAYERS:
                self.assertEqual(planes[layer], other[layer])

    @full
    def test_png_shows_the_best(self):
        """The PNG is smaller, since a smooth picture compresses better."""
        for name, denoise in (("clean", ["--denoise"]), ("noisy", [])):
            self.assert_ok(eclat("render", *JOB, *denoise, "--spp", "16", "-q", "-o", self.path(name + ".png"), env=self.oidn))
        self.assertLess(os.path.getsize(self.path("clean.png")), 0.9 * os.path.getsize(self.path("noisy.png")))

    @full
    def test_words(self):
        run = self.assert_ok(eclat("render", *JOB, "--spp", "64", "--denoise", "-o", self.path("a.exr"), env=self.oidn))
        number = r"[\d.]+ %"
        self.assertRegex(run.stdout, rf"denoised error {number} \(95 % interval {number} to {number}\), bias {number}, noise {number}; .*nearer to the truth in \d of 9 tiles")
        self.assertRegex(run.stdout, rf"best     error {number} \(95 % interval {number} to {number}\); the denoiser is off in \d of 9 tiles, .* around pixel \d+, \d+\n")

    def test_too_few_samples(self):
        """A picture is written, but no denoised one, and a message says why."""
        report, _, planes = self.render("--spp", "3")
        self.assertIsNone(report["denoised"]["error"])
        self.assertIn("4 samples a pixel", report["denoised"]["why_not"])
        self.assertNotIn("best.R", planes)
        run = self.assert_ok(eclat("render", *JOB, "--spp", "3", "--denoise", "-o", self.path("a.exr"), env=self.oidn))
        self.assertIn("denoised no: it needs 4 samples a pixel", run.stdout)

    def test_refusals(self):
        for options, word in ((["--replicates", "3"], "give 4 or more"), (["--denoise=loud"], "off, auto, oidn, atrous"), (["--integrator", "raster"], "--integrator path")):
            line = self.assert_one_error(eclat("render", *JOB, "--denoise", *options, "-o", self.path("a.exr"), env=self.oidn), 2)
            self.assertIn(word, line)

    def test_merged(self):
        """Merged slices give the denoised picture of the whole, first hits included. Each slice can be denoised by itself."""
        whole, attributes, planes = self.render("--spp", "96", "--channels", "all")
        slices = []
        for samples in ("0:64", "64:80", "80:96"):
            slices.append(self.path(samples.replace(":", "-") + ".exr"))
            run = self.assert_ok(eclat("render", *JOB, "--denoise", "--spp", "96", "--samples", samples, "-o", slices[-1], env=self.oidn))
            self.assertIn("denoised error", run.stdout)
        merged = self.path("merged.exr")
        report = json.loads(self.assert_ok(eclat("merge", *reversed(slices), "--denoise", "--json", "-o", merged, env=self.oidn)).stdout)
        for name in ("denoised", "best"):
            self.assertEqual({**report[name], "seconds": 0}, {**whole[name], "seconds": 0})
        merged_attributes, merged_planes = read_exr(merged)
        # a picture that can be merged no further keeps some channels in 16 bits
        exact = {c: v if v == planes[c] else [half(x) for x in v] for c, v in merged_planes.items()}
        self.assertEqual([c for c in planes if exact.get(c) != planes[c]], [])
        first = read_exr(slices[0])[1]
        self.assertNotEqual([half(x) for x in first["albedo.R"]], planes["albedo.R"])
        self.assertEqual(merged_attributes["eclat.best.high95"], attributes["eclat.best.high95"])
        run = self.assert_ok(eclat("merge", merged, "--denoise=atrous", "-o", self.path("again.png"), env=self.oidn))
        self.assertRegex(run.stdout, r"denoised error .*\nbest     error ")
        self.assert_ok(eclat("merge", merged, "-o", self.path("noisy.png")))
        self.assertLess(os.path.getsize(self.path("again.png")), 0.97 * os.path.getsize(self.path("noisy.png")))
        self.assertIsNone(json.loads(self.assert_ok(eclat("merge", merged, "--json", "-o", self.path("b.exr"))).stdout)["best"])
        line = self.assert_one_error(eclat("merge", merged, "--denoise=oidn", "-o", self.path("c.exr"), env={"ECLAT_OIDN": self.path("nowhere")}), 1)
        self.assertIn("ECLAT_OIDN: there is no", line)
        self.assertFalse(os.path.exists(self.path("c.exr")))

    def test_no_library(self):
        """--denoise oidn fails before rendering, and names both ways to get the library. --denoise alone says that the library is missing,
        and uses the built-in filter."""
        nowhere = {"HOME": self.folder, "VIRTUAL_ENV": "", "ECLAT_OIDN": self.path("nowhere")}
        line = self.assert_one_error(eclat("render", *JOB, "--denoise", "-o", self.path("a.exr"), env=nowhere), 1)
        self.assertIn("ECLAT_OIDN: there is no", line)
        nowhere["ECLAT_OIDN"] = ""
        if not denoiser.is_of_system() and not os.path.exists("/usr/local/lib/python3/dist-packages/pyoidn"):
            line = self.assert_one_error(eclat("render", *JOB, "--denoise=oidn", "-o", self.path("a.exr"), env=nowhere), 1)
            self.assertIn("install version 2 from the system's packages", line)
            self.assertIn("pip install pyoidn", line)
            run = self.assert_ok(eclat("render", *JOB, "--denoise", "--spp", "16", "-o", self.path("b.exr"), env=nowhere))
            self.assertIn("note: Intel's Open Image Denoise is not installed (version 2 of the system's package, or 'pip install pyoidn')", run.stderr)
            self.assertEqual(read_exr(self.path("b.exr"))[0]["eclat.denoised.library"], "a-trous filter")
        with open(self.path("libOpenImageDenoise.so.2"), "w", encoding="utf-8") as file:
            file.write("no library")
        line = self.assert_one_error(eclat("render", *JOB, "--denoise", "-o", self.path("a.exr"), env=dict(nowhere, ECLAT_OIDN=self.folder)), 1)
        self.assertIn("cannot load", line)
        self.assertFalse(os.path.exists(self.path("a.exr")))

    def test_channels(self):
        _, _, planes = self.render("--spp", "32", "--channels", "best")
        self.assertEqual(sorted(planes), ["B", "G", "R", "best.B", "best.G", "best.R"])

    @full
    def test_stops_by_the_clean_picture(self):
        """The requested error is reached with fewer samples: the stated interval of the best picture ends below it."""
        noisy, _, _ = self.render("--error", "2.5%", "--adaptive=off", job=SMOOTH, denoise=())
        clean, _, _ = self.render("--error", "2.5%", "--adaptive=off", job=SMOOTH)
        self.assertEqual(clean["stopped_by"], "error")
        self.assertLessEqual(clean["best"]["high95"], 0.025)
        self.assertGreater(clean["error"], 0.025)
        self.assertLess(clean["samples_per_pixel"], noisy["samples_per_pixel"])

    @long
    def test_stated_error_is_the_real_one(self):
        """The interval contains the distance to a long render for most of 20 seeds. The standard deviation of 95 % of 20 is 1.0."""
        _, _, reference = self.render("--spp", "8192", "--seed", "99", name="r.exr", job=SMOOTH, denoise=())
        truth = luminance(reference)
        held = 0
        for seed in range(20):
            report, _, planes = self.render("--spp", "32", "--seed", str(seed), job=SMOOTH)
            held += report["denoised"]["low95"] <= distance(luminance(planes, "denoised."), truth) <= report["denoised"]["high95"]
        self.assertGreaterEqual(held, 15)

    @full
    def test_resumed(self):
        """A resumed render gives the same denoised picture, also from a checkpoint that lacks first hits of some samples."""
        _, _, whole = self.render("--spp", "96")
        for spp in ("20", "40", "64"):
            checkpoint = self.path("c.exr")
            self.assert_ok(eclat("render", *JOB, "--denoise", "--spp", spp, "--checkpoint", checkpoint, "-q", "-o", self.path("p.exr"), env=self.oidn))
            self.assert_ok(eclat("render", "--resume", checkpoint, "--spp", "96", "-q", "-o", self.path("b.exr"), env=self.oidn))
            self.assertEqual(read_exr(self.path("b.exr"))[1], whole, spp)


class Halves(Case):
    """A stand-in for the denoiser makes all colours 0.9 as bright."""

    def render(self, *options, env=None):
        if "ECLAT_DIM_DENOISER" not in os.environ:
            self.skipTest("no ECLAT_DIM_DENOISER")
        name = self.path("a.exr")
        run = self.assert_ok(eclat("render", *JOB, "--denoise", *options, "--json", "-q", "-o", name, env={"ECLAT_OIDN": os.environ["ECLAT_DIM_DENOISER"], **(env or {})}))
        return json.loads(run.stdout), read_exr(name)[1]

    def test_denoised_is_the_mean_of_both(self):
        _, planes = self.render("--spp", "16")
        for c in "RGB":
            for denoised, noisy in zip(planes["denoised." + c], planes[c]):
                self.assertAlmostEqual(denoised, 0.9 * noisy, delta=1e-6 * abs(noisy))

    def test_each_half_has_its_own_guides(self):
        """The stand-in returns the albedo in place of colours. The mean of both halves' albedos is the whole picture's, times the scale in
        which colours are filtered."""
        _, planes = self.render("--spp", "16", "--channels", "denoised,albedo", env={"DIM_SHOWS_ALBEDO": "1"})
        scale = 2 ** round(math.log2(sum(planes["denoised.R"]) / sum(planes["albedo.R"])))
        for c in "RGB":
            for denoised, albedo in zip(planes["denoised." + c], planes["albedo." + c]):
                self.assertAlmostEqual(denoised, scale * albedo, delta=1e-3 * scale)  # half floats

    def test_each_half_is_judged_by_the_other(self):
        """A half that judged itself would take its noise for accuracy: the stated squared error would be 0.41 of the real one."""
        truth = luminance(self.render("--spp", "512", "--seed", "99")[1])  # its own noise adds 3 % to the real error
        stated = real = 0
        for seed in range(8):
            report, planes = self.render("--spp", "16", "--seed", str(seed))
            stated += report["denoised"]["error"] ** 2 / 8
            real += distance(luminance(planes, "denoised."), truth) ** 2 / 8
        self.assertAlmostEqual(stated / real, 1, delta=0.1)


class Truths(unittest.TestCase):
    def test_without_bias(self):
        """Sets of six pictures of ten pixels around 1 with a noise of 0.5, and one picture with a pixel off by 0.3. Their expected squares
        are 0.25 and 0.009, though the mean of five pictures has a variance of 0.05."""
        sets, sums, off, dice = 400, [0, 0], [1.3] + [1.0] * 9, random.Random(1)
        for _ in range(sets):
            noisy = [[1 + 0.5 * dice.gauss(0, 1) for _ in range(10)] for _ in range(6)]
            truth = Truth(noisy)
            for own in noisy:
                mean = (sum(map(sum, noisy)) - sum(own)) / 50
                sums = [s + square * mean**2 / sets / 6 for s, square in zip(sums, truth.errors(own, (own, off)))]
        self.assertAlmostEqual(sums[0], 0.25, delta=0.012)
        self.assertAlmostEqual(sums[1], 0.009, delta=0.005)


@full
class Frames(FramesCase):
    def test_each_by_itself(self):
        """Each frame equals the picture of that moment alone."""
        oidn, scene = denoiser.environment(), self.sliding()
        job = ["render", scene, "--size", "32x24", *QUICK, "--denoise", "--spp", "32", "-q"]
        self.assert_ok(eclat(*job, "--frames", "0:1", "--fps", "4", "-o", self.path("f%d.exr"), env=oidn))
        for frame in (0, 1):
            self.assert_ok(eclat(*job, "--at", str(frame / 4), "-o", self.path("alone.exr"), env=oidn))
            planes = read_exr(self.path(f"f{frame}.exr"))[1]
            self.assertIn("best.R", planes)
            self.assertEqual(planes, read_exr(self.path("alone.exr"))[1])


if __name__ == "__main__":
    unittest.main()

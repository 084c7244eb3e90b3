# tiers: quick, full
"""eclat render from end to end: files, reports, and equal bits."""
import hashlib
import json
import math
import os
import re
import struct
import unittest

from support import CORNELL, FLOAT, HALF, RING, UINT, WIDE, Case, eclat, png_size, quad_scene, read_exr, write_gltf
from tiers import full

SMALL = ["--size", "24x16", "--spp", "16"]
KEYS = """seconds samples_per_pixel samples_per_second rays_per_second error error_bound relmse heavy_pixels replicates invalid_samples
          invalid_samples_by_stage device lanes effects accel_seconds kernel_seconds pack_seconds first_pixel_seconds
          load_seconds peak_memory_bytes outputs stopped_by image_sha256 samples rays wave version command""".split()
CHANNELS = {**dict.fromkeys("RGB", FLOAT), "samples": UINT, **dict.fromkeys("A heavy stderr.R stderr.G stderr.B stderr.Y".split(), HALF)}
INTERVALS = dict.fromkeys("low95.R low95.G low95.B high95.R high95.G high95.B".split(), FLOAT)
FEATURES = {**dict.fromkeys("albedo.R albedo.G albedo.B normal.X normal.Y normal.Z".split(), HALF), "depth.Z": FLOAT}


class Render(Case):
    def setUp(self):
        super().setUp()
        self.scene = write_gltf(self.path("quad.gltf"), quad_scene()[0])

    def render(self, *options, scene=None, env=None):
        run = self.assert_ok(eclat("render", scene or self.scene, "--json", "--quiet", *options, cwd=self.folder, env=env))
        self.assertEqual(run.stdout.count("\n"), 1)
        return json.loads(run.stdout)


class Files(Render):
    def test_default_outputs_and_size_follow_scene_and_camera(self):
        run = self.assert_ok(eclat("render", self.scene, "--spp", "2", cwd=self.folder, env=WIDE))
        self.assertEqual(sorted(os.listdir(self.folder)), ["quad.exr", "quad.gltf", "quad.png"])
        self.assertIn("no -o given", run.stderr)
        for name in ["quad.exr", "quad.png"]:
            self.assertIn(os.path.join(os.path.realpath(self.folder), name), run.stdout)
        self.assertEqual(png_size(self.path("quad.png")), (768, 512))  # the aspect ratio is 1.5
        self.assertRegex(run.stdout, r"error .* at 2 samples a pixel in .* samples/s")
        self.assertRegex(run.stdout, r"(?m)^set-up   kernels [\d.]+ m?s( \(\d+ compiled, \d+ from the cache\))?, acceleration structure .*; first pixel after [\d.]+ m?s$")
        self.assertRegex(run.stdout, r"(?m)^invalid  0 samples$")

    def test_effects_are_told_in_all_places(self):
        report = self.render(*SMALL, "-o", "a.exr", scene=CORNELL)
        attributes, _ = read_exr(self.path("a.exr"))
        rows = [row for row in report["effect_list"] if row["called_for"]]
        self.assertEqual(report["effects"], ["emission", "area-lights", "back-face-culling", "sobol-sampler"])
        self.assertEqual([row["name"] for row in rows], report["effects"])
        self.assertEqual(rows[0]["why"], 'material 3 "lamp" emits')
        self.assertEqual(attributes["eclat.effects"].split(), report["effects"])
        self.assertEqual(attributes["eclat.effects.why"].splitlines(), [f"{row['name']}: {row['why']}" for row in rows])
        self.assertEqual(attributes["eclat.kernels"].split(", "), report["kernels"])
        built = [line.split("; ") for line in attributes["eclat.effects.built"].splitlines()]
        self.assertEqual([(name, kernels) for name, kernels, *_ in built], [(row["name"], "in " + ", ".join(row["kernels"])) for row in rows])
        self.assertEqual([made[0].rsplit(", ", 1)[0].split(", ") if made else [] for _, _, *made in built], [row["buffers"] for row in rows])
        for option, pattern in [("-q", r"\A\Z"), ("-v", r'(?m)^  emission +material 3 "lamp" emits; in shade$'),
                                ("--exposure=0", r"(?m)^effects  4 of \d+: emission area-lights back-face-culling sobol-sampler$")]:
            run = self.assert_ok(eclat("render", CORNELL, *SMALL, option, "-o", "a.exr", cwd=self.folder))
            self.assertRegex(run.stdout, pattern)

    def test_an_effect_is_left_out_by_its_name(self):
        report = self.render(*SMALL, "-o", "a.exr", "--without", "emission", "--without", "sheen", scene=CORNELL)
        left_out = [row["name"] for row in report["effect_list"] if row["left_out"]]
        self.assertEqual(left_out, ["emission", "sheen"])
        self.assertLessEqual({"emission; left out", "sheen; left out"}, set(read_exr(self.path("a.exr"))[0]["eclat.effects.built"].splitlines()))
        self.assertEqual(report["effects"], ["back-face-culling", "sobol-sampler"])
        self.assertEqual(report["mean_luminance"], 0)  # the lamp gave all the light
        run = self.assert_ok(eclat("render", CORNELL, *SMALL, "-v", "-o", "a.exr", "--without", "emission", "--without", "sheen", cwd=self.folder))
        self.assertRegex(run.stdout, r"(?m)^  emission +left out: --without$")
        self.assertIn("--without: the scene does not call for sheen\n", run.stderr)

    def test_what_is_no_effect_is_refused_with_the_names_of_all(self):
        for name in ("shee", "sobol-sampler"):
            line = self.assert_one_error(eclat("render", CORNELL, "--without", name, cwd=self.folder), 2)
            self.assertIn(f"--without: '{name}' is not one of the effects that can be left out: emission punctual-lights environment environment-map specular", line)
            self.assertIn(" sheen ", line)
        self.assertIn("needed, all", self.assert_one_error(eclat("render", CORNELL, "--effects", "every", cwd=self.folder), 2))

    def test_exr_has_the_channels_and_all_that_is_needed_to_render_it_again(self):
        report = self.render(*SMALL, "-o", "a.exr", "--seed", "18446744073709551615")
        attributes, planes = read_exr(self.path("a.exr"))
        self.assertEqual(dict(attributes["channels"]), CHANNELS)
        for name in ["command", "version", "scene", "camera", "environment", "seed", "integrator", "rr", "sample", "cutoff", "adaptive", "sampler", "terminator", "replicates",
                     "samplesPerPixel", "maxDepth", "lanes", "wave", "device", "device.version", "device.driver",
                     "device.platform", "seconds", "error", "errorBound", "relMSE", "heavyPixels", "effects", "invalid", "stoppedBy", "host",
                     "png.exposure", "png.tonemap"]:
            self.assertIn("eclat." + name, attributes)
        self.assertEqual(attributes["eclat.seed"], "18446744073709551615")
        self.assertIn("--seed 18446744073709551615", attributes["eclat.command"])
        self.assertEqual(set(planes["samples"]), {float(report["samples_per_pixel"])})
        self.assertAlmostEqual(attributes["eclat.error"], report["error"])

    def test_channels_on_request(self):
        self.render(*SMALL, "-o", "all.exr", "--channels", "all", scene=CORNELL)
        attributes, every = read_exr(self.path("all.exr"))
        self.assertEqual(dict(attributes["channels"]), {**CHANNELS, **INTERVALS, **FEATURES})
        rgb = {name: CHANNELS[name] for name in "RGB"}
        for asked, found in [("default", CHANNELS), ("R", rgb), ("depth.Z,stderr.Y", {**rgb, "depth.Z": FLOAT, "stderr.Y": HALF}),
                             ("default,low95,high95", {**CHANNELS, **INTERVALS}), ("default,albedo,normal,depth", {**CHANNELS, **FEATURES}),
                             ("clamped", rgb)]:  # channels that only --clamp makes
            self.render(*SMALL, "-o", "a.exr", "--channels", asked, scene=CORNELL)
            attributes, planes = read_exr(self.path("a.exr"))
            self.assertEqual(dict(attributes["channels"]), found, asked)
            for name in found:
                self.assertEqual(planes[name], every[name], name)

    def test_channels_that_cannot_be(self):
        for asked in ["stderr.Z", "", "R,", "stderr.", "ALL"]:
            line = self.assert_one_error(eclat("render", self.scene, "--channels", asked, cwd=self.folder), 2)
            self.assertIn(f"--channels: '{asked.split(',')[-1]}' is not a channel; give all, default, ", line)
        for options, says in [(["-o", "a.png"], "-o names none"), (["--samples", "0:64", "--spp", "64"], "a slice holds all of them")]:
            self.assertIn(says, self.assert_one_error(eclat("render", self.scene, "--channels", "all", *options, cwd=self.folder), 2))
        self.assertEqual(os.listdir(self.folder), ["quad.gltf"])

    def test_errors_that_halves_do_not_hold_are_floats(self):
        """Errors of a scene lit by almost nothing, or by 10^8 times the usual light."""
        for strength, kind in [("1e-7", FLOAT), ("0.1", HALF), ("1", HALF), ("1e8", FLOAT)]:
            report = self.render("--size", "24x16", "--spp", "16", "-o", "a.exr", "--env", "1,1,1", "--env-strength", strength, scene=self.lit())
            attributes, planes = read_exr(self.path("a.exr"))
            self.assertEqual(dict(attributes["channels"]), {**CHANNELS, **{name: kind for name in CHANNELS if name.startswith("stderr.")}}, strength)
            square = sum(error * error for error in planes["stderr.Y"]) / len(planes["R"])
            self.assertTrue(math.isclose(report["error"], math.sqrt(square) / report["mean_luminance"], rel_tol=1e-3))

    def lit(self):
        """A rough metal quad lit by an environment, which has as much noise as a mirror."""
        return write_gltf(self.path("lit.gltf"), quad_scene(material={"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}})[0])

    def test_without_two_replicates_no_channel_claims_an_error(self):
        self.render("--size", "8x8", "--spp", "1", "-o", "a.exr")
        attributes, planes = read_exr(self.path("a.exr"))
        self.assertEqual([name for name in planes if re.match("stderr|low95|high95|heavy", name)], [])
        self.assertNotIn("eclat.heavyPixels", attributes)

    def test_intervals_hold_the_mean_and_flags_are_counted(self):
        report = self.render("--size", "24x16", "--spp", "32", "-o", "a.exr", "--channels", "all", scene=RING)
        attributes, planes = read_exr(self.path("a.exr"))
        for c in "RGB":
            for low, mean, high in zip(planes[f"low95.{c}"], planes[c], planes[f"high95.{c}"]):
                self.assertTrue(0 <= low <= mean <= high)
        heavy = planes["heavy"].count(1)
        self.assertEqual(heavy + planes["heavy"].count(0), 24 * 16)
        self.assertEqual([heavy, attributes["eclat.heavyPixels"]], [report["heavy_pixels"]] * 2)
        self.assertGreater(heavy, 50)  # most of the caustic
        run = self.assert_ok(eclat("render", RING, "--size", "24x16", "--spp", "32", cwd=self.folder))
        self.assertRegex(run.stdout, rf"(?m)^pixels +{heavy} \(.* %\) need more samples for an error of their own")

    def test_the_errors_channels_are_those_of_the_stated_error(self):
        # enough pixels for the rounding of halves to average out
        report = self.render("--size", "96x64", "--spp", "16", "-o", "a.exr", scene=CORNELL)
        _, planes = read_exr(self.path("a.exr"))
        square = sum(error * error for error in planes["stderr.Y"]) / len(planes["R"])
        self.assertTrue(math.isclose(report["error"], math.sqrt(square) / report["mean_luminance"], rel_tol=1e-4))
        relmse = sum((error / (mean + 0.01)) ** 2 for c in "RGB" for mean, error in zip(planes[c], planes["stderr." + c]))
        self.assertTrue(math.isclose(report["relmse"], relmse / (3 * len(planes["R"])), rel_tol=1e-4))

    def test_hash_is_that_of_the_pixels_in_the_file(self):
        report = self.render(*SMALL, "-o", "a.exr")
        _, planes = read_exr(self.path("a.exr"))
        pixels = zip(planes["R"], planes["G"], planes["B"])
        self.assertEqual(hashlib.sha256(b"".join(struct.pack("<3f", *pixel) for pixel in pixels)).hexdigest(),
                         report["image_sha256"])

    def test_the_middle_of_the_quad_shines_and_the_rest_is_empty(self):
        self.render(*SMALL, "--channels", "all", "-o", "a.exr")
        _, planes = read_exr(self.path("a.exr"))
        middle, corner = 8 * 24 + 12, 0
        self.assertAlmostEqual(planes["R"][middle], 1, places=5)
        self.assertEqual((planes["A"][middle], planes["A"][corner], planes["R"][corner]), (1, 0, 0))
        self.assertAlmostEqual(planes["normal.Z"][middle], 1, places=5)

    def test_several_outputs_and_capital_extensions(self):
        report = self.render(*SMALL, "-o", "a.exr", "-o", "B.PNG", "-o", "c.png")
        self.assertEqual([os.path.basename(path) for path in report["outputs"]], ["a.exr", "B.PNG", "c.png"])
        for path in report["outputs"]:
            self.assertTrue(os.path.isabs(path) and os.path.getsize(path) > 0)

    def test_exposure_and_tonemap_touch_the_png_only(self):
        plain = self.render(*SMALL, "-o", "a.png", "--tonemap", "none")
        dark = self.render(*SMALL, "-o", "b.png", "--tonemap", "none", "--exposure", "-2")
        self.assertEqual(plain["image_sha256"], dark["image_sha256"])
        with open(self.path("a.png"), "rb") as a, open(self.path("b.png"), "rb") as b:
            self.assertNotEqual(a.read(), b.read())


class Reports(Render):
    def test_json_has_everything_measured(self):
        report = self.render(*SMALL, scene=CORNELL)
        for key in KEYS:
            self.assertIn(key, report)
        self.assertEqual((report["samples_per_pixel"], report["stopped_by"], report["invalid_samples"]), (16, "spp", 0))
        self.assertIsInstance(report["effects"], list)
        self.assertTrue(report["device"]["name"])
        self.assertEqual(report["samples"], 16 * 24 * 16)
        self.assertLessEqual(report["error"], report["error_bound"])

    def test_one_replicate_has_no_error_and_says_null(self):
        report = self.render("--size", "8x8", "--spp", "1")
        for key in ["error", "error_bound", "relmse", "heavy_pixels"]:
            self.assertIsNone(report[key], key)

    def test_error_target(self):
        report = self.render("--size", "16x16", "--error", "20%", "--time", "60", scene=CORNELL)
        self.assertEqual(report["stopped_by"], "error")
        self.assertLessEqual(report["error_bound"], 0.2)

    def test_percent_sign_is_optional(self):
        with_sign = self.render("--size", "16x16", "--error", "20%", scene=CORNELL)
        without = self.render("--size", "16x16", "--error", "20", scene=CORNELL)
        self.assertEqual(with_sign["image_sha256"], without["image_sha256"])

    def test_a_forecast_is_told_before_and_compared_after(self):
        run = self.assert_ok(eclat("render", self.scene, *SMALL[:2], "--spp", "64", "-o", self.path("a.png"), cwd=self.folder, env=WIDE))
        self.assertRegex(run.stderr, r"after 32 samples a pixel: about 64 samples a pixel, .+ \(95 %: .+ to .+\), error then about")
        self.assertRegex(run.stdout, r"(?m)^forecast about 64 samples a pixel.*; made after 32 samples$")
        forecast = self.render(*SMALL[:2], "--error", "1", "--spp", "4096", env=WIDE)["forecast"]
        self.assertTrue(forecast["seconds_low"] <= forecast["seconds"] <= forecast["seconds_high"])
        self.assertTrue(forecast["samples_per_pixel_low"] <= forecast["samples_per_pixel"] <= forecast["samples_per_pixel_high"] <= 4096)
        self.assertIsNone(self.render(*SMALL[:2], "--spp", "1")["forecast"])

    def test_time_limit(self):
        report = self.render("--size", "64x64", "--time", "1.5s", scene=CORNELL)
        self.assertEqual(report["stopped_by"], "time")
        self.assertGreater(report["samples_per_pixel"], 0)

    def test_default_stop_is_256_samples(self):
        report = self.render("--size", "4x4")
        self.assertEqual((report["samples_per_pixel"], report["stopped_by"]), (256, "spp"))

    def test_environment_option(self):
        report = self.render(*SMALL, "--env", "2,2,2", "-o", "a.exr")
        _, planes = read_exr(self.path("a.exr"))
        self.assertTrue(math.isclose(planes["G"][0], 2, rel_tol=1e-5))
        self.assertEqual(report["environment"], "2,2,2")
        report = self.render(*SMALL, "--env", "2,2,2", "--env-strength", "1.5", "-o", "a.exr")
        _, planes = read_exr(self.path("a.exr"))
        self.assertTrue(math.isclose(planes["G"][0], 3, rel_tol=1e-5))
        self.assertEqual(report["environment"], "2,2,2, turned by 0 degrees, strength 1.5")

    def test_an_environment_that_is_not_there_cannot_be_turned(self):
        line = self.assert_one_error(eclat("render", self.scene, *SMALL, "--env-rotate", "90", cwd=self.folder), 1)
        self.assertIn("give one with --light", line)

    def test_quiet_is_silent(self):
        run = self.assert_ok(eclat("render", self.scene, *SMALL, "--quiet", cwd=self.folder))
        self.assertEqual((run.stdout, run.stderr), ("", ""))

    def test_a_lost_report_is_a_failure_but_the_picture_is_there(self):
        with open("/dev/full", "w") as full:
            run = eclat("render", self.scene, *SMALL, "-o", self.path("a.png"), stdout=full)
        self.assertEqual(run.returncode, 1)
        self.assertEqual(png_size(self.path("a.png")), (24, 16))


class Pieces(Render):
    def test_settings_are_told_as_they_were_asked_for(self):
        options = {"--integrator": "path", "--rr": "0.8", "--sample": "hemisphere", "--max-depth": "3"}
        report = self.render(*SMALL, "-o", "a.exr", *[word for pair in options.items() for word in pair])
        attributes, _ = read_exr(self.path("a.exr"))
        self.assertEqual([report[key] for key in ["integrator", "sample", "max_depth"]], ["path", "hemisphere", 3])
        self.assertEqual([float(report["rr"]), float(attributes["eclat.rr"])], [0.8, 0.8])
        self.assertEqual([attributes["eclat." + key] for key in ["integrator", "sample", "maxDepth"]],
                         ["path", "hemisphere", "3"])

    def test_the_rasteriser_takes_no_rays_beyond_the_camera(self):
        report = self.render(*SMALL, "--integrator", "raster", scene=CORNELL)
        self.assertEqual([report["integrator"], report["invalid_samples"]], ["raster", 0])
        self.assertEqual(report["rays"], report["samples"])

    def test_whitteds_defaults_are_those_of_the_help(self):
        report = self.render(*SMALL, "--integrator", "whitted", "-o", "a.exr", scene=CORNELL)
        self.assertEqual([report[key] for key in ["integrator", "max_depth", "cutoff", "invalid_samples"]], ["whitted", 10, 0.001, 0])
        attributes, _ = read_exr(self.path("a.exr"))
        self.assertEqual([attributes["eclat." + key] for key in ["integrator", "maxDepth"]], ["whitted", "10"])

    def test_defaults_are_those_of_the_help(self):
        report = self.render(*SMALL)
        self.assertEqual([report[key] for key in ["integrator", "rr", "sample", "max_depth"]], ["path", "auto", "mis", None])
        again = self.render(*SMALL, "--integrator", "path", "--rr", "auto", "--sample", "mis", "--max-depth", "inf")
        self.assertEqual(again["image_sha256"], report["image_sha256"])

    def test_roulette_off_needs_a_depth_and_one_is_off(self):
        off = self.render(*SMALL, "--rr", "off", "--max-depth", "9", scene=CORNELL)
        one = self.render(*SMALL, "--rr", "1", "--max-depth", "9", scene=CORNELL)
        self.assertEqual([off["rr"], off["image_sha256"]], ["off", one["image_sha256"]])
        for other in ["auto", "0.5"]:
            self.assertNotEqual(self.render(*SMALL, "--rr", other, "--max-depth", "9", scene=CORNELL)["image_sha256"],
                                off["image_sha256"])


class SameBits(Render):
    def test_limits_only_say_how_many_samples(self):
        """Whichever limit ends a render of N samples a pixel, its bits are those of --spp N."""
        job = ["--size", "33x17", "--max-depth", "5"]
        for limit, stopped_by in [(["--error", "30%", "--adaptive=off"], "error"), (["--time", "0.5s"], "time"), (["--time", "0.5s", "--spp", "100000"], "time"),
                                  (["--spp", "77", "--time", "10m", "--error", "0.1%", "--adaptive=off"], "spp")]:
            with self.subTest(limit=limit):
                ended = self.render(*job, *limit, "-o", "a.exr", scene=CORNELL)
                counted = self.render(*job, "--spp", str(ended["samples_per_pixel"]), "-o", "b.exr", scene=CORNELL)
                self.assertEqual((ended["stopped_by"], counted["stopped_by"]), (stopped_by, "spp"))
                self.assertEqual([ended[key] for key in ("image_sha256", "samples", "error")], [counted[key] for key in ("image_sha256", "samples", "error")])
                self.assertEqual(read_exr(self.path("a.exr"))[1], read_exr(self.path("b.exr"))[1])

    def test_so_many_samples_are_exactly_so_many(self):
        for spp in (1, 7, 19, 33, 101, 130):
            report = self.render("--size", "8x8", "--spp", str(spp), "-o", "a.exr")
            planes = read_exr(self.path("a.exr"))[1]
            self.assertEqual((report["samples"], report["samples_per_pixel"], report["replicates"], set(planes["samples"])), (64 * spp, spp, min(spp, 4), {float(spp)}))

    def test_an_error_asks_for_samples_where_they_tell(self):
        """--error turns --adaptive on, unless it is turned off, or there is nothing to gain."""
        for options, told, spends in [(["--error", "20%"], True, True), (["--error", "20%", "--adaptive=auto"], True, True), (["--error", "20%", "--adaptive=off"], False, False),
                                      (["--spp", "96"], False, False), (["--spp", "96", "--adaptive"], True, True), (["--spp", "96", "--adaptive=on"], True, True)]:
            with self.subTest(options=options):
                report = self.render("--size", "24x16", *options, "-o", "a.exr", scene=CORNELL)
                self.assertEqual((report["adaptive"], report["allotment_gain"] < 0.95, len(set(read_exr(self.path("a.exr"))[1]["samples"])) > 1), (told, spends, spends))
        self.assertEqual(self.render("--size", "8x8", "--spp", "48", "--adaptive")["allotment_gain"], 1)  # a quad that emits has no noise

    @full
    def test_nothing_but_the_seed_and_the_sampler_changes_a_bit(self):
        options = ["--size", "33x17", "--spp", "8", "--max-depth", "5"]
        first = self.render(*options, scene=CORNELL)["image_sha256"]
        for change in [[], ["--lanes", "1"], ["--lanes", "4"], ["--lanes", "8"], ["--lanes", "16"], ["--wave", "1000"],
                       ["--wave", "100000"], ["--effects", "all", "--lanes", "4"], ["--accel", "bvh2"], ["--accel", "bvh8"],
                       ["--accel", "grid"], ["--accel", "kdtree"], ["--accel", "none"],
                       ["--accel", "twolevel"], ["--instancing", "on"]]:
            with self.subTest(change=change):
                self.assertEqual(self.render(*options, *change, scene=CORNELL)["image_sha256"], first)
        with self.subTest("density"):
            grids = [self.render(*options, "--accel", "grid", "--grid-density", density, scene=CORNELL) for density in ("0.01", "10000")]
            self.assertEqual([grid["image_sha256"] for grid in grids], [first, first])
            self.assertLess(grids[0]["device_bytes"], grids[1]["device_bytes"])  # the two grids differ
        with self.subTest("threads"):
            one = self.render(*options, scene=CORNELL, env={"POCL_MAX_PTHREAD_COUNT": "1"})
            self.assertEqual(one["image_sha256"], first)
        for change in [["--seed", "1"], ["--seed", str(2 ** 63)], ["--sampler", "independent"]]:
            with self.subTest(change=change):
                self.assertNotEqual(self.render(*options, *change, scene=CORNELL)["image_sha256"], first)


if __name__ == "__main__":
    unittest.main()

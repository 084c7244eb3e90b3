"""Slices of a job, rendered apart and merged: the bits of one render, in any order; and what cannot be merged."""
import itertools
import json
import os
import random
import re
import shutil
import subprocess
import unittest

from support import CORNELL, ECLAT, ENVIRONMENT, RING, Case, eclat, read_exr

SIZE = ["--size", "20x18"]


class Slices(Case):
    def render(self, name, *options, scene=CORNELL):
        path = self.path(name)
        self.assert_ok(eclat("render", scene, *SIZE, *options, "-q", "-o", path))
        return path

    def merge(self, *arguments):
        return eclat("merge", *arguments, "-q", "-o", self.path("all.exr"))

    def assert_same_picture(self, a, b):
        """Every channel of it."""
        (_, left), (_, right) = read_exr(a), read_exr(b)
        self.assertEqual(sorted(left), sorted(right))
        for name in left:
            self.assertEqual(left[name], right[name], name)

    def cut(self, job, cuts):
        """The slices between these numbers of samples."""
        return [self.render(f"s{a}-{b}.exr", *job, "--samples", f"{a}:{b}") for a, b in zip(cuts, cuts[1:])]

    def test_any_order_gives_the_bits_of_one_render(self):
        job = ["--spp", "72", "--batch", "2"]  # 36 batches: beyond two blocks of 16
        whole = self.render("whole.exr", *job)
        slices = self.cut(job, [0, 2, 24, 32, 72])
        for order in itertools.islice(itertools.permutations(slices), 0, 24, 5):
            self.assert_ok(self.merge(*order))
            self.assert_same_picture(whole, self.path("all.exr"))

    def test_by_way_of_other_merges(self):
        job = ["--spp", "40", "--batch", "1", "--integrator", "whitted"]
        whole = self.render("whole.exr", *job)
        dice = random.Random(3)
        slices = self.cut(job, [0, *sorted(dice.sample(range(1, 40), 4)), 40])
        self.assert_ok(eclat("merge", *slices[1::2], "--partial", "-q", "-o", self.path("odd.exr")))
        self.assert_ok(eclat("merge", *slices[::2], "--partial", "-q", "-o", self.path("even.exr")))
        self.assert_ok(self.merge(self.path("odd.exr"), self.path("even.exr")))
        self.assert_same_picture(whole, self.path("all.exr"))

    def test_the_batch_follows_from_the_whole_job(self):
        whole = self.render("whole.exr", "--spp", "64")
        slices = self.cut(["--spp", "64", "--time", "10m"], [0, 28, 64])
        run = self.assert_ok(eclat("merge", *slices, "--json", "-o", self.path("all.exr"), "-o", self.path("all.png")))
        result = json.loads(run.stdout)
        self.assertEqual((result["samples_per_pixel"], result["batches"], result["files"]), (64, 16, 2))
        self.assertEqual(result["outputs"], [os.path.realpath(self.path(name)) for name in ["all.exr", "all.png"]])
        attributes, _ = read_exr(whole)
        self.assertEqual(result["image_sha256"], attributes["eclat.imageSha256"])
        self.assert_same_picture(whole, self.path("all.exr"))

    def test_a_slice_is_a_picture(self):
        path = self.render("s.exr", "--spp", "64", "--samples", "16:32")
        attributes, planes = read_exr(path)
        self.assertEqual(attributes["eclat.samplesPerPixel"], 16)
        self.assertEqual(set(planes["samples"]), {16.0})
        run = eclat("compare", path, self.render("other.exr", "--spp", "64", "--seed", "5"), "-q")
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_jobs_without_an_end_grow(self):
        job = ["--batch", "4"]
        slices = self.cut(job, [0, 8, 20])
        whole = self.render("whole.exr", *job, "--spp", "20")
        self.assert_ok(self.merge(*slices))
        self.assert_same_picture(whole, self.path("all.exr"))

    def test_the_default_name_tells_slices_apart(self):
        run = self.assert_ok(eclat("render", CORNELL, *SIZE, "--spp", "32", "--samples", "8:16", "-q", cwd=self.folder))
        self.assertEqual(run.stderr, "")
        self.assertEqual(os.listdir(self.folder), ["cornell-box.8-16.exr"])

    def peak(self, *slices):
        process = subprocess.Popen([ECLAT, "merge", *slices, "-q", "-o", self.path("all.exr")], env=ENVIRONMENT)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0)
        return usage.ru_maxrss

    def test_memory_does_not_go_by_the_order(self):
        """Sums whose left neighbours come later would wait, 6 of them here, 11 MB each."""
        slices = [self.render(f"s{a}.exr", "--size", "400x400", "--spp", "192", "--batch", "1", "--samples", f"{a}:{a + 16}", "--integrator", "raster")
                  for a in range(0, 192, 16)]
        self.assertLess(self.peak(*slices[1::2], *slices[::2]), 1.1 * self.peak(*slices))

    def test_gaps_are_named(self):
        a, _, c, _ = self.cut(["--spp", "32", "--batch", "2"], [0, 8, 12, 24, 32])
        error = self.assert_one_error(self.merge(a, c), 1)
        self.assertIn("samples 8:12, 24:32 are missing; ", error)
        self.assertFalse(os.path.exists(self.path("all.exr")))
        run = self.assert_ok(self.merge(c, a, "--partial"))
        self.assertEqual(run.stderr, "eclat: warning: samples 8:12, 24:32 are missing: the picture is of the others\n")
        self.assertEqual(set(read_exr(self.path("all.exr"))[1]["samples"]), {20.0})

    def test_many_gaps_are_named_or_counted(self):
        slices = [self.render(f"s{a}.exr", "--spp", "2000000", "--batch", "1", "--samples", f"{a}:{a + 1}") for a in range(1000000, 1000060, 2)]
        error = self.assert_one_error(self.merge(*slices), 1)
        named, more = re.search("samples (.*) and ([0-9]+) more ranges are missing; ", error).groups()
        self.assertEqual(named.split(", ")[:2], ["0:1000000", "1000001:1000002"])
        self.assertEqual(len(named.split(", ")) + int(more), 31)
        self.assertTrue(named.endswith(f"{999999 + 2 * (31 - int(more) - 1)}:{999999 + 2 * (31 - int(more) - 1) + 1}"), named)

    def test_nothing_twice(self):
        job = ["--spp", "32", "--batch", "2"]
        a, b = self.render("a.exr", *job, "--samples", "0:20"), self.render("b.exr", *job, "--samples", "16:32")
        self.assertIn(f"'{a}' and '{b}' both have samples 16:20; ", self.assert_one_error(self.merge(a, b), 1))
        shutil.copy(a, self.path("copy.exr"))
        self.assertIn("both have samples 0:20; ", self.assert_one_error(self.merge(a, self.path("copy.exr")), 1))
        self.assertIn("are the same slice; ", self.assert_one_error(self.merge(a, a), 1))

    def test_other_jobs_are_refused_with_the_difference(self):
        a = self.render("a.exr", "--spp", "32", "--samples", "0:16")
        for options, says in [(["--seed", "2"], "--seed is 0 there and 2 here"), (["--max-depth", "3"], "--max-depth is inf there and 3 here"),
                              (["--size", "20x17"], "--size is 20x18 there and 20x17 here"), (["--batch", "4"], "--batch is 2 there and 4 here"),
                              (["--sampler", "independent"], "--sampler is sobol there"), (["--fstop", "2", "--focus", "3"], "--fstop is 0 there and 2 here"),
                              (["--env", "1,1,1"], "environment"), (["--without", "emission"], "--without is nothing there and emission here")]:
            b = self.render("b.exr", "--spp", "32", "--samples", "16:32", *options)
            error = self.assert_one_error(self.merge(a, b), 1)
            self.assertIn(f"'{b}' is not of the same job as '{a}': ", error)
            self.assertIn(says, error)
        b = self.render("b.exr", "--spp", "32", "--samples", "16:32", scene=RING)
        self.assertRegex(self.assert_one_error(self.merge(a, b), 1), "not the same are the scene's camera, geometry, ")
        c = self.render("c.exr", "--spp", "32", "--samples", "16:32", "--lanes", "4", "--wave", "2048", "--effects", "all",
                        "--exposure", "1", "--light-choice", "power")
        self.assert_ok(self.merge(a, c))

    def test_a_changed_scene_is_another(self):
        with open(CORNELL, encoding="utf-8") as file:
            scene = json.load(file)
        folder = os.path.dirname(CORNELL)
        for name in os.listdir(folder):
            if name.endswith(".bin"):
                shutil.copy(os.path.join(folder, name), self.path(name))
        a = self.render("a.exr", "--spp", "32", "--samples", "0:16")
        scene["materials"][0].setdefault("pbrMetallicRoughness", {})["baseColorFactor"] = [0.7, 0.7, 0.71, 1]
        with open(self.path("changed.gltf"), "w", encoding="utf-8") as file:
            json.dump(scene, file)
        b = self.render("b.exr", "--spp", "32", "--samples", "16:32", scene=self.path("changed.gltf"))
        self.assertIn("not the same are the scene's materials; ", self.assert_one_error(self.merge(a, b), 1))

    def test_what_is_no_slice(self):
        plain = self.render("plain.exr", "--spp", "4")
        self.assertIn(f"cannot read '{plain}': it is no checkpoint or slice", self.assert_one_error(self.merge(plain), 1))
        self.assertIn("cannot open", self.assert_one_error(self.merge(self.path("none.exr")), 1))
        self.assertIn("merge needs slices", self.assert_one_error(eclat("merge", "-o", self.path("x.exr")), 2))
        self.assertIn("merge needs -o", self.assert_one_error(eclat("merge", plain), 2))
        self.assertIn("is an input", self.assert_one_error(eclat("merge", plain, "-o", plain), 1))

    def test_the_command_line(self):
        def refuse(says, *options):
            self.assertIn(says, self.assert_one_error(eclat("render", CORNELL, *options), 2))
        refuse("slices begin and end with a batch, here every 16 samples, as 0:32; --batch sets that", "--samples", "10:20")
        refuse("reaches beyond the job's 64 samples", "--spp", "64", "--samples", "0:68")
        refuse("reaches beyond the job's 64 samples", "--spp", "64", "--batch", "2", "--samples", "0:65")
        refuse("here every 2 samples, as 0:64; ", "--spp", "64", "--batch", "2", "--samples", "0:63")
        for text in ["5", ":5", "5:", "a:b", "1:2:3", "-1:4"]:
            refuse("--samples", "--samples", text)
        refuse("holds no samples", "--samples", "4:4")
        refuse("--samples and --adaptive", "--samples", "0:16", "--adaptive")
        refuse("--samples and --error", "--samples", "0:16", "--error", "2%")
        refuse("a slice is an .exr", "--samples", "0:16", "-o", "a.png")


if __name__ == "__main__":
    unittest.main()

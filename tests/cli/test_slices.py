# tiers: quick, full
"""Slices of a job, rendered apart and merged: the bits of one render, in any order; and refusals of slices that cannot be merged."""
import itertools
import json
import os
import random
import re
import shutil
import subprocess
import unittest

from support import CORNELL, ECLAT, ENVIRONMENT, NARROW, RING, Case, eclat, read_alike, read_exr
from tiers import full

SIZE = ["--size", "20x18"]


class Slices(Case):
    def render(self, name, *options, scene=CORNELL):
        path = self.path(name)
        every = () if "--samples" in options else ("--channels", "all")
        kernels = () if "--lanes" in options else NARROW
        self.assert_ok(eclat("render", scene, *SIZE, *options, *every, *kernels, "-q", "-o", path))
        return path

    def merge(self, *arguments):
        return eclat("merge", *arguments, "-q", "-o", self.path("all.exr"))

    def assert_same_picture(self, a, b):
        """Compares every channel."""
        left, right = read_alike(a, b)
        self.assertEqual(sorted(left), sorted(right))
        for name in left:
            self.assertEqual(left[name], right[name], name)

    def cut(self, job, cuts):
        """Renders the slices between these numbers of samples."""
        return [self.render(f"s{a}-{b}.exr", *job, "--samples", f"{a}:{b}") for a, b in zip(cuts, cuts[1:])]

    def test_any_order_gives_the_bits_of_one_render(self):
        """Includes a slice shorter than a stride of all replicates, and a job that ends within a batch: sample 900 is in 896:928."""
        small = ["--size", "12x10"]
        for job, cuts in [(["--spp", "600", *small], [0, 8, 28, 512, 600]), (["--spp", "901", *small], [0, 92, 512, 896, 901]),
                          (["--spp", "50", "--replicates", "3"], [0, 12, 16, 46, 50])]:
            whole = self.render("whole.exr", *job)
            slices = self.cut(job, cuts)
            for order in itertools.islice(itertools.permutations(slices), 0, 24, 5):
                self.assert_ok(self.merge(*order))
                self.assert_same_picture(whole, self.path("all.exr"))

    def test_merges_of_merges(self):
        job = ["--spp", "75", "--integrator", "whitted"]  # the last batch, 72:76, is cut
        whole = self.render("whole.exr", *job)
        dice = random.Random(3)
        for _ in range(2):
            slices = self.cut(job, [0, *sorted(dice.sample([*range(8, 16, 2), *range(16, 32, 4), *range(32, 64, 2), *range(64, 76, 4)], 4)), 75])
            odd, even = slices[1::2], slices[::2]
            dice.shuffle(even)
            self.assert_ok(eclat("merge", *odd, "--partial", "-q", "-o", self.path("odd.exr")))
            self.assert_ok(eclat("merge", *even, "--partial", "-q", "-o", self.path("even.exr")))
            self.assert_ok(self.merge(self.path("even.exr"), self.path("odd.exr")))
            self.assert_same_picture(whole, self.path("all.exr"))

    def test_any_limits_are_of_one_job(self):
        """The samples of a batch do not depend on the limits."""
        whole = self.render("whole.exr", "--spp", "64")
        slices = self.cut(["--spp", "64", "--time", "10m"], [0, 28]) + self.cut([], [28, 36]) + self.cut(["--spp", "700"], [36, 64])
        self.assertIn("samples 64:700 are missing; ", self.assert_one_error(self.merge(*slices), 1))
        slices[-1] = self.render("last.exr", "--spp", "64", "--samples", "36:64")
        run = self.assert_ok(eclat("merge", *slices, "--json", "-o", self.path("all.exr"), "-o", self.path("all.png")))
        result = json.loads(run.stdout)
        self.assertEqual((result["samples_per_pixel"], result["replicates"], result["files"]), (64, 4, 3))
        self.assertEqual(result["outputs"], [os.path.realpath(self.path(name)) for name in ["all.exr", "all.png"]])
        attributes, _ = read_exr(whole)
        self.assertEqual(result["image_sha256"], attributes["eclat.imageSha256"])
        self.assert_same_picture(whole, self.path("all.exr"))

    def test_a_checkpoint_is_a_slice(self):
        """A checkpoint holds the job's beginning; another machine can render the rest."""
        whole = self.render("whole.exr", "--spp", "101")
        for done in [12, 41]:  # the last batch of the second, 40:42, is not in it
            self.render("begun.exr", "--spp", str(done), "--checkpoint", self.path("kept.exr"))
            rest = self.render("rest.exr", "--spp", "101", "--samples", f"{done // 4 * 4}:101")
            self.assert_ok(self.merge(rest, self.path("kept.exr")))
            self.assert_same_picture(whole, self.path("all.exr"))

    def test_a_slice_is_a_picture(self):
        path = self.render("s.exr", "--spp", "64", "--samples", "16:32")
        attributes, planes = read_exr(path)
        self.assertEqual(attributes["eclat.samplesPerPixel"], 16)
        self.assertEqual(set(planes["samples"]), {16.0})
        run = eclat("compare", path, self.render("other.exr", "--spp", "64", "--seed", "5"), "-q")
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_jobs_without_an_end_grow(self):
        slices = self.cut([], [0, 8, 21])  # the last batch, 20:24, is cut
        whole = self.render("whole.exr", "--spp", "21")
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

    @full
    def test_memory_does_not_depend_on_the_order(self):
        """Batches would wait for their left neighbours, which come later here: 24 of 4 MB each."""
        cuts = [0, 8, 16, 32, 64, 80, 96]
        slices = [self.render(f"s{a}.exr", "--size", "400x400", "--spp", "96", "--samples", f"{a}:{b}", "--integrator", "raster") for a, b in zip(cuts, cuts[1:])]
        self.assertLess(self.peak(*slices[1::2], *slices[::2]), 1.1 * self.peak(*slices))

    def test_gaps_are_named(self):
        a, _, c, _ = self.cut(["--spp", "33"], [0, 8, 12, 24, 33])
        error = self.assert_one_error(self.merge(a, c), 1)
        self.assertIn("samples 8:12, 24:33 are missing; ", error)
        self.assertFalse(os.path.exists(self.path("all.exr")))
        run = self.assert_ok(self.merge(c, a, "--partial"))
        self.assertEqual(run.stderr, "eclat: warning: samples 8:12, 24:33 are missing; the picture is made of the others\n")
        self.assertEqual(set(read_exr(self.path("all.exr"))[1]["samples"]), {20.0})

    @full
    def test_many_gaps_are_named_or_counted(self):
        slices = [self.render(f"s{a}.exr", "--spp", "2000000", "--samples", f"{a}:{a + 64}") for a in range(1000000, 1000000 + 30 * 128, 128)]
        error = self.assert_one_error(self.merge(*slices), 1)
        named, more = re.search("samples (.*) and ([0-9]+) more ranges are missing; ", error).groups()
        self.assertEqual(named.split(", ")[:2], ["0:1000000", "1000064:1000128"])
        self.assertEqual(len(named.split(", ")) + int(more), 31)
        last = 1000000 - 64 + 128 * (31 - int(more) - 1)
        self.assertTrue(named.endswith(f"{last}:{last + 64}"), named)

    def test_nothing_twice(self):
        job = ["--spp", "32"]
        a, b = self.render("a.exr", *job, "--samples", "0:20"), self.render("b.exr", *job, "--samples", "16:32")
        self.assertIn(f"'{a}' and '{b}' both have samples 16:20; ", self.assert_one_error(self.merge(a, b), 1))
        shutil.copy(a, self.path("copy.exr"))
        self.assertIn("both have samples 0:20; ", self.assert_one_error(self.merge(a, self.path("copy.exr")), 1))
        self.assertIn("are the same slice; ", self.assert_one_error(self.merge(a, a), 1))

    def test_nothing_after_an_end_within_a_batch(self):
        """A job that ends within a batch cannot go on."""
        a, b, c = self.render("a.exr", "--samples", "0:8"), self.render("b.exr", "--spp", "19", "--samples", "16:19"), self.render("c.exr", "--samples", "20:24")
        self.assert_ok(self.merge(a, c, "--partial"))
        shutil.copy(self.path("all.exr"), self.path("ac.exr"))
        for slices in [[b, c], [c, b], [self.path("ac.exr"), b]]:
            self.assertIn("one ends within a batch, after 19 samples a pixel, and the other continues after that; ", self.assert_one_error(self.merge(*slices, "--partial"), 1))
        self.assert_ok(self.merge(a, b, "--partial"))
        self.assertEqual(set(read_exr(self.path("all.exr"))[1]["samples"]), {11.0})

    def refuse_others(self, job, others, alike):
        """others: pairs of options and words of the merge's message; alike: options that change no bit."""
        job = [*job, "--spp", "32", "--samples"]
        a = self.render("a.exr", *job, "0:16")
        for options, says in others:
            b = self.render("b.exr", *job, "16:32", *options)
            error = self.assert_one_error(self.merge(a, b), 1)
            self.assertIn(f"'{b}' is not from the same job as '{a}': ", error)
            self.assertIn(says, error)
        b = self.render("b.exr", *job, "16:32", scene=RING)
        self.assertRegex(self.assert_one_error(self.merge(a, b), 1), "the scenes differ in camera, geometry, ")
        c = self.render("c.exr", *job, "16:32", *alike)
        self.assert_ok(self.merge(a, c))

    def test_other_jobs_are_refused_with_the_difference(self):
        """Uses the rasteriser, whose kernels compile soonest."""
        self.refuse_others(["--integrator", "raster"], [
            (["--seed", "2"], "--seed is 0 there and 2 here"), (["--size", "20x17"], "--size is 20x18 there and 20x17 here"),
            (["--replicates", "8"], "--replicates is 4 there and 8 here"), (["--sampler", "independent"], "--sampler is sobol there"),
            (["--env", "1,1,1"], "environment"), (["--without", "emission"], "--without is nothing there and emission here")],
            ["--wave", "2048", "--exposure", "1"])

    @full
    def test_other_paths_are_refused_with_the_difference(self):
        self.refuse_others([], [(["--max-depth", "3"], "--max-depth is inf there and 3 here"), (["--fstop", "2", "--focus", "3"], "--fstop is 0 there and 2 here"),
                                (["--env", "1,1,1"], "environment"), (["--without", "emission"], "--without is nothing there and emission here")],
                           ["--wave", "2048", "--exposure", "1", "--light-choice", "power"])

    @full
    def test_kernels_of_all_effects_are_of_the_same_job(self):
        a = self.render("a.exr", "--spp", "32", "--samples", "0:16")
        b = self.render("b.exr", "--spp", "32", "--samples", "16:32", "--lanes", "4", "--wave", "2048", "--effects", "all")
        self.assert_ok(self.merge(a, b))

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
        self.assertIn("the scenes differ in materials; ", self.assert_one_error(self.merge(a, b), 1))

    def test_files_that_are_no_slices(self):
        plain = self.render("plain.exr", "--spp", "4")
        self.assertIn(f"cannot read '{plain}': it is not a checkpoint or slice", self.assert_one_error(self.merge(plain), 1))
        self.assertIn("cannot open", self.assert_one_error(self.merge(self.path("none.exr")), 1))
        self.assertIn("merge needs slices", self.assert_one_error(eclat("merge", "-o", self.path("x.exr")), 2))
        self.assertIn("merge needs -o", self.assert_one_error(eclat("merge", plain), 2))
        self.assertIn("is an input", self.assert_one_error(eclat("merge", plain, "-o", plain), 1))

    def test_the_command_line(self):
        def refuse(says, *options):
            self.assertIn(says, self.assert_one_error(eclat("render", CORNELL, *options), 2))
        refuse("slices begin and end with a batch, here as 32:40; multiples of 64 always do", "--spp", "64", "--samples", "33:40")
        refuse("slices begin and end with a batch, here as 12:20; ", "--spp", "64", "--samples", "12:19")
        refuse("here as 64:100; ", "--spp", "101", "--samples", "65:99")
        refuse("here as 64:101; ", "--spp", "101", "--samples", "65:101")
        refuse("here as 896:901; ", "--spp", "901", "--samples", "900:901")
        for samples in ["4:16", "7:16", "1:16"]:
            refuse("here as 0:16; ", "--spp", "64", "--samples", samples)  # first-hit features come from the first 8 samples
        refuse("here as 0:8; ", "--spp", "64", "--samples", "0:7")
        refuse("here as 0:16; ", "--spp", "64", "--replicates", "16", "--samples", "0:8")
        refuse("reaches beyond the job's 64 samples", "--spp", "64", "--samples", "0:68")
        refuse("reaches beyond the job's 64 samples", "--spp", "64", "--samples", "0:65")
        for text in ["5", ":5", "5:", "a:b", "1:2:3", "-1:4"]:
            refuse("--samples", "--samples", text)
        refuse("holds no samples", "--samples", "4:4")
        refuse("--samples and --adaptive", "--samples", "0:16", "--adaptive")
        refuse("--samples and --adaptive", "--samples", "0:16", "--adaptive=on")
        refuse("--samples and --error", "--samples", "0:16", "--error", "2%")
        refuse("a slice is an .exr", "--samples", "0:16", "-o", "a.png")


if __name__ == "__main__":
    unittest.main()

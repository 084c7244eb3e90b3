"""Tests of options that find the light of path tracing in another way: the picture is the same within noise, and its bits do not depend on how a job is
shared out."""
import json
import os

from support import NARROW, SOURCE, Case, eclat


def scene(name):
    return os.path.join(SOURCE, "scenes", name, name + ".gltf")


class OtherWay(Case):
    WAY = []  # the options

    def render(self, *job, name="a.exr"):
        run = self.assert_ok(eclat("render", *NARROW, *job, "--json", "-q", "-o", self.path(name)))
        return json.loads(run.stdout)

    def assert_same_picture(self, job, samples, fewer=1.0, extra=()):
        """Path tracing alone and this way agree within their noise: in the mean, in blocks, in pixels. error^2 is so many times smaller."""
        alone = ["--light-paths", "0"]
        way = [*self.WAY, *extra]
        without = self.render(*job, *alone, "--spp", str(samples), name="without.exr")
        found = self.render(*job, "--spp", str(samples), *way, *([] if "--light-paths" in way else alone), "--seed", "2", name="with.exr")
        run = self.assert_ok(eclat("compare", self.path("without.exr"), self.path("with.exr"), "--json"))
        self.assertGreater(json.loads(run.stdout)["noise_test"]["p"], 1e-3)
        self.assertLess(found["error"] ** 2 * fewer, without["error"] ** 2)

    def assert_same_bits(self, job, others):
        """As without each of these options; returns what the report says."""
        whole = self.render(*job, "--spp", "32")
        for other in others:
            with self.subTest(other=other):
                self.assertEqual(self.render(*job, "--spp", "32", *other)["image_sha256"], whole["image_sha256"])
        return whole

    def assert_slices_and_resume(self, job):
        whole = self.render(*job, "--spp", "32")["image_sha256"]
        for a, b in [(0, 16), (16, 32)]:
            self.assert_ok(eclat("render", *NARROW, *job, "--spp", "32", "--samples", f"{a}:{b}", "-q", "-o", self.path(f"{a}.exr")))
        merged = self.assert_ok(eclat("merge", self.path("0.exr"), self.path("16.exr"), "--json", "-o", self.path("m.exr")))
        self.assertEqual(json.loads(merged.stdout)["image_sha256"], whole)
        self.render(*job, "--spp", "16", "--checkpoint", self.path("c.exr"))
        self.assertEqual(self.render(*job, "--spp", "32", "--resume", self.path("c.exr"))["image_sha256"], whole)

    def assert_refused(self, others):
        """others: options and a word of the message, besides this way's own."""
        for other, word in others:
            with self.subTest(other=other):
                line = self.assert_one_error(eclat("render", scene("ring"), *self.WAY, *other, "-o", self.path("a.exr")), 2)
                self.assertIn(self.WAY[0], line)
                self.assertIn(word, line)

    def assert_info(self, words):
        """An effect like any other, where it is asked for."""
        self.assertRegex(self.assert_ok(eclat("info", scene("ring"), *self.WAY)).stdout, words)
        self.assertNotRegex(self.assert_ok(eclat("info", scene("ring"))).stdout, r"\n *" + words.split(" ")[0] + "  ")

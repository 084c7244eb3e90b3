"""Tests of options that find light in another way than path tracing alone: the picture must be equal within noise, and its bits must not
depend on how a job is divided."""
import json
import os

from support import NARROW, SOURCE, Case, eclat


def scene(name):
    return os.path.join(SOURCE, "scenes", name, name + ".gltf")


class OtherWay(Case):
    WAY = []  # the options of this way

    def render(self, *job, name="a.exr"):
        run = self.assert_ok(eclat("render", *NARROW, *job, "--json", "-q", "-o", self.path(name)))
        return json.loads(run.stdout)

    def assert_same_picture(self, job, samples, fewer=1.0, extra=()):
        """Checks that path tracing alone and this way agree within their noise: in the mean, in blocks and in pixels. fewer: the factor by
        which error^2 falls."""
        alone = ["--light-paths", "0"]
        way = [*self.WAY, *extra]
        without = self.render(*job, *alone, "--spp", str(samples), name="without.exr")
        found = self.render(*job, "--spp", str(samples), *way, *([] if "--light-paths" in way else alone), "--seed", "2", name="with.exr")
        run = self.assert_ok(eclat("compare", self.path("without.exr"), self.path("with.exr"), "--json"))
        self.assertGreater(json.loads(run.stdout)["noise_test"]["p"], 1e-3)
        self.assertLess(found["error"] ** 2 * fewer, without["error"] ** 2)

    def assert_same_bits(self, job, others):
        """Checks that none of these options changes a bit; returns the report of the render without them."""
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
        """others: pairs of options and a word of the message. The message must name this way's own option too."""
        for other, word in others:
            with self.subTest(other=other):
                line = self.assert_one_error(eclat("render", scene("ring"), *self.WAY, *other, "-o", self.path("a.exr")), 2)
                self.assertIn(self.WAY[0], line)
                self.assertIn(word, line)

    def assert_info(self, words):
        """Checks that `eclat info` lists the effect only where the option asks for it."""
        self.assertRegex(self.assert_ok(eclat("info", scene("ring"), *self.WAY)).stdout, words)
        self.assertNotRegex(self.assert_ok(eclat("info", scene("ring"))).stdout, r"\n *" + words.split(" ")[0] + "  ")

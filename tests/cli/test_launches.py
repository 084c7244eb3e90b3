# tiers: quick, full, long
"""Kernel launches are cut into pieces, so that none takes long: on graphics cards, and where ECLAT_LAUNCH_SECONDS asks for it."""
import json
import os
import unittest

from support import CORNELL, QUICK, RING, SOURCE, Case, eclat, read_exr
from tiers import full, long

SHORT = {"ECLAT_LAUNCH_SECONDS": "1e-6"}


class Launches(Case):
    def render(self, name, *arguments, scene=CORNELL, **environment):
        run = self.assert_ok(eclat("render", scene, "-q", "--json", "-o", self.path(name), *arguments, env=environment))
        return json.loads(run.stdout), read_exr(self.path(name))[1]

    def assert_cut(self, *arguments, **how):
        """Many pieces of each launch give the bits of whole launches."""
        whole, picture = self.render("whole.exr", *arguments, ECLAT_LAUNCH_SECONDS="0", **how)
        cut, other = self.render("cut.exr", *arguments, **SHORT, **how)
        self.assertNotIn("launches", whole)
        self.assertGreater(cut["launches"]["pieces"], 4 * cut["launches"]["count"], cut["launches"])
        self.assertEqual(other, picture)
        self.assertEqual(cut["image_sha256"], whole["image_sha256"])
        self.assertEqual(cut["rays"], whole["rays"])

    def test_pieces_give_the_same_bits(self):
        self.assert_cut("--size", "48x48", "--spp", "16", *QUICK)

    def test_a_processor_is_left_alone_and_a_card_is_not(self):
        size = "--size", "24x24", "--spp", "8"
        self.assertNotIn("launches", self.render("a.exr", *size)[0])
        launches = self.render("a.exr", *size, ECLAT_DEVICE_TYPE="gpu")[0]["launches"]
        self.assertEqual(launches["pieces"], launches["count"])  # each launch is short: one piece
        self.assertGreater(launches["longest_seconds"], 0)

    def assert_late_bounces(self, lanes):
        """On a card, a launch has the parts of a queue as its second dimension, and covers as many entries of each as the longest part has."""
        options = "--size", "32x32", "--spp", "32", "--lanes", lanes, "--rr", "1", "--max-depth", "20"
        whole, _ = self.render("whole.exr", *options)
        late, _ = self.render("late.exr", *options, ECLAT_DEVICE_TYPE="gpu")
        self.assertEqual((late["image_sha256"], late["rays"]), (whole["image_sha256"], whole["rays"]))

    def test_late_bounces_go_over_what_is_left(self):
        self.assert_late_bounces("1")

    @full
    def test_late_bounces_of_packets(self):
        self.assert_late_bounces("8")

    def count_calls(self, *options, **environment):
        """Returns how many times a render of the Cornell box makes each OpenCL call, by name."""
        if "ECLAT_FAULT_SHIM" not in os.environ:
            self.skipTest("no ECLAT_FAULT_SHIM")
        self.render("a.exr", *options, LD_PRELOAD=os.environ["ECLAT_FAULT_SHIM"], FAULT_CALL="none", FAULT_COUNTS=self.path("counts"), **environment)
        with open(self.path("counts"), encoding="utf-8") as file:
            return {name: int(count) for name, count in (line.split() for line in file)}

    def test_the_host_waits_once_in_eight_bounces(self):
        """Queues are counted on the device: for each wait of the host there are three launches a bounce, and a few before and after."""
        calls = self.count_calls("--size", "48x48", "--spp", "16", ECLAT_DEVICE_TYPE="gpu")
        self.assertGreater(calls["clEnqueueNDRangeKernel"], 12 * calls["clEnqueueReadBuffer"], calls)

    def test_a_processor_is_looked_at_where_the_last_wave_ended(self):
        """Some paths of each wave have all 20 bounces: 60 launches, and one read of the queues and one of the dropped samples."""
        options = "--size", "16x16", "--wave", "4096", "--accel", "bvh8", "--rr", "1", "--max-depth", "20", "--spp"
        few, many = self.count_calls(*options, "64"), self.count_calls(*options, "192")
        more = {name: many[name] - few[name] for name in ("clEnqueueNDRangeKernel", "clEnqueueReadBuffer")}
        self.assertGreater(more["clEnqueueReadBuffer"], 0)
        self.assertGreater(more["clEnqueueNDRangeKernel"], 28 * more["clEnqueueReadBuffer"], more)

# tiers: quick, full, long
"""Several devices on one picture: the bits of one device, however the work is divided. A device that fails loses nothing, and a slow one
delays nobody.

Uses two or three devices of PoCL's single-threaded driver, which makes one for each word in POCL_DEVICES, and PoCL beside Intel's runtime
where tools/test --all-devices has installed it."""
import functools
import json
import os
import re
import signal
import subprocess
import sys
import unittest

from faults import SHIM, FaultCase
from polling import poll_until, poll_writes
from support import CORNELL, ECLAT, ENVIRONMENT, RING, SOURCE, Case, eclat, read_exr
from tiers import full, long

sys.path.insert(0, os.path.join(SOURCE, "tools"))
import opencl_devices

TWO = {"POCL_DEVICES": "basic basic"}
THREE = {"POCL_DEVICES": "basic basic basic"}
RESULT = ["image_sha256", "samples", "error", "error_bound", "relmse", "heavy_pixels", "stopped_by", "replicates"]
SIZE = ["--size", "72x50"]  # the last row and column of tiles are cut
OUT = re.compile(r"^eclat: warning: (.*) has failed, and the others take over its work: (.*)$")


def setUpModule():
    found = subprocess.run([ECLAT, "devices", "--json"], env=dict(ENVIRONMENT, **TWO), stdout=subprocess.PIPE, encoding="utf-8", check=False)
    if found.returncode or sum(device["name"].startswith("basic") for device in json.loads(found.stdout)["devices"]) < 2:
        print("skipped: the default OpenCL driver is not a PoCL that offers two basic devices")
        sys.exit(77)


class Several(Case):
    def render(self, *options, device="all", env=None, name="a.exr", timeout=300):
        run = eclat("render", *options, *(["--device", device] if device else []), "--json", "-q", "-o", self.path(name), env=env or TWO,
                    timeout=timeout)
        return json.loads(self.assert_ok(run).stdout)

    def assert_same(self, *job, env=None, scene=CORNELL):
        """Compares with the report and planes of one device."""
        one = self.render(scene, *SIZE, *job, device="0", env=env)
        planes = read_exr(self.path("a.exr"))[1]
        several = self.render(scene, *SIZE, *job, env=env)
        self.assertEqual({key: one[key] for key in RESULT}, {key: several[key] for key in RESULT})
        self.assertEqual(planes, read_exr(self.path("a.exr"))[1])
        self.assertNotIn("devices", one)
        return several

    def test_samples(self):
        several = self.assert_same("--spp", "41", env=THREE)
        self.assertEqual(len(several["devices"]), 3)
        self.assertAlmostEqual(sum(one["samples_per_pixel"] for one in several["devices"]), 41, places=4)
        self.assertEqual(several["rays"], self.render(CORNELL, *SIZE, "--spp", "41", device="1", env=THREE)["rays"])

    @full
    def test_pieces_of_batches(self):
        """From sample 512 on, a wave is two of the seven rows of tiles: every batch is divided."""
        several = self.assert_same("--spp", "1024", "--wave", str(72 * 8 * 16 * 2))
        self.assertTrue(all(one["samples_per_pixel"] > 0 for one in several["devices"]), several["devices"])

    @full
    def test_light_paths(self):
        several = self.assert_same("--spp", "41", "--light-paths", "0.5", scene=RING)
        self.assertEqual(len(several["devices"]), 2)

    @full
    def test_error(self):
        self.assertEqual(self.assert_same("--error", "12%", "--adaptive=off")["stopped_by"], "error")

    @full
    def test_adaptive(self):
        several = self.assert_same("--adaptive", "--spp", "256", "--wave", "4096")
        self.assertLess(several["allotment_gain"], 1)  # samples are still distributed by noise
        self.assertTrue(all(one["samples_per_pixel"] > 0 for one in several["devices"]), several["devices"])
        self.assert_same("--error", "10%")
        self.assert_same("--adaptive", "--spp", "160", "--wave", "4096", "--denoise=atrous", "--channels", "all")

    @full
    def test_slices(self):
        self.assert_same("--samples", "16:80", "--spp", "97")
        self.render(CORNELL, *SIZE, "--samples", "0:48", "--spp", "97", name="first.exr")
        self.render(CORNELL, *SIZE, "--samples", "48:97", "--spp", "97", device="0", name="second.exr")
        self.assert_ok(eclat("merge", self.path("first.exr"), self.path("second.exr"), "-o", self.path("all.exr"), "-q"))
        self.render(CORNELL, *SIZE, "--spp", "97", device="1")
        self.assertEqual(read_exr(self.path("a.exr"))[1]["R"], read_exr(self.path("all.exr"))[1]["R"])
        self.assert_same("--samples", "64:80", "--spp", "97", "--denoise=atrous")

    @long
    def test_other_integrators_and_lanes(self):
        for options in [["--integrator", "whitted"], ["--integrator", "raster"], ["--lanes", "1", "--accel", "grid"]]:
            with self.subTest(options):
                self.assert_same("--spp", "19", *options)

    @full
    def test_resume(self):
        kept = self.path("kept.exr")
        for first, job in [("all", []), ("0", ["--adaptive"])]:
            whole = self.render(CORNELL, *SIZE, "--spp", "96", *job, device="0")
            self.render(CORNELL, *SIZE, "--spp", "45", *job, "--checkpoint", kept, device=first)
            again = self.render("--resume", kept, "--spp", "96")
            self.assertEqual({key: whole[key] for key in RESULT}, {key: again[key] for key in RESULT})

    @long
    def test_resume_within_a_batch_of_one_device(self):
        """Waves end anywhere in a row of tiles; with several devices, pieces end there."""
        kept, job = self.path("kept.exr"), [CORNELL, *SIZE, "--spp", "2048", "--replicates", "1", "--wave", "16384", "--background", "transparent"]  # batches of 32 samples from 256 on, of 64 from 512
        whole = self.render(*job, device="0")
        planes = read_exr(self.path("a.exr"))[1]
        for wanted in [22, 29]:
            def is_there():
                state = self.state(kept) if os.path.exists(kept) else {"batches": -1}
                return state["batches"] >= wanted and state["underWay"] % (72 * 8) != 0
            for _ in range(9):  # each kill may come at another moment
                process = subprocess.Popen([ECLAT, "render", *job, "--device", "0", "--checkpoint", kept, "--every", "0.0000001", "-q", "-o", self.path("b.exr")],
                                           env=dict(ENVIRONMENT, **TWO))
                poll_until(is_there, process)
                process.send_signal(signal.SIGKILL)
                process.wait()
                if is_there():
                    break
                os.remove(kept)
            self.assertGreater(self.state(kept)["underWay"], 0)
            again = self.render("--resume", kept)
            self.assertEqual(again["image_sha256"], whole["image_sha256"])
            self.assertEqual(planes, read_exr(self.path("a.exr"))[1])
            os.remove(kept)

    @staticmethod
    def state(kept):
        return json.loads(read_exr(kept)[0]["eclat.state"])

    @full
    def test_killed(self):
        """The last checkpoint stays, without gaps."""
        job = [RING, "--size", "96x96", "--spp", "4608", "--samples", "4096:4608", "--wave", "16384"]  # 36 waves a batch, which are divided
        whole = self.render(*job, device="0")
        cut = 0
        for writes in [3, 15]:
            kept = self.path(f"kept{writes}.exr")
            process = subprocess.Popen([ECLAT, "render", *job, "--device", "all", "--checkpoint", kept, "--every", "0.1", "-q", "-o", self.path("a.exr")],
                                       env=dict(ENVIRONMENT, **TWO, LD_PRELOAD=SHIM, FAULT_CALL="clEnqueueNDRangeKernel", FAULT_PAUSE="2"))
            poll_writes(kept, process, writes)
            process.send_signal(signal.SIGKILL)
            process.wait()
            cut += self.state(kept)["underWay"] > 0
            again = self.render("--resume", kept, device=None)
            self.assertEqual(again["image_sha256"], whole["image_sha256"])
        self.assertGreater(cut, 0)

    @full
    def test_time_and_interruption(self):
        """The render ends within waves; the picture has only complete batches."""
        job = [CORNELL, "--size", "256x256", "--wave", "2048"]
        self.assertEqual(self.render(*job, "--time", "2s")["stopped_by"], "time")
        # within the first batch: pixels that were reached are right, others are marked
        first = self.render(*job, "--time", "0.02s", name="first.exr")
        samples, red = read_exr(self.path("first.exr"))[1]["samples"], read_exr(self.path("first.exr"))[1]["R"]
        done = max(samples)
        whole = self.render(*job, "--spp", f"{done:.0f}", device="0")
        right = read_exr(self.path("a.exr"))[1]["R"]
        self.assertEqual(whole["samples_per_pixel"], done)
        self.assertLessEqual(set(samples), {0.0, done})
        self.assertEqual(sum(samples), first["samples"])
        self.assertEqual([a for a, n in zip(red, samples) if n], [b for b, n in zip(right, samples) if n])

    def test_messages_and_attributes(self):
        run = self.assert_ok(eclat("render", CORNELL, *SIZE, "--spp", "16", "--device", "1,0", "-o", self.path("a.exr"), env=TWO))
        self.assertRegex(run.stderr, r"(?m)^eclat: rendering 72x50 pixels on basic-.* and 1 more device until 16 samples a pixel$")
        shares = re.findall(r"(?m)^device   basic-.*, \d+ lanes: ([0-9.]+) of 16 samples a pixel$", run.stdout)
        self.assertEqual((len(shares), sum(map(float, shares))), (2, 16))
        self.assertRegex(read_exr(self.path("a.exr"))[0]["eclat.devices"], r"^1 basic-.*: [0-9.]+ samples, 0 basic-.*: [0-9.]+ samples$")
        self.assertNotIn("warning", run.stderr)  # both devices round in the same way

    def test_queues_of_one_device(self):
        """A device that is named twice has two queues, each with half of its memory."""
        for device, memory in [("0", None), ("0,0", 2), ("0,1,0,0", 3)]:
            report = self.render(RING, *SIZE, "--spp", "64", "--error", "90%", "--clamp", "20", device=device)
            whole = whole if memory else report
            self.assertEqual({key: whole[key] for key in RESULT}, {key: report[key] for key in RESULT})
            shares = report.get("devices", [])
            self.assertEqual([one["index"] for one in shares], list(map(int, device.split(","))) if memory else [])
            for one in shares:
                self.assertEqual(one["memory_bytes"], self.memory() // (memory if one["index"] == 0 else 1))
        run = self.assert_ok(eclat("render", CORNELL, *SIZE, "--spp", "16", "--device", "0,0", "-o", self.path("a.exr"), env=TWO))
        self.assertRegex(run.stderr, r"(?m)^eclat: rendering 72x50 pixels on basic-.* with 2 queues until 16 samples a pixel$")

    def memory(self):
        return json.loads(eclat("devices", "--json", env=TWO).stdout)["devices"][0]["memory_bytes"]

    def test_refusals(self):
        for device, words in [("0,,1", "has an empty entry"), ("0,no-such", "--device no-such: no such device"),
                              ("0,7", "--device 7: no such device")]:
            self.assertIn(words, self.assert_one_error(eclat("render", CORNELL, "--device", device, env=TWO, cwd=self.folder), 1))
        plan = eclat("render", CORNELL, "--plan", "3", "--device", "0,1", env=TWO, cwd=self.folder)
        self.assertIn("--plan takes one device, which stands for those of all machines; name one with --device",
                      self.assert_one_error(plan, 1))
        large = eclat("render", CORNELL, "--size", "4096x4096", "--spp", "4", "--memory", "300M", "--device", "all", env=TWO, cwd=self.folder)
        self.assertIn("more than one --device needs the picture whole; name one, or give more", self.assert_one_error(large, 1))
        for command in [["cost", CORNELL], ["selftest"], ["info", CORNELL, "--accel", "bvh2"], ["view", CORNELL]]:
            for device in ["0,1", "all"]:
                run = eclat(*command, "--device", device, env=TWO, cwd=self.folder)
                if "built without" not in run.stderr:
                    self.assertIn("this takes one device; only eclat render takes several; name one of them", self.assert_one_error(run, 1))


class Failing(FaultCase):
    """One of three devices fails."""
    job = ["--size", "256x256", "--device", "all", "--json"]  # long enough for all devices to take part

    @functools.cached_property
    def whole(self):
        run, _ = self.run_with("whole", *self.job, spp=128, env=THREE)
        return json.loads(self.assert_ok(run).stdout)

    def fails(self, name, *options, spp=128, **faults):
        run, folder = self.run_with(name, *self.job, *options, spp=spp, env=THREE, device=1, **faults)
        report = json.loads(self.assert_ok(run).stdout)
        self.assertEqual(report["image_sha256"], self.whole["image_sha256"])
        self.assertEqual(self.check_files(folder), {"a.exr": "new", "a.png": "new"})
        lines = [OUT.match(line) for line in run.stderr.splitlines() if not line.startswith("  ")]
        self.assertEqual((len(lines), bool(lines and lines[0])), (1, True), run.stderr)
        self.assertRegex(lines[0].group(1), "^basic-")
        self.assertEqual([one["failed"] for one in report["devices"]], [False, True, False])
        return lines[0].group(2)

    @full
    def test_at_any_time(self):
        for at, faults in [(1, {}), (2, {"lost": 1}), (12, {}), (40, {"lost": 1})]:
            with self.subTest(at=at, faults=faults):
                why = self.fails(f"lost{at}", call="clEnqueueNDRangeKernel", at=at, **faults)
                self.assertIn("CL_OUT_OF_RESOURCES", why)

    @full
    def test_in_set_up(self):
        self.assertIn("CL_MEM_OBJECT_ALLOCATION_FAILURE", self.fails("memory", call="clCreateBuffer", at=2, code=-4, lost=1))
        why = self.fails("build", call="clBuildProgram", code=-11, log="lib/bsdf.h:42: error: no such thing\n")
        self.assertRegex(why, "^kernels lanes.* do not compile on basic-")

    def test_before_it_opens(self):
        whole, _ = self.run_with("whole", *self.job, spp=16, env=THREE)
        run, _ = self.run_with("queue", *self.job, spp=16, env=THREE, device=1, call="clCreateCommandQueue")
        report = json.loads(self.assert_ok(run).stdout)
        self.assertEqual((report["image_sha256"], len(report["devices"])), (json.loads(self.assert_ok(whole).stdout)["image_sha256"], 2))
        self.assertRegex(run.stderr, r"^eclat: warning: basic-.* has failed, and the others take over its work: clCreateCommandQueue .*\n$")

    def test_one_size_a_kernel(self):
        """PoCL 3.1 sometimes aborts when two threads run one kernel with two sizes. Batches have 8 and 16 samples here."""
        run, _ = self.run_with("sizes", *self.job, "--size", "128x128", spp=256, env=TWO, launches=self.path("launches"))
        self.assert_ok(run)
        sizes = {}
        with open(self.path("launches"), encoding="utf-8") as file:
            for line in file:
                program, kernel, items = line.split()
                sizes.setdefault((program, kernel), set()).add(int(items))
        self.assertIn("ec_accumulate", {kernel for _, kernel in sizes})
        self.assertEqual({kernel: of for kernel, of in sizes.items() if len(of) > 1}, {})

    @full
    def test_all_fail(self):
        run, folder = self.run_with("none", *self.job, spp=4096, env=THREE, call="clEnqueueNDRangeKernel", at=300, lost=1)
        lines = [line for line in run.stderr.splitlines() if not OUT.match(line)]
        self.assertEqual((run.returncode, len(lines)), (1, 1), run.stderr)
        self.assertRegex(lines[0], r"^eclat: error: the render failed after \d+ samples a pixel: .*; the picture so far is written$")
        report = json.loads(run.stdout)
        self.assertEqual(report["stopped_by"], "device")
        self.check_files(folder)
        run, _ = self.run_with("so far", *self.job, spp=report["samples_per_pixel"], env=THREE)
        self.assertEqual(json.loads(run.stdout)["image_sha256"], report["image_sha256"])

    @full
    def test_a_slow_device_delays_no_other(self):
        """Each launch of one device takes a thirtieth of the other's whole render. Once two waves have shown its pace, it gets no piece
        that the other would have to wait for. (It would go on with batches that are shorter than its shortest wave, to 26 samples a pixel
        instead of 10.)"""
        job = [*self.job, "--replicates", "1", "--wave", str(256 * 256 * 8)]
        run, _ = self.run_with("fast", *job, "--device", "0", spp=1024, env=TWO)
        fast = json.loads(self.assert_ok(run).stdout)
        run, _ = self.run_with("both", *job, spp=1024, env=TWO, call="clEnqueueNDRangeKernel", pause=int(1000 * fast["seconds"] / 30), device=1)
        both = json.loads(self.assert_ok(run).stdout)
        self.assertEqual(both["image_sha256"], fast["image_sha256"])
        self.assertGreater(both["devices"][1]["samples_per_pixel"], 0)
        self.assertLess(both["devices"][1]["samples_per_pixel"], 18)


class Unlike(FaultCase):
    """Devices of different drivers together."""

    @full
    def test_one_that_does_not_say_how_it_rounds(self):
        """The last query to the second device asks how it rounds."""
        env = {"POCL_DEVICES": "pthread basic"}
        last = self.count_calls("--device", "0", env=env)["clGetDeviceInfo"]
        for device, warns in [("all", True), ("1", False)]:
            run, _ = self.run_with("rounds" + device, "--device", device, env=env, call="clGetDeviceInfo", at=last)
            said = re.search("(?m)^eclat: warning: (basic|pthread)-.* does not say that it rounds division and square root correctly; if it does not, "
                             "the last bits differ from those of one device$", self.assert_ok(run).stderr)
            self.assertEqual(bool(said), warns, run.stderr)

    @full
    def test_pocl_and_intel(self):
        build = os.path.dirname(os.path.abspath(ECLAT))
        icds = [icd for icd in opencl_devices.icd_files(build) if re.search("pocl|intel", icd)]
        vendors = self.path("vendors")
        os.mkdir(vendors)
        for icd in icds:
            os.symlink(os.path.abspath(icd), os.path.join(vendors, os.path.basename(icd)))
        env = dict(opencl_devices.environment_of(vendors), POCL_DEVICES="basic")
        found = json.loads(self.assert_ok(eclat("devices", "--json", env=env)).stdout)["devices"]
        if len({device["platform"] for device in found}) < 2:
            self.skipTest("one driver only; tools/test --all-devices installs Intel's")
        job = ["render", CORNELL, *SIZE, "--spp", "64", "--json", "-o", self.path("a.exr")]
        pictures = set()
        for device in ["0", "all", "intel,pocl"]:
            run = self.assert_ok(eclat(*job, "--device", device, env=env))
            pictures.add(json.loads(run.stdout)["image_sha256"])
            self.assertNotIn("warning", run.stderr)
        self.assertEqual(len(pictures), 1)
        self.assertTrue(all(one["samples_per_pixel"] > 0 for one in json.loads(run.stdout)["devices"]), run.stdout)


if __name__ == "__main__":
    unittest.main()

# tiers: quick, full
"""Every OpenCL call fails once: one clear line, no damaged file, and a picture of the samples so far, if there are any."""
import json
import os
import re
import unittest

from faults import SHIM, FaultCase, at_once, spread
from support import CORNELL, eclat, read_exr
from tiers import full

HARMLESS = ["clGetPlatformInfo", "clGetDeviceInfo", "clGetProgramBuildInfo", "clGetProgramInfo"]  # a render can do without these
CACHED = ["clCreateProgramWithBinary", "clBuildProgram"]  # nor does it need the cache: if the driver's binaries fail, it uses the sources
# the last calls, once the picture is complete: unmapping samples and features, and waiting for nothing
CLOSING = {"clEnqueueUnmapMemObject": 2, "clFinish": 2}
LOST = {"CL_OUT_OF_RESOURCES": -5, "CL_INVALID_COMMAND_QUEUE": -36, "CL_DEVICE_NOT_AVAILABLE": -2}
KEPT = re.compile(r"the render failed after (\d+) samples a pixel: .*; the picture so far is written$")


class Device(FaultCase):
    most = 8  # uses of each call; test_faults_every_call.py tests more

    def check_kept(self, run, folder, error):
        """Checks that the files hold as many samples as the line states, and no sample of the failed batch."""
        kept = KEPT.search(error)
        if not kept:
            self.assertEqual(self.check_files(folder), {"a.exr": "old", "a.png": "old"}, error)
            return 0
        self.assertEqual(self.check_files(folder), {"a.exr": "new", "a.png": "new"}, error)
        attributes, planes = read_exr(os.path.join(folder, "a.exr"))
        samples = int(kept.group(1))
        self.assertEqual([attributes["eclat.stoppedBy"], attributes["eclat.samplesPerPixel"], set(planes["samples"])],
                         ["device", samples, {float(samples)}])
        self.assertEqual(planes["R"], self.pictures(samples))
        return samples

    def pictures(self, samples):
        """Returns red of renders with so many samples."""
        if samples not in self.known:
            _, folder = self.run_with(f"spp{samples}", spp=samples)
            self.known[samples] = read_exr(os.path.join(folder, "a.exr"))[1]["R"]
        return self.known[samples]

    def setUp(self):
        super().setUp()
        self.known = {}
        self.keeps_binaries = False
        self.closing = {}
        for samples in range(1, 5):
            self.pictures(samples)

    def test_a_card_that_holds_few_work_items_of_a_kernel(self):
        """The limit is not a power of two: groups get the largest power of two below it."""
        run, folder = self.run_with("few", spp=4, group=3)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(read_exr(os.path.join(folder, "a.exr"))[1]["R"], self.pictures(4))

    @full
    def test_any_call_fails(self):
        counts = self.count_calls()
        self.keeps_binaries = "clCreateProgramWithBinary" in counts
        self.closing = {call: counts[call] - last for call, last in CLOSING.items()}
        calls = [call for call in counts if call.startswith("cl") and call != "close"]
        self.assertGreater(len(calls), 15)
        kept = at_once(self.fail_once, [(call, n, -5) for call in calls for n in spread(counts[call], self.most)])
        self.assertEqual({0, 1, 2, 3} - set(kept), set())  # it failed at the start, in the middle and late

    def fail_once(self, call, n, code, **more):
        run, folder = self.run_with(f"{call}{n}{code}{len(more)}", call=call, at=n, code=code, **more)
        with self.subTest(call=call, n=n, code=code, more=more):
            another = call == "clGetDeviceIDs" and n > 2  # a failing second driver, if one is installed: the first one's device is used
            if n > self.closing.get(call, n):
                self.assertEqual([run.returncode, self.check_files(folder)], [0, {"a.exr": "new", "a.png": "new"}])
                self.assertEqual(read_exr(os.path.join(folder, "a.exr"))[1]["R"], self.pictures(4))
                return None
            if run.returncode == 0 and (another or call in (HARMLESS + CACHED if self.keeps_binaries else HARMLESS)):
                self.assertEqual(self.check_files(folder), {"a.exr": "new", "a.png": "new"})
                return None
            error = self.check_error(run)
            return self.check_kept(run, folder, error)

    def test_device_lost(self):
        count = self.count_calls()["clEnqueueNDRangeKernel"]
        kept = at_once(lambda n, code: self.fail_once("clEnqueueNDRangeKernel", n, code, lost=1),
                       [(n, code) for n in spread(count, 4) for code in LOST.values()])
        self.assertEqual({0, 3} - set(kept), set())

    def test_a_command_that_fails_as_it_runs(self):
        count = self.count_calls()["clGetEventInfo"]
        kept = at_once(lambda n: self.fail_once("clGetEventInfo", n, -5, status=-5), [(n,) for n in spread(count, 6)])
        self.assertEqual({0, 3} - set(kept), set())

    def test_the_report_is_made_all_the_same(self):
        count = self.count_calls()["clEnqueueNDRangeKernel"]
        run, _ = self.run_with("json", "--json", call="clEnqueueNDRangeKernel", at=count - 3)
        report = json.loads(run.stdout)
        self.assertEqual([run.returncode, report["stopped_by"], report["samples_per_pixel"], report["replicates"]], [1, "device", 3, 3])
        self.assertEqual([report["samples"], len(report["outputs"])], [3 * 64, 2])


class Others(FaultCase):
    """Other commands that use a device."""

    def test_devices_and_info(self):
        def fail(command, call):
            run = eclat(*command, env={"LD_PRELOAD": SHIM, "FAULT_CALL": call, **(self.no_cache() if call == "clBuildProgram" else {})})
            with self.subTest(command=command, call=call):
                self.check_error(run)
                self.assertEqual(run.stdout, "")
        info = ["info", "--accel", "bvh2", CORNELL]
        self.assert_ok(eclat(*info))
        at_once(fail, [(["devices"], call) for call in ["clGetPlatformIDs", "clGetDeviceIDs"]] +
                [(info, call) for call in ["clCreateContext", "clCreateBuffer", "clBuildProgram", "clCreateKernel",
                                           "clEnqueueNDRangeKernel", "clEnqueueReadBuffer", "clFinish", "clGetEventInfo"]])

    @full
    def test_a_study_reports_what_was_measured_before(self):
        builds = self.count_calls()["clBuildProgram"]  # one each for reference, base and rungs
        run = eclat("cost", CORNELL, "--size", "16x16", "--budget", "8s", "--json", self.path("a.json"),
                    env={"LD_PRELOAD": SHIM, "FAULT_CALL": "clBuildProgram", "FAULT_AT": str(2 * builds + 1), "FAULT_LOST": "1"})
        if run.returncode == 0:
            self.skipTest("this machine gets no further than the first row in 8 s")
        self.assertEqual(run.returncode, 1)
        self.assertRegex(run.stderr.splitlines()[-1], r"^eclat: error: .*; what was measured before is reported$")
        self.assertIn("the device failed before", run.stdout)
        with open(self.path("a.json"), encoding="utf-8") as file:
            rungs = json.load(file)["rungs"]
        self.assertEqual(rungs[0]["state"], "measured")
        self.assertIn("interrupted", [rung["state"] for rung in rungs])


class Memory(FaultCase):
    big = ["--size", "64x64", "--replicates", "1", "--spp", "80"]  # its last batch has 16 samples

    def test_a_smaller_wave_where_memory_is_short(self):
        run, folder = self.run_with("plain", *self.big, "--json")
        plain = json.loads(run.stdout)
        limit = 0.6 * plain["device_bytes"]
        for call in ["clCreateBuffer", "clEnqueueFillBuffer"]:  # fails when it is requested, or when it is first used
            for code in [-4, -5]:
                with self.subTest(call=call, code=code):
                    run, folder = self.run_with(f"{call}{code}", *self.big, "--json", call=call, code=code, memory=int(limit))
                    small = json.loads(self.assert_ok(run).stdout)
                    self.assertEqual(small["image_sha256"], plain["image_sha256"])
                    self.assertLessEqual(small["wave"], plain["wave"] / 2)
                    self.check_files(folder)
        run, _ = self.run_with("told", *self.big, quiet=False, call="clCreateBuffer", memory=int(limit))
        self.assertRegex(run.stderr, rf"(?m)^eclat: note: the device has memory for a wave of \d+ paths, not of {plain['wave']}; --wave sets the size$")

    def test_what_does_not_fit_at_all_names_bytes_and_remedy(self):
        run, folder = self.run_with("none", *self.big, call="clCreateBuffer", code=-4, memory=200000)
        error = self.check_error(run)
        self.assertRegex(error, r"clCreateBuffer \([a-z -]+, \d+\.\d MiB beside \d+\.\d in use\).*CL_MEM_OBJECT_ALLOCATION_FAILURE.*smaller --size")
        run, _ = self.run_with("wave", *self.big, "--wave", "100000", call="clCreateBuffer", code=-4, memory=4000000)
        self.assertRegex(self.check_error(run), r"smaller --size.*or a smaller --wave")
        self.assertEqual(self.check_files(folder), {"a.exr": "old", "a.png": "old"})


class Kernels(FaultCase):
    own_cache = {"platform": "OpenCL 3.0 of its own"}

    def test_a_build_that_fails_shows_the_start_of_the_log(self):
        log = "note: this is line one\n" + "kernels/lib/bsdf.h:42: error: use of undeclared identifier\n" + "more\n" * 500
        run, folder = self.run_with("build", call="clBuildProgram", code=-11, log=log, env=self.no_cache())
        error = self.check_error(run)
        self.assertRegex(error, r"kernels lanes\d+ do not compile on .*CL_BUILD_PROGRAM_FAILURE.*; ECLAT_DUMP_KERNELS=DIR")
        lines = run.stderr.splitlines()
        self.assertIn("bsdf.h:42: error: use of undeclared identifier", lines[1])
        self.assertLess(len(lines), 20)
        self.assertEqual(self.check_files(folder), {"a.exr": "old", "a.png": "old"})

    def render_with_cache(self, name, cache, misses, **more):
        environment = {"XDG_CACHE_HOME": cache, "POCL_CACHE_DIR": self.path("pocl"), **more}
        run, folder = self.run_with(name, "--json", env=environment, **self.own_cache)
        report = json.loads(self.assert_ok(run).stdout)
        self.check_files(folder)
        self.assertEqual(report["kernel_cache_misses"] > 0, misses, name)
        return report["image_sha256"]

    @full
    def test_a_damaged_cache_costs_time_only(self):
        cache = self.path("cache")
        first = self.render_with_cache("cold", cache, True)
        self.assertEqual(self.render_with_cache("warm", cache, False), first)
        kernels = os.path.join(cache, "eclat", "kernels")
        entries = [os.path.join(kernels, name) for name in os.listdir(kernels)]
        self.assertGreater(len(entries), 0)
        with open(entries[0], "r+b") as file:
            file.truncate(os.path.getsize(entries[0]) // 2)
        with open(entries[-1], "r+b") as file:
            file.seek(-100, os.SEEK_END)
            file.write(b"eclat")
        self.assertEqual(self.render_with_cache("damaged", cache, True), first)
        self.assertEqual(self.render_with_cache("mended", cache, False), first)
        with open(self.path("file"), "w", encoding="utf-8"):
            pass
        self.assertEqual(self.render_with_cache("no_home", "", False, HOME=""), first)
        for place in [self.path("file"), "/dev/null", "/proc/no/such"]:  # in the last one not even root may make a file
            self.assertEqual(self.render_with_cache(place.replace("/", "_"), place, True), first)


    def test_a_driver_without_a_place_for_its_kernels(self):
        run, _ = self.run_with("nowhere", env={"XDG_CACHE_HOME": "/proc/no", "POCL_CACHE_DIR": "/proc/no/such"})
        if run.returncode == 0:
            self.skipTest("this driver needs none")
        self.assertIn("offers no device; PoCL needs a writable folder, which POCL_CACHE_DIR=FOLDER names", self.check_error(run))


if __name__ == "__main__":
    unittest.main()

# tiers: quick, full
"""A render that stops and goes on has the bits of a render without a break. A checkpoint of another job is refused."""
import json
import os
import shlex
import shutil
import signal
import subprocess
import unittest

from polling import GUARD, poll_until, poll_writes
from support import CORNELL, ECLAT, ENVIRONMENT, RING, Case, eclat, quad_scene, read_alike, read_exr, write_gltf
from tiers import full

SIZE = ["--size", "20x18"]
SMALL = ["--size", "12x10"]  # the last row and column of tiles are cut
RESULT = ["image_sha256", "samples", "rays", "error", "error_bound", "relmse", "heavy_pixels", "stopped_by", "replicates"]


class Checkpoint(Case):
    def setUp(self):
        super().setUp()
        self.kept = self.path("kept.exr")

    def render(self, *options, name="a.exr"):
        return json.loads(self.assert_ok(eclat("render", *options, "--json", "-q", "-o", self.path(name))).stdout)

    def assert_same(self, first, job, limits, says=True):
        """Compares a render that ends early and goes on to the job's limits with the job without a break. says: also runs the command in
        its report."""
        whole = self.render(CORNELL, *SMALL, *job)
        planes = read_exr(self.path("a.exr"))[1]
        begun = self.render(CORNELL, *SMALL, *first, "--checkpoint", self.kept)
        self.assertLess(begun["samples"], whole["samples"])
        again = self.render("--resume", self.kept, *limits)
        self.assertNotIn("--resume", again["command"])
        self.assertEqual({key: whole[key] for key in RESULT}, {key: again[key] for key in RESULT})
        self.assertEqual(planes, read_exr(self.path("a.exr"))[1])
        if says:
            command = shlex.split(again["command"])
            self.assertEqual(again["image_sha256"], json.loads(self.assert_ok(eclat(*command[1:], "--json", "-q")).stdout)["image_sha256"])

    def test_paths(self):
        """Ends within the first batches of the replicates, between two strides, and within a batch: 101 samples are one less than batch
        100:102 ends with."""
        for first, all_of_it in [(2, 8), (32, 80), (101, 300), (37, 203)]:
            self.assert_same(["--spp", str(first)], ["--spp", str(all_of_it)], ["--spp", str(all_of_it)], says=first == 37)

    def test_first_hits_within_a_batch(self):
        """A hidden environment needs first hits of all batches. A batch that was cut short adds first hits that the checkpoint must not
        have."""
        job = ["--background", "transparent"]
        self.assert_same([*job, "--spp", "37"], [*job, "--spp", "80"], ["--spp", "80"])

    @full
    def test_other_numbers_of_replicates(self):
        for replicates, first, all_of_it in [(1, 3, 21), (3, 4, 50), (16, 40, 75)]:
            job = ["--replicates", str(replicates)]
            self.assert_same([*job, "--spp", str(first)], [*job, "--spp", str(all_of_it)], ["--spp", str(all_of_it)])

    @full
    def test_other_integrators(self):
        for integrator in ["whitted", "raster"]:
            job = ["--integrator", integrator]
            self.assert_same([*job, "--spp", "5"], [*job, "--spp", "21"], ["--spp", "21"])

    def test_adaptive(self):
        """Ends within the pilot, at its end, and where pixels have different counts."""
        for first in [12, 32, 50]:
            self.assert_same(["--adaptive", "--spp", str(first)], ["--adaptive", "--spp", "96"], ["--spp", "96"], says=first == 50)

    @full
    def test_in_the_middle_of_a_batch(self):
        """A wave has 256 paths, so that a batch takes 22 or more: nearly every stop is within a batch."""
        clean = ["--adaptive", "--denoise=atrous", "--channels", "all"]  # keeps first hits of all samples
        for options in [["--spp", "96", "--adaptive"], ["--spp", "1280", "--samples", "1024:1280"], ["--spp", "160", *clean]]:
            job = [CORNELL, "--size", "40x36", "--wave", "256", *options]
            whole = self.render(*job)
            planes = read_exr(self.path("a.exr"))[1]
            stops, cut = 0, 0
            while stops < 3 or not cut:
                self.assertLess(stops, 60)
                now = ["--resume", self.kept] if os.path.exists(self.kept) else job
                process = self.start(*now, "--checkpoint", self.kept, "--every", "0.000001s", "-q", "-o", self.path("a.exr"))
                poll_writes(self.kept, process, 1 + stops % 7)
                done = process.poll() is not None
                self.stop(process, [signal.SIGINT, signal.SIGKILL][stops % 2])
                stops += 1
                if os.path.exists(self.kept):
                    cut += self.state()["underWay"] > 0
                if done and not cut:
                    os.remove(self.kept)
            again = self.render("--resume", self.kept)
            self.assertEqual(whole["image_sha256"], again["image_sha256"])
            self.assertEqual(whole["samples"], again["samples"])
            self.assertEqual(planes, read_exr(self.path("a.exr"))[1])
            os.remove(self.kept)

    def state(self):
        return json.loads(read_exr(self.kept)[0]["eclat.state"])

    def signalled(self, number, write, *job):
        """Renders with a checkpoint after each wave. The process gets the signal as it renames the checkpoint with number `write`."""
        if "ECLAT_FAULT_SHIM" not in os.environ:
            self.skipTest("no ECLAT_FAULT_SHIM")
        fault = {"LD_PRELOAD": os.environ["ECLAT_FAULT_SHIM"], "FAULT_FOLDER": self.folder, "FAULT_CALL": "rename", "FAULT_AT": str(write),
                 "FAULT_SIGNAL": str(int(number))}
        return eclat("render", *job, "--checkpoint", self.kept, "--every", "0.000001s", "-q", "-o", self.path("b.exr"), env=fault)

    @full
    def test_within_the_first_batches(self):
        """The kept part of a batch that is under way has first hits here, which are averaged over the first batch of each replicate."""
        job = [CORNELL, "--size", "40x36", "--wave", "64", "--spp", "64"]  # 23 waves a batch
        whole = self.render(*job)
        planes = read_exr(self.path("a.exr"))[1]
        parts = set()
        for at in range(8):
            self.signalled(signal.SIGKILL, at + 1, *job)
            state = self.state()
            parts.add((state["batches"], state["underWay"]))
            again = self.render("--resume", self.kept)
            self.assertEqual((whole["image_sha256"], whole["samples"]), (again["image_sha256"], again["samples"]))
            self.assertEqual(planes, read_exr(self.path("a.exr"))[1])
            os.remove(self.kept)
        self.assertTrue([batches for batches, done in parts if batches < 8 and done], "never stopped early enough")

    @full
    def test_within_a_pass(self):
        """Ctrl-C in a render that holds no more than the picture. The kept part is in the order of the pass, and stays as it is."""
        if "ECLAT_FAULT_SHIM" not in os.environ:
            self.skipTest("no ECLAT_FAULT_SHIM")
        job = [CORNELL, "--size", "640x480", "--max-depth", "1", "--spp", "72", "--wave", "65536", "--adaptive", "--denoise=atrous"]
        whole = self.render(*job)
        planes = read_exr(self.path("a.exr"))[1]
        fault = {"LD_PRELOAD": os.environ["ECLAT_FAULT_SHIM"], "FAULT_FOLDER": self.folder, "FAULT_CALL": "clEnqueueNDRangeKernel",
                 "FAULT_SIGNAL": str(int(signal.SIGINT))}
        found = 0
        for at in range(1450, 2300, 40):
            eclat("render", *job, "--checkpoint", self.kept, "--every", "1h", "-q", "-o", self.path("b.exr"), env=dict(fault, FAULT_AT=str(at)))
            state = self.state()
            if state["hasWeights"] and state["underWay"]:
                found += 1
                again = self.render("--resume", self.kept)
                self.assertEqual((whole["image_sha256"], whole["samples"]), (again["image_sha256"], again["samples"]))
                self.assertEqual([c for c, plane in read_exr(self.path("a.exr"))[1].items() if plane != planes[c]], [])
            os.remove(self.kept)
            if found == 2:
                return
        self.fail("never stopped within a pass")

    @full
    def test_within_the_first_batch_of_a_slice(self):
        """This batch is cut like any other: on large pictures it takes minutes."""
        job = [CORNELL, "--size", "40x36", "--wave", "1024", "--spp", "4608", "--samples", "4096:4608"]  # a checkpoint after each of 90 waves
        whole = self.render(*job)
        planes = read_exr(self.path("a.exr"))[1]
        for number in [signal.SIGKILL, signal.SIGINT]:
            said = self.signalled(number, 3, *job).stderr
            self.assertEqual("continues" in said, number == signal.SIGINT, said)
            state = self.state()
            self.assertEqual((state["batches"], state["parts"], state["underWay"] > 0), (0, [], True))
            error = self.assert_one_error(eclat("merge", self.kept, "-o", self.path("m.exr")), 1)
            self.assertIn("stopped within its first batch", error)
            again = self.render("--resume", self.kept)
            self.assertEqual((whole["image_sha256"], whole["samples"]), (again["image_sha256"], again["samples"]))
            self.assertEqual(planes, read_exr(self.path("a.exr"))[1])
            os.remove(self.kept)

    @full
    def test_until_an_error(self):
        """Also with adaptive sampling, which --resume keeps as it was: on by default with --error, otherwise off."""
        self.assert_same(["--spp", "12"], ["--error", "60%", "--adaptive=off"], ["--error", "60%"])
        self.assert_same(["--error", "10%", "--spp", "40"], ["--error", "10%"], ["--error", "10%"])
        self.assert_same(["--error", "60%"], ["--spp", "150", "--adaptive"], ["--spp", "150"])

    def test_a_slice(self):
        job = [CORNELL, *SIZE, "--spp", "80", "--samples", "10:80"]
        whole = self.render(*job)
        process = self.start(*job, "--checkpoint", self.kept, "--every", "0.001s", "-o", self.path("b.exr"))
        self.stop(process, signal.SIGINT)
        again = self.render("--resume", self.kept, name="b.exr")
        self.assertEqual(whole["image_sha256"], again["image_sha256"])
        self.assert_ok(eclat("merge", self.path("b.exr"), "--partial", "-q", "-o", self.path("m.exr")))

    def test_a_slice_that_ends_within_a_batch(self):
        """The checkpoint ends before that batch, the picture within it."""
        job = [CORNELL, *SIZE, "--spp", "101", "--samples", "64:101"]
        whole = self.render(*job)
        planes = read_exr(self.path("a.exr"))[1]
        self.assertEqual((whole["samples_per_pixel"], json.loads(read_exr(self.path("a.exr"))[0]["eclat.state"])["cut"]), (37, 3))
        self.render(*job, "--checkpoint", self.kept)
        self.assertEqual((self.state()["cut"], set(read_exr(self.kept)[1]["samples"])), (0, {36.0}))
        for _ in range(2):
            self.assertEqual(whole["image_sha256"], self.render("--resume", self.kept)["image_sha256"])
            self.assertEqual(planes, read_exr(self.path("a.exr"))[1])

    def start(self, *options):
        return subprocess.Popen([ECLAT, "render", *options], env=ENVIRONMENT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, encoding="utf-8")

    def stop(self, process, number):
        poll_until(lambda: os.path.exists(self.kept), process)
        process.send_signal(number)
        return process.communicate(timeout=GUARD)

    def test_a_stopped_render_writes_a_checkpoint(self):
        """A last checkpoint is written, with everything that the picture shows."""
        for number in [signal.SIGINT, signal.SIGTERM]:
            process = self.start(CORNELL, "--size", "40x40", "--spp", "100000", "--checkpoint", self.kept, "--every", "0.05s",
                                 "--channels", "all", "-o", self.path("a.exr"))
            _, error = self.stop(process, number)
            self.assertEqual(process.returncode, 0, error)
            self.assertEqual(read_exr(self.path("a.exr"))[0]["eclat.stoppedBy"], "user")
            planes, kept = read_alike(self.path("a.exr"), self.kept)
            for name in kept:
                self.assertEqual(kept[name], planes[name], name)
            os.remove(self.kept)

    def test_the_limits_and_outputs_are_those_of_before(self):
        self.assert_ok(eclat("render", CORNELL, *SIZE, "--spp", "16", "--checkpoint", "kept.exr", "-q", "-o", "x.exr", cwd=self.folder))
        first = read_exr(self.path("x.exr"))
        os.remove(self.path("x.exr"))
        self.assert_ok(eclat("render", "--resume", "kept.exr", "-q", cwd=self.folder))
        self.assertEqual(first[1], read_exr(self.path("x.exr"))[1])
        self.assert_ok(eclat("render", "--resume", "kept.exr", "--spp", "20", "-q", cwd=self.folder))
        self.assertEqual(read_exr(self.path("x.exr"))[0]["eclat.samplesPerPixel"], 20)
        self.assertEqual(set(read_exr(self.kept)[1]["samples"]), {20.0})
        before = os.stat(self.kept).st_mtime_ns
        for limit in [[], ["--spp", "8"]]:
            run = self.assert_ok(eclat("render", "--resume", "kept.exr", *limit, cwd=self.folder))
            self.assertEqual(run.stderr, "eclat: 'kept.exr' already has 20 samples a pixel, and "
                             f"{(limit or ['--spp', '20'])[1]} are asked for; the picture is written as it is\n")
        self.assertEqual(os.stat(self.kept).st_mtime_ns, before)  # the checkpoint already has all samples
        self.assert_ok(eclat("render", "--resume", "kept.exr", "--checkpoint", "other.exr", "-q", cwd=self.folder))
        self.assertEqual(read_exr(self.kept)[1], read_exr(self.path("other.exr"))[1])
        self.assert_ok(eclat("render", "--resume", "other.exr", "-q", cwd=self.folder))
        for limit, kept in [(["--spp", "22"], 20), ([], 20), (["--spp", "24"], 24)]:  # half of 20:24, again, and all of it
            self.assert_ok(eclat("render", "--resume", "kept.exr", *limit, "-q", cwd=self.folder))
            self.assertEqual(set(read_exr(self.path("x.exr"))[1]["samples"]), {float((limit or [0, 20])[1])})
            self.assertEqual(set(read_exr(self.kept)[1]["samples"]), {float(kept)})
        plan = eclat("render", "--resume", "kept.exr", "--plan", "3", cwd=self.folder)
        self.assertIn("--plan and --resume: ", self.assert_one_error(plan, 2))

    def test_an_old_checkpoint_gives_a_warning(self):
        job = ["render", CORNELL, *SIZE, "--spp", "16", "--checkpoint", self.kept, "-q", "-o", self.path("a.exr")]
        self.assertEqual(self.assert_ok(eclat(*job)).stderr, "")
        self.assertEqual(self.assert_ok(eclat(*job)).stderr, f"eclat: warning: '{self.kept}' holds 16 samples per pixel of this render and "
                         f"will be overwritten; '--resume {self.kept}' continues it instead\n")
        self.assertEqual(self.assert_ok(eclat(*job, "--seed", "1")).stderr, "")

    def test_time_counts_on(self):
        self.render(CORNELL, *SIZE, "--spp", "16", "--checkpoint", self.kept)
        again = self.render("--resume", self.kept, "--time", "0.001s")
        self.assertEqual((again["samples_per_pixel"], again["stopped_by"]), (16, "time"))

    def test_what_does_not_fit_is_refused(self):
        self.render(CORNELL, *SIZE, "--spp", "16", "--checkpoint", self.kept)
        for options, says in [(["--seed", "2"], "--seed is 0 there and 2 here"), (["--size", "20x17"], "--size is 20x18 there and 20x17 here"),
                              (["--replicates", "8"], "--replicates is 4 there and 8 here"), (["--adaptive"], "--adaptive is off there and on here"),
                              (["--light-choice", "tree"], "--light-choice is power there and tree here"),
                              (["--integrator", "raster"], "--integrator is path there and raster here"), (["--rr", "0.5"], "--rr is"),
                              (["--camera", "0", "--filter", "blackman-harris"], "--filter is box there"), ([RING], "the scenes differ in camera, geometry")]:
            run = eclat("render", "--resume", self.kept, *options, "--spp", "32", "-q", "-o", self.path("b.exr"))
            error = self.assert_one_error(run, 1)
            self.assertIn(f"cannot continue from '{self.kept}': ", error)
            self.assertIn(says, error)
            self.assertFalse(os.path.exists(self.path("b.exr")))

    @full
    def test_meshes_that_are_kept_once_and_written_out(self):
        """Accelerators that know no instances number triangles differently, but trace the same samples."""
        scene, _ = quad_scene(material={"doubleSided": True})
        scene["nodes"] += [{"mesh": 0, "translation": [k, 0.5, -k]} for k in range(3)]
        scene["scenes"][0]["nodes"] += [2, 3, 4]
        job = [write_gltf(self.path("many.gltf"), scene), *SIZE, "--instancing", "on"]
        whole = self.render(*job, "--spp", "12")
        self.assertGreater(whole["instances"], 1)
        for first, then in [("auto", "bvh8"), ("grid", "twolevel")]:
            self.render(*job, "--spp", "8", "--accel", first, "--checkpoint", self.kept)
            again = self.render("--resume", self.kept, "--accel", then, "--spp", "12")
            self.assertEqual(whole["image_sha256"], again["image_sha256"])
        error = self.assert_one_error(eclat("render", "--resume", self.kept, "--instancing", "off", "-q", "-o", self.path("b.exr")), 1)
        self.assertIn("the scenes differ in geometry", error)

    @full
    def test_what_a_scene_does_not_call_for_makes_no_difference(self):
        self.render(CORNELL, *SIZE, "--spp", "16", "--checkpoint", self.kept)
        self.render("--resume", self.kept, "--scattering", "multiple")
        rough = write_gltf(self.path("rough.gltf"), quad_scene(material={"pbrMetallicRoughness": {"roughnessFactor": 0.5}})[0])
        self.render(rough, *SIZE, "--spp", "16", "--checkpoint", self.kept)
        error = self.assert_one_error(eclat("render", "--resume", self.kept, "--scattering", "multiple", "-q", "-o", self.path("b.exr")), 1)
        self.assertIn("--scattering is single there and multiple here", error)

    def test_a_scene_that_was_changed_or_moved(self):
        folder = os.path.dirname(CORNELL)
        for name in os.listdir(folder):
            if name.endswith((".bin", ".gltf")):
                shutil.copy(os.path.join(folder, name), self.path(name))
        scene = self.path("cornell-box.gltf")
        self.render(scene, *SIZE, "--spp", "8", "--checkpoint", self.kept)
        with open(scene, encoding="utf-8") as file:
            text = json.load(file)
        text["cameras"][0]["perspective"]["yfov"] += 1e-6
        with open(scene, "w", encoding="utf-8") as file:
            json.dump(text, file)
        run = eclat("render", "--resume", self.kept, "--spp", "32", "-q")
        self.assertIn("the scenes differ in camera; ", self.assert_one_error(run, 1))
        os.remove(scene)
        run = eclat("render", "--resume", self.kept, "--spp", "32", "-q", cwd="/")
        self.assertRegex(self.assert_one_error(run, 1), rf"cornell-box.gltf.*; the job was begun in '{os.getcwd()}'$")

    def test_snapshots(self):
        """Snapshots are whole whenever they are read. The last one is the final picture except for its attributes."""
        shot, end = self.path("shot.exr"), self.path("a.exr")
        process = self.start(CORNELL, *SIZE, "--spp", "512", "--channels", "default,depth", "--snapshot", shot, "--every", "0.000001s", "-q", "-o", end)
        samples = []

        def more():
            if os.path.exists(shot):
                attributes, planes = read_exr(shot)
                samples.append(attributes["eclat.samplesPerPixel"])
                self.assertLessEqual({"A", "B", "G", "R", "samples"}, set(planes))
            return False
        poll_until(more, process)
        self.assertEqual(process.wait(GUARD), 0)
        self.assertEqual(samples, sorted(samples))
        self.assertGreater(len(set(samples)), 2)
        (mine, planes), (theirs, whole) = read_exr(shot), read_exr(end)
        self.assertEqual(planes, whole)
        for name in ("eclat.samplesPerPixel", "eclat.error", "eclat.errorBound"):
            self.assertEqual(mine.get(name), theirs.get(name))
        without = self.render(CORNELL, *SIZE, "--spp", "512")
        self.assertEqual(without["image_sha256"], theirs["eclat.imageSha256"])

    def test_the_command_line(self):
        def refuse(says, *options, code=2):
            self.assertIn(says, self.assert_one_error(eclat("render", *options), code))
        refuse("--every belongs to --checkpoint or --snapshot", CORNELL, "--every", "5s")
        refuse("is both the snapshot and the picture", CORNELL, "--snapshot", "a.exr", "-o", "a.exr")
        refuse("is both the snapshot and the checkpoint", CORNELL, "--snapshot", "b.exr", "--checkpoint", "b.exr", "-o", "a.exr")
        refuse("leave --snapshot out", CORNELL, "--snapshot", "b.exr", "--frames", "1:2")
        refuse("must be named NAME.exr", CORNELL, "--checkpoint", "kept")
        refuse("is both the checkpoint and the picture", CORNELL, "--checkpoint", "a.exr", "-o", "a.exr")
        for name in ["./a.exr", os.path.join(os.getcwd(), "a.exr")]:
            refuse("is both the checkpoint and the picture", CORNELL, "--checkpoint", name, "-o", "a.exr")
            refuse("are the same file; leave one out", CORNELL, "-o", "a.exr", "-o", name)
        link, end = self.path("b.exr"), self.path("a.exr")
        os.symlink("a.exr", link)  # the link's target does not exist yet
        refuse("is both the checkpoint and the picture", CORNELL, "--checkpoint", end, "-o", link)
        refuse("are the same file; leave one out", CORNELL, "-o", link, "-o", end)
        refuse("cannot open", "--resume", self.path("none.exr"), code=1)
        refuse("No such file or directory", CORNELL, "--checkpoint", self.path("none", "kept.exr"), "-o", self.path("a.exr"), code=1)


if __name__ == "__main__":
    unittest.main()

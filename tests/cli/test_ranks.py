# tiers: quick, full
"""The processes of an MPI job make the picture of one process, bit for bit, however many there are and wherever. They end properly when
something fails.

Skips without mpirun, or where eclat was built without MPI."""
import json
import os
import re
import shutil
import signal
import subprocess
import unittest

from hosts import Hosts
from polling import GUARD, poll_until
from support import CORNELL, ECLAT, ENVIRONMENT, Case, eclat, quad_scene, read_exr, write_gltf
from tiers import full

# Runs as root and oversubscribed, which only tests should. Two threads a process are enough for pictures of 300 pixels. Without gl, hwloc
# does not query every X server for its cards, and does not end with servers that other tests close meanwhile.
MPI = dict(ENVIRONMENT, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", PRTE_ALLOW_RUN_AS_ROOT="1", PRTE_ALLOW_RUN_AS_ROOT_CONFIRM="1",
           POCL_MAX_PTHREAD_COUNT="2", HWLOC_COMPONENTS="-gl")
RESULT = ["image_sha256", "samples", "error", "error_bound", "relmse", "heavy_pixels", "stopped_by", "replicates", "invalid_samples", "allotment_gain"]
JOB = [CORNELL, "--size", "20x18"]
LAUNCHER = 60  # seconds for the launcher to end
NEVER_LOST = {"ECLAT_RANK_LOST": "1000000"}  # a rank that waits for another in vain makes the test hang


def mpirun(ranks, *arguments, env=None):
    return subprocess.run(["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(ranks), ECLAT, *arguments], env=dict(MPI, **(env or {})),
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8", timeout=GUARD)


def without_mpi():
    """Returns why there is nothing to test, or None."""
    if not shutil.which("mpirun"):
        return "no mpirun here"
    return "this eclat has no MPI" if "has no MPI" in mpirun(2, "--version").stderr else None


def own_lines(run):
    """eclat's lines, without the launcher's."""
    return [line for line in run.stderr.splitlines() if "eclat: " in line]


def has_ended(number):
    """True if the process is gone, or a zombie: a launcher that waits for itself reaps no process."""
    try:
        with open(f"/proc/{number}/stat", encoding="utf-8") as file:
            return file.read().rpartition(") ")[2].startswith("Z")
    except OSError:
        return True


class Ranks(Case):
    @classmethod
    def setUpClass(cls):
        if why := without_mpi():
            raise unittest.SkipTest(why)

    rendered = {}

    def render(self, *options):
        """The report and planes of one process. Each render is made once for all tests."""
        if options not in self.rendered:
            run = self.assert_ok(eclat("render", *options, "--json", "-q", "-o", self.path("a.exr")))
            self.rendered[options] = json.loads(run.stdout), read_exr(self.path("a.exr"))[1]
        return self.rendered[options]

    def assert_same(self, job, ranks, env=None, more=()):
        whole, planes = self.render(*job)
        run = self.assert_ok(mpirun(ranks, "render", *job, *more, "--json", "-q", "-o", self.path("b.exr"), env=env))
        report = json.loads(run.stdout)
        self.assertEqual(report["ranks"], ranks)
        self.assertEqual({key: whole[key] for key in RESULT}, {key: report[key] for key in RESULT})
        self.assertEqual(planes, read_exr(self.path("b.exr"))[1])

    def test_a_number_of_samples(self):
        for ranks in 2, 3, 5:
            self.assert_same([*JOB, "--spp", "131"], ranks)  # the last batch, 128:132, is cut

    @full
    def test_all_take_part(self):
        run = self.assert_ok(mpirun(3, "render", CORNELL, "--size", "64x64", "--spp", "1024", "--json", "-q", "-o", self.path("b.exr")))
        report = json.loads(run.stdout)
        self.assertGreater(report["other_ranks_samples_per_pixel"], 0.2 * 1024)
        self.assertLess(report["other_ranks_samples_per_pixel"], 1024)

    @full
    def test_trees(self):
        """A chain of five ranks, and two levels of two: only neighbours exchange messages."""
        self.assert_same([*JOB, "--adaptive", "--spp", "80"], 5, {"ECLAT_RANK_FANOUT": "1"})
        self.assert_same([*JOB, "--spp", "131"], 5, {"ECLAT_RANK_FANOUT": "2"})

    @full
    def test_a_series(self):
        """All ranks render each picture of several scenes, and of a turntable: the bits of one process."""
        scenes = [self.path(f"{name}.gltf") for name in "ab"]
        for k, scene in enumerate(scenes):
            write_gltf(scene, quad_scene(material={"emissiveFactor": [1, 0.5, k], "doubleSided": True})[0])
        small = ("--size", "12x10", "--spp", "16", "--json", "-q")
        for inputs, names in ((scenes, "{name}"), ([scenes[0], "--orbit", "3"], "%d")):
            found = {}
            for ranks in (1, 3):
                run = (mpirun(ranks, "render", *inputs, *small, "-o", self.path(f"{ranks}-{names}.exr")) if ranks > 1 else
                       eclat("render", *inputs, *small, "-o", self.path(f"{ranks}-{names}.exr")))
                reports = [json.loads(line) for line in self.assert_ok(run).stdout.splitlines()]
                found[ranks] = [report["image_sha256"] for report in reports[:-1]]
                self.assertEqual(reports[-1]["failed"], 0)
                self.assertEqual(len(found[ranks]), reports[-1]["rendered"])
            self.assertEqual(found[1], found[3])

    @full
    def test_ranks_of_several_devices(self):
        """Pieces of one batch reach the same rank one after the other."""
        job = [CORNELL, "--size", "64x64", "--spp", "512", "--wave", "4096"]
        self.assert_same(job, 2, {"POCL_DEVICES": "basic basic basic basic"}, ["--device", "all"])

    def test_one_process(self):
        self.assert_same([*JOB, "--spp", "16"], 1)

    @full
    def test_more_ranks_than_batches(self):
        self.assert_same([*JOB, "--spp", "3"], 5)

    @full
    def test_an_error(self):
        self.assert_same([*JOB, "--error", "30%", "--adaptive=off"], 3)
        self.assert_same([*JOB, "--error", "25%"], 3)

    def test_more_samples_where_they_tell(self):
        self.assert_same([*JOB, "--adaptive", "--spp", "80", "--denoise=atrous", "--channels", "all"], 3)

    @full
    def test_a_slice(self):
        self.assert_same([*JOB, "--spp", "101", "--samples", "64:101"], 3)
        self.assert_same([*JOB, "--spp", "96", "--samples", "10:80"], 3)

    @full
    def test_other_integrators(self):
        self.assert_same([*JOB, "--integrator", "whitted", "--spp", "18"], 2)
        self.assert_same([*JOB, "--integrator", "raster", "--spp", "18"], 2)

    @full
    def test_resume_with_other_ranks(self):
        """With adaptive sampling; test_rank_blocks tests without."""
        job = [*JOB, "--adaptive"]
        whole, planes = self.render(*job, "--spp", "90")
        kept = self.path("kept.exr")
        self.assert_ok(mpirun(3, "render", *job, "--spp", "50", "--checkpoint", kept, "-q", "-o", self.path("b.exr")))
        self.assert_ok(eclat("render", "--resume", kept, "--spp", "71", "-q", "-o", self.path("b.exr")))
        run = self.assert_ok(mpirun(2, "render", "--resume", kept, "--spp", "90", "--json", "-q", "-o", self.path("b.exr")))
        self.assertEqual(whole["image_sha256"], json.loads(run.stdout)["image_sha256"])
        self.assertEqual(planes, read_exr(self.path("b.exr"))[1])

    @full
    def test_a_limit_of_time(self):
        run = self.assert_ok(mpirun(3, "render", *JOB, "--time", "1.5s", "--json", "-q", "-o", self.path("a.exr"), env=NEVER_LOST))
        report = json.loads(run.stdout)
        self.assertEqual(report["stopped_by"], "time")
        whole, _ = self.render(*JOB, "--spp", str(report["samples_per_pixel"]))
        self.assertEqual(whole["image_sha256"], report["image_sha256"])

    @full
    def test_what_fails_early_is_said_once(self):
        large = ["render", CORNELL, "--size", "4096x4096", "--spp", "4", "--memory", "300M", "-o", self.path("a.exr")]
        for arguments, code, says in [(large, 1, "an MPI job needs the picture whole; start one process without mpirun, or"),
                                      (["render", self.path("none.gltf")], 1, "none.gltf"), (["render", CORNELL, "--spp", "x"], 2, "--spp"),
                                      (["render", CORNELL, "-o", self.path("no", "a.exr")], 1, "No such file")]:
            run = mpirun(2, *arguments)
            self.assertEqual(run.returncode, code, run.stderr)
            lines = own_lines(run)
            self.assertEqual(len(lines), 1, run.stderr)
            self.assertIn(says, lines[0])
            self.assertEqual(run.stdout, "")

    @full
    def test_another_launcher(self):
        """The MPI library of the launcher is another one: each of three processes would find itself alone, and render the whole picture."""
        for number, lines in [("0", 1), ("1", 0)]:
            run = eclat("render", *JOB, "--spp", "4", "-o", self.path("a.exr"), env=dict(MPI, PMI_SIZE="3", PMI_RANK=number))
            self.assertEqual(run.returncode, 1)
            self.assertEqual([line[:60] for line in own_lines(run)], ["eclat: error: 3 processes were started, but each finds 1: the la"[:60]] * lines)
        self.assertFalse(os.path.exists(self.path("a.exr")))

    def test_srun_without_mpi(self):
        """Only the first process warns. A slice gets no warning, since it may be one of many."""
        for number, more, says in [("0", [], 1), ("1", [], 0), ("0", ["--samples", "0:8"], 0)]:
            env = {"SLURM_STEP_NUM_TASKS": "2", "SLURM_PROCID": number}
            run = eclat("render", *JOB, "--spp", "16", *more, "-o", self.path("a.exr"), env=env)
            self.assertEqual(self.assert_ok(run).stderr.count("srun started 2 processes that do not know of one another"), says, run.stderr)

    def test_other_commands(self):
        run = self.assert_ok(mpirun(2, "info", CORNELL))
        self.assertEqual(run.stdout.splitlines()[:3], self.assert_ok(eclat("info", CORNELL)).stdout.splitlines()[:3])
        self.assertIn("rank 0 does this alone", run.stderr)

    def start(self, ranks, *arguments, launcher=(), env=None):
        return subprocess.Popen(["mpirun", "--oversubscribe", "--bind-to", "none", *launcher, "-n", str(ranks), ECLAT, "render", *arguments], env=dict(MPI, **(env or {})),
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8")

    def wait_for(self, path, process):
        self.assertTrue(poll_until(lambda: os.path.exists(path), process), "no checkpoint")

    def ranks_of(self, process):
        """Returns process numbers by rank."""
        found = {}
        for entry in os.listdir("/proc"):
            try:
                with open(f"/proc/{entry}/environ", "rb") as file:
                    variables = dict(line.split(b"=", 1) for line in file.read().split(b"\0") if b"=" in line)
                with open(f"/proc/{entry}/status", encoding="utf-8") as file:
                    parent = next(int(line.split()[1]) for line in file if line.startswith("PPid:"))
            except (OSError, ValueError):
                continue
            if parent == process.pid and b"OMPI_COMM_WORLD_RANK" in variables:
                found[int(variables[b"OMPI_COMM_WORLD_RANK"])] = int(entry)
        return found

    def outcome(self, process, ranks, lost):
        """Returns the process's output. Open MPI's launcher may wait for itself in PMIx_server_finalize after MPI_Abort: it is ended once
        its ranks have ended."""
        others = [number for rank, number in ranks.items() if rank != lost]
        poll_until(lambda: all(map(has_ended, others)), process)
        if os.path.exists(f"/proc/{ranks[lost]}"):  # it may only be stopped
            os.kill(ranks[lost], signal.SIGKILL)
        try:
            return process.communicate(timeout=LAUNCHER)
        except subprocess.TimeoutExpired:
            process.kill()
            return process.communicate(timeout=GUARD)

    @full
    def test_a_rank_that_is_killed(self):
        """The checkpoint survives and can be resumed; a line says how; the job fails."""
        job = [*JOB]
        for victim in [2, 0]:
            kept = self.path("kept.exr")
            process = self.start(3, *job, "--spp", "200000", "--checkpoint", kept, "--every", "0.1s", "-o", self.path("b.exr"))
            self.wait_for(kept, process)
            ranks = self.ranks_of(process)
            os.kill(ranks[victim], signal.SIGKILL)
            _, error = self.outcome(process, ranks, victim)
            self.assertNotEqual(process.returncode, 0, error)
            # a command ready to be typed: stated when the render begins, and again by rank 0 if it is left
            goes_on = f"{ECLAT} render --resume {kept}\n"
            self.assertEqual((error.count("from the last checkpoint with: " + goes_on), error.count("under mpirun, with: " + goes_on)),
                             (1, 1 if victim else 0), error)
            run = self.assert_ok(eclat("render", "--resume", kept, "--spp", "1", "--json", "-q", "-o", self.path("b.exr")))
            done = json.loads(run.stdout)["samples_per_pixel"]
            whole, _ = self.render(*job, "--spp", str(done + 10))
            run = self.assert_ok(mpirun(2, "render", "--resume", kept, "--spp", str(done + 10), "--json", "-q", "-o", self.path("b.exr")))
            self.assertEqual(whole["image_sha256"], json.loads(run.stdout)["image_sha256"])
            os.remove(kept)

    @full
    def test_ranks_that_are_lost(self):
        """The launcher keeps the other ranks alive. One lost rank is below another, and its loss is reported too; another hangs, and the
        launcher reports the abnormal end."""
        job = [*JOB, "--spp", "12000"]
        whole, planes = self.render(*job)
        for victim, number, env, launcher in [(5, signal.SIGKILL, {"ECLAT_RANK_FANOUT": "2"}, ["--enable-recovery"]), (2, signal.SIGSTOP, {}, [])]:
            kept = self.path("kept.exr")
            process = self.start(victim + 1, *job, "--checkpoint", kept, "--every", "0.1s", "--json", "-q", "-o", self.path("b.exr"), launcher=launcher,
                                 env=dict(env, ECLAT_RANK_LOST="10"))
            self.wait_for(kept, process)
            ranks = self.ranks_of(process)
            os.kill(ranks[victim], number)
            out, error = self.outcome(process, ranks, victim)
            told = "from rank 2: " if victim == 5 else ""
            self.assertRegex(error, f"warning: {told}rank {victim} on .* has failed, and the others take over its work: rank {victim} is lost")
            self.assertEqual(json.JSONDecoder().raw_decode(out)[0]["image_sha256"], whole["image_sha256"])
            self.assertEqual(planes, read_exr(self.path("b.exr"))[1])
            if number == signal.SIGKILL:
                self.assertEqual(process.returncode, 0, error)
            os.remove(kept)

    @full
    def test_a_rank_that_is_lost_before_the_scene_comes(self):
        """Rank 1 dies while it looks for devices: the others do not wait for it, and still get the scene."""
        if "ECLAT_FAULT_SHIM" not in os.environ:
            self.skipTest("no ECLAT_FAULT_SHIM")
        fault = f"LD_PRELOAD={os.environ['ECLAT_FAULT_SHIM']} FAULT_CALL=clGetDeviceInfo FAULT_SIGNAL=9"
        run = self.render_with(fault, [*JOB, "--spp", "131"], launcher=["--enable-recovery"])
        self.assertRegex(run.stderr, "warning: rank 1 is lost: it has ended or cannot be reached; the others go on without it")
        self.assertEqual(json.loads(run.stdout)["ranks"], 2)

    @full
    def test_devices_of_ranks_that_round_otherwise(self):
        """Rank 1 has another driver, and reports last how it rounds. No warning where it has rank 0's driver."""
        if "ECLAT_FAULT_SHIM" not in os.environ:
            self.skipTest("no ECLAT_FAULT_SHIM")
        counts, shim = self.path("counts"), f"LD_PRELOAD={os.environ['ECLAT_FAULT_SHIM']}"
        self.assert_ok(eclat("render", *JOB, "--spp", "4", "-q", "-o", self.path("a.exr"),
                             env=dict(word.split("=", 1) for word in [shim, "POCL_DEVICES=basic", "FAULT_COUNTS=" + counts])))
        with open(counts, encoding="utf-8") as file:
            last = dict(line.split() for line in file)["clGetDeviceInfo"]
        for fault, warns in [(f"{shim} FAULT_CALL=clGetDeviceInfo FAULT_AT={last}", 1), ("", 0)]:
            run = self.render_with(f"POCL_DEVICES=basic {fault}", [*JOB, "--spp", "40"], {"POCL_DEVICES": "pthread"})
            self.assertEqual(len(re.findall("warning: rank 1 has basic-.* and rank 0 has pthread-.*; if one of these does not round", run.stderr)), warns,
                             run.stderr)

    @full
    def test_a_device_of_a_rank_that_does_not_open(self):
        """A warning names the device, and the rank goes on with its other one."""
        if "ECLAT_FAULT_SHIM" not in os.environ:
            self.skipTest("no ECLAT_FAULT_SHIM")
        job = [CORNELL, "--size", "64x48", "--spp", "512"]
        fault = f"LD_PRELOAD={os.environ['ECLAT_FAULT_SHIM']} FAULT_CALL=clCreateCommandQueue POCL_DEVICES='basic basic basic basic basic basic'"
        run = self.render_with(fault, job, {"POCL_DEVICES": "basic basic basic basic basic basic"}, ["--device", "all"])
        self.assertRegex(run.stderr, "warning: from rank 1: basic-.* has failed, and the others take over its work: clCreateCommandQueue")
        self.assertEqual(json.loads(run.stdout)["ranks"], 3)

    def render_with(self, on_rank_1, job, env=None, more=(), launcher=()):
        """Renders with three ranks, one of which has other variables."""
        script = f'if [ "$OMPI_COMM_WORLD_RANK" = 1 ]; then export {on_rank_1}; fi; exec "$@"'
        run = subprocess.run(["mpirun", "--oversubscribe", "--bind-to", "none", *launcher, "-n", "3", "sh", "-c", script, "sh", ECLAT, "render", *job, *more,
                              "--json", "-o", self.path("b.exr")], env=dict(MPI, **(env or {})), stdin=subprocess.DEVNULL, capture_output=True, encoding="utf-8",
                             timeout=GUARD)
        self.assert_ok(run)
        whole, planes = self.render(*job)
        self.assertEqual(whole["image_sha256"], json.loads(run.stdout)["image_sha256"])
        self.assertEqual(planes, read_exr(self.path("b.exr"))[1])
        return run

    def test_a_rank_without_a_device(self):
        """The rank warns and the others do its work. In a chain it still passes messages to the last rank."""
        run = self.render_with("OCL_ICD_VENDORS=/nonexistent", [*JOB, "--spp", "40"], {"ECLAT_RANK_FANOUT": "1"})
        self.assertRegex(run.stderr, "warning: rank 1 on .*; the others go on without it")
        self.assertEqual(json.loads(run.stdout)["ranks"], 2)

    @full
    def test_a_rank_whose_device_fails(self):
        if "ECLAT_FAULT_SHIM" not in os.environ:
            self.skipTest("no ECLAT_FAULT_SHIM")
        fault = f"LD_PRELOAD={os.environ['ECLAT_FAULT_SHIM']} FAULT_CALL=clEnqueueNDRangeKernel FAULT_AT=60 FAULT_LOST=1"
        job = [CORNELL, "--size", "64x48", "--spp", "512"]
        self.assertRegex(self.render_with(fault, job).stderr, "warning: rank 1 on .* has failed.*CL_OUT_OF_RESOURCES")

    @full
    def test_cores(self):
        """eclat warns if a launcher binds it to a core, as Open MPI does."""
        for binding, says in [("core", 1), ("none", 0)]:
            run = subprocess.run(["mpirun", "--oversubscribe", "--bind-to", binding, "--mca", "hwloc_base_binding_policy",
                                  f"{binding}:overload-allowed", "-n", "2", ECLAT, "render", *JOB, "--spp", "4", "-o", self.path("b.exr")], env=MPI, stdin=subprocess.DEVNULL, capture_output=True,
                                 encoding="utf-8", timeout=GUARD)
            self.assertEqual(self.assert_ok(run).stderr.count("--bind-to none"), says, run.stderr)

    @full
    def test_hosts(self):
        """Only the first host has the scene, and the folder of the picture."""
        here = self.path("only-here")
        shutil.copytree(os.path.dirname(CORNELL), here)
        scene = os.path.join(here, os.path.basename(CORNELL))
        try:
            with Hosts(3, self.folder, here) as hosts:
                job = [scene, "--size", "20x18", "--spp", "41"]
                run = subprocess.run(hosts.mpirun(ECLAT, "render", *job, "--json", "-o", os.path.join(here, "b.exr")), env=MPI, stdin=subprocess.DEVNULL,
                                     capture_output=True, encoding="utf-8", timeout=GUARD)
        except OSError as error:
            self.skipTest(f"no network namespaces here: {error}")
        self.assert_ok(run)
        report, (whole, planes) = json.loads(run.stdout), self.render(*job)
        self.assertEqual({key: whole[key] for key in RESULT}, {key: report[key] for key in RESULT})
        self.assertEqual(planes, read_exr(os.path.join(here, "b.exr"))[1])

    def test_a_plan(self):
        run = self.assert_ok(eclat("render", *JOB, "--spp", "64", "--plan", "1000,100,2", "--json", "-q"))
        plan = json.loads(run.stdout)
        self.assertEqual([row["ranks"] for row in plan["plan"]], [1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1000])
        self.assertEqual((plan["batches"], plan["gbit_per_second"], plan["batch_bytes"]), (32, 100, 20 * 18 * 24))
        self.assertGreater(plan["scene_bytes"], 1000)
        for row in plan["plan"]:
            self.assertAlmostEqual(row["seconds"], row["load_seconds"] + row["send_seconds"] + row["render_seconds"] + row["wait_seconds"], delta=1e-9)
            self.assertAlmostEqual(row["efficiency"], plan["plan"][0]["seconds"] / row["seconds"] / row["ranks"], delta=1e-6)
        self.assertAlmostEqual(plan["plan"][0]["render_seconds"], 32 * plan["batch_seconds"], delta=1e-9)
        for row in plan["plan"]:
            self.assertGreaterEqual(row["render_seconds"] * row["ranks"], 32 * plan["batch_seconds"] * (1 - 1e-9))
        self.assertNotEqual(plan["plan"][-1]["held_back_by"], "")
        text = self.assert_ok(eclat("render", *JOB, "--spp", "64", "--plan", "6", "-q")).stdout
        self.assertEqual([line.split()[0] for line in text.splitlines()[-4:]], ["1", "2", "4", "6"])
        for bad in ["0", "x", "4,0", "4,10,-1", "4,10,5,6"]:
            self.assert_one_error(eclat("render", *JOB, "--plan", bad), 2)


if __name__ == "__main__":
    unittest.main()

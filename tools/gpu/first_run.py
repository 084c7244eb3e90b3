"""The steps of tools/gpu_first_run, and their report. If a step fails, the others run nevertheless."""
import json
import os
import statistics
import subprocess
import sys

SCENES = ["cornell-box", "showcase", "lamps", "glass", "car-paint"]
SECONDS = 3600  # of one command, in case a driver hangs


def say(text):
    print(f"tools/gpu_first_run: {text}", file=sys.stderr, flush=True)


def last_line(run):
    return ((run.stderr + run.stdout).strip().splitlines() or [f"exit code {run.returncode}"])[-1]


def longest(launches):
    seconds = launches["longest_seconds"]
    return f"{'unknown' if seconds is None else f'{1e3 * seconds:.3g} ms'} of {launches['pieces']}"


class Run:
    def __init__(self, options, root, build, work):
        self.options, self.root, self.build, self.work = options, root, build, work
        self.eclat = os.path.abspath(options.eclat) if options.eclat else os.path.join(build, "eclat")
        self.parts, self.failed = [], []
        self.under_way = "list of devices"
        self.card = dict(os.environ)
        if options.device:
            self.card["ECLAT_DEVICE"] = options.device
        # Variables that change the tested device must not change the other one.
        self.other = {key: value for key, value in self.card.items() if key not in ("ECLAT_DEVICE", "ECLAT_DEVICE_TYPE", "ECLAT_LAUNCH_SECONDS", "ECLAT_WORKAROUND")}

    def call(self, *arguments, env=None, program=None):
        command = [program or self.eclat, *arguments]
        try:
            return subprocess.run(command, env=env or self.card, capture_output=True, encoding="utf-8", errors="replace", stdin=subprocess.DEVNULL,
                                  timeout=SECONDS, check=False)
        except (OSError, subprocess.TimeoutExpired) as error:
            return subprocess.CompletedProcess(command, -1, "", str(error))

    def add(self, title, lines, passed=True):
        self.parts.append(f"## {title}\n\n" + "\n".join(lines) + "\n")
        if not passed:
            self.failed.append(title)

    def verbatim(self, title, run, keep=200):
        """Adds a command's output; a failure is noted separately."""
        lines = (run.stdout + run.stderr).rstrip().splitlines()
        note = [] if run.returncode == 0 else [f"Exit code {run.returncode}.", ""]
        self.add(title, note + ["    " + line for line in lines[-keep:]], run.returncode == 0)

    def devices(self):
        run = self.call("devices", "--json")
        try:
            report = json.loads(run.stdout)
            found = report["devices"]
            self.card_device = found[report["default"]]
        except (ValueError, TypeError):
            self.add("Devices", [last_line(run)], False)
            return False
        # The devices as they are, without the variables that change the tested one.
        true = json.loads(self.call("devices", "--json", env=self.other).stdout)["devices"]
        processors = [device["index"] for device in true if device["type"] == "CPU" and device["available"]]
        others = [index for index in processors if index != report["default"]] or processors
        self.other["ECLAT_DEVICE"] = self.options.against or (str(others[0]) if others else "")
        self.verbatim("Devices", self.call("devices"))
        return True

    def selftest(self):
        say("self-test")
        self.verbatim("Self-test", self.call("selftest", *([] if self.options.quick else ["--full"])))

    def kernel_tests(self):
        if self.options.quick or self.options.eclat:
            return self.add("Kernel tests", ["Left out."])
        say("kernel tests")
        environment = dict(self.card, ECLAT_DEVICE=str(self.card_device["index"]))
        return self.verbatim("Kernel tests", self.call("--test-dir", self.build, "-L", "^kernel$", "-LE", "^long$", "-E", "oclgrind", "--output-on-failure",
                                                       "--no-tests=error", program="ctest", env=environment))

    def render(self, scene, name, env):
        size, spp = ("64x64", "16") if self.options.quick else ("512x512", "64")
        path = os.path.join(self.work, f"{scene}-{name}.exr")
        run = self.call("render", os.path.join(self.root, "scenes", scene, scene + ".gltf"), "--size", size, "--spp", spp, "--compile", "first", "-q",
                        "--json", "-o", path, env=env)
        return path, (json.loads(run.stdout) if run.returncode == 0 else None), last_line(run)

    def compare(self, scene):
        """Returns a row of the table, and whether it passed."""
        say(f"{scene} on both devices")
        mine, report, why = self.render(scene, "card", self.card)
        theirs, right, why_not = self.render(scene, "processor", self.other)
        if not report or not right:
            return f"| {scene} | {why if not report else why_not} | | | | | |", False
        launches = report.get("launches")
        same = report["image_sha256"] == right["image_sha256"]
        test = self.call("compare", mine, theirs, "--json")
        told = json.loads(test.stdout) if test.stdout else {}
        verdict = "same bits" if same else "no more than noise" if test.returncode == 0 else "differs by more than noise"
        error = f"{100 * told['error']:.3g} %" if told.get("error") is not None else "-"
        return (f"| {scene} | {verdict} | {error} | {report['image_sha256'][:16]} | {report['rays_per_second'] / 1e6:.2f} | "
                f"{right['rays_per_second'] / 1e6:.2f} | "
                + (longest(launches) if launches else "-") + " |"), test.returncode == 0

    def pictures(self):
        rows = [self.compare(scene) for scene in SCENES]
        self.add("Pictures", ["| scene | against the processor's | difference | SHA-256 | Mrays/s | the processor's | longest launch |",
                              "|---|---|---|---|---|---|---|",
                              *(row for row, _ in rows)], all(passed for _, passed in rows))

    def traversal(self):
        say("traversal")
        scene = os.path.join(self.root, "scenes", "showcase", "showcase.gltf")
        self.verbatim("Rays through the showcase", self.call("info", scene, "--accel", *(["bvh2"] if self.options.quick else ["all"])), keep=8)

    def rate(self, scene, device):
        """Returns the samples per second of one render by the devices named, and the picture's SHA-256; or None and why."""
        size, spp = ("64x64", "16") if self.options.quick else ("1024x1024", "64")
        run = self.call("render", os.path.join(self.root, "scenes", scene, scene + ".gltf"), "--size", size, "--spp", spp, "--compile", "first", "-q",
                        "--json", "--device", device, "-o", os.path.join(self.work, "queues.exr"))
        if run.returncode:
            return None, last_line(run)
        report = json.loads(run.stdout)
        return report["samples"] / report["seconds"], report["image_sha256"]

    def queues(self):
        """Compares one command queue with two, in turns."""
        say("two command queues")
        one, rows, passed = str(self.card_device["index"]), [], True
        for scene in SCENES[:2]:
            runs = [[self.rate(scene, device) for device in (one, f"{one},{one}")] for _ in range(1 if self.options.quick else 5)]
            failed = [why for turn in runs for rate, why in turn if rate is None]
            same = len({sha for turn in runs for _, sha in turn}) == 1
            passed = passed and not failed and same
            ratio = "-" if failed else f"{statistics.median(two[0] / single[0] for single, two in runs):.3f}"
            rows.append(f"| {scene} | {failed[0] if failed else 'same bits' if same else 'other bits'} | {ratio} |")
        self.add("Two command queues", ["| scene | picture | samples per second, two queues over one |", "|---|---|---|", *rows], passed)

    def steps(self):
        """Runs a step at a time, so that the caller can write the report so far after each: a driver may crash the machine."""
        if self.devices():
            for name, step in (("self-test", self.selftest), ("kernel tests", self.kernel_tests), ("pictures", self.pictures), ("traversal", self.traversal),
                               ("two command queues", self.queues)):
                self.under_way = name
                yield
                step()
        self.under_way = None
        yield

    def report(self):
        version = self.call("--version").stdout.splitlines()
        return "\n".join([f"# First run of eclat on {getattr(self, 'card_device', {}).get('name', 'no device')}", "", self.verdict(), "",
                          *("    " + line for line in version), "", *self.parts])

    def verdict(self):
        if self.under_way:
            return f"This did not finish; last in progress: {self.under_way}."
        return "Everything passed." if not self.failed else "Failed: " + ", ".join(self.failed) + "."

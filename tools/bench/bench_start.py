#!/usr/bin/env python3
"""Measures the time to the first pixel: with empty caches, with and without the kernels that were compiled when eclat was built; after a render of
another scene; and with full caches. Also the time to a small error with empty caches, and memory with a million triangles. See README.md."""
import argparse
import glob
import os
import re
import shutil
import subprocess
import tempfile
import time

import bench_common as common

# Most seconds to the first pixel: at the very first use, by scene; after any earlier render; and with all kernels compiled.
FIRST = {"cornell-box": 1.8, "showcase": 3.0, "lamps": 4.0, "DamagedHelmet": 3.0}
AFTER, WARM = 1.0, 0.3
VIEW = {"first": 4.0, "after": 1.0}  # seconds to the preview's first picture
ERROR, SOONER = "5%", 0.5  # at most this share of the time that an earlier program, or this one with --compile first, takes to this error
MEMORY = 600.0         # MB


def first_pixel(report):
    """Returns seconds from the start of the process to the end of the first wave. The report does not include loading the program and its
    libraries: that is the process's wall time less the report's total."""
    outside = max(report["wall_seconds"] - report["total_seconds"], 0.0)
    return outside + report["load_seconds"] + report["first_pixel_seconds"]


def scenes():
    helmet = common.shared("assets", "gltf", "DamagedHelmet", "glTF-Binary", "DamagedHelmet.glb") or common.shared("assets", "gltf", "DamagedHelmet", "glTF", "DamagedHelmet.gltf")
    found = {name: os.path.join(common.ROOT, "scenes", name, name + ".gltf") for name in FIRST if name != "DamagedHelmet"}
    return dict(found, DamagedHelmet=helmet) if helmet else found


class Caches:
    """Folders for the kernels of the program and the driver. Emptying keeps the folders themselves, so that the program recognises them."""

    def __init__(self, folder):
        self.folder, self.kept = os.path.join(folder, "caches"), os.path.join(folder, "kept")
        self.environment = dict(os.environ, ECLAT_COMPILE="beside", XDG_CACHE_HOME=os.path.join(self.folder, "xdg"), POCL_CACHE_DIR=os.path.join(self.folder, "pocl"))
        for path in (self.environment["XDG_CACHE_HOME"], self.environment["POCL_CACHE_DIR"]):
            os.makedirs(path)

    def empty(self):
        for path in glob.glob(os.path.join(self.folder, "*", "*")):
            shutil.rmtree(path) if os.path.isdir(path) else os.remove(path)

    def keep(self):
        shutil.copytree(self.folder, self.kept)

    def restore(self):
        self.empty()
        shutil.copytree(self.kept, self.folder, dirs_exist_ok=True)

    def wait(self):
        """Waits until nothing is compiled into them any more."""
        mark = os.fsencode("XDG_CACHE_HOME=" + self.environment["XDG_CACHE_HOME"])
        while any(self.is_compiler(path, mark) for path in glob.glob("/proc/[0-9]*")):
            time.sleep(0.2)

    @staticmethod
    def is_compiler(path, mark):
        try:
            with open(os.path.join(path, "cmdline"), "rb") as command, open(os.path.join(path, "environ"), "rb") as environment:
                return b"eclat-compile" in command.read() and mark in environment.read()
        except OSError:
            return False


def start(eclat, scene, folder, caches, size="512x512", **more):
    """more: additional environment variables."""
    report = common.run_eclat(eclat, [scene, "--size", size, "--spp", "1", "-o", os.path.join(folder, "start.exr")], dict(caches.environment, **more))
    return first_pixel(report)


def measure_start(eclat, runs, folder):
    caches, found = Caches(folder), scenes()
    times = {name: {"nothing": [], "first": [], "after": [], "warm": []} for name in found}
    for name, scene in found.items():
        for kind, more in [("nothing", {"ECLAT_KERNELS": ""}), ("first", {})] * runs:
            caches.wait()
            caches.empty()
            times[name][kind].append(start(eclat, scene, folder, caches, **more))
        caches.wait()
        times[name]["warm"] = [start(eclat, scene, folder, caches) for _ in range(runs)]
    caches.empty()
    start(eclat, os.path.join(common.ROOT, "scenes", "ring", "ring.gltf"), folder, caches, "64x64")
    caches.wait()
    caches.keep()
    for name, scene in found.items():
        for _ in range(runs):
            caches.restore()
            times[name]["after"].append(start(eclat, scene, folder, caches))
            caches.wait()
    return times


def measure_error(eclat, before, runs, folder):
    """Returns seconds to a picture of a small error with empty caches. Two variants take turns: the default, and the earlier program, or, if there
    is none, the default program with fast kernels from the first wave on."""
    caches = Caches(os.path.join(folder, "error"))
    times = {name: {"now": [], "before": []} for name in ("showcase", "lamps")}
    for name, found in times.items():
        for which in list(found) * runs:
            caches.wait()
            caches.empty()
            program, more = (before or eclat, [] if before else ["--compile", "first"]) if which == "before" else (eclat, [])
            report = common.run_eclat(program, [scenes()[name], "--size", "64x64", "--error", ERROR, *more, "-o", os.path.join(folder, "error.exr")], caches.environment)
            found[which].append(report["wall_seconds"] - report["write_seconds"])
    return times


def first_light(eclat, scene, folder, caches, screen):
    """Returns seconds from the start of the process to the preview's first picture, which the rasteriser makes."""
    script = os.path.join(folder, "settle.txt")
    with open(script, "w", encoding="utf-8") as file:
        file.write("settle\nquit\n")
    environment = dict(caches.environment, DISPLAY=screen, LIBGL_ALWAYS_SOFTWARE="1")
    done = subprocess.run([eclat, "view", scene, "--spp", "1", "--script", script, "--stats", "-q"], env=environment, capture_output=True, text=True, check=True)
    return float(re.search(r"first light +([0-9.]+) s", done.stdout)[1])


def measure_view(eclat, runs, folder):
    """Returns None if there is no screen."""
    if not shutil.which("Xvfb"):
        return None
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-screen", "0", "1280x1024x24", "-displayfd", str(write), "-nolisten", "tcp", "-noreset"], pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as pipe:
        screen = ":" + pipe.readline().strip()
    caches, found = Caches(os.path.join(folder, "view")), scenes()
    times = {name: {"first": [], "after": []} for name in found}
    try:
        for kind in ("first", "after"):
            for name, scene in found.items():
                for _ in range(runs):
                    caches.wait()
                    caches.restore() if kind == "after" else caches.empty()
                    times[name][kind].append(first_light(eclat, scene, folder, caches, screen))
            if kind == "first":
                caches.wait()
                caches.empty()
                first_light(eclat, os.path.join(common.ROOT, "scenes", "ring", "ring.gltf"), folder, caches, screen)
                caches.wait()
                caches.keep()
    finally:
        server.terminate()
        server.wait()
    return times


def measure_memory(eclat, folder):
    scene = common.shared("assets", "gltf", "MetalRoughSpheresNoTextures", "glTF-Binary", "MetalRoughSpheresNoTextures.glb")
    scene = scene or common.shared("assets", "gltf", "MetalRoughSpheresNoTextures", "glTF", "MetalRoughSpheresNoTextures.gltf")
    if not scene:
        return None
    report = common.run_eclat(eclat, [scene, "--spp", "16", "-o", os.path.join(folder, "memory.exr")])
    return report["peak_memory_bytes"] / 1e6


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--runs", type=int, default=5, help="starts of each kind and scene")
    parser.add_argument("--eclat", help="program to measure (else $ECLAT, build-bench/eclat, build/eclat)")
    parser.add_argument("--before", metavar="ECLAT", help="an earlier program to compare the time to a small error with (else this one with --compile first)")
    parser.add_argument("--json", metavar="FILE", help="write everything measured to FILE")
    options = parser.parse_args()
    eclat = common.eclat_path(options.eclat)
    with tempfile.TemporaryDirectory() as folder:
        starts = measure_start(eclat, options.runs, folder)
        errors = measure_error(eclat, options.before, options.runs, folder)
        views = measure_view(eclat, options.runs, folder)
        memory = measure_memory(eclat, folder)
    rows = []
    for scene, times in starts.items():
        for name, what, target in (("nothing", "first use, no kernels from building", FIRST[scene]), ("first", "first use", FIRST[scene]),
                                   ("after", "after another scene", AFTER), ("warm", "warm", WARM)):
            value = common.median(times[name])
            rows.append(common.row(f"first pixel, {what}, {scene}", f"{value:.2f} s", f"<= {target:.1f} s", value <= target, f"+- {common.spread(times[name]):.0%}"))
    for scene, times in errors.items():
        now, before = common.median(times["now"]), common.median(times["before"])
        rows.append(common.row(f"time to {ERROR} from empty caches, {scene}", f"{now:.1f} s, {now / before:.2f} of {before:.1f} s", f"<= {SOONER}", now <= SOONER * before,
                               f"+- {common.spread(times['now']):.0%}"))
    for scene, times in (views or {}).items():
        for kind, what in (("first", "first use"), ("after", "after another scene")):
            value = common.median(times[kind])
            rows.append(common.row(f"preview's first picture, {what}, {scene}", f"{value:.2f} s", f"<= {VIEW[kind]:.1f} s", value <= VIEW[kind], f"+- {common.spread(times[kind]):.0%}"))
    if views is None:
        rows.append(common.row("preview's first picture", "skipped", "", None, "Xvfb is not installed"))
    if memory is None:
        rows.append(common.row("peak memory, MetalRoughSpheresNoTextures", "skipped", f"<= {MEMORY:.0f} MB", None, "../shared/assets is not here"))
    else:
        rows.append(common.row("peak memory, MetalRoughSpheresNoTextures", f"{memory:.0f} MB", f"<= {MEMORY:.0f} MB", memory <= MEMORY))
    common.print_rows(rows)
    if options.json:
        common.write_json(options.json, {"starts": starts, "errors": errors, "views": views, "peak_memory_mb": memory, "rows": rows})


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Measures the host's share of a render: the processor time of the program's main thread over that of all threads. The main thread launches kernels,
waits, and adds batches to the film; the other threads belong to the CPU's OpenCL driver. Linux only."""
import argparse
import glob
import json
import os
import subprocess
import tempfile
import time

import bench_common as common

MOST = 2.0  # per cent
SPP = 4096
FIRST_SECONDS = 0.5  # processor time of all threads that is taken for preparation and left out
LEAST_SECONDS = 2.0


def look(pid, seconds):
    """Updates the processor time of each thread; threads that have ended keep theirs. Returns that of the main thread and of all threads."""
    for path in glob.glob(f"/proc/{pid}/task/*/schedstat"):
        try:
            with open(path, encoding="utf-8") as file:
                nanoseconds = int(file.read().split()[0])
        except (OSError, IndexError):
            continue  # it has ended in the meantime
        thread = int(path.split("/")[4])
        seconds[thread] = max(seconds.get(thread, 0.0), 1e-9 * nanoseconds)
    return seconds.get(pid, 0.0), sum(seconds.values())


def render(eclat, scene, wave, size, spp, environment):
    """Returns the report, and the seconds of the main thread and of all threads: after preparation, and shortly before the end."""
    with tempfile.TemporaryDirectory() as folder:
        command = [eclat, "render", scene, "--size", size, "--spp", str(spp), "--wave", str(wave), "-q", "--json", "-o", os.path.join(folder, "a.exr")]
        seconds, first, last = {}, None, None
        with subprocess.Popen(command, stdout=subprocess.PIPE, env=dict(os.environ, **environment), encoding="utf-8") as run:
            while run.poll() is None:
                time.sleep(0.05)
                last = look(run.pid, seconds)
                first = first or (last if last[1] > FIRST_SECONDS else None)
            return json.loads(run.stdout.read()), first, last


def measure(eclat, scene, wave, size, spp, environment):
    """Returns the seconds of the main thread and of all threads, and the number of waves."""
    report, first, last = render(eclat, scene, wave, size, spp, environment)
    if not first or last[1] - first[1] < LEAST_SECONDS:
        common.fail("the render ended before there was anything to measure; give more --spp")
    whole = last[1] - first[1]
    return last[0] - first[0], whole, report["samples"] / report["wave"] * whole / last[1]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--eclat", help="program to measure (else $ECLAT, build-bench/eclat, build/eclat)")
    parser.add_argument("--wave", type=int, default=65536, help="paths in flight (default: 65536)")
    parser.add_argument("--size", default="64x64", help="of the picture (default: 64x64)")
    parser.add_argument("--spp", type=int, default=SPP, help=f"samples a pixel (default: {SPP})")
    parser.add_argument("--json", metavar="FILE", help="write everything measured to FILE")
    options = parser.parse_args()
    eclat = common.eclat_path(options.eclat)
    rows = []
    for name, environment in (("as it is", {}), ("as if a card", {"ECLAT_DEVICE_TYPE": "gpu"})):
        job = eclat, common.cornell_box(), options.wave, options.size
        render(*job, 16, environment)  # compiles
        own, whole, waves = measure(*job, options.spp, environment)
        share = 100 * own / whole
        rows.append(common.row(f"host's share of a wave of {options.wave} paths, processor {name}", f"{share:.2f} % ({1e6 * own / waves:.0f} us a wave)",
                               f"<= {MOST:g} %", share <= MOST))
    common.print_rows(rows)
    if options.json:
        common.write_json(options.json, {"rows": rows})


if __name__ == "__main__":
    main()

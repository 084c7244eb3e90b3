#!/usr/bin/env python3
"""Checks by the clock that time limits are kept: `eclat render --time`, Ctrl-C and `eclat cost --budget`. Run it once the kernels are compiled."""
import argparse
import json
import os
import signal
import subprocess
import tempfile
import time

import bench_common as common

TIME, BUDGET = 5.0, 30.0  # seconds
OVER = 1.1                # times the limit, at most


def render_seconds(eclat, folder, size="64x64"):
    report = common.run_eclat(eclat, [common.cornell_box(), "--size", size, "--time", str(TIME), "-o", os.path.join(folder, "a.png")])
    if report["stopped_by"] != "time":
        common.fail(f"the render was stopped by {report['stopped_by']}, not by time")
    return report["seconds"]


def large_seconds(eclat, folder):
    return render_seconds(eclat, folder, "4096x4096")


def larger_seconds(eclat, folder):
    return render_seconds(eclat, folder, "8192x4096")


def interrupted_seconds(eclat, folder):
    command = [eclat, "render", common.cornell_box(), "--size", "8192x4096", "-o", os.path.join(folder, "a.png"), "--json", "--quiet"]
    listen = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)  # a process started in the background would ignore it
    render = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, preexec_fn=listen)
    time.sleep(TIME)
    render.send_signal(signal.SIGINT)
    report = json.loads(render.communicate()[0])
    if report["stopped_by"] != "user":
        common.fail(f"the render was stopped by {report['stopped_by']}, not by Ctrl-C")
    return report["seconds"]


def study_seconds(eclat, folder):
    path = os.path.join(folder, "study.json")
    subprocess.run([eclat, "cost", common.cornell_box(), "--size", "32x32", "--budget", str(BUDGET), "--json", path], check=True, capture_output=True)
    with open(path, encoding="utf-8") as file:
        return json.load(file)["total_seconds"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--eclat", help="program to measure (else $ECLAT, build-bench/eclat, build/eclat)")
    parser.add_argument("--json", metavar="FILE", help="write everything measured to FILE")
    options = parser.parse_args()
    eclat = common.eclat_path(options.eclat)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, measure, limit in (("render --time", render_seconds, TIME), ("render --size 4096x4096 --time", large_seconds, TIME),
                                     ("render --size 8192x4096 --time", larger_seconds, TIME),
                                     ("render --size 8192x4096, Ctrl-C after", interrupted_seconds, TIME), ("cost --budget", study_seconds, BUDGET)):
            if measure in (render_seconds, study_seconds):
                measure(eclat, folder)  # compiles
            took = measure(eclat, folder)
            rows.append(common.row(f"{name} {limit:g}, Cornell box", f"{took:.2f} s", f"<= {OVER * limit:.1f} s", took <= OVER * limit))
    common.print_rows(rows)
    if options.json:
        common.write_json(options.json, {"rows": rows})


if __name__ == "__main__":
    main()

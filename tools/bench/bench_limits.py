#!/usr/bin/env python3
"""Limits of time are kept: `eclat render --time` and `eclat cost --budget`, by the clock. Run it with kernels that are compiled."""
import argparse
import json
import os
import subprocess
import tempfile

import bench_common as common

TIME, BUDGET = 5.0, 30.0  # seconds
OVER = 1.1                # and no further


def render_seconds(eclat, folder):
    report = common.run_eclat(eclat, [common.cornell_box(), "--size", "64x64", "--time", str(TIME), "-o", os.path.join(folder, "a.exr")])
    if report["stopped_by"] != "time":
        common.fail(f"the render was stopped by {report['stopped_by']}, not by time")
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
        for name, measure, limit in (("render --time", render_seconds, TIME), ("cost --budget", study_seconds, BUDGET)):
            measure(eclat, folder)  # compiles
            took = measure(eclat, folder)
            rows.append(common.row(f"{name} {limit:g}, Cornell box", f"{took:.2f} s", f"<= {OVER * limit:.1f} s", took <= OVER * limit))
    common.print_rows(rows)
    if options.json:
        common.write_json(options.json, {"rows": rows})


if __name__ == "__main__":
    main()

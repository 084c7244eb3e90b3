#!/usr/bin/env python3
"""Measures writing a picture: seconds per million pixels and bytes per pixel of EXR and PNG, at 2048 x 2048 and 4096 x 4096. With --before two
programs take turns. See README.md."""
import argparse
import os
import resource
import tempfile

import bench_common as common

SECONDS, BYTES = 0.25, 20.0  # per million pixels, per pixel


def write(eclat, folder, side, kind):
    """The picture is as noisy as a short render: eight replicates of one sample, with direct light only, since that renders quickly."""
    path = os.path.join(folder, "picture." + kind)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    report = common.run_eclat(eclat, [common.cornell_box(), "--size", f"{side}x{side}", "--spp", "8", "--max-depth", "2", "-o", path])
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime - report["cpu_seconds"]
    pixels = side * side
    return {"seconds": report["write_seconds"] * 1e6 / pixels, "cpu": cpu * 1e6 / pixels, "bytes": os.path.getsize(path) / pixels,
            "memory": report["peak_memory_bytes"] / pixels, "sha256": report["image_sha256"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--runs", type=int, default=3, help="pictures of each kind and size")
    parser.add_argument("--sizes", type=int, nargs="+", default=[2048, 4096], help="pixels a side")
    parser.add_argument("--eclat", help="program to measure (else $ECLAT, build-bench/eclat, build/eclat)")
    parser.add_argument("--before", metavar="ECLAT", help="another program to compare with")
    parser.add_argument("--json", metavar="FILE", help="write everything measured to FILE")
    options = parser.parse_args()
    programs = {"": common.eclat_path(options.eclat)}
    if options.before:
        programs["before, "] = common.eclat_path(options.before)
    rows, measured = [], []
    with tempfile.TemporaryDirectory() as folder:
        for program in programs.values():
            write(program, folder, 64, "exr")  # compiles
        for side in options.sizes:
            for kind in ("exr", "png"):
                runs = [(name, write(program, folder, side, kind)) for _ in range(options.runs) for name, program in programs.items()]
                if len({run["sha256"] for _, run in runs}) > 1:
                    common.fail("the programs do not render the same picture")
                for name in programs:
                    mine = [run for other, run in runs if other == name]
                    measured.append({"program": name, "side": side, "kind": kind, "runs": mine})
                    middle = {key: common.median([run[key] for run in mine]) for key in ("seconds", "cpu", "bytes", "memory")}
                    what = f"{name}{kind.upper()} {side} x {side}"
                    rows.append(common.row(f"{what}, a million pixels", f"{middle['seconds']:.2f} s", f"<= {SECONDS:g} s", middle["seconds"] <= SECONDS if not name else None,
                                           f"{middle['cpu']:.2f} s of all cores beside rendering"))
                    rows.append(common.row(f"{what}, a pixel", f"{middle['bytes']:.1f} bytes", f"<= {BYTES:g}", middle["bytes"] <= BYTES if not name else None,
                                           f"{middle['memory']:.0f} bytes of memory at the most"))
    common.print_rows(rows)
    if options.json:
        common.write_json(options.json, {"measured": measured, "rows": rows})


if __name__ == "__main__":
    main()

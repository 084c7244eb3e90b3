#!/usr/bin/env python3
"""Time to the first pixel of the Cornell box, cold and warm, and memory on a million triangles. See README.md."""
import argparse
import os
import shutil
import tempfile

import bench_common as common

COLD, WARM = 3.0, 0.5  # seconds
MEMORY = 600.0         # MB


def first_pixel(report):
    """Seconds from the start of the process: everything before the render, then its first finished wave. What the report
    does not see (loading the program and its libraries) is the process's wall time less the report's own total."""
    outside = max(report["wall_seconds"] - report["total_seconds"], 0.0)
    before = report["total_seconds"] - report["write_seconds"] - report["seconds"]
    setup = report["accel_seconds"] + report["pack_seconds"] + report["kernel_seconds"]
    return outside + max(before - setup, 0.0) + report["first_pixel_seconds"]


def start(eclat, scene, folder, caches):
    environment = dict(os.environ, XDG_CACHE_HOME=os.path.join(caches, "xdg"), POCL_CACHE_DIR=os.path.join(caches, "pocl"))
    os.makedirs(environment["XDG_CACHE_HOME"], exist_ok=True)
    os.makedirs(environment["POCL_CACHE_DIR"], exist_ok=True)
    return common.run_eclat(eclat, [scene, "--size", "512x512", "--spp", "1", "-o", os.path.join(folder, "start.exr")], environment)


def measure_start(eclat, runs, folder):
    scene = common.cornell_box()
    cold, warm, walls = [], [], {"cold": [], "warm": []}
    caches = os.path.join(folder, "caches")
    for _ in range(runs):
        shutil.rmtree(caches, ignore_errors=True)
        report = start(eclat, scene, folder, caches)
        cold.append(first_pixel(report))
        walls["cold"].append(report["wall_seconds"])
        report = start(eclat, scene, folder, caches)
        warm.append(first_pixel(report))
        walls["warm"].append(report["wall_seconds"])
    return {"cold": cold, "warm": warm, "wall": walls}


def measure_memory(eclat, folder):
    scene = common.shared("assets", "gltf", "MetalRoughSpheresNoTextures", "glTF-Binary", "MetalRoughSpheresNoTextures.glb")
    scene = scene or common.shared("assets", "gltf", "MetalRoughSpheresNoTextures", "glTF", "MetalRoughSpheresNoTextures.gltf")
    if not scene:
        return None
    report = common.run_eclat(eclat, [scene, "--spp", "16", "-o", os.path.join(folder, "memory.exr")])
    return report["peak_memory_bytes"] / 1e6


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--runs", type=int, default=5, help="cold and warm starts each")
    parser.add_argument("--eclat", help="program to measure (else $ECLAT, build-bench/eclat, build/eclat)")
    parser.add_argument("--json", metavar="FILE", help="write everything measured to FILE")
    options = parser.parse_args()
    eclat = common.eclat_path(options.eclat)
    with tempfile.TemporaryDirectory() as folder:
        starts = measure_start(eclat, options.runs, folder)
        memory = measure_memory(eclat, folder)
    rows = []
    for name, target in (("cold", COLD), ("warm", WARM)):
        value = common.median(starts[name])
        rows.append(common.row(f"first pixel, {name} start, Cornell box", f"{value:.2f} s", f"<= {target:.1f} s", value <= target,
                               f"+- {common.spread(starts[name]):.0%}; whole process {common.median(starts['wall'][name]):.2f} s"))
    if memory is None:
        rows.append(common.row("peak memory, MetalRoughSpheresNoTextures", "skipped", f"<= {MEMORY:.0f} MB", None, "../shared/assets is not here"))
    else:
        rows.append(common.row("peak memory, MetalRoughSpheresNoTextures", f"{memory:.0f} MB", f"<= {MEMORY:.0f} MB", memory <= MEMORY))
    common.print_rows(rows)
    if options.json:
        common.write_json(options.json, {"starts": starts, "peak_memory_mb": memory, "rows": rows})


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""How good are forecasts? Renders scenes to error targets and compares what the pilot predicted with what was needed.

usage: bench_forecast.py [--eclat build/eclat] [--runs N] [--size WxH] [SCENE TARGET ...]

SCENE TARGET: a file and a percentage, any number of pairs; without any, 24 pairs of the scenes in scenes/. Prints a line for each pair, then the
score: the share of times and of sample counts inside the 95 % interval, and the median relative error. Let nothing else run on the machine.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
SCENES = {
    "cornell-box/cornell-box.gltf": (8, 5, 3.5, 2.5),
    "veach-plates/veach-plates.gltf": (60, 45, 35, 30),
    "ladder/ladder.gltf": (14, 10, 8, 6),
    "lamps/lamps.gltf": (60, 45, 35, 28),
    "showcase/showcase.gltf": (20, 14, 10, 8),
    "furnace/box-materials.gltf": (2, 1.4, 1, 0.7),
}


def render(eclat, scene, target, size, seed):
    run = subprocess.run([eclat, "render", scene, "--error", str(target), "--size", size, "--seed", str(seed), "--json", "-q",
                          "-o", "/dev/shm/bench_forecast.png"], capture_output=True, text=True)
    if run.returncode:
        sys.exit(run.stderr)
    return json.loads(run.stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--eclat", default=os.path.join(ROOT, "build", "eclat"))
    parser.add_argument("--runs", type=int, default=1, help="seeds a pair (default: 1)")
    parser.add_argument("--size", default="192x192")
    parser.add_argument("pairs", nargs="*", metavar="SCENE TARGET")
    args = parser.parse_args()
    pairs = list(zip(args.pairs[::2], map(float, args.pairs[1::2])))
    pairs = pairs or [(os.path.join(ROOT, "scenes", s), t) for s, targets in SCENES.items() for t in targets]
    inside_time = inside_samples = told = 0
    errors = []
    print(f"{'scene':24} {'target':>7} {'said':>8} {'95 %':>17} {'took':>8} {'off':>7} {'said':>7} {'took':>7} samples")
    for scene, target in pairs:
        for seed in range(args.runs):
            r = render(args.eclat, scene, target, args.size, seed)
            f = r["forecast"]
            if not f:
                print(f"{os.path.basename(scene):24} {target:6g} %  done before a forecast")
                continue
            told += 1
            off = f["seconds"] / r["seconds"] - 1
            errors.append(abs(off))
            inside_time += f["seconds_low"] <= r["seconds"] <= f["seconds_high"]
            inside_samples += f["samples_per_pixel_low"] <= r["samples_per_pixel"] <= f["samples_per_pixel_high"]
            print(f"{os.path.basename(scene):24} {target:6g} % {f['seconds']:7.2f}s {f['seconds_low']:7.2f}-{f['seconds_high']:7.2f}s "
                  f"{r['seconds']:7.2f}s {100 * off:+6.1f}% {f['samples_per_pixel']:7.0f} {r['samples_per_pixel']:7d}", flush=True)
    if told:
        print(f"{told} forecasts: time inside the interval {100 * inside_time / told:.0f} %, samples {100 * inside_samples / told:.0f} %, "
              f"median error of the time {100 * statistics.median(errors):.1f} %")


if __name__ == "__main__":
    main()

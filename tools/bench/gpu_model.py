#!/usr/bin/env python3
"""usage: tools/bench/gpu_model.py [SCENE…] [--eclat FILE] [--json FILE]

Models how fast graphics cards could be at most, since none was at hand. Oclgrind renders a small picture and counts what kernels of one lane
load, store and compute. A roofline (Williams, Waterman, Patterson 2009) then says what the bandwidth and the arithmetic of a card allow.

  SCENE       names of scenes/ (default: cornell-box showcase)
  --eclat     the program (default: build/eclat)
  --json FILE also write the figures there

Oclgrind runs unoptimised code: what the code loads twice is counted twice. Only those operations are counted that an optimised kernel has too:
arithmetic, comparisons, conversions, selections, built-in functions (a division or root counts as eight). There are two bounds for bytes: all come
from memory, or nodes and triangles come from caches and only queues from memory. A real card is slower than the model: its threads diverge, wait,
and share resources."""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# GB/s; 10^12 operations a second: half of the vendor's FP32 figure, since that counts an fma as two.
CARDS = {"H200": (4800, 33.5), "RTX 4070": (504, 14.6), "Iris Xe, 96 units": (68, 1.04)}
PLAIN = {"fadd", "fsub", "fmul", "fneg", "fcmp", "icmp", "add", "sub", "mul", "and", "or", "xor", "shl", "lshr", "ashr", "select", "zext", "sext", "trunc",
         "sitofp", "uitofp", "fptosi", "fptoui"}
SLOW = {"fdiv": 8, "udiv": 8, "urem": 8, "call _Z4sqrtf()": 8}
BLOCK = re.compile(r"Instructions executed for kernel '(\w+)':\n((?: +[\d,]+ - .*\n?)*)")
LINE = re.compile(r" +([\d,]+) - (.+?)(?: \(([\d,]+) bytes\))?$", re.M)
IN_TREE = ("ec_intersect", "ec_connect")


def number(text):
    return int(text.replace(",", ""))


def count(text):
    """Returns {kernel: [bytes of global and constant memory, operations]} from Oclgrind's histograms, summed over launches."""
    found = {}
    for name, block in BLOCK.findall(text):
        sums = found.setdefault(name, [0, 0])
        for times, what, size in LINE.findall(block):
            if re.fullmatch("(load|store) (global|constant)", what):
                sums[0] += number(size)
            elif what in PLAIN or what.startswith("call _Z") or what in SLOW:
                sums[1] += number(times) * SLOW.get(what, 1)
    return found


def bounds(bytes_, operations, card):
    """Returns the units per second that bandwidth and arithmetic allow."""
    bandwidth, rate = CARDS[card]
    return bandwidth * 1e9 / bytes_, rate * 1e12 / operations


def measure(eclat, scene, folder):
    path = os.path.join(ROOT, "scenes", scene, scene + ".gltf")
    run = subprocess.run(["oclgrind", "--build-options", "-cl-opt-disable -Dalways_inline=unused", "--inst-counts", eclat, "render", path, "--lanes", "1",
                          "--accel", "bvh2", "--size", "8x8", "--spp", "2", "--compile", "first", "-q", "--json", "-o", os.path.join(folder, "a.exr")],
                         capture_output=True, encoding="utf-8", errors="replace", stdin=subprocess.DEVNULL, check=False)
    report = re.search(r'^\{"version".*$', run.stdout, re.M)
    if run.returncode or not report:
        sys.exit(f"gpu_model.py: {scene}: " + ((run.stderr.strip().splitlines() or ["no report"])[-1]))
    return json.loads(report[0])["rays"], json.loads(report[0])["samples"], count(run.stdout + run.stderr)


def figures(eclat, scene, folder):
    rays, samples, counts = measure(eclat, scene, folder)
    in_tree = [sum(counts[name][k] for name in counts if name.startswith(IN_TREE)) for k in (0, 1)]
    total = [sum(sums[k] for sums in counts.values()) for k in (0, 1)]
    queues = 4 * (7 + 3) * rays  # what traversal loads for a ray and stores for its hit
    result = {"scene": scene, "rays_per_sample": rays / samples, "bytes_per_ray": total[0] / rays,
              "bytes_per_ray_cached": (total[0] - in_tree[0] + queues) / rays, "operations_per_ray": total[1] / rays,
              "traversal_operations_per_ray": in_tree[1] / rays, "cards": {}}
    for card in CARDS:
        memory, arithmetic = bounds(result["bytes_per_ray"], result["operations_per_ray"], card)
        cached, _ = bounds(result["bytes_per_ray_cached"], result["operations_per_ray"], card)
        result["cards"][card] = {"all_from_memory": min(memory, arithmetic), "tree_from_caches": min(cached, arithmetic), "arithmetic": arithmetic}
    return result


def main():
    parser = argparse.ArgumentParser(usage=__doc__, add_help=True)
    parser.add_argument("scenes", nargs="*", default=["cornell-box", "showcase"])
    parser.add_argument("--eclat", default=os.path.join(ROOT, "build", "eclat"))
    parser.add_argument("--json")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="eclat-model-") as folder:
        rows = [figures(os.path.abspath(options.eclat), scene, folder) for scene in options.scenes]
    print("| scene | rays a sample | bytes a ray | of which not the tree's | operations a ray | "
          + " | ".join(f"{card}: 10⁶ rays/s" for card in CARDS) + " |")
    print("|---" * (5 + len(CARDS)) + "|")
    for row in rows:
        cards = " | ".join(f"{row['cards'][card]['all_from_memory'] / 1e6:.0f} to {row['cards'][card]['tree_from_caches'] / 1e6:.0f}" for card in CARDS)
        print(f"| {row['scene']} | {row['rays_per_sample']:.1f} | {row['bytes_per_ray']:.0f} | {row['bytes_per_ray_cached']:.0f} | "
              f"{row['operations_per_ray']:.0f} | {cards} |")
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(rows, file, indent=1)


if __name__ == "__main__":
    main()

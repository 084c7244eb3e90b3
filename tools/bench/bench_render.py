#!/usr/bin/env python3
"""Samples a second of eclat beside Mitsuba 3 (llvm_ad_rgb), turn by turn on the same scene. See README.md."""
import argparse
import json
import os
import subprocess
import sys
import tempfile

import bench_common as common
import bench_mitsuba

TARGETS = {"cornell": 1.3, "sponza": 1.0}


def scene_of(name, size):
    """What both renderers need to know of a scene, or why there is none."""
    if name == "cornell":
        return {"scene": common.cornell_box(), "width": size, "height": size, "environment": None}
    scene = common.shared("assets", "classic", "gltf", "sponza-dabrovic", "sponza-dabrovic.gltf")
    environment = common.shared("assets", "env", "pmndrs-assets", "studio.hdr")
    if not scene or not environment:
        return "../shared/assets is not here"
    return {"scene": scene, "width": size, "height": size, "environment": environment}


# Run by Mitsuba's Python, which reads EXR files: means of both images, and how far blocks of 32 pixels lie apart.
COMPARE = """
import json, sys
import numpy, mitsuba as mi
mi.set_variant("scalar_rgb")
bitmap = mi.Bitmap(sys.argv[1])
names = [field.name for field in bitmap.struct_()]
ours = numpy.array(bitmap)[..., [names.index(c) for c in "RGB"]].astype(numpy.float64)
theirs = numpy.load(sys.argv[2]).astype(numpy.float64)
def blocks(image):
    h, w = image.shape[0] // 32, image.shape[1] // 32
    return image[:32 * h, :32 * w].reshape(h, 32, w, 32, 3).mean(axis=(1, 3, 4))
a, b = blocks(ours), blocks(theirs)
lit = b > 0.05 * b.mean()
json.dump({"ours": ours.mean(axis=(0, 1)).tolist(), "theirs": theirs.mean(axis=(0, 1)).tolist(),
           "blocks": float(numpy.median(abs(a / b - 1)[lit])), "worst_block": float(abs(a / b - 1)[lit].max())}, sys.stdout)
"""


def compare_images(python, exr, npy):
    done = subprocess.run([python, "-c", COMPARE, exr, npy], capture_output=True, text=True)
    return json.loads(done.stdout) if done.returncode == 0 else {"error": done.stderr.strip()[-300:]}


def measure(name, options, eclat, python, llvm):
    scene = scene_of(name, options.size)
    if isinstance(scene, str):
        print(f"{name}: skipped, {scene}")
        return None
    with tempfile.TemporaryDirectory() as folder:
        exr, npy = os.path.join(folder, "eclat.exr"), os.path.join(folder, "mitsuba.npy")
        arguments = [scene["scene"], "--size", f"{scene['width']}x{scene['height']}", "--max-depth", "8", "--sampler", "independent",
                     "--spp", str(options.spp), "-o", exr]
        if scene["environment"]:
            arguments += ["--env", scene["environment"]]
        mitsuba = bench_mitsuba.Mitsuba(python, llvm, name, scene)
        samples = scene["width"] * scene["height"] * options.spp
        ours, theirs = [], []
        mitsuba.render(seed=options.runs + 1, spp=options.spp)  # Dr.Jit compiles, and may once more for another seed
        for run in range(-1, options.runs):  # the first is for warming up
            m = mitsuba.render(seed=run + 1, spp=options.spp, image=npy)
            e = common.run_eclat(eclat, arguments + ["--seed", str(run + 1)])
            if run < 0:
                continue
            theirs.append(samples / m["seconds"])
            ours.append(e["samples"] / e["seconds"])
            print(f"{name} {run + 1}/{options.runs}: eclat {ours[-1] / 1e6:.2f}, Mitsuba {theirs[-1] / 1e6:.2f} million samples/s",
                  file=sys.stderr, flush=True)
        mitsuba.close()
        images = compare_images(python, exr, npy)
        if options.keep:
            os.makedirs(options.keep, exist_ok=True)
            for path in (exr, npy):
                os.replace(path, os.path.join(options.keep, f"{name}-{os.path.basename(path)}"))
    ratios = [a / b for a, b in zip(ours, theirs)]
    result = {"scene": name, "width": scene["width"], "height": scene["height"], "spp": options.spp, "runs": options.runs,
              "eclat_samples_per_second": ours, "mitsuba_samples_per_second": theirs, "ratio": common.median(ratios),
              "spread": common.spread(ratios), "target": TARGETS[name], "met": common.median(ratios) >= TARGETS[name],
              "mitsuba": mitsuba.about, "image_means": images, "device": e["device"]["name"], "lanes": e["lanes"]}
    print(f"{name}: {scene['width']}x{scene['height']}, {options.spp} samples a pixel, depth 8, {options.runs} alternating runs")
    print(f"  eclat    {common.median(ours) / 1e6:7.2f} million samples/s (spread {common.spread(ours):.1%})")
    print(f"  Mitsuba  {common.median(theirs) / 1e6:7.2f} million samples/s (spread {common.spread(theirs):.1%}), {mitsuba.about['version']} {mitsuba.about['variant']}")
    print(f"  ratio    {result['ratio']:7.2f} (spread {result['spread']:.1%}), target {TARGETS[name]}: {'met' if result['met'] else 'NOT met'}")
    if "error" in images:
        print(f"  the images could not be compared: {images['error']}")
    else:
        relative = [a / b - 1 for a, b in zip(images["ours"], images["theirs"])]
        print("  means of the two images differ by " + ", ".join(f"{r:+.2%}" for r in relative) +
              f"; blocks of 32 pixels typically by {images['blocks']:.2%}, at most {images['worst_block']:.1%}")
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--scene", choices=["cornell", "sponza", "all"], default="all")
    parser.add_argument("--runs", type=int, default=5, help="alternating runs after warming up")
    parser.add_argument("--spp", type=int, default=64, help="samples a pixel and run, the same for both")
    parser.add_argument("--size", type=int, default=512, help="pixels along either side")
    parser.add_argument("--eclat", help="program to measure (else $ECLAT, build-bench/eclat, build/eclat)")
    parser.add_argument("--json", metavar="FILE", help="write everything measured to FILE")
    parser.add_argument("--keep", metavar="DIR", help="keep the last images (.exr of eclat, .npy of Mitsuba) in DIR")
    options = parser.parse_args()
    eclat = common.eclat_path(options.eclat)
    python = bench_mitsuba.find_python(lambda text: print(text, file=sys.stderr))
    llvm = bench_mitsuba.find_llvm()
    if not python or not llvm:
        common.fail("no Mitsuba to measure against" if not python else
                    "Mitsuba needs LLVM: apt-get install libllvm19, or name the library in DRJIT_LIBLLVM_PATH")
    names = ["cornell", "sponza"] if options.scene == "all" else [options.scene]
    results = [r for r in (measure(name, options, eclat, python, llvm) for name in names) if r]
    if options.json:
        rows = [common.row(f"samples/s of Mitsuba 3, {r['scene']}", f"{r['ratio']:.2f} x", f">= {r['target']:.1f} x", r["met"],
                           f"+- {r['spread']:.1%}") for r in results]
        common.write_json(options.json, {"results": results, "rows": rows})


if __name__ == "__main__":
    main()

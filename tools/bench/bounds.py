#!/usr/bin/env python3
"""How often do eclat's stated bounds hold? Renders scenes with many seeds and compares each picture with a reference.

SCENE is one of the names below; without any, all of them run. A render's true error is the root mean square
difference of pixel luminance from the reference, without the part that comes from the reference's own noise, over the reference's mean
luminance. A bound that is null, infinite or absent counts as refused."""
import argparse
import concurrent.futures
import hashlib
import json
import math
import os
import sys
import tempfile
import threading

import bench_common as common

LUMINANCE = (0.2126, 0.7152, 0.0722)
STUDIO = ("assets", "env", "pmndrs-assets", "studio.hdr")
SUN = ("assets", "env", "polyhaven", "qwantani_afternoon_puresky_1k.hdr")
REFERENCE_SEED = 2 ** 31  # no judged render has it
CAP = 1024                # samples a pixel at which a render to an error gives up
HELD, REFUSED = 0.95, 0.02


class Scene:
    """path: under scenes/, without .gltf. spp: of the reference. twin: a scene that gives the same picture, but whose light is found sooner.
    harmless: a bound is expected, since before bounds could be refused it held in at least 19 of 20 renders at every budget. In Veach's
    plates, the balls and the lamps, few samples make most of the noise, so a refusal is right there too."""

    def __init__(self, title, path, size, spp, environment=None, depth=None, twin=None, harmless=True):
        self.title, self.size, self.spp, self.environment, self.harmless = title, size, spp, environment, harmless
        self.file, self.reference_file = (os.path.join(common.ROOT, "scenes", p + ".gltf") for p in (path, twin or path))
        self.options = ["--max-depth", str(depth)] if depth else []

    def place(self, size):
        """Returns the options of all renders, or None if the environment map is not there."""
        map_ = common.shared(*self.environment) if self.environment else None
        if self.environment and not map_:
            return None
        return self.options + ["--size", "{}x{}".format(*(size or self.size))] + (["--env", map_] if map_ else [])


SCENES = {  # the first eight have the sizes and depths of tests/stat/test_coverage.c
    "box": Scene("box of emitting walls of six materials", "furnace/box-materials", (32, 32), 1 << 16),
    "cornell-box": Scene("Cornell box", "cornell-box/cornell-box", (32, 32), 1 << 16, depth=5),
    "plates": Scene("GGX plates under an environment map", "furnace/plates", (32, 32), 1 << 16, STUDIO, depth=4),
    "balls": Scene("spheres, mirror to matt, under an environment map", "furnace/spheres", (60, 20), 1 << 16, STUDIO, harmless=False),
    "veach-plates": Scene("Veach's plates", "veach-plates/veach-plates", (48, 32), 1 << 17, depth=4, harmless=False),
    "ring": Scene("ring, a caustic", "ring/ring", (48, 32), 1 << 17),
    "showcase": Scene("showcase", "showcase/showcase", (36, 24), 1 << 16),
    "lamps": Scene("lamps, a room lit by a bulb smaller than a pixel", "lamps/lamps", (24, 24), 1 << 18, harmless=False),
    "vase": Scene("a glass vase in the sun", "vase/vase", (24, 24), 1 << 20, SUN, harmless=False),
    "curl": Scene("a chrome knot in the sun", "curl/curl", (24, 24), 1 << 20, SUN, harmless=False),
    "toy": Scene("a coated toy in the sun", "toy/toy", (24, 24), 1 << 20, SUN, harmless=False),
    "pinlamp": Scene("a lamp of 0.1 mm by way of a mirror", "pinlamp/pinlamp", (24, 24), 1 << 18, twin="pinlamp/unfolded", harmless=False),
    "keyhole": Scene("a keyhole between two rooms", "keyhole/keyhole", (24, 24), 1 << 20, harmless=False),
}


def pair(text):
    width, _, height = text.partition("x")
    return int(width), int(height or width)


def parse():
    about = __doc__.split("\n\n")
    parser = argparse.ArgumentParser(description=about[0], epilog=about[1] + " Scenes: " + ", ".join(SCENES) + ".")
    parser.add_argument("scene", nargs="*", metavar="SCENE")
    parser.add_argument("--scenes", metavar="LIST", help="the same as SCENE…, with commas between")
    parser.add_argument("--seeds", type=int, default=20, metavar="N", help="renders of each scene and budget (default: 20; the manual's table: 200)")
    parser.add_argument("--budgets", default="16,64,256,10%", metavar="LIST",
                        help=f"samples a pixel, or an error in per cent with {CAP} samples at most (default: %(default)s)")
    parser.add_argument("--size", type=pair, metavar="WxH", help="pixels (default: each scene's own)")
    parser.add_argument("--references", default="references", metavar="FOLDER",
                        help="long renders are kept there, and made if missing: an hour on two cores (default: %(default)s)")
    parser.add_argument("--reference-share", type=float, default=1, metavar="F", help="references of F times as many samples (default: 1)")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="renders at once; seconds do not count here (default: 1)")
    parser.add_argument("--extra", default="", metavar="OPTIONS", help="options of every render that is judged")
    parser.add_argument("--eclat", help="program to measure (else $ECLAT, build-bench/eclat, build/eclat)")
    parser.add_argument("--json", metavar="FILE", help="write everything measured to FILE, and continue from what a run with the same options left there")
    parser.add_argument("--table", metavar="FILE", help="write the manual's table to FILE: docs/data/bounds.json, for tools/docs_tables.py")
    options = parser.parse_args()
    options.scene = options.scene + (options.scenes.split(",") if options.scenes else []) or list(SCENES)
    for name in options.scene:
        if name not in SCENES:
            parser.error(f"no scene is called {name}; there are {', '.join(SCENES)}")
    return options


def luminance(path):
    import numpy as np
    import OpenEXR
    rgb = OpenEXR.File(path, separate_channels=True).channels()
    return sum(weight * rgb[c].pixels.astype(np.float64) for c, weight in zip("RGB", LUMINANCE))


def digest(scene, place):
    """Returns a digest of all that determines the picture, so that the reference of another scene is not taken for this one's."""
    text = hashlib.sha256()
    stem = os.path.splitext(scene.reference_file)[0]
    for path in (stem + ".gltf", stem + ".bin"):
        with open(path, "rb") as file:
            text.update(file.read())
    text.update(" ".join(p if not os.path.isabs(p) else os.path.basename(p) for p in place).encode())
    return text.hexdigest()[:8]


class Reference:
    """Luminance of the long render, its mean, and its stated error."""

    def __init__(self, eclat, name, options):
        scene = SCENES[name]
        place = scene.place(options.size)
        spp = max(int(scene.spp * options.reference_share), 32)
        os.makedirs(options.references, exist_ok=True)
        self.path = os.path.join(options.references, f"{name}-{spp}-{digest(scene, place)}.exr")
        if not os.path.exists(self.path):
            print(f"{name}: reference of {spp} samples a pixel", file=sys.stderr, flush=True)
            unfinished = self.path[:-4] + ".part.exr"
            common.run_eclat(eclat, [scene.reference_file, *place, "--spp", str(spp), "--seed", str(REFERENCE_SEED), "-o", unfinished])
            os.replace(unfinished, self.path)
        self.spp, self.luminance = spp, luminance(self.path)
        self.mean = self.luminance.mean()
        self.noise = self.own_noise()

    def own_noise(self):
        import OpenEXR
        errors = OpenEXR.File(self.path, separate_channels=True).channels()["stderr.Y"].pixels.astype(float)
        return math.sqrt((errors ** 2).mean()) / self.mean

    def error_of(self, picture):
        square = ((picture - self.luminance) ** 2).mean() / self.mean ** 2
        return math.sqrt(max(square - self.noise ** 2, 0.0))


def limit(budget):
    return ["--error", budget, "--spp", str(CAP)] if budget.endswith("%") else ["--spp", budget]


def one(eclat, scene, place, budget, seed, options, folder, reference):
    out = os.path.join(folder, f"{threading.current_thread().name}.exr")
    report = common.run_eclat(eclat, [scene.file, *place, *limit(budget), "--seed", str(seed), *options.extra.split(), "-o", out])
    bound = report.get("error_bound")
    stated = isinstance(bound, (int, float)) and math.isfinite(bound)
    return {"seed": seed, "bound": bound if stated else None, "why": report.get("error_bound_why"), "spp": report["samples_per_pixel"],
            "stated_error": report.get("error"), "true": reference.error_of(luminance(out))}


class Record:
    """The measurements, written to --json as soon as a budget of a scene is done: an interrupted run goes on from there."""

    def __init__(self, options):
        self.path, self.results = options.json, []
        self.settings = {"seeds": options.seeds, "size": options.size and list(options.size), "extra": options.extra, "reference_share": options.reference_share}
        self.before = {}
        if not self.path or not os.path.exists(self.path):
            return
        with open(self.path, encoding="utf-8") as file:
            data = json.load(file)
        if data.get("settings") != self.settings:
            common.fail(f"{self.path} is from a run with other options, {data.get('settings')}; name another file or remove it")
        self.before = {(r["scene"], c["budget"]): c for r in data["results"] for c in r["cells"]}

    def rows(self):
        return [row for r in self.results if r["cells"] for row in rows_of(r)]

    def write(self):
        if self.path:
            common.write_json(self.path, {"settings": self.settings, "results": self.results, "rows": self.rows()})


def measure(eclat, name, options, record):
    """Returns the scene's result, which is also in the record; None if the scene is skipped."""
    scene = SCENES[name]
    place = scene.place(options.size)
    if place is None:
        print(f"{name}: skipped, its environment map in ../shared/assets is not here", file=sys.stderr)
        return None
    reference = Reference(eclat, name, options)
    result = {"scene": name, "title": scene.title, "harmless": scene.harmless, "size": options.size or scene.size,
              "reference": {"file": os.path.basename(reference.path), "spp": reference.spp, "error": reference.noise, "mean": reference.mean}, "cells": []}
    record.results.append(result)
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for budget in options.budgets.split(","):
            if (name, budget) not in record.before:
                renders = list(pool.map(lambda seed: one(eclat, scene, place, budget, seed, options, folder, reference), range(options.seeds)))
                record.before[name, budget] = cell(budget, renders)
            result["cells"].append(record.before[name, budget])
            record.write()
            print(f"{name}, {budget}: done", file=sys.stderr, flush=True)
    return result


def cell(budget, renders):
    stated = [r for r in renders if r["bound"] is not None]
    return {"budget": budget, "renders": renders, "count": len(renders), "stated": len(stated), "held": sum(r["true"] <= r["bound"] for r in stated),
            "refused": len(renders) - len(stated), "bound": common.median([r["bound"] for r in stated]) if stated else None,
            "true": common.median([r["true"] for r in renders]), "worst": max(r["true"] for r in renders),
            "spp": common.median([r["spp"] for r in renders])}


def per_cent(x):
    return "-" if x is None else f"{100 * x:.3g} %" if x < 9.995 else f"{100 * x:.0f} %"


BRIEF = ["scene", "bound, medians", "true error, medians", "stated", "of these held"]
HEAD = ("| scene | reference | samples a pixel | bound, median | true error, median | at most | stated | of these held | refused |\n"
        "|---|---|---|---|---|---|---|---|---|")


def lines(result):
    """Returns the lines of the table, one for each budget."""
    for k, c in enumerate(result["cells"]):
        first = (result["title"], per_cent(result["reference"]["error"])) if not k else ("", "")
        budget = f"`--error {c['budget']}`: {c['spp']:.0f}" if c["budget"].endswith("%") else c["budget"]
        held = f"{c['held']}, {100 * c['held'] / c['stated']:.3g} %" if c["stated"] else "-"
        yield "| " + " | ".join((*first, budget, per_cent(c["bound"]), per_cent(c["true"]), per_cent(c["worst"]), str(c["stated"]), held,
                                  str(c["refused"]))) + " |"


def brief(results):
    """Returns the manual's table: a line for each scene, the figures of its budgets separated by commas."""
    for r in results:
        stated, held, renders = (sum(c[k] for c in r["cells"]) for k in ("stated", "held", "count"))
        yield [r["title"], ", ".join(per_cent(c["bound"]) for c in r["cells"]), ", ".join(per_cent(c["true"]) for c in r["cells"]),
               f"{100 * stated / renders:.3g} %", f"{100 * held / stated:.3g} %" if stated else "-"]


def rows_of(result):
    """Returns the requirements: at least 95 % of stated bounds hold; harmless scenes are refused a bound in under 2 % of renders."""
    stated, held, refused = (sum(c[k] for c in result["cells"]) for k in ("stated", "held", "refused"))
    share = held / stated if stated else None
    yield common.row(f"stated bounds that hold, {result['scene']}", per_cent(share), f">= {per_cent(HELD)}", share is None or share >= HELD)
    if result["harmless"]:
        share = refused / (stated + refused)
        yield common.row(f"bounds refused, {result['scene']}", per_cent(share), f"< {per_cent(REFUSED)}", share < REFUSED)


def main():
    options = parse()
    eclat = common.eclat_path(options.eclat)
    record = Record(options)
    print(HEAD, flush=True)
    for name in options.scene:
        result = measure(eclat, name, options, record)
        if result:
            print("\n".join(lines(result)), flush=True)
    rows = record.rows()
    if rows:
        print()
    common.print_rows(rows)
    if options.table:
        share = "" if options.reference_share == 1 else f", of {options.reference_share:g} times as many samples as in a full run"
        common.write_table(options.table, f"{options.seeds} renders of each scene at {options.budgets.replace(',', ', ')} samples per pixel, against "
                           f"long renders{share}; in the sun: the map {os.path.splitext(SUN[-1])[0]}", BRIEF,
                           list(brief(record.results)))
    sys.exit(not all(r["met"] for r in rows))


if __name__ == "__main__":
    main()

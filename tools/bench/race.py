#!/usr/bin/env python3
"""How much sooner does eclat reach an error than Mitsuba 3 (llvm_ad_rgb)? Both render the same scene with the same number of samples, in turns. See README.md.

SCENE is a .gltf with its files beside it, or one of the names below; without any, all of these run. Efficiency is
1 / (error^2 * seconds). The error is the square root of the pixels' mean luminance variance, over the mean luminance; the variance comes from
renders with different seeds on both sides. The script prints eclat's efficiency over that of the better one of Mitsuba's samplers."""
import argparse
import math
import os
import sys
import tempfile

import bench_common as common
import race_mitsuba

POLYHAVEN = ("assets", "env", "polyhaven", "qwantani_afternoon_puresky_1k.hdr")
STUDIO = ("assets", "env", "pmndrs-assets", "studio.hdr")
OURS = os.path.join(common.ROOT, "scenes")
SCENES = {  # name: (scene, parts of the environment map's path under ../shared, diffuse)
    "cornell-box": (os.path.join(OURS, "cornell-box", "cornell-box.gltf"), None, False),
    "sponza": (common.shared("assets", "classic", "gltf", "sponza-dabrovic", "sponza-dabrovic.gltf"), STUDIO, True),
    "dining-room": (common.shared("assets", "classic", "gltf", "dining-room", "dining-room.gltf"), None, True),
    "veach-plates": (os.path.join(OURS, "veach-plates", "veach-plates.gltf"), None, False),
    "six-lamps": (os.path.join(OURS, "six-lamps", "six-lamps.gltf"), None, False),
    "spheres": (os.path.join(OURS, "spheres", "spheres.gltf"), POLYHAVEN, False),
}
EFFICIENCY = {"eclat": 1.2, "eclat, --error": 2.0}  # what each entrant should reach on every scene
RATE = {"cornell-box": 1.3, "dining-room": 1.15}    # samples a second of the entrant "eclat", over Mitsuba's


def pair(text):
    width, _, height = text.partition("x")
    return int(width), int(height or width)


def parse():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0], epilog=__doc__.split("\n\n")[1] + " Scenes: " + ", ".join(SCENES) + ".")
    parser.add_argument("scene", nargs="*", metavar="SCENE")
    parser.add_argument("--env", metavar="MAP", help="environment map (default: that of a scene above, else none)")
    parser.add_argument("--size", type=pair, default=(160, 160), metavar="WxH", help="pixels (default: 160x160)")
    parser.add_argument("--spp", type=int, default=128, metavar="N", help="samples a pixel on both sides (default: 128)")
    parser.add_argument("--error", metavar="PCT", help="eclat also renders until this error, with its default options; `same`: "
                        "until about that of the better one of Mitsuba's samplers")
    parser.add_argument("--depth", type=int, default=8, metavar="N", help="segments of a path (default: 8)")
    parser.add_argument("--diffuse", action="store_true", help="nothing but diffuse materials on both sides; else they are only alike")
    parser.add_argument("--seeds", type=int, default=8, metavar="N", help="renders of each entrant that count (default: 8)")
    parser.add_argument("--samplers", default="independent,multijitter", metavar="LIST", help="Mitsuba's (default: %(default)s)")
    parser.add_argument("--extra", default="", metavar="OPTIONS", help="options of every render of eclat's")
    parser.add_argument("--no-adaptive", action="store_true", help="eclat without its entrant --adaptive")
    parser.add_argument("--reference", type=int, metavar="SPP", help="also print the error against a render by eclat with SPP samples")
    parser.add_argument("--clock", choices=("cpu", "wall"), default="cpu", help="which seconds count; wall needs a quiet machine (default: cpu)")
    parser.add_argument("--eclat", help="program to measure (else $ECLAT, build-bench/eclat, build/eclat)")
    parser.add_argument("--json", metavar="FILE", help="write everything measured to FILE")
    parser.add_argument("--table", metavar="FILE", help="write the manual's table to FILE: docs/data/race.json, for tools/docs_tables.py")
    options = parser.parse_args()
    if options.seeds < 2:
        parser.error("--seeds: a spread needs two")
    return options


def scene_of(name, options):
    """Returns (path, environment map, diffuse), or a line that says what is missing."""
    path, environment, diffuse = SCENES.get(name, (name, None, False))
    if not path or not os.path.exists(path):
        return f"{name}: skipped, {'../shared/assets is not here' if name in SCENES else 'there is no such scene'}"
    if not path.endswith(".gltf"):
        return f"{name}: skipped, races read .gltf with files beside it; convert it, for example with gltf-transform copy"
    if environment:
        environment = common.shared(*environment)
        if not environment and not options.env:
            return f"{name}: skipped, its environment map in ../shared/assets is not here"
    return os.path.abspath(path), options.env and os.path.abspath(options.env) or environment, diffuse or options.diffuse


def ways_of(options, target):
    """Returns eclat's entrants: names and options."""
    ways = {"eclat": ["--spp", str(options.spp)]}
    if not options.no_adaptive:
        ways["eclat, --adaptive"] = ["--spp", str(options.spp), "--adaptive"]
    if target:
        ways["eclat, --error"] = ["--error", target]
    return ways


def race(name, options, eclat):
    import mitsuba as mi
    import numpy as np
    mi.set_variant(race_mitsuba.VARIANT)
    mi.set_log_level(mi.LogLevel.Error)  # multijitter rounds samples up, which Mitsuba would warn of; the table says so
    import race_entrants
    import race_gltf
    import race_result
    found = scene_of(name, options)
    if isinstance(found, str):
        print(found)
        return None
    path, environment, diffuse = found
    document = race_gltf.Gltf(path)
    scene, sensor, triangles = race_mitsuba.scene(mi, document, options.size, options.depth, environment, diffuse)
    with tempfile.TemporaryDirectory() as folder:
        if diffuse:
            path = race_gltf.write_diffuse(document, folder)
        common_options = ["--size", "{}x{}".format(*options.size), "--max-depth", str(options.depth), *(["--env", environment] if environment else [])]
        entrants = [race_entrants.Mitsuba(mi, scene, sensor, s, options.spp) for s in options.samplers.split(",")]
        target = options.error
        if target == "same":
            error = min(race_result.errors(np.stack([e.run(1000 + k).luminance for k in range(2)]))[0] for e in entrants)
            target = f"{min(100 * error, 100):.2g}%"  # the most that --error takes
        common_options += options.extra.split()
        entrants += [race_entrants.Eclat(mi, eclat, path, common_options + way, folder, n) for n, way in ways_of(options, target).items()]
        reference = None
        if options.reference:
            long = ["--spp", str(options.reference)]
            reference = race_entrants.Eclat(mi, eclat, path, common_options + long, folder, "reference").run(2 ** 31)
        laps = {e.name: [] for e in entrants}
        for e in entrants:
            for k in range(e.warm_ups):
                e.run(1000 + k)
        for seed in range(options.seeds):
            for e in entrants:
                laps[e.name].append(e.run(seed))
            print(f"{name}: {seed + 1} of {options.seeds}", file=sys.stderr, flush=True)
    result = {"scene": name, "triangles": triangles, "size": options.size, "spp": options.spp, "depth": options.depth, "diffuse": diffuse,
              "untranslated": [] if diffuse else race_gltf.untranslated(document), "mitsuba": mi.__version__, "clock": options.clock, "target": target,
              "entrants": race_result.compare(laps, reference, options.clock)}
    race_result.show(result)
    return result


def rows_of(result):
    """Returns lines for the table of tools/bench/run."""
    def row(figure, value, target):
        return common.row(figure, f"{value:.2f} x", f">= {target} x" if target else "-", bool(value >= target) if target else None)
    ours = {n: e for n, e in result["entrants"].items() if not n.startswith("Mitsuba")}
    yield row(f"samples/s of Mitsuba 3, {result['scene']}", ours["eclat"]["rate_ratio"], RATE.get(result["scene"]))
    for name, e in ours.items():
        yield row(f"efficiency of Mitsuba 3, {result['scene']}, {name}", e["efficiency_ratio"], EFFICIENCY.get(name))


def brief(results):
    """Returns the manual's table: names of its columns, and a line for each scene."""
    ours = [n for n in results[0]["entrants"] if not n.startswith("Mitsuba")]
    yield ["scene", "samples per second", *(f"efficiency (trimmed), {n}" for n in ours), "mean (± 1 standard error)"]
    for r in results:
        entrants = [r["entrants"][n] for n in ours]
        yield [f"{r['scene']}, {r['size'][0]} x {r['size'][1]}", f"{entrants[0]['rate_ratio']:.2f}",
               *(f"{e['efficiency_ratio']:.3g} ({e['trimmed_efficiency_ratio']:.3g})" for e in entrants),
               f"{100 * entrants[0]['off']:+.2f} % ({100 * entrants[0]['off_error']:.2f})"]


def main():
    options = parse()
    race_mitsuba.enter(common.fail)
    eclat = common.eclat_path(options.eclat)
    results = [r for r in (race(name, options, eclat) for name in options.scene or SCENES) if r]
    for name in results[0]["entrants"] if len(results) > 1 else ():
        ratios = [r["entrants"][name]["efficiency_ratio"] for r in results]
        print(f"geometric mean of efficiency, {name}: {math.exp(sum(map(math.log, ratios)) / len(ratios)):.2f}")
    if options.json:
        common.write_json(options.json, {"results": results, "rows": [line for r in results for line in rows_of(r)]})
    if options.table and results:
        columns, *rows = brief(results)
        common.write_table(options.table, f"{options.clock} seconds, Mitsuba {results[0]['mitsuba']}, {options.spp} samples per pixel", columns, rows)
    sys.exit(not results)


if __name__ == "__main__":
    main()

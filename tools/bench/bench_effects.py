#!/usr/bin/env python3
"""Measures what it gains to build only the effects that a scene calls for: specialised kernels and kernels with every effect take turns.
See README.md."""
import argparse
import os
import shutil
import tempfile

import bench_common as common
from bench_start import first_pixel

PLAIN = ("cornell", "helmet") # effects that they do not call for must slow them by under 3 %; the full build must cost them something


def scenes():
    """Returns (name, file, environment) of each scene whose files are here."""
    own = [(name, os.path.join(common.ROOT, "scenes", name, name + ".gltf"), None) for name in ("lamps", "showcase", "glass")]
    helmet = common.shared("assets", "gltf", "DamagedHelmet", "glTF-Binary", "DamagedHelmet.glb")
    environment = common.shared("assets", "env", "pmndrs-assets", "studio.hdr")
    found = [("cornell", common.cornell_box(), None), ("helmet", helmet, environment), *own]
    return [scene for scene in found if scene[1] and os.path.exists(scene[1])]


def folder_bytes(folder, ending):
    return sum(os.path.getsize(os.path.join(at, name)) for at, _, names in os.walk(folder) for name in names if name.endswith(ending))


class Scene:
    """Renders one scene with any program, with its own caches or the usual ones."""

    def __init__(self, file, environment, options, folder):
        self.arguments = [file, "--size", f"{options.size}x{options.size}", "--lanes", options.lanes]
        self.arguments += ["-o", os.path.join(folder, "effects.exr")]
        self.arguments += ["--env", environment] if environment else []
        self.spp, self.caches = options.spp, os.path.join(folder, "caches")

    def render(self, eclat, *more, spp=None, caches=False):
        places = {"XDG_CACHE_HOME": os.path.join(self.caches, "xdg"), "POCL_CACHE_DIR": os.path.join(self.caches, "pocl")}
        for place in places.values():
            os.makedirs(place, exist_ok=True)
        environment = dict(os.environ, **(places if caches else {}))
        return common.run_eclat(eclat, [*self.arguments, "--spp", str(spp or self.spp), *more], environment)

    def cold(self, eclat, which):
        """Renders with empty caches. Returns the time to the first pixel, and how much code was compiled."""
        shutil.rmtree(self.caches, ignore_errors=True)
        report = self.render(eclat, "--effects", which, spp=1, caches=True)
        return {"compile": report["kernel_seconds"], "first_pixel": first_pixel(report), "binary": folder_bytes(self.caches, ".bin"),
                "code": folder_bytes(self.caches, ".so")}

    def warm(self, eclat, which):
        """Renders with the caches that a cold start has left."""
        return first_pixel(self.render(eclat, "--effects", which, spp=1, caches=True))


def in_turns(scene, programs, runs):
    """Returns samples a second of each (program, options). They run one after the other, `runs` times; a first run compiles and does not count."""
    for eclat, more in programs:
        scene.render(eclat, *more, spp=1)
    reports = [[] for _ in programs]
    for _ in range(runs):
        for (eclat, more), list_ in zip(programs, reports):
            list_.append(scene.render(eclat, *more))
    return reports


def ratio(reports, other):
    """Returns the rate of the first over that of another, from neighbouring runs."""
    return [a["samples_per_second"] / b["samples_per_second"] for a, b in zip(reports[0], reports[other])]


def measure(name, scene, eclat, options):
    cold, warm = {}, {}
    for which in ("needed", "all"):
        cold[which] = [scene.cold(eclat, which) for _ in range(options.cold)]
        warm[which] = [scene.warm(eclat, which) for _ in range(options.cold)]
    programs = [(eclat, ["--effects", "needed"]), (eclat, ["--effects", "all"])] + ([(options.before, [])] if options.before else [])
    reports = in_turns(scene, programs, options.runs)
    if reports[0][0]["image_sha256"] != reports[1][0]["image_sha256"]:
        common.fail(f"{name}: the full build gives another picture")
    result = {"scene": name, "cold": cold, "warm": warm, "effects": reports[0][0]["effects"],
              "rate": [common.median([r["samples_per_second"] for r in list_]) for list_ in reports],
              "device_bytes": [list_[0]["device_bytes"] for list_ in reports], "gain": ratio(reports, 1)}
    if options.before:
        result["before"] = ratio(reports, 2)
    return result


def rows_of(r):
    name, gain = r["scene"], common.median(r["gain"])
    middle = {which: {key: common.median([run[key] for run in runs]) for key in runs[0]} for which, runs in r["cold"].items()}
    needed, full = middle["needed"], middle["all"]
    plain = name in PLAIN
    yield common.row(f"{name}: rate, specialised over full build", f"{gain:.2f} x", "> 1.03 x" if plain else "", gain > 1.03 if plain else None,
                     f"+- {common.spread(r['gain']):.0%}; {r['rate'][0] / 1e6:.2f} and {r['rate'][1] / 1e6:.2f} M samples/s, {len(r['effects'])} effects")
    for key, words in (("compile", "compile time, cold"), ("first_pixel", "first pixel, cold")):
        yield common.row(f"{name}: {words}", f"{needed[key]:.1f} s", "", None, f"full build {full[key]:.1f} s")
    yield common.row(f"{name}: first pixel, warm", f"{common.median(r['warm']['needed']):.2f} s", "", None,
                     f"full build {common.median(r['warm']['all']):.2f} s")
    for key, words in (("binary", "program binaries"), ("code", "native code that PoCL keeps")):
        if full[key]:
            yield common.row(f"{name}: {words}", f"{needed[key] / 1e3:.0f} kB", "", None, f"full build {full[key] / 1e3:.0f} kB")
    yield common.row(f"{name}: device memory", f"{r['device_bytes'][0] / 1e6:.1f} MB", "", None, f"full build {r['device_bytes'][1] / 1e6:.1f} MB")
    if "before" in r:
        before = common.median(r["before"])
        yield common.row(f"{name}: rate, over that of --before", f"{before:.3f} x", ">= 0.97 x" if plain else "", before >= 0.97 if plain else None,
                         f"+- {common.spread(r['before']):.1%}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--runs", type=int, default=7, help="turns of each build for the rate")
    parser.add_argument("--cold", type=int, default=3, help="starts with empty caches of each build")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--lanes", default="auto", help="as of eclat render")
    parser.add_argument("--scene", action="append", metavar="NAME", help="only these; may be repeated")
    parser.add_argument("--before", metavar="ECLAT", help="a program of an earlier commit, to take turns with too")
    parser.add_argument("--eclat", help="program to measure (else $ECLAT, build-bench/eclat, build/eclat)")
    parser.add_argument("--json", metavar="FILE", help="write everything measured to FILE")
    parser.add_argument("--table", metavar="FILE", help="write the manual's table to FILE: docs/data/effects.json, for tools/docs_tables.py")
    options = parser.parse_args()
    eclat, results, rows = common.eclat_path(options.eclat), [], []
    names = [name for name, _, _ in scenes()]
    if set(options.scene or []) - set(names):
        common.fail(f"no such scene here; there are {', '.join(names)}")
    with tempfile.TemporaryDirectory() as folder:
        for name, file, environment in scenes():
            if options.scene and name not in options.scene:
                continue
            results.append(measure(name, Scene(file, environment, options, folder), eclat, options))
            rows.append(list(rows_of(results[-1])))
            common.print_rows(rows[-1])
    if options.json:
        common.write_json(options.json, {"scenes": results, "rows": [row for part in rows for row in part]})
    if options.table:
        common.write_table(options.table, f"{options.runs} turns of {options.spp} samples at {options.size} pixels", ["figure", "value", "note"],
                           [[row["figure"], row["value"], row["note"]] for part in rows for row in part])


if __name__ == "__main__":
    main()

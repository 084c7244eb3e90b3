"""Collects the results that the benchmarks left in a folder into one table: figure, value, target, met or not."""
import json
import os
import re
import sys

import bench_common as common


def load(folder, name):
    try:
        with open(os.path.join(folder, name), encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return None


def traversal_rows(data):
    """A kind of rays is as fast as the better of the two kernels, since the pipeline measures both and takes that one."""
    names = {"camera": "camera rays", "bounce": "diffuse bounce", "shadow": "shadow rays"}
    for kind, name in names.items():
        ours = [r for r in data["results"] if r["rays"] == kind and r["kernels"] == "embedded"]
        wide = next(r for r in ours if r["kernel"] == "bvh8")
        packet = [r for r in ours if r["kernel"] == "packet"]
        note = f"8-wide BVH, {wide['mismatches']} of {wide['count']} differ"
        if packet:
            note += f"; packets {packet[0]['ratio']:.2f} x"
        yield common.row(f"Embree's single rays, {name}, {data['triangles']} triangles", f"{wide['ratio']:.2f} x",
                         f">= {wide['target']} x", wide["ratio"] >= wide["target"], note)


def build_rows(text):
    found = re.search(r"tree \+ 8-wide +([\d.]+) ms +([\d.]+) x embree", text)
    if found:
        value = float(found.group(2))
        yield common.row("Embree's build time, tree and 8-wide layout", f"{value:.2f} x", "<= 2.0 x", value <= 2.0, f"{found.group(1)} ms")


def main():
    folder = sys.argv[1]
    rows = []
    traversal = load(folder, "traversal.json")
    if traversal:
        rows += traversal_rows(traversal)
    try:
        with open(os.path.join(folder, "build.txt"), encoding="utf-8") as file:
            rows += build_rows(file.read())
    except OSError:
        pass
    for name in ("start.json", "limits.json", "host.json", "write.json", "race.json", "effects.json"):
        rows += (load(folder, name) or {"rows": []})["rows"]
    common.print_rows(rows)
    if len(sys.argv) > 2:
        common.write_json(sys.argv[2], {"rows": rows, "traversal": traversal, "start": load(folder, "start.json"), "limits": load(folder, "limits.json"), "host": load(folder, "host.json"), "write": load(folder, "write.json"), "race": load(folder, "race.json"),
                                         "effects": load(folder, "effects.json")})
    sys.exit(any(r["met"] is False for r in rows))


if __name__ == "__main__":
    main()

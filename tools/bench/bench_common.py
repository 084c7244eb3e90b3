"""Shared code of the benchmark scripts: finds files, runs eclat, makes medians and tables."""
import json
import os
import statistics
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
SHARED = os.environ.get("ECLAT_SHARED", os.path.join(os.path.dirname(ROOT), "shared"))

# Benchmarks measure rendering with the fast kernels. Only bench_start.py measures the time before these are there.
os.environ.setdefault("ECLAT_COMPILE", "first")


def fail(text):
    sys.exit(f"{os.path.basename(sys.argv[0])}: {text}")


def eclat_path(given=None):
    """Returns the program's path: --eclat, $ECLAT, or one of the usual build folders."""
    places = [given, os.environ.get("ECLAT"), os.path.join(ROOT, "build-bench", "eclat"), os.path.join(ROOT, "build", "eclat")]
    for place in places:
        if place and os.access(place, os.X_OK):
            return os.path.abspath(place)
    fail("no eclat program; build one, as tools/bench/run does, and name it with --eclat")


def shared(*parts):
    """Returns the path of a file under ../shared, or None if it is not there."""
    path = os.path.join(SHARED, *parts)
    return path if os.path.exists(path) else None


def cornell_box():
    return shared("reference", "cornell-box", "cornell-box.gltf") or os.path.join(ROOT, "scenes", "cornell-box", "cornell-box.gltf")


def run_eclat(eclat, arguments, environment=None):
    """Runs `eclat render --json`. Returns its report, with the wall time of the whole process as wall_seconds."""
    command = [eclat, "render", *arguments, "--json", "--quiet"]
    start = time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    wall = time.monotonic() - start
    if done.returncode:
        fail(f"{' '.join(command)}\nended with {done.returncode}: {done.stderr.strip()}")
    report = json.loads(done.stdout)
    report["wall_seconds"] = wall
    return report


def median(values):
    return statistics.median(values)


def spread(values):
    """Returns half the distance between the quartiles, relative to the median: how much the runs vary."""
    if len(values) < 4:
        return (max(values) - min(values)) / (2 * median(values))
    low, _, high = statistics.quantiles(values, n=4)
    return (high - low) / (2 * median(values))


def row(figure, value, target, met, note=""):
    """Returns one line of the table that tools/bench/run collects."""
    return {"figure": figure, "value": value, "target": target, "met": met, "note": note}


def print_rows(rows):
    for r in rows:
        met = {True: "met", False: "NOT met", None: "-"}[r["met"]]
        print(f"  {r['figure']:<58} {r['value']:>14} {r['target']:>12}  {met:<8}{r['note']}")


def commit():
    """Returns the commit of the sources and its date; nothing if they are not a git checkout."""
    done = subprocess.run(["git", "-C", ROOT, "log", "-1", "--format=%h %cs"], capture_output=True, text=True)
    return done.stdout.split() if done.returncode == 0 else ["", ""]


PLACES = ("--table", "--json", "--eclat", "--references")  # options that only say where files are, and change no figure


def write_table(path, setting, columns, rows):
    """Writes the data from which tools/docs_tables.py makes a table of docs/. Cells are text."""
    hash_, date = commit()
    words = [os.path.relpath(sys.argv[0], ROOT) if os.path.exists(sys.argv[0]) else sys.argv[0], *sys.argv[1:]]
    for option in PLACES:
        if option in words:
            del words[words.index(option):words.index(option) + 2]
    write_json(path, {"command": " ".join(words), "commit": hash_, "date": date, "setting": setting, "columns": columns, "rows": rows})


def write_json(path, data):
    unfinished = path + ".part"
    with open(unfinished, "w", encoding="utf-8") as file:
        json.dump(data, file, indent=1, ensure_ascii=False)
        file.write("\n")
    os.replace(unfinished, path)

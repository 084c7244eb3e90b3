#!/usr/bin/env python3
"""Makes small checkpoints and slices as seeds for fuzz_checkpoint, without their seals, which the fuzzer adds. NAME-state has the JSON
object of each alone. Also makes damaged files that older readers accepted.

usage: ECLAT=build/eclat seed_checkpoints.py OUT"""
import json
import os
import pathlib
import struct
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))
from polling import poll_until
from support import CORNELL, read_header

ECLAT = os.path.abspath(os.environ["ECLAT"])
FOLDER = pathlib.Path("/tmp/seed")  # the files contain it, as the folder where the job began
SEAL = len(b"eclat: sealed by SHA-256\n") + 32
JOB = ["render", os.path.basename(CORNELL), "--effects", "all", "--lanes", "4", "-q", "-o", "x.exr"]
KINDS = {  # options of the render, and the file of it that is kept
    "whole": (["--size", "2x2", "--spp", "523", "--checkpoint", "c.exr"], "c.exr"),
    "adaptive": (["--size", "8x8", "--spp", "40", "--adaptive", "--checkpoint", "c.exr"], "c.exr"),
    "slice": (["--size", "2x2", "--spp", "64", "--samples", "10:20"], "x.exr"),
    "denoised": (["--size", "2x2", "--spp", "96", "--samples", "64:80", "--denoise=atrous"], "x.exr"),
    "cut": (["--size", "2x2", "--spp", "47", "--samples", "40:47"], "x.exr"),
    "under-way": (["--size", "4x4", "--wave", "16", "--spp", "100000", "--checkpoint", "c.exr", "--every", "0.00001s"], "c.exr"),
}


def headers(data):
    """Returns the attributes of each part, and the offsets of their tables of blocks."""
    parts, at = [], 8
    while data[at]:
        part, at = read_header(data, at)
        parts.append(part)
    return parts, at + 1


def state_of(data):
    return json.loads(headers(data)[0][0]["eclat.state"])


def make(name):
    options, kept = KINDS[name]
    path = FOLDER / kept
    path.unlink(missing_ok=True)
    process = subprocess.Popen(["eclat", *JOB, *options], executable=ECLAT, cwd=FOLDER)
    if name == "under-way":
        poll_until(lambda: path.exists() and state_of(path.read_bytes())["underWay"], process, 0.001)
        process.kill()
    assert process.wait() in (0, -9), name
    return path.read_bytes()[:-SEAL]


def with_nan(data):
    """Replaces the first value of the first sums, which are not compressed, by NaN."""
    parts, at = headers(data)
    before = sum(part["chunkCount"] for part in parts[:[part["name"] for part in parts].index("sums 0")])
    start, = struct.unpack_from("<Q", data, at + 8 * before)
    first = start + 12  # skips part, line and length
    return data[:first] + struct.pack("<f", float("nan")) + data[first + 4:]


def with_huge_window(data):
    """Sets the largest number of pixels that a header can state."""
    window = struct.pack("<4i", *headers(data)[0][0]["dataWindow"])
    return data.replace(window, struct.pack("<4i", 0, 0, 2**31 - 2, 2**31 - 2))


def main():
    out = pathlib.Path(sys.argv[1])
    FOLDER.mkdir(exist_ok=True)
    for path in pathlib.Path(CORNELL).parent.glob("cornell-box.[gb]*"):
        (FOLDER / path.name).write_bytes(path.read_bytes())
    made = {name: make(name) for name in KINDS}
    states = {name: state_of(data) for name, data in made.items()}
    assert states["cut"]["cut"] and states["denoised"]["featureSets"] == 2 and states["under-way"]["underWay"] and states["adaptive"]["hasWeights"] and states["adaptive"]["hasCounts"]
    made.update({name + "-state": json.dumps(state, separators=(",", ":")).encode() for name, state in states.items()})
    unasked = made["denoised"].replace(b'"featureSets":2', b'"featureSets":0')
    made.update({"features-unasked": unasked, "sums-not-a-number": with_nan(made["whole"]), "huge-window": with_huge_window(made["whole"])})
    for name, data in made.items():
        (out / name).write_bytes(data)
        print(f"{len(data):7} {name}")


main()

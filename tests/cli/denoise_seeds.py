"""usage: python3 denoise_seeds.py [--seeds N] [--keep FOLDER] [--clamp LIMIT] [SCENE ...]

Measures how far denoised pictures of many seeds are from the truth, and how often the stated intervals contain the real error. Prints rows
of docs/denoise.md's table.

Renders are kept in FOLDER as slices: after a change of host/denoise they are merged and judged again, and no path is traced. Ctrl-C during
the renders ends with the seeds that all scenes have. The truth of a seed's picture is the mean of all other seeds' pictures. The variance
of that mean is subtracted, so that each squared error is unbiased."""
import argparse
import json
import math
import os
import sys
import tempfile
from array import array

import denoiser
from support import SOURCE, eclat, read_exr

SCENES = ["cornell-box/cornell-box", "showcase/showcase", "ring/ring", "veach-plates/veach-plates", "lamps/lamps", "glass/glass", "drink/drink",
          "brushed-metal/brushed-metal", "furnace/spheres", "stadium/stadium"]
NAMES = {"cornell-box": "Cornell box", "ring": "ring, a caustic", "veach-plates": "Veach's plates", "brushed-metal": "brushed metal"}
# Samples are rendered in these slices. Each budget merges some of them, which gives the bits of one render.
SLICES = ((0, 16), (0, 64), (64, 256))
BUDGETS = {16: SLICES[:1], 64: SLICES[1:2], 256: SLICES[1:]}
LAYERS = ("", "denoised.", "best.")
SEEDS = 100


def luminance(planes, layer):
    return array("d", (0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in zip(*(planes[layer + c] for c in "RGB"))))


def percent(square):
    root = 100 * math.sqrt(max(square, 0))
    return f"{root:.3g} %" if root < 1000 else f"{root:.0f} %"


def run(*words):
    done = eclat(*words, env=denoiser.environment(), timeout=3600)
    if done.returncode:
        raise RuntimeError(f"eclat {' '.join(words)}: {done.stderr}")
    return done.stdout


class Seeds:
    """Pictures of one scene, kept in a folder."""

    def __init__(self, folder, scene, options=()):
        self.path = os.path.join(SOURCE, "scenes", scene + ".gltf")
        self.options = ["--size", "96x72", "--spp", "256", *options]
        self.stem = os.path.join(folder, "-".join([os.path.basename(scene), *(word.strip("-") for word in options)]))
        self.folder = folder

    def slice(self, seed, first, end):
        path = f"{self.stem}-{seed}-{first}-{end}.exr"
        if not os.path.exists(path):  # --denoise keeps first hits of all samples
            part = os.path.join(self.folder, f"part-{os.getpid()}.exr")
            run("render", self.path, *self.options, "--seed", str(seed), "--samples", f"{first}:{end}", "--denoise=atrous", "-q", "-o", part)
            os.rename(part, path)
        return path

    def picture(self, seed, spp):
        """Returns the report, and the luminance of each layer."""
        picture = os.path.join(self.folder, f"picture-{os.getpid()}.exr")
        report = json.loads(run("merge", *(self.slice(seed, *part) for part in BUDGETS[spp]), "--partial", "--denoise=oidn", "--json", "-o", picture))
        planes = read_exr(picture)[1]
        os.remove(picture)
        return report, [luminance(planes, layer) for layer in LAYERS]


class Truth:
    """The truth of each of several pictures of one scene: the mean of all others, and the variance of that mean."""

    def __init__(self, pictures):
        self.count = len(pictures)
        self.sums = array("d", map(sum, zip(*pictures)))
        self.squares = array("d", (sum(y * y for y in pixel) for pixel in zip(*pictures)))

    def errors(self, own, layers):
        """Returns the squared error of each layer of one seed, relative to the mean luminance. own: the seed's picture in the set that the
        truth comes from."""
        others = self.count - 1
        truth = array("d", ((s - y) / others for s, y in zip(self.sums, own)))
        variance = sum((q - y * y) / others - t * t for q, y, t in zip(self.squares, own, truth)) / (others - 1)
        mean = sum(truth) / len(truth)
        return [(sum((a - b) ** 2 for a, b in zip(layer, truth)) - variance) / len(truth) / mean**2 for layer in layers]


class Cell:
    """Sums over the seeds of one scene at one budget: real errors of each layer, and for the denoised and the best layer the stated errors
    and how often the interval held."""

    def __init__(self, scene, spp):
        self.scene, self.spp, self.seeds = os.path.basename(scene), spp, 0
        self.real, self.stated, self.low, self.high = [0.0] * 3, [0.0] * 3, [0] * 3, [0] * 3
        self.open = 0

    def add(self, report, squares):
        self.seeds += 1
        self.open += report["denoised"]["high95"] is None
        for i, layer in enumerate(LAYERS):
            self.real[i] += squares[i]
            if not layer:
                continue
            one, real = report[layer[:-1]], math.sqrt(max(squares[i], 0))
            self.stated[i] += one["error"] ** 2
            self.low[i] += real < one["low95"]
            self.high[i] += one["high95"] is not None and real > one["high95"]

    def held(self, layer):
        return self.seeds - self.low[layer] - self.high[layer]

    def worse(self):
        """Error of the best picture over the smaller error of the noisy and the denoised one."""
        return math.sqrt(self.real[2] / min(self.real[:2]))

    def row(self, is_first):
        noisy, *both = (percent(sum_ / self.seeds) for sum_ in self.real)
        told = [f"{real}, {percent(sum_ / self.seeds)} | {self.held(i)}" for i, real, sum_ in zip((1, 2), both, self.stated[1:])]
        return f"| {NAMES.get(self.scene, self.scene) if is_first else ''} | {self.spp} | {noisy} | {' | '.join(told)} |"

    def __str__(self):
        return (f"{self.scene} {self.spp}: denoised under its interval {self.low[1]}, over it {self.high[1]}; best {self.low[2]}, {self.high[2]}; "
                f"{self.open} without an upper end; best is {self.worse():.3f} of the better; {self.seeds} seeds")


def measure(folder, scene, seeds, options=(), budgets=tuple(BUDGETS)):
    """Returns a cell for each budget."""
    source = Seeds(folder, scene, options)
    most = max(budgets)
    pictures = {spp: [source.picture(seed, spp) for seed in range(1, seeds + 1)] for spp in budgets}
    long = [layers[0] for _, layers in pictures[most]]
    truth, cells = Truth(long), []
    for spp in budgets:
        cells.append(Cell(scene, spp))
        for (report, layers), own in zip(pictures[spp], long):
            cells[-1].add(report, truth.errors(own, layers))
    return cells


def fill(folder, scenes, seeds, options):
    """Renders the pictures seed by seed; returns how many seeds all scenes have. Ctrl-C stops rendering."""
    for seed in range(1, seeds + 1):
        try:
            for scene in scenes:
                for part in SLICES:
                    Seeds(folder, scene, options).slice(seed, *part)
        except KeyboardInterrupt:
            return seed - 1
    return seeds


def show(cells):
    for cell in cells:
        print(cell.row(cell is cells[0]), cell, sep="\n    ", file=sys.stderr, flush=True)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--keep")
    parser.add_argument("--clamp")
    parser.add_argument("scenes", nargs="*", default=SCENES)
    args = parser.parse_args()
    if args.seeds < 3:
        parser.error("--seeds takes 3 or more: of each picture the others are the truth")
    options = ["--clamp", args.clamp] if args.clamp else []
    with tempfile.TemporaryDirectory() as passing:
        folder = args.keep or passing
        seeds = fill(folder, args.scenes, args.seeds, options)
        for scene in args.scenes:
            show(measure(folder, scene, seeds, options))


if __name__ == "__main__":
    main()

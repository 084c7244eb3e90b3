"""Evaluates the laps of a race: errors, rates, efficiencies, whether the pictures agree."""
import math

import numpy as np


def errors(images):
    """Returns the error of one render, from the spread of several, and the same without the worst 1 % of pixels, where a few bright
    samples dominate. Both are fractions of the mean luminance. images: (renders, height, width)."""
    variance, mean = images.var(axis=0, ddof=1), images.mean()
    kept = np.sort(variance.ravel())[:max(1, int(0.99 * variance.size))]
    return math.sqrt(variance.mean()) / mean, math.sqrt(kept.mean()) / mean


def true_error(images, reference):
    """Returns the root mean square difference of renders from the reference, without the part that comes from the reference's own error."""
    squared = ((images - reference.luminance) ** 2).mean() - reference.variance.mean()
    return math.sqrt(max(squared, 0.0)) / reference.luminance.mean()


def measure(laps, reference, clock):
    images = np.stack([lap.luminance for lap in laps])
    error, trimmed = errors(images)
    seconds = float(np.median([getattr(lap, clock) for lap in laps]))
    samples = float(np.mean([lap.samples for lap in laps]))
    means = images.mean(axis=(1, 2))
    out = {"mean": np.mean([lap.mean for lap in laps], axis=0).tolist(), "luminance": float(means.mean()),
           "luminance_error": float(means.std(ddof=1) / math.sqrt(len(laps))), "error": error, "trimmed_error": trimmed,
           "samples": samples, "cpu_seconds": [lap.cpu for lap in laps], "wall_seconds": [lap.wall for lap in laps], "seconds": seconds,
           "rate": samples * images[0].size / seconds, "efficiency": 1 / (error ** 2 * seconds),
           "trimmed_efficiency": 1 / (trimmed ** 2 * seconds),
           "stated": float(np.median([lap.stated for lap in laps])) if laps[0].stated is not None else None}
    if reference:
        out["true_error"] = true_error(images, reference)
    return out


def compare(laps, reference, clock):
    """Returns each entrant's measurements, and their ratios to the better one of Mitsuba's entrants."""
    entrants = {name: measure(list_, reference, clock) for name, list_ in laps.items()}
    theirs = [e for name, e in entrants.items() if name.startswith("Mitsuba")]
    mean = sum(e["luminance"] for e in theirs) / len(theirs)
    spread = math.sqrt(sum(e["luminance_error"] ** 2 for e in theirs)) / len(theirs)
    for e in entrants.values():
        e["efficiency_ratio"] = e["efficiency"] / max(t["efficiency"] for t in theirs)
        e["trimmed_efficiency_ratio"] = e["trimmed_efficiency"] / max(t["trimmed_efficiency"] for t in theirs)
        e["rate_ratio"] = e["rate"] / theirs[0]["rate"]
        e["off"], e["off_error"] = e["luminance"] / mean - 1, math.hypot(e["luminance_error"], spread) / mean
    return entrants


def show(result):
    notes = (["diffuse"] if result["diffuse"] else []) + ([f"not translated: {', '.join(result['untranslated'])}"] if result["untranslated"] else [])
    print(f"{result['scene']}: {result['triangles']} triangles, {result['size'][0]} x {result['size'][1]}, depth {result['depth']}"
          + "".join(f", {n}" for n in notes) + (f", --error {result['target']}" if result["target"] else "") + f"; {result['clock']} seconds, Mitsuba {result['mitsuba']}")
    print(f"  {'':<24}{'samples':>8}{'error':>9}{'states':>9}{'true':>9}{'seconds':>9}{'Ms/s':>7}{'rate':>7}{'efficiency':>12}{'trimmed':>9}   mean against Mitsuba's")
    percent = lambda value: f"{100 * value:8.3g}%" if value is not None else " " * 9
    for name, e in result["entrants"].items():
        print(f"  {name:<24}{e['samples']:8.0f}{percent(e['error'])}{percent(e['stated'])}{percent(e.get('true_error'))}{e['seconds']:9.3f}"
              f"{e['rate'] / 1e6:7.2f}{e['rate_ratio']:7.2f}{e['efficiency_ratio']:12.2f}{e['trimmed_efficiency_ratio']:9.2f}"
              f"   {100 * e['off']:+.2f} % (+- {100 * e['off_error']:.2f})")

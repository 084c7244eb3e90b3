"""Lists the options of `eclat render` that the panels have, and turns settings into words of a command line. options.json describes each option;
tools/blender/make_options.py makes it from the program's own table."""
import json
import os
from typing import NamedTuple

HERE = os.path.dirname(os.path.abspath(__file__))


class Row(NamedTuple):
    option: str   # as on the command line, without dashes
    label: str
    panel: str
    kind: str     # "int", "real", "choice" or "text"
    first: object # the value in a new scene
    unset: object # the value with which the option is left out
    least: float = 0
    most: float = 2**31 - 1


ROWS = (
    Row("error", "Error (%)", "limits", "real", 0.0, 0.0, most=100),
    Row("spp", "Samples", "limits", "int", 256, 0),
    Row("time", "Time (s)", "limits", "real", 0.0, 0.0, most=1e9),
    Row("adaptive", "Adaptive", "limits", "choice", "auto", "auto"),
    Row("integrator", "Integrator", "transport", "choice", "path", "path"),
    Row("max-depth", "Max Depth", "transport", "int", 0, 0),
    Row("clamp", "Clamp", "transport", "real", 0.0, 0.0, most=1e9),
    Row("scattering", "Scattering", "transport", "choice", "single", "single"),
    Row("terminator", "Terminator", "transport", "choice", "geometric", "geometric"),
    Row("light-choice", "Light Choice", "transport", "choice", "auto", "auto"),
    Row("sample", "Directions", "transport", "choice", "mis", "mis"),
    Row("sampler", "Random Numbers", "transport", "choice", "sobol", "sobol"),
    Row("seed", "Seed", "transport", "int", 0, 0),
    Row("filter", "Pixel Filter", "picture", "choice", "box", "box"),
    Row("filter-width", "Filter Width", "picture", "real", 1.5, 1.5, 0.1, 10),
    Row("device", "Device", "device", "text", "", ""),
    Row("lanes", "Lanes", "device", "choice", "auto", "auto"),
    Row("effects", "Effects", "device", "choice", "needed", "needed"),
)
PANELS = (("limits", "When to Stop"), ("transport", "Light Transport"), ("picture", "Picture"), ("device", "Device"))


def identifier(option):
    """Returns the option's name as a property."""
    return option.replace("-", "_")


def table():
    """Returns {option: {"help", "otherwise", "choices"}} of the program that this add-on was made with."""
    with open(os.path.join(HERE, "options.json"), encoding="utf-8") as file:
        return json.load(file)


def description(entry):
    return entry["help"] + (f" (default: {entry['otherwise']})" if entry.get("otherwise") else "")


def number(value):
    """Formats with at most nine digits, which is what single precision needs."""
    return f"{value:.9g}"


def words(settings):
    """settings: {identifier: value}. Options with the program's default value are left out."""
    found = []
    for row in ROWS:
        value = settings.get(identifier(row.option), row.unset)
        if value == row.unset:
            continue
        found.append(f"--{row.option}={number(value) if row.kind == 'real' else value}")
    return found

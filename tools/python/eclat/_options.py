"""Turns options given in Python into the texts of a command line. The library says which options there are."""
from __future__ import annotations

import difflib
import numbers
import os
from collections.abc import Iterable
from decimal import Decimal
from functools import cache
from typing import Any, NamedTuple, Union

from ._error import Error
from ._library import library

Path = Union[str, "os.PathLike[str]"]


class Option(NamedTuple):
    name: str          # as on the command line
    metavar: str       # the name of the value in help; empty: it takes none
    repeats: bool
    choices: tuple[str, ...]


# Options that only make sense in a terminal, or that have a function of their own.
NOT_HERE = {
    "output": "Picture.save and the parameter html write files",
    "json": "results are Python objects",
    "quiet": "messages go to the logger 'eclat'",
    "verbose": "eclat.info says what calls for each effect",
    "frames": "Scene.render_frames renders a sequence",
    "fps": "Scene.render_frames renders a sequence",
    "overwrite": "Scene.render_frames renders a sequence",
    "orbit": "Scene.render_orbit renders a turntable",
    "out": "eclat.render_scenarios renders a file of them",
    "scenarios": "eclat.render_scenarios renders a file of them",
    "shard": "eclat.render_all and eclat.render_scenarios share work",
    "sheet": "eclat.render_all, Scene.render_frames and Scene.render_orbit make contact sheets",
    "plan": "it renders no picture; use the command `eclat render --plan`",
}


@cache
def options_of(command: str) -> dict[str, Option]:
    found: dict[str, Option] = {}
    while (row := library().eclat_option_at(command.encode(), len(found))).name:
        choices: list[str] = []
        while row.choices and row.choices[len(choices)]:
            choices.append(row.choices[len(choices)].decode())
        found[row.name.decode()] = Option(row.name.decode(), (row.metavar or b"").decode(), bool(row.repeats), tuple(choices))
    return found


def find_option(command: str, name: str, allowed: Iterable[str]) -> Option:
    known = options_of(command)
    option = known.get(name.replace("_", "-"))
    if option is not None and (option.name in allowed or option.name not in NOT_HERE):
        return option
    if option is not None:
        raise TypeError(f"{command} has no option {name} in Python: {NOT_HERE[option.name]}")
    close = difflib.get_close_matches(name, [other.replace("-", "_") for other in known], 1)
    raise TypeError(f"{command} has no option {name}" + (f"; did you mean {close[0]}?" if close else ""))


def percent(name: str, value: numbers.Real) -> str:
    """Returns a fraction in per cent, without spurious binary digits: 0.07 is 7%."""
    if not 0 < float(value) < 1:
        raise Error(f"{name}={value} is not a fraction between 0 and 1: 2 % is {name}=0.02, or {name}='2%'", "usage")
    return format(Decimal(repr(float(value))) * 100, "f") + "%"


def text_of(option: Option, value: Any) -> str | None:
    """Returns the value as the command line would have it; None: the option stands alone."""
    if value is True:
        return "on" if "on" in option.choices else None
    if value is False:
        return "off"
    if isinstance(value, numbers.Real) and option.metavar == "PCT":
        return percent(option.name, value)
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return repr(float(value))
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, Iterable):
        between = "x" if option.metavar == "WxH" else ":" if ":" in option.metavar else ","
        return between.join(text_of(option, part) or "" for part in value)
    raise TypeError(f"{option.name.replace('-', '_')} cannot be {value!r}")


def texts(command: str, options: dict[str, Any], allowed: Iterable[str] = ()) -> list[tuple[str, str | None]]:
    """Returns (name, value) of each option to set; None and switches that are off are left out. allowed: those of NOT_HERE that the caller
    handles."""
    found: list[tuple[str, str | None]] = []
    for name, value in options.items():
        option = find_option(command, name, allowed)
        if value is None or (value is False and not option.metavar):
            continue
        many = option.repeats and not isinstance(value, (str, os.PathLike))
        found += [(option.name, text_of(option, each)) for each in (value if many else [value])]
    return found

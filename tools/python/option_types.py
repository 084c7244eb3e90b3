"""Writes eclat/_option_types.py of the wheel: type hints of the options, for editors and type checkers, from the library's own table."""
from __future__ import annotations

import sys
import types
from pathlib import Path

HEAD = '''"""The options of each command, from the library's table."""
from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Literal, TypedDict, Union

Path = Union[str, "os.PathLike[str]"]
'''
# By the name of the value in help; others are numbers.
TYPES = {"WxH": "Union[tuple[int, int], str]", "X,Y,Z": "Union[Sequence[float], str]", "A:B": "Union[tuple[float, float], str]",
         "FILE|R,G,B": "Union[Path, Sequence[float]]", "NAME|FILE": "Union[Path, Sequence[float]]", "FILE": "Path",
         "NAME|INDEX": "Union[int, str]", "ID": "Union[int, str]",
         "LIST": "Union[Sequence[str], str]", "EFFECT": "Union[Sequence[str], str]"}
# (class, its base, command, options that the function has as named parameters)
NAMED = {"error", "spp", "size", "time"}
CLASSES = [("InfoOptions", "TypedDict", "info", set()), ("CostOptions", "TypedDict", "cost", {"budget"}), ("RenderOptions", "TypedDict", "render", NAMED)]


def type_of(option) -> str:  # type: ignore[no-untyped-def]
    if not option.metavar:
        return "bool"
    if not option.choices:
        return TYPES.get(option.metavar, "Union[float, str]")
    also = ["bool"] * ("on" in option.choices) + ["int"] * any(choice.isdigit() for choice in option.choices)
    choices = f"Literal[{', '.join(repr(choice) for choice in option.choices)}]"
    return f"Union[{', '.join([*also, choices])}]" if also else choices


def write(package: Path, library: Path) -> str:
    """Imports the table without the package's __init__, which needs NumPy."""
    stub = types.ModuleType("eclat")
    stub.__path__ = [str(package)]
    sys.modules["eclat"] = stub
    from eclat import _library, _options

    _library.LIBRARY = library

    def rows(command: str, names: set[str]) -> list[str]:
        return [f"    {name.replace('-', '_')}: {type_of(option)}\n" for name, option in _options.options_of(command).items() if name in names]

    text = HEAD
    for name, base, command, named in CLASSES:
        names = _options.options_of(command).keys() - _options.NOT_HERE.keys() - named
        text += f"\n\nclass {name}({base}, total=False):\n" + "".join(rows(command, names))
    text += "\n\nclass FrameOptions(RenderOptions, total=False):\n" + "".join(rows("render", NAMED | {"fps", "overwrite"}))
    return text

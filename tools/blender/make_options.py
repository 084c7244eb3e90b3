#!/usr/bin/env python3
"""usage: tools/blender/make_options.py [--check]
Writes tools/blender/eclat_blender/options.json: the program's table of options, which the add-on's panels show as help. ECLAT_LIBRARY names the
library (default: libeclat.so in the build folder). --check only says whether the file is up to date."""
import ctypes
import json
import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FILE = os.path.join(ROOT, "tools", "blender", "eclat_blender", "options.json")
TEXT, NUMBER = ctypes.c_char_p, ctypes.c_int


class Option(ctypes.Structure):
    """eclat_option of eclat/eclat.h."""
    _fields_ = [("name", TEXT), ("letter", ctypes.c_char), ("takes_value", NUMBER), ("metavar", TEXT), ("help", TEXT), ("otherwise", TEXT),
                ("choices", ctypes.POINTER(TEXT)), ("group", NUMBER), ("group_title", TEXT), ("repeats", NUMBER), ("is_borrowed", NUMBER), ("refused", TEXT)]


def choices(option):
    found = []
    while option.choices and option.choices[len(found)]:
        found.append(option.choices[len(found)].decode())
    return found


def main(arguments):
    build = os.environ.get("ECLAT_BUILD", os.path.join(ROOT, "build"))
    library = ctypes.CDLL(os.environ.get("ECLAT_LIBRARY", os.path.join(build, "libeclat.so")))
    library.eclat_option_at.restype = Option
    library.eclat_option_at.argtypes = [TEXT, ctypes.c_size_t]
    table, index = {}, 0
    while (option := library.eclat_option_at(b"render", index)).name:
        entry = {"help": option.help.decode(), "otherwise": option.otherwise and option.otherwise.decode(), "choices": choices(option)}
        table[option.name.decode()] = {key: value for key, value in entry.items() if value}
        index += 1
    text = json.dumps(table, indent=1, ensure_ascii=False, sort_keys=True) + "\n"
    if "--check" in arguments:
        with open(FILE, encoding="utf-8") as file:
            return 0 if file.read() == text else "tools/blender/eclat_blender/options.json is not what the program has; run tools/blender/make_options.py"
    with open(FILE, "w", encoding="utf-8") as file:
        file.write(text)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

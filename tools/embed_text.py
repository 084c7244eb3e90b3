#!/usr/bin/env python3
"""Writes text files as C strings: embed_text.py --header NAME.h --output FILE.c NAME=FILE...

Each becomes `const char ec_text_NAME[]`."""
import argparse

from embed_kernels import c_string, write_if_changed


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--header", required=True, help="the header that declares them, as an #include names it")
    parser.add_argument("--output", required=True)
    parser.add_argument("texts", nargs="+", metavar="NAME=FILE")
    arguments = parser.parse_args()
    parts = [f'/* Written by tools/embed_text.py; do not edit. */\n#include "{arguments.header}"\n']
    for item in arguments.texts:
        name, path = item.split("=", 1)
        with open(path, encoding="utf-8") as file:
            parts.append(f"\nconst char ec_text_{name}[] =\n{c_string(file.read())};\n")
    write_if_changed(arguments.output, "".join(parts))


if __name__ == "__main__":
    main()

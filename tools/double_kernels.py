#!/usr/bin/env python3
"""Turns tests/robust/precision/precision.cl and its includes into C in double precision (double.h beside it).

Three things differ from the kernels' text: float becomes double, except behind pointers to read-only memory, so that both versions read
the same numbers; constants lose their f; and double.h replaces the headers that work on the bits of floats (--replaced).
"""
import argparse
import os
import re
import sys

from embed_kernels import PRELUDE, EmbedError, Flattener, without_comments, write_if_changed

FLOAT = re.compile(r"\b(const(?:ant)? float (?:\*|\w+\[))|\bfloat\b")
CONSTANT = re.compile(r"(?<![\w.])((?:\d+\.\d*|\.\d+|\d+(?=[eE]))(?:[eE][+-]?\d+)?|0x[0-9a-fA-F.]+p[+-]?\d+)f\b")
KERNEL = re.compile(r"^PRECISION\((\w+)\)", re.M)


def in_double(text):
    return CONSTANT.sub(r"\1", FLOAT.sub(lambda match: match[1] or "double", text))


def table(names):
    rows = "".join(f'    {{"{name}", precision_{name}}},\n' for name in names)
    return f"\nconst ec_precision_reference ec_precision_references[] = {{\n{rows}    {{NULL, NULL}},\n}};\n"


def main():
    parser = argparse.ArgumentParser(description="Turn a kernel source into C in double precision.")
    parser.add_argument("--root", required=True, help="folder of the kernels")
    parser.add_argument("--output", required=True, metavar="FILE")
    parser.add_argument("--replaced", action="append", default=[], metavar="HEADER", help="under --root, left out")
    parser.add_argument("source")
    arguments = parser.parse_args()
    flattener = Flattener(arguments.root)
    try:
        text = flattener.unit(arguments.source, [os.path.join(flattener.root, header) for header in arguments.replaced])
    except EmbedError as error:
        sys.exit(f"double_kernels.py: {error}")
    text = in_double(without_comments(text.removeprefix(PRELUDE)))
    names = KERNEL.findall(text)
    write_if_changed(arguments.output, '/* Written by tools/double_kernels.py; do not edit. */\n#include "robust/precision/double.h"\n' +
                     text + table(names))


if __name__ == "__main__":
    main()

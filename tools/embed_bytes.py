#!/usr/bin/env python3
"""Writes a file as a C array: embed_bytes.py --name NAME --output FILE.c FILE makes `const unsigned char ec_bytes_NAME[]`."""
import argparse

from embed_kernels import write_if_changed


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--name", required=True)
    parser.add_argument("--output", required=True)
    parser.add_argument("file")
    arguments = parser.parse_args()
    with open(arguments.file, "rb") as file:
        data = file.read()
    lines = [",".join(str(byte) for byte in data[at:at + 32]) for at in range(0, len(data), 32)]
    name = f"ec_bytes_{arguments.name}"
    write_if_changed(arguments.output, "/* Written by tools/embed_bytes.py; do not edit. */\n"
                     f"extern const unsigned char {name}[];\nconst unsigned char {name}[] = {{\n" + ",\n".join(lines) + "};\n")


if __name__ == "__main__":
    main()

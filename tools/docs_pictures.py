#!/usr/bin/env python3
"""usage: tools/docs_pictures.py NAME.png...
Makes pictures of docs/images again with the commands below each of them in docs/*.md, and reduces them to 256 colours. Needs eclat in
build/ (or $ECLAT_BUILD), ImageMagick and pngquant; channels.png also needs PyPI's OpenEXR, numpy and pillow."""
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# A picture, an empty line, and the indented lines that follow.
PICTURE = re.compile(r"^!\[[^\]]*\]\(images/([\w-]+\.png)\)\n\n((?: {4}.*\n)+)", re.M)

ALL_COLOURS = {"materials.png"}  # six scenes in one: 256 colours are too few


def commands():
    """Returns {picture: its commands}, one per line."""
    return {name: [line.strip() for line in block.splitlines()] for page in sorted((ROOT / "docs").glob("*.md"))
            for name, block in PICTURE.findall(page.read_text(encoding="utf-8"))}


def make(name, lines):
    build = os.environ.get("ECLAT_BUILD", ROOT / "build")
    environment = dict(os.environ, PATH=f"{build}{os.pathsep}{os.environ['PATH']}")
    target = ROOT / "docs" / "images" / name
    subprocess.run("\n".join(["set -e", *lines]), shell=True, cwd=ROOT, env=environment, check=True)
    if name not in ALL_COLOURS:
        subprocess.run(["pngquant", "--force", "--ext", ".png", "--speed", "1", "--strip", target], check=True)
    print(f"{target}: {target.stat().st_size} bytes")


def main():
    known = commands()
    wanted = sys.argv[1:]
    if not wanted or set(wanted) - set(known):
        sys.exit(f"{__doc__}\nPictures: {' '.join(sorted(known))}")
    for name in wanted:
        if not any(f"docs/images/{name}" in line for line in known[name]):
            sys.exit(f"{name}: no command below it writes docs/images/{name}; it is made by hand")
        make(name, known[name])


if __name__ == "__main__":
    main()

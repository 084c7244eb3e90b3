#!/usr/bin/env python3
"""Packs the add-on into the zip that Blender installs."""
import argparse
import os
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.join(HERE, "eclat_blender")
LICENSE = os.path.join(HERE, "..", "..", "LICENSE")


def main():
    build = os.environ.get("ECLAT_BUILD", os.path.join(HERE, "..", "..", "build"))
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("path", nargs="?", default=os.path.normpath(os.path.join(build, "eclat_blender.zip")), metavar="FILE", help="default: eclat_blender.zip in the build folder")
    path = parser.parse_args().path
    files = sorted(name for name in os.listdir(SOURCE) if name.endswith((".py", ".json", ".toml")))
    with zipfile.ZipFile(path + ".part", "w", zipfile.ZIP_DEFLATED) as packed:
        for name, source in [(name, os.path.join(SOURCE, name)) for name in files] + [("LICENSE", LICENSE)]:
            with open(source, "rb") as file: # without its time, so that the zip always has the same bytes
                packed.writestr(zipfile.ZipInfo(name), file.read(), zipfile.ZIP_DEFLATED)
    os.replace(path + ".part", path)
    print(path)


if __name__ == "__main__":
    main()

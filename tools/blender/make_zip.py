#!/usr/bin/env python3
"""usage: tools/blender/make_zip.py [FILE.zip]
Packs the add-on as Blender installs it (default: eclat_blender.zip in the build folder)."""
import os
import sys
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.join(HERE, "eclat_blender")
LICENSE = os.path.join(HERE, "..", "..", "LICENSE")


def main(arguments):
    build = os.environ.get("ECLAT_BUILD", os.path.join(HERE, "..", "..", "build"))
    path = arguments[0] if arguments else os.path.normpath(os.path.join(build, "eclat_blender.zip"))
    files = sorted(name for name in os.listdir(SOURCE) if name.endswith((".py", ".json", ".toml")))
    with zipfile.ZipFile(path + ".part", "w", zipfile.ZIP_DEFLATED) as packed:
        for name, source in [(name, os.path.join(SOURCE, name)) for name in files] + [("LICENSE", LICENSE)]:
            with open(source, "rb") as file: # the same bytes whenever it is made
                packed.writestr(zipfile.ZipInfo(name), file.read(), zipfile.ZIP_DEFLATED)
    os.replace(path + ".part", path)
    print(path)


if __name__ == "__main__":
    main(sys.argv[1:])

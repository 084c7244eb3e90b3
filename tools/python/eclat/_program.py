"""The command `eclat`: the program in this package, with the same drivers as the package."""
import os
import sys
from pathlib import Path
from typing import NoReturn

from . import _drivers


def main() -> NoReturn:
    _drivers.announce()
    os.execv(Path(__file__).with_name("eclat"), ["eclat", *sys.argv[1:]])


if __name__ == "__main__":
    main()

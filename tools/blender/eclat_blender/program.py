"""Finds the program eclat."""
import importlib.util
import os
import shutil

from .trouble import Trouble

LOOKED = "the add-on's preferences, the environment variable ECLAT, an installed Python package eclat, and PATH"


def in_package():
    """Returns the program in the Python package eclat, if that brings one. Does not import the package."""
    found = importlib.util.find_spec("eclat")
    for folder in (found.submodule_search_locations or []) if found else []:
        for parts in (("eclat",), ("bin", "eclat"), ("_bin", "eclat")):
            path = os.path.join(folder, *parts)
            if os.path.isfile(path) and os.access(path, os.X_OK):
                return path
    return None


def find(preferred="", environment=os.environ):
    """Returns the path of the program. If a named one does not work, that is an error: no other one is tried."""
    for path, source in ((preferred, "the add-on's preferences"), (environment.get("ECLAT", ""), "the environment variable ECLAT")):
        if not path:
            continue
        found = shutil.which(os.path.expanduser(path), path=environment.get("PATH"))
        if not found:
            raise Trouble(f"'{path}' is not a program that can be run; it comes from {source}")
        return found
    found = in_package() or shutil.which("eclat", path=environment.get("PATH"))
    if not found:
        raise Trouble(f"the program eclat was not found in {LOOKED}; install it, or name it in the add-on's preferences")
    return found

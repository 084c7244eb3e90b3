# tier: quick
"""No cycles among the files of a folder of host/: each file can be read and tested after those that it calls."""
import collections
import os
import re
import shutil
import subprocess
import unittest

from support import ECLAT, Case

BUILD = os.path.dirname(os.path.abspath(ECLAT))
SOURCE = os.environ["ECLAT_SOURCE_DIR"]


OBJECT = re.compile(r"CMakeFiles/(?:room_\w+|eclat|eclat_view|eclat_mpi)\.dir/(host/([^/]+)/.+)\.o$")


def objects():
    """Returns {folder: {file: object}} of the build, without objects of deleted files."""
    rooms = collections.defaultdict(dict)
    for folder, _, names in os.walk(os.path.join(BUILD, "CMakeFiles")):
        for name in names:
            path = os.path.join(folder, name)
            found = OBJECT.search(path)
            if found and os.path.exists(os.path.join(SOURCE, found[1])):
                rooms[found[2]][found[1]] = path
    return rooms


def calls(files):
    """Returns {file: files of the same folder that define symbols that it uses}."""
    defined, used = {}, collections.defaultdict(set)
    by_object = {path: name for name, path in files.items()}
    symbols = subprocess.run(["nm", "-A", "-P", *by_object], capture_output=True, text=True, check=True).stdout
    for line in symbols.splitlines():
        path, symbol, kind = line.rsplit(": ", 1)[0], *line.rsplit(": ", 1)[1].split()[:2]
        if kind == "U":
            used[by_object[path]].add(symbol)
        elif kind in "BDRTVW":
            defined[symbol] = by_object[path]
    return {name: {defined[symbol] for symbol in used[name] if symbol in defined} - {name} for name in files}


def circle(graph):
    """Removes files that call no others, and files that none calls, until nothing changes; the rest are cycles."""
    left = set(graph)
    while True:
        called = set().union(*(graph[name] & left for name in left)) if left else set()
        loose = {name for name in left if not graph[name] & left or name not in called}
        if not loose:
            return left
        left -= loose


class Rooms(Case):
    @unittest.skipUnless(shutil.which("nm"), "nm is not there")
    def test_no_folder_has_a_circle(self):
        rooms = objects()
        self.assertGreater(len(rooms), 10)
        for room, files in sorted(rooms.items()):
            with self.subTest(room):
                left = sorted(circle(calls(files)))
                self.assertEqual(left, [], f"files of host/{room} call each other in a circle")


if __name__ == "__main__":
    unittest.main()

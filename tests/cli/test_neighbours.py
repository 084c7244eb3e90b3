# tier: quick
"""The rooms of host/: each includes and links only those that host/rooms.cmake gives it, which come before it in that file. The preview
window uses none."""
import collections
import functools
import glob
import os
import re
import subprocess
import unittest

from support import ECLAT, SOURCE

BUILD = os.path.dirname(os.path.abspath(ECLAT))
HOST = os.path.join(SOURCE, "host")
COMPILE = {"base", "cl"}  # the rooms of eclat-compile, a program of its own


def permitted():
    """Returns {room: rooms that it may use}, in the order of the list."""
    with open(os.path.join(HOST, "rooms.cmake"), encoding="utf-8") as file:
        return {name: set(rest.split()) for name, rest in re.findall(r"^eclat_room\((\w+)(.*)\)$", file.read(), re.M)}


def included():
    """Returns (room, room, where) for each include from one room in another."""
    for path in glob.glob(os.path.join(HOST, "*", "**", "*.*"), recursive=True):
        room = os.path.relpath(path, HOST).split(os.sep)[0]
        if not path.endswith((".c", ".h", ".cpp")):
            continue
        with open(path, encoding="utf-8") as file:
            for other in re.findall(r'^#include "(\w+)/', file.read(), re.M):
                yield room, other, os.path.relpath(path, HOST)


@functools.lru_cache(maxsize=None)
def symbols(room):
    """Symbols that the room's archive, with its module, defines, and those that it needs."""
    module = {"ranks": "eclat_mpi"}.get(room, "none")
    objects = glob.glob(os.path.join(BUILD, "CMakeFiles", f"{module}.dir", "host", room, "*.o"))
    return symbols_of(os.path.join(BUILD, f"libroom_{room}.a"), *objects)


def symbols_of(*files):
    text = subprocess.run(["nm", *files], capture_output=True, text=True, check=True).stdout
    rows = [line.split() for line in text.splitlines() if line]
    defined = {row[2] for row in rows if len(row) == 3 and row[1] in "TDBRC"}
    return defined, {row[1] for row in rows if len(row) == 2 and row[0] == "U"} - defined


class Rooms(unittest.TestCase):
    def test_rooms_use_only_earlier_rooms(self):
        before = set()
        for room, neighbours in permitted().items():
            self.assertLessEqual(neighbours, before, f"{room} uses a room that comes behind it")
            before.add(room)

    def test_every_folder_is_a_room(self):
        folders = {name for name in os.listdir(HOST) if glob.glob(os.path.join(HOST, name, "*.c"))}
        self.assertEqual(folders - {"cli", "compile", "view"}, set(permitted()))

    def test_includes(self):
        rooms = dict(permitted(), compile=COMPILE)
        for room, other, where in included():
            if room in rooms and other in rooms and other != room:
                self.assertIn(other, rooms[room], f"{where} includes {other}/")
            self.assertFalse(other == "cli" and room != "cli", f"{where} includes cli/")

    def test_the_window_knows_the_public_header_alone(self):
        for path in glob.glob(os.path.join(HOST, "view", "*.[ch]")):
            with open(path, encoding="utf-8") as file:
                for name in re.findall(r'^#include [<"](.+)[>"]', file.read(), re.M):
                    ours = os.path.exists(os.path.join(HOST, name)) or os.path.exists(os.path.join(HOST, "include", name))
                    self.assertTrue(not ours or name.startswith("view/") or name == "eclat/eclat.h", f"{os.path.basename(path)} includes {name}")
        if os.path.exists(os.path.join(BUILD, "eclat-view.so")):
            needs = symbols_of(os.path.join(BUILD, "eclat-view.so"))[1]
            self.assertIn("eclat_live_open", needs)
            self.assertEqual({name for name in needs if name.startswith("ec_")}, set())

    def test_the_program_knows_the_public_header_alone(self):
        """The linker enforces this too: it gets libeclat.so and no other library of ours, and that exports only the symbols of the header."""
        for path in [*glob.glob(os.path.join(HOST, "cli", "*")), os.path.join(HOST, "main.c")]:
            with open(path, encoding="utf-8") as file:
                for name in re.findall(r'^#include (?:"([^"]+)"|<eclat/(?!eclat\.h>).*>)', file.read(), re.M):
                    self.assertRegex(name, r"^cli/", path)
        program = subprocess.run(["objdump", "-p", ECLAT], capture_output=True, text=True, check=True).stdout
        self.assertEqual(re.findall(r"NEEDED +(?!ld-|libc\.|libm\.)(\S+)", program), ["libeclat.so.0"])
        self.assertRegex(program, r"RUNPATH +\$ORIGIN")

    def test_symbols(self):
        rooms = permitted()
        owner, needs = {}, collections.defaultdict(set)
        for room in rooms:
            defined, needs[room] = symbols(room)
            owner.update(dict.fromkeys((name for name in defined if name.startswith(("ec_", "eclat_"))), room))
        self.assertGreater(len(owner), 500)
        for room, names in needs.items():
            for name in names & owner.keys():
                self.assertIn(owner[name], rooms[room], f"{room} calls {name} of {owner[name]}")

    def test_every_permitted_room_is_used(self):
        used = collections.defaultdict(set)
        for room, other, _ in included():
            used[room].add(other)
        for room, neighbours in permitted().items():
            defined_of = {other: symbols(other)[0] for other in neighbours}
            needs = symbols(room)[1]
            vain = {other for other in neighbours if other not in used[room] and not needs & defined_of[other]}
            self.assertEqual(vain, set(), f"{room} need not be given them")


if __name__ == "__main__":
    unittest.main()

# tier: quick
"""The installed files: the library as another project links it, by pkg-config and by CMake; the manual's example; the program with its
modules."""
import os
import re
import shutil
import subprocess
import tempfile
import unittest

import support
from support import ECLAT, SOURCE

BUILD = os.path.dirname(os.path.abspath(ECLAT))
MANUAL = os.path.join(SOURCE, "docs", "library.md")

PROJECT = """cmake_minimum_required(VERSION 3.16)
project(example C)
find_package(eclat 0.1 REQUIRED)
add_executable(example example.c)
target_link_libraries(example PRIVATE eclat::eclat m)
"""


def find(folder, name):
    for parent, _, names in os.walk(folder):
        if name in names:
            return os.path.join(parent, name)
    raise AssertionError(f"{name} is not installed")


def example(index=0):
    with open(MANUAL, encoding="utf-8") as manual:
        return re.findall(r"```c\n(.*?)```", manual.read(), re.DOTALL)[index]


class Installed(support.Case):
    @classmethod
    def setUpClass(cls):
        cls.prefix = tempfile.mkdtemp(prefix="eclat-installed-")
        cls.addClassCleanup(shutil.rmtree, cls.prefix, ignore_errors=True)
        subprocess.run(["cmake", "--install", BUILD, "--prefix", cls.prefix], check=True, capture_output=True)
        cls.libraries = os.path.dirname(find(cls.prefix, "libeclat.so"))
        cls.environment = dict(support.ENVIRONMENT, PKG_CONFIG_PATH=os.path.dirname(find(cls.prefix, "eclat.pc")))

    def run_tool(self, *words, cwd=None, env=None):
        run = subprocess.run(words, cwd=cwd or self.folder, env=dict(self.environment, **(env or {})), capture_output=True, text=True, timeout=600)
        self.assertEqual(run.returncode, 0, " ".join(words) + run.stdout + run.stderr)
        return run.stdout

    def flags(self, *options):
        return self.run_tool("pkg-config", "--cflags", "--libs", *options, "eclat").split()

    def write_example(self):
        with open(self.path("example.c"), "w", encoding="utf-8") as file:
            file.write(example())

    def check_example(self, program, **env):
        told = self.run_tool(program, support.CORNELL, env=env)
        error, bound = map(float, re.search(r"error ([\d.]+) %, 95 % bound ([\d.]+) %", told).groups())
        self.assertLess(error, bound)
        self.assertLessEqual(bound, 5)
        self.assertGreater(os.path.getsize(self.path("example.png")), 1000)

    def test_the_example_of_the_manual(self):
        self.assertLessEqual(len(example().splitlines()), 60)
        self.write_example()
        self.run_tool("cc", "-std=c11", "-Wall", "-Wextra", "-Werror", "-o", "example", "example.c", *self.flags(), "-lm")
        self.check_example("./example", LD_LIBRARY_PATH=self.libraries)
        # The program with the same options makes the same picture.
        run = self.assert_ok(support.eclat("render", support.CORNELL, "--size", "160x120", "--error", "5%", "-o", self.path("b.exr"), "-q"))
        self.assertEqual(run.stderr, "")
        self.assertEqual(support.eclat("compare", self.path("example.exr"), self.path("b.exr"), "-q").returncode, 0)
        a, b = (support.read_exr(self.path(name))[0] for name in ("example.exr", "b.exr"))
        self.assertEqual(a["eclat.imageSha256"], b["eclat.imageSha256"])

    def test_the_live_example_of_the_manual(self):
        with open(self.path("live.c"), "w", encoding="utf-8") as file:
            file.write(example(1))
        self.run_tool("cc", "-Wall", "-Wextra", "-Werror", "-o", "live", "live.c", *self.flags())
        told = self.run_tool("./live", support.CORNELL, env={"LD_LIBRARY_PATH": self.libraries})
        self.assertIn("160 x 120 pixels", told)
        self.assertEqual(told.count("16 samples a pixel, error"), 2)  # from both sides of the comparison

    def test_by_cmake(self):
        self.write_example()
        with open(self.path("CMakeLists.txt"), "w", encoding="utf-8") as file:
            file.write(PROJECT)
        self.run_tool("cmake", "-S", ".", "-B", "build", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        self.run_tool("cmake", "--build", "build")
        self.check_example(self.path("build", "example"))

    def test_the_archive(self):
        self.write_example()
        shutil.copy(find(self.prefix, "libeclat.a"), self.path("libeclat.a"))
        needs = [flag for flag in self.flags("--static") if flag != "-leclat" and not flag.startswith("-L" + self.prefix)]
        self.run_tool("cc", "-o", "example", "example.c", "libeclat.a", *needs)
        self.check_example("./example")

    def test_the_header_is_c11_and_cxx(self):
        header = find(self.prefix, "eclat.h")
        self.run_tool("cc", "-std=c11", "-pedantic-errors", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-x", "c", header)
        self.run_tool("c++", "-std=c++11", "-pedantic-errors", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-x", "c++", header)

    def test_symbols_are_those_of_the_header(self):
        declared = set()
        for name in ("eclat.h", "live.h"):
            with open(find(self.prefix, name), encoding="utf-8") as header:
                declared |= set(re.findall(r"\b(eclat_\w+)\(", header.read()))
        symbols = self.run_tool("nm", "-D", "--defined-only", os.path.join(self.libraries, "libeclat.so"))
        self.assertEqual({line.split()[-1].split("@")[0] for line in symbols.splitlines()}, declared)
        self.assertIn("libeclat.so.0", self.run_tool("objdump", "-p", os.path.join(self.libraries, "libeclat.so")))

    def test_neither_program_nor_library_links_modules(self):
        for file in (os.path.join(self.libraries, "libeclat.so"), os.path.join(self.prefix, "bin", "eclat")):
            needs = self.run_tool("ldd", file)
            self.assertNotRegex(needs, r"libmpi|libglfw|libepoxy|libGL")

    def test_man_page_and_completion_are_those_of_the_program(self):
        program = os.path.join(self.prefix, "bin", "eclat")
        for place, words in {"man/man1/eclat.1": ["help", "--man"], "bash-completion/completions/eclat": ["completion", "bash"],
                             "fish/vendor_completions.d/eclat.fish": ["completion", "fish"],
                             "zsh/site-functions/_eclat": ["completion", "zsh"]}.items():
            with open(os.path.join(self.prefix, "share", place), encoding="utf-8") as file:
                self.assertEqual(file.read(), self.run_tool(program, *words), place)

    def test_the_program_finds_its_modules(self):
        program = os.path.join(self.prefix, "bin", "eclat")
        built = support.eclat("view", "--help").stdout
        self.assertEqual(self.run_tool(program, "view", "--help"), built)
        if os.path.exists(os.path.join(BUILD, "eclat-view.so")):
            self.assertIn("Keys and mouse", built)
            os.rename(find(self.prefix, "eclat-view.so"), self.path("away.so"))
            run = subprocess.run([program, "view", support.CORNELL], capture_output=True, text=True)
            self.assertEqual(run.returncode, 1)
            self.assertIn("install the package eclat-view", run.stderr)


if __name__ == "__main__":
    unittest.main()

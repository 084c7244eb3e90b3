# tiers: quick, full
"""The packages that cpack makes of this build, and the files that describe how to install eclat. tests/packages installs the packages on
other systems."""
import glob
import os
import re
import shutil
import subprocess
import unittest

import support
from support import ECLAT, SOURCE
from tiers import full

BUILD = os.path.dirname(os.path.abspath(ECLAT))


def read(*names):
    with open(os.path.join(SOURCE, *names), encoding="utf-8") as file:
        return file.read()


class Files(unittest.TestCase):
    def test_the_workflow_runs_the_two_commands_of_the_readme(self):
        commands = re.findall(r"^    (tools/(?:render|test)\b[^#\n]*?) *(?:#.*)?$", read("README.md").split("## Install")[1], re.M)[:2]
        self.assertEqual(len(commands), 2)
        steps = re.findall(r"^ +run: (tools/.*)$", read(".github", "workflows", "test.yml"), re.M)
        self.assertEqual(steps, commands)

    def test_the_container_takes_the_packages_that_debian_has(self):
        text = read("Containerfile")
        self.assertEqual(re.findall(r"^FROM (\S+)", text, re.M), ["debian:bookworm-slim"] * 2)
        for path in re.findall(r"\btools/[\w/-]+", text):
            self.assertTrue(os.path.exists(os.path.join(SOURCE, path)), path)
        self.assertIn("pocl-opencl-icd", text)
        self.assertIn("pocl-opencl-icd", read("tools", "packages"))

    def test_lists_for_other_systems_say_that_nobody_tried_them(self):
        for system in ("fedora", "arch", "homebrew"):
            text = read("tools", f"packages.{system}")
            self.assertIn("UNTESTED", text.split("\n\n")[0])
            names = set(re.sub(r"#.*", "", text).split())
            for part in ("cmake", "boost", "cjson", "imath", "isa-l", "jpeg", "nettle", "openexr", "libpng", "json", "zlib", "draco", "webp", "pocl",
                         "opencl-headers"):
                self.assertTrue(any(part in name for name in names), f"{system}: {part}")


def why_not(*programs):
    missing = [program for program in programs if not shutil.which(program)]
    return f"not installed: {', '.join(missing)}; tools/install-dependencies packing" if missing else None


@full
class Packages(support.Case):
    def make(self, generator):
        run = subprocess.run(["cpack", "-G", generator, "--config", os.path.join(BUILD, "CPackConfig.cmake"), "-B", self.folder], capture_output=True,
                             text=True, cwd=BUILD)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)

    @unittest.skipIf(why_not("cpack", "dpkg-shlibdeps", "file"), why_not("cpack", "dpkg-shlibdeps", "file"))
    def test_debian_packages(self):
        self.make("DEB")
        files = {os.path.basename(file).split("_")[0]: file for file in glob.glob(self.path("*.deb"))}
        modules = [name for name in ("mpi", "view") if os.path.exists(os.path.join(BUILD, f"eclat-{name}.so"))]
        self.assertEqual(set(files), {"eclat", "libeclat-dev", *(f"eclat-{name}" for name in modules)})

        def field(package, name):
            return subprocess.run(["dpkg-deb", "-f", files[package], name], capture_output=True, text=True, check=True).stdout.strip()

        self.assertEqual(field("eclat", "Recommends"), "pocl-opencl-icd | opencl-icd")
        self.assertRegex(field("eclat", "Depends"), r"libc6 .*libpng16.*")
        for package in set(files) - {"eclat"}:
            self.assertIn(f"eclat (= {field('eclat', 'Version')})", field(package, "Depends"))
        for package, library in [("eclat-mpi", "libopenmpi"), ("eclat-view", "libglfw3")]:
            if package in files:
                self.assertIn(library, field(package, "Depends"))
                self.assertNotIn(library, field("eclat", "Depends"))
        held = {name for file in files.values() for name in re.findall(r" \./(\S*[^/\s])(?: -> .*)?$", subprocess.run(
            ["dpkg-deb", "-c", file], capture_output=True, text=True, check=True).stdout, re.M)}
        for name in ("usr/bin/eclat", "usr/lib/eclat/eclat-compile", "usr/lib/libeclat.so.0", "usr/include/eclat/eclat.h", "usr/share/man/man1/eclat.1.gz",
                     "usr/share/bash-completion/completions/eclat", "usr/share/fish/vendor_completions.d/eclat.fish", "usr/share/zsh/vendor-completions/_eclat"):
            self.assertIn(name, held)
        if shutil.which("lintian"):
            run = subprocess.run(["lintian", "--fail-on", "error", *files.values()], capture_output=True, text=True)
            self.assertEqual(run.returncode, 0, run.stdout)

    @unittest.skipIf(why_not("cpack", "patchelf", "dpkg-query"), why_not("cpack", "patchelf", "dpkg-query"))
    def test_the_archive_brings_its_libraries(self):
        self.make("TGZ")
        subprocess.run(["tar", "-C", self.folder, "-xf", *glob.glob(self.path("*.tar.gz"))], check=True)
        folder, = glob.glob(self.path("eclat-*[!z]"))
        program = os.path.join(folder, "bin", "eclat")
        self.assertEqual(subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[:4],
                         support.eclat("--version").stdout.splitlines()[:4])
        for file in (program, os.path.join(folder, "lib", "eclat", "eclat-compile")):
            needs = subprocess.run(["ldd", file], capture_output=True, text=True, check=True).stdout
            for name, place in re.findall(r"^\s*(\S+) => (\S+)", needs, re.M):
                self.assertTrue(place.startswith(folder) or re.match(r"lib(c|m|dl|pthread|rt|gcc_s|stdc\+\+|z)\.so", name), f"{name} is from {place}")
        self.assertFalse(os.path.exists(os.path.join(folder, "lib", "eclat", "eclat-mpi.so")))
        self.assertIn("libpng16-16", os.listdir(os.path.join(folder, "share", "doc", "eclat", "licences")))


if __name__ == "__main__":
    unittest.main()

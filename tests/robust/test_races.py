# tier: full
"""Runs four threads that build every acceleration structure, decode pictures and compute a map's table, and a team of five sources of
batches, under ThreadSanitizer. Uses clang with its own OpenMP run-time (libomp), whose libarcher tells the sanitizer about OpenMP's
barriers and tasks. gcc's libgomp does not, and every barrier would be reported."""
import glob
import os
import re
import shutil
import subprocess
import tempfile
import unittest

from support import SOURCE

CLANG = shutil.which("clang")
TEAM = ["render/team*.c", "device/fold.c", "film/features.c", "film/film.c", "film/matte*.c", "film/parts.c", "film/pixel.c", "film/schedule.c", "film/sums.c", "film/threads.c"]


class Races(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not CLANG:
            raise unittest.SkipTest("there is no clang")
        cls.folder = tempfile.mkdtemp(prefix="eclat-races-")
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)

    def compile(self, name, files, libraries):
        program = os.path.join(self.folder, name)
        sources = [os.path.join(SOURCE, "tests", "robust", name + ".c")]
        for pattern in [*files, "base/*.c"]:
            sources += sorted(glob.glob(os.path.join(SOURCE, "host", pattern)))
        build = subprocess.run(
            [CLANG, "-std=c11", "-g", "-O1", "-fsanitize=thread", "-fopenmp", "-ffp-contract=off", "-D_POSIX_C_SOURCE=200809L",
             "-D_DEFAULT_SOURCE", "-I", os.path.join(SOURCE, "host"), "-I", os.path.join(SOURCE, "kernels"), *sources, "-o",
             program, *libraries, "-lnettle", "-lm"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8", timeout=600)
        if build.returncode:
            missing = [line for line in build.stdout.splitlines() if "libclang_rt.tsan" in line or "omp.h" in line or "-lomp" in line]
            if missing:
                raise unittest.SkipTest("clang lacks its run-time libraries: " + missing[0])
            raise AssertionError(build.stdout)
        return program

    def watch(self, *command):
        environment = dict(os.environ, TSAN_OPTIONS="ignore_noninstrumented_modules=1 exitcode=66")
        return subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              encoding="utf-8", errors="replace", timeout=600)

    @staticmethod
    def findings(text):
        """Returns reports on the program's own memory. libomp keeps records of its tasks in memory of its own, and hands the record of a
        finished task to the next by atomics that the sanitizer does not see. So the arguments of two tasks seem to race."""
        reports = re.findall(r"WARNING: ThreadSanitizer.*?(?=\n=+\n|\Z)", text, re.S)
        runtime = re.compile(r"Location is heap block .*\n *#0 malloc .*\n *#1 <null> <null> \(libomp\.")
        return [report for report in reports if not runtime.search(report)]

    def check(self, name, expected, *files, libraries=()):
        program = self.compile(name, files, libraries)
        run = self.watch(program, "race")
        self.assertEqual(run.returncode, 66, run.stdout)
        self.assertTrue(any("data race" in report and name + ".c" in report for report in self.findings(run.stdout)), run.stdout[:4000])
        run = self.watch(program)
        self.assertIn(run.returncode, [0, 66], run.stdout[:4000])
        self.assertEqual(self.findings(run.stdout)[:2], [])
        self.assertIn(expected, run.stdout)

    def test_builders(self):
        self.check("race_accel", "5 structures of 80000 triangles by 4 threads, 2 refitted", "accel/*.c")

    def test_loading(self):
        self.check("race_load", "12 of 16 pictures by 4 threads, 4 warnings, densities as by one thread", "gltf/textures.c", "scene/texture_range.c",
                   "scene/scene.c", "scene/texels.c", "scene/streams.c", "scene/contents.c", "gltf/image_decode.c", "gltf/image_check.c", "gltf/image_png.c",
                   "gltf/image_jpeg.c", "gltf/codecs/no_avif.c", "gltf/codecs/no_basisu.c", "gltf/codecs/no_webp.c", "gltf/gltf_uri.c", "gltf/gltf_tree.c",
                   "pack/environment_map.c", "pack/distribution.c", libraries=["-lpng", "-ljpeg"])

    def test_teams(self):
        self.check("race_team", "57 batches of 5 sources, 0 wrong, 2 warnings, all samples once", *TEAM)


if __name__ == "__main__":
    unittest.main()

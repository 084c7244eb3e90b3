"""ThreadSanitizer watches four threads build every acceleration structure, and five sources of batches work as a team. clang with its
own OpenMP run-time (libomp), whose libarcher tells the sanitizer of OpenMP's barriers and tasks; gcc's libgomp does not, and every
barrier would be a finding."""
import glob
import os
import shutil
import subprocess
import tempfile
import unittest

from support import SOURCE

CLANG = shutil.which("clang")


class Races(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not CLANG:
            raise unittest.SkipTest("there is no clang")
        cls.folder = tempfile.mkdtemp(prefix="eclat-races-")
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)

    def compile(self, name, *files):
        program = os.path.join(self.folder, name)
        sources = [os.path.join(SOURCE, "tests", "robust", name + ".c")]
        for pattern in [*files, "base/*.c"]:
            sources += sorted(glob.glob(os.path.join(SOURCE, "host", pattern)))
        build = subprocess.run(
            [CLANG, "-std=c11", "-g", "-O1", "-fsanitize=thread", "-fopenmp", "-ffp-contract=off", "-D_POSIX_C_SOURCE=200809L",
             "-D_DEFAULT_SOURCE", "-I", os.path.join(SOURCE, "host"), "-I", os.path.join(SOURCE, "kernels"), *sources, "-o",
             program, "-lm"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8", timeout=600)
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

    def check(self, name, expected, *files):
        program = self.compile(name, *files)
        run = self.watch(program, "race")
        self.assertEqual(run.returncode, 66, run.stdout)
        self.assertIn("WARNING: ThreadSanitizer: data race", run.stdout)
        self.assertIn(name + ".c", run.stdout)
        run = self.watch(program)
        self.assertEqual(run.returncode, 0, run.stdout[:4000])
        self.assertIn(expected, run.stdout)

    def test_builders(self):
        self.check("race_accel", "5 structures of 80000 triangles by 4 threads, 2 refitted", "accel/*.c")

    def test_teams(self):
        self.check("race_team", "57 batches of 5 sources, 0 wrong, 2 warnings, all pixels once", "pipeline/team.c")


if __name__ == "__main__":
    unittest.main()

# tier: quick
"""Effects of the system on a process: signals, small stacks, drivers that cannot be loaded, names that a terminal would interpret."""
import os
import resource
import signal
import subprocess
import unittest

from polling import GUARD, poll_writes
from support import ECLAT, ENVIRONMENT, QUICK, Case, eclat, quad_scene, write_gltf, write_exr

SMALL = ("--size", "8x8", "--spp", "2", *QUICK)


class Process(Case):
    def setUp(self):
        super().setUp()
        self.scene = write_gltf(self.path("scene.gltf"), quad_scene()[0])

    def test_signals_end_it_as_the_system_has_it(self):
        """Signals also work once a driver's compiler has installed handlers that swallow them."""
        for number in [signal.SIGQUIT, signal.SIGUSR1, signal.SIGUSR2]:
            with self.subTest(number):
                kept = self.path(f"{number}.exr")
                process = subprocess.Popen(
                    [ECLAT, "render", self.scene, "--size", "16x16", "--spp", "10000000", "-q", "--checkpoint", kept, "--every", "0.05s", *QUICK,
                     "-o", self.path("a.png")],
                    env=ENVIRONMENT, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CORE, (0, 0)))
                self.addCleanup(process.kill)
                self.assertTrue(poll_writes(kept, process))
                process.send_signal(number)
                self.assertEqual(process.wait(GUARD), -number)

    def test_signals_that_are_ignored_stay_so(self):
        def ignore():
            signal.signal(signal.SIGQUIT, signal.SIG_IGN)
        run = eclat("render", self.scene, *SMALL, "-q", "-o", self.path("a.png"), preexec_fn=ignore)
        self.assert_ok(run)

    def test_a_small_stack_suffices(self):
        """A driver's compiler needs more than 128 KiB of stack, and overruns it without a message."""
        cache = self.path("cache")  # an empty cache, so that kernels are compiled
        os.mkdir(cache)

        def shrink():
            resource.setrlimit(resource.RLIMIT_STACK, (128 << 10, 128 << 10))
        run = eclat("render", self.scene, "--size", "8x8", "--spp", "2", "--integrator", "raster", "-q", "-o", self.path("a.png"),
                    env={"XDG_CACHE_HOME": cache}, preexec_fn=shrink)
        self.assert_ok(run)

    def test_a_driver_that_cannot_load_is_named(self):
        vendors = self.path("vendors")
        os.mkdir(vendors)
        line = self.assert_one_error(eclat("devices", env={"OCL_ICD_VENDORS": vendors}), 1)
        self.assertIn("no OpenCL driver is installed", line)
        with open(os.path.join(vendors, "broken.icd"), "w") as file:
            file.write("/nonexistent/libdriver.so\n")
        for where in [vendors, os.path.join(vendors, "broken.icd")]:
            line = self.assert_one_error(eclat("devices", env={"OCL_ICD_VENDORS": where}), 1)
            self.assertIn("broken.icd' cannot be used: /nonexistent/libdriver.so: ", line)

    def test_names_reach_a_terminal_safely(self):
        """Escape sequences, line breaks, and characters that change the direction of writing."""
        bad = "x\x1b[31m\n\u202ey"
        scene = write_gltf(self.path(bad + ".gltf"), quad_scene()[0])
        exr = write_exr(self.path(bad + ".exr"), 2, 2, {name: [1.0] * 4 for name in "RGB"})
        runs = [eclat("info", scene), eclat("render", scene, *SMALL, "-o", self.path(bad + ".png")),
                eclat("render", self.path("no" + bad)), eclat("compare", exr or self.path(bad + ".exr"), self.path(bad + ".exr"))]
        self.assertEqual([run.returncode for run in runs], [0, 0, 1, 0])
        for run in runs:
            said = run.stdout + run.stderr
            self.assertIn("x?[31m??y", said)
            for character in "\x1b\u202e":
                self.assertNotIn(character, said)


if __name__ == "__main__":
    unittest.main()

# tier: full
"""Kernels that the driver has not compiled yet: a render begins with narrow ones, which compile sooner, while eclat-compile makes the fast
ones."""
import glob
import json
import os
import random
import shutil
import signal
import subprocess
import threading
import unittest

from polling import poll_until
from support import CORNELL, ECLAT, NARROW, SOURCE, Case, eclat

TRAVERSAL = ["ec_intersect_bvh2", "ec_connect_bvh2", "ec_intersect_bvh8", "ec_connect_bvh8"]
FIRST_LINE = "compiling kernels for the effects of this scene"


def children(cache):
    """Processes of eclat-compile that use this cache."""
    found = []
    for folder in glob.glob("/proc/[0-9]*"):
        try:
            with open(os.path.join(folder, "cmdline"), "rb") as file:
                is_compiler = b"eclat-compile" in file.read()
            with open(os.path.join(folder, "environ"), "rb") as file:
                is_ours = is_compiler and os.fsencode(f"XDG_CACHE_HOME={cache}") in file.read().split(b"\0")
        except OSError:
            continue
        if is_ours:
            found.append(int(os.path.basename(folder)))
    return found


class Compile(Case):
    def setUp(self):
        super().setUp()
        self.cache, self.is_refused = self.path("cache"), False
        os.mkdir(self.cache)
        self.addCleanup(self.end_children)

    def end_children(self):
        """Ends the compilers, which would write to the folder while it is removed."""
        while found := children(self.cache):
            for process in found:
                try:
                    os.kill(process, signal.SIGKILL)
                except ProcessLookupError:
                    pass

    def hurry(self):
        """Raises the priority of compilers; returns true once all have ended. Beside other work, processes of the lowest priority might
        take for ever. Only root may raise it."""
        found = children(self.cache)
        for process in found:
            try:
                os.setpriority(os.PRIO_PROCESS, process, 0)
                with open(f"/proc/{process}/autogroup", "w", encoding="ascii") as group:
                    group.write("0")
            except PermissionError:
                self.is_refused = True
            except (FileNotFoundError, ProcessLookupError):
                pass  # the system does not group sessions, or the process has ended
        return not found

    def compiled(self, kernel):
        """Counts the programs that have this kernel compiled."""
        return len(glob.glob(os.path.join(self.cache, "pocl", "**", kernel + ".so"), recursive=True))

    def render(self, *options, eclat_is=None, scene=CORNELL, spp=8, **more):
        environment = {"XDG_CACHE_HOME": self.cache, "POCL_CACHE_DIR": os.path.join(self.cache, "pocl"), "ECLAT_COMPILE": "beside", "ECLAT_KERNELS": "", **more}
        arguments = ["render", scene, "--size", "48x48", "--spp", str(spp), "--json", "-o", self.path("a.exr"), *options]
        run = self.assert_ok(eclat(*arguments, env=environment, program=eclat_is))
        return json.loads(run.stdout), run.stderr

    def skip_unless_late(self, report):
        if "Portable Computing Language" not in report["device"]["platform"]:
            self.skipTest("this driver does not compile at the first launch")

    def test_begins_with_narrow_and_later_finds_fast_kernels(self):
        first, said = self.render()
        self.skip_unless_late(first)
        self.assertIn(FIRST_LINE, said)
        self.assertEqual(first["first_kernels"], "narrow")
        self.assertEqual(first["lanes"] > 1, True)
        again, _ = self.render("--compile", "first")
        self.assertEqual((again["first_kernels"], again["image_sha256"]), ("fast", first["image_sha256"]))
        later, said = self.render()  # the kernels that the render above compiled count too
        self.assertEqual((later["first_kernels"], later["image_sha256"]), ("fast", first["image_sha256"]))
        self.assertNotIn(FIRST_LINE, said)

    def test_what_a_kernel_does_is_compiled_once(self):
        """PoCL makes an entry point and two launchers of each kernel. By default the kernel's code would be inlined into all of them."""
        if not shutil.which("nm"):
            self.skipTest("nm of binutils reads the sizes")
        for options in (("--light-paths", "1"), ("--accel", "bvh8"), ("--accel", "grid")):
            self.skip_unless_late(self.render(*options, ECLAT_COMPILE="first")[0])
        for path in glob.glob(os.path.join(self.cache, "pocl", "**", "ec_*.so"), recursive=True):
            name = os.path.basename(path)[:-len(".so")]
            lines = [line.split() for line in subprocess.run(["nm", "-S", path], capture_output=True, text=True, check=True).stdout.splitlines()]
            sizes = {words[3]: int(words[1], 16) for words in lines if len(words) == 4}
            with self.subTest(kernel=name):
                self.assertIn(f"{name}_item", sizes)
                if name not in ("ec_features", "ec_splat"):  # these two are short
                    self.assertLess(sizes[f"_pocl_kernel_{name}_workgroup"], sizes[f"{name}_item"])

    def test_fast_kernels_take_over(self):
        report, _ = self.render(spp=12000)
        self.skip_unless_late(report)
        self.assertEqual(report["first_kernels"], "narrow")
        self.assertGreater(report["fast_kernels_after_seconds"], 0)
        self.assertEqual(report["image_sha256"], self.render("--compile", "first", spp=12000)[0]["image_sha256"])

    def test_kernels_stay_where_the_device_may_round_otherwise(self):
        if "ECLAT_FAULT_SHIM" not in os.environ:
            self.skipTest("no ECLAT_FAULT_SHIM")
        self.skip_unless_late(self.render()[0])
        line = "the device does not say that it rounds division and square root correctly"
        for rounds, options, begins in ((0, (), "fast"), (0, ("--compile", "narrow"), "narrow"), (0, ("--lanes", "4"), "fast"), (1, (), "narrow")):
            with self.subTest(rounds=rounds, options=options):
                self.end_children()
                shutil.rmtree(self.cache)
                os.mkdir(self.cache)
                environment = {"LD_PRELOAD": os.environ["ECLAT_FAULT_SHIM"], "FAULT_ROUNDS": str(rounds)}
                self.assertEqual(self.render(*options, **environment)[0]["first_kernels"], begins)
                told = self.assert_ok(eclat("render", CORNELL, "--size", "48x48", "--spp", "8", "-v", "-o", self.path("a.exr"), *options,
                                            env={"XDG_CACHE_HOME": self.cache, "POCL_CACHE_DIR": os.path.join(self.cache, "pocl"), "ECLAT_COMPILE": "beside", **environment}))
                self.assertEqual(line in told.stdout, not rounds and not options)

    def end_idle(self):
        with open(self.path("idle"), encoding="ascii") as file:
            for process in file.read().split():
                os.kill(int(process), signal.SIGKILL)

    def idle_compiler(self):
        """Copies eclat beside an eclat-compile that does nothing."""
        alone = self.path("eclat")
        shutil.copy(ECLAT, alone)
        for library in glob.glob(os.path.join(os.path.dirname(ECLAT), "libeclat.so*")):
            shutil.copy(library, self.folder)
        idle = self.path("eclat-compile")
        with open(idle, "w", encoding="ascii") as script:
            script.write(f"#!/bin/sh\nsleep 600 &\necho $! >> {self.path('idle')}\n")
        os.chmod(idle, 0o755)
        self.addCleanup(self.end_idle)
        return alone

    def test_a_render_takes_part_in_compiling(self):
        """The render compiles everything itself where the other process does nothing."""
        alone = self.idle_compiler()
        report, _ = self.render(eclat_is=alone, spp=12000)
        self.skip_unless_late(report)
        self.assertEqual(report["first_kernels"], "narrow")
        self.assertGreater(report["fast_kernels_after_seconds"], 0)
        later, _ = self.render(eclat_is=alone, spp=12000)
        self.assertEqual((later["first_kernels"], later["image_sha256"]), ("fast", report["image_sha256"]))

    def test_packets_are_not_waited_for(self):
        """Fast kernels of the accelerator that takes one ray at a time are enough to take over; those of packets come later."""
        job = dict(scene=os.path.join(SOURCE, "scenes", "stadium", "stadium.gltf"), spp=8000)
        report, _ = self.render(eclat_is=self.idle_compiler(), **job)
        self.skip_unless_late(report)
        self.assertGreater(report["fast_kernels_after_seconds"], 0)
        self.assertEqual([self.compiled(kernel) for kernel in TRAVERSAL], [1, 1, 1, 1])  # bvh2 for narrow kernels, bvh8 for the fast ones
        self.assertEqual(self.render("--compile", "first", **job)[0]["image_sha256"], report["image_sha256"])
        self.assertEqual([self.compiled(kernel) for kernel in TRAVERSAL], [2, 2, 1, 1])

    def test_a_short_render_keeps_narrow_kernels(self):
        report, _ = self.render(eclat_is=self.idle_compiler(), spp=1)
        self.skip_unless_late(report)
        self.assertEqual((report["first_kernels"], report["fast_kernels_after_seconds"]), ("narrow", None))

    def test_narrow_kernels_to_the_end(self):
        """The render compiles only narrow kernels, and uses fast ones where these are already compiled."""
        report, said = self.render("--compile", "narrow", spp=64)
        self.skip_unless_late(report)
        self.assertEqual((report["first_kernels"], report["fast_kernels_after_seconds"], children(self.cache)), ("narrow", None, []))
        self.assertIn(FIRST_LINE, said)
        self.assertEqual(self.render("--compile", "first", spp=64)[0]["image_sha256"], report["image_sha256"])
        self.assertEqual(self.render("--compile", "narrow")[0]["first_kernels"], "fast")

    def test_narrow_kernels_where_the_driver_compiles_at_once(self):
        self.skip_unless_late(self.render("--compile", "narrow")[0])
        report, _ = self.render("--compile", "narrow", ECLAT_WORKAROUND="none")
        self.assertEqual(report["first_kernels"], "narrow")
        report, _ = self.render("--compile", "beside", ECLAT_WORKAROUND="none")
        self.assertEqual((report["first_kernels"], children(self.cache)), ("fast", []))

    def end_children_after(self, files):
        """Ends the compilers once `files` more files are in the cache, or none is left that compiles."""
        def count():
            return sum(len(names) for _, _, names in os.walk(self.cache))
        poll_until(lambda: children(self.cache))
        begun = count()
        poll_until(lambda: count() >= begun + files or self.hurry())
        self.end_children()

    def test_a_killed_compiler_leaves_the_cache_whole(self):
        moments = random.Random(7)
        for number in range(3):
            self.cache = self.path(f"cache{number}")
            os.mkdir(self.cache)
            files = moments.randrange(20)
            with self.subTest(files=files):
                killer = threading.Thread(target=self.end_children_after, args=(files,), daemon=True)
                killer.start()
                report, _ = self.render(spp=4000)
                self.skip_unless_late(report)
                killer.join()
                self.assertEqual(self.render("--compile", "first", spp=4000)[0]["image_sha256"], report["image_sha256"])

    def test_without_the_compiler_the_fast_ones_come_first(self):
        alone = self.path("eclat")
        shutil.copy(ECLAT, alone)
        for library in glob.glob(os.path.join(os.path.dirname(ECLAT), "libeclat.so*")):
            shutil.copy(library, self.folder)
        report, _ = self.render(eclat_is=alone)
        self.assertEqual(report["first_kernels"], "fast")

    def test_a_damaged_file_is_set_aside(self):
        whole, said = self.render(*NARROW)  # narrow ones compile soonest
        self.skip_unless_late(whole)
        for name, damage in (("ec_shade.so", b""), ("ec_shade.so", b"no library"), ("program.bc", None)):
            with self.subTest(name, damage=damage):
                paths = [path for path in glob.glob(os.path.join(self.cache, "pocl", "*", "*", "**", name), recursive=True) if "damaged" not in path]
                path = max(paths, key=os.path.getsize)
                with open(path, "rb") as file:
                    data = file.read()
                with open(path, "wb") as file:
                    file.write(data[:len(data) // 2] if damage is None else damage)
                mended, said = self.render(*NARROW)
                self.assertIn("damaged file in the driver's cache", said)
                self.assertEqual(mended["image_sha256"], whole["image_sha256"])
                self.assertNotIn("damaged", self.render(*NARROW)[1])

    def test_another_scene_finds_universal_kernels(self):
        self.skip_unless_late(self.render()[0])
        poll_until(lambda: self.hurry() or self.is_refused, pause=1)
        if self.is_refused:
            self.skipTest("only root may raise the priority of eclat-compile")
        other = ("--without", "back-face-culling", "--size", "320x240")  # the size of waves changes
        report, said = self.render(*other)
        self.assertEqual(report["first_kernels"], "universal")
        self.assertNotIn(FIRST_LINE, said)
        self.end_children()
        fast, _ = self.render(*other, "--compile", "first")
        self.assertEqual((fast["first_kernels"], fast["image_sha256"]), ("fast", report["image_sha256"]))


if __name__ == "__main__":
    unittest.main()

# tiers: quick, full, long
"""valgrind's memcheck on whole commands: no invalid access, no branch on undefined memory, no leak. The kernels that PoCL compiles run
under it too. The first run compiles them under valgrind, which takes most of the time; later runs find them in build/tests/cache-valgrind."""
import json
import os
import shutil
import unittest

import support
from hard_scene import LAMP, NORMAL, QUAD, UV, HardCase, Scene, one_pixel_png
from support import CORNELL, QUICK, SOURCE, Case
from tiers import full, long

VALGRIND = shutil.which("valgrind")
CACHE = os.path.join(os.path.dirname(os.path.abspath(support.ECLAT)), "tests", "cache-valgrind")
# One thread each for kernels and builders, since valgrind runs one at a time. memcheck does not support AVX-512 and hides it from LLVM, so
# these kernels must not mix with those of other tests.
ENVIRONMENT = dict(os.environ, XDG_CACHE_HOME=CACHE, POCL_CACHE_DIR=os.path.join(CACHE, "pocl"), POCL_MAX_PTHREAD_COUNT="1",
                   OMP_NUM_THREADS="1", OCL_ICD_VENDORS="pocl.icd", ECLAT_KERNELS="")  # other drivers are not tested


@full
@unittest.skipUnless(VALGRIND, "there is no valgrind")
class Valgrind(HardCase):
    def watch(self, code, *arguments, more=()):
        """Returns the output."""
        os.makedirs(os.path.join(CACHE, "pocl"), exist_ok=True)
        log = self.path("valgrind.log")
        command = [VALGRIND, "--leak-check=full", "--show-leak-kinds=definite", "--errors-for-leak-kinds=definite",
                   "--error-exitcode=99", "--num-callers=30", "--log-file=" + log,
                   "--suppressions=" + os.path.join(SOURCE, "tests", "robust", "valgrind.supp"), *more, support.ECLAT, *arguments]
        run = support.subprocess.run(command, env=ENVIRONMENT, cwd=self.folder, stdin=support.subprocess.DEVNULL, encoding="utf-8",
                                     stdout=support.subprocess.PIPE, stderr=support.subprocess.PIPE, timeout=1100)
        with open(log) as file:
            self.assertEqual(run.returncode, code, run.stderr + file.read()[:6000])
        return run.stdout

    def test_render_and_compare(self):
        job = ["render", CORNELL, "--size", "8x8", "--spp", "4", "--seed"]
        self.watch(0, *job, "1", "--compile", "narrow", "-o", "1.exr", "-o", "1.png")
        self.assert_ok(support.eclat(*job, "2", "-o", self.path("2.exr")))
        self.watch(0, "compare", "1.exr", "2.exr")

    @long
    def test_eight_lanes(self):
        """Full packets read nothing undefined. In three kernels, packets at the end of a queue read lanes behind it. Whether these hold
        zeros, large numbers or NaN, the picture has the bits of one lane, which test_render_and_compare shows to be clean."""
        job = ["render", CORNELL, "--seed", "1", "--spp", "1", "--json", "-q", "-o", "a.exr", "--lanes"]
        self.watch(0, *job, "8", "--size", "16x8", "--max-depth", "1")
        picture = json.loads(self.assert_ok(support.eclat(*job, "1", "--size", "16x8", cwd=self.folder)).stdout)["image_sha256"]
        lanes = "--suppressions=" + os.path.join(SOURCE, "tests", "robust", "valgrind-lanes.supp")
        for fill in ["0x00", "0x7f", "0xff"]:
            watched = self.watch(0, *job, "8", "--size", "16x8", more=(lanes, "--malloc-fill=" + fill))
            self.assertEqual(json.loads(watched)["image_sha256"], picture, fill)

    def test_info_on_every_stream_and_a_texture(self):
        material = dict(LAMP, normalTexture={"index": 0}, emissiveTexture={"index": 0})
        scene = Scene(material).texture(one_pixel_png([1, 2, 3])).add(QUAD, streams=[NORMAL, UV, ("TANGENT", 4, [1, 0, 0, 1] * 6)])
        self.watch(0, "info", scene.write(self.path("scene.gltf")))

    def test_refusals(self):
        for count, nodes in enumerate([{"children": [7]}, {"scale": [0, 0, 0]}, {"translation": [1e39, 0, 0]}]):
            path = Scene(LAMP).add(QUAD, **nodes).write(self.path(f"{count}.gltf"))
            self.watch(1, "info", path)
        self.watch(1, "compare", path, path)
        self.watch(2, "render", path, "--spp", "none")


class Fill(Case):
    """The C library fills new memory with a byte: no picture depends on it."""

    def test_the_picture_is_the_same(self):
        pictures = set()
        for byte in ["0", "1", "128", "255"]:
            run = support.eclat("render", CORNELL, "--size", "13x7", "--spp", "3", "--seed", "1", *QUICK, "--json", "-q", "-o", self.path("a.exr"),
                                env={"MALLOC_PERTURB_": byte})
            pictures.add(json.loads(self.assert_ok(run).stdout)["image_sha256"])
        self.assertEqual(len(pictures), 1)


if __name__ == "__main__":
    unittest.main()

# tiers: quick, full
"""tools/gpu_compile: registers and memory of the kernels on graphics cards, within budgets. Skips without the compilers."""
import json
import os
import subprocess
import sys
import unittest

from support import ECLAT, ENVIRONMENT, SOURCE, Case
from tiers import full

TOOL = os.path.join(SOURCE, "tools", "gpu_compile")
BUILD = os.path.dirname(os.path.abspath(ECLAT))
NVIDIA, AMD, INTEL = ("sm_75", "sm_90"), ("gfx906", "gfx1030", "gfx1100"), ("tgllp", "dg2")
NAMES = {"ec_generate", "ec_intersect_bvh2", "ec_shade", "ec_connect_bvh2", "ec_lamp_edges", "ec_accumulate", "ec_features"}

# Maximum registers of a work-item on NVIDIA's and on AMD's cards.
SHADE = {"cornell-box": (96, 96), "showcase": (128, 120), "lamps": (168, 168)}
TRACE = (80, 80)
STACK = 128  # bytes of private memory


def run(*arguments, **environment):
    return subprocess.run([sys.executable, TOOL, *arguments], env={**ENVIRONMENT, "ECLAT": ECLAT, "ECLAT_BUILD": BUILD, **environment},
                          capture_output=True, encoding="utf-8", stdin=subprocess.DEVNULL, timeout=1800, check=False)


def scene(name):
    return os.path.join(SOURCE, "scenes", name, name + ".gltf")


class Usage(Case):
    def test_what_is_wrong_is_one_line(self):
        for arguments, words in [((), "SCENE is missing"), (("--target", "sm_1", "a.gltf"), "--target sm_1: must be of sm_75, "),
                                 (("--nonsense", "a.gltf"), "--nonsense before SCENE is not an option")]:
            done = run(*arguments)
            self.assertEqual((done.returncode, done.stdout, len(done.stderr.splitlines())), (2, "", 1))
            self.assertIn(words, done.stderr)

    def test_a_target_without_a_compiler_is_left_out_and_said(self):
        done = run("--target", "sm_90", scene("cornell-box"), PATH=self.folder, ECLAT_BUILD=self.folder, ECLAT_SKIP_INSTALL="1")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("sm_90 is left out: there is no clang, and ECLAT_SKIP_INSTALL is set", done.stderr)


@full
class Budgets(Case):
    """Intel's compiler takes ten times as long as the others: it compiles one scene only."""

    def rows(self, name, *options):
        done = run("--json", *options, scene(name))
        if not done.stdout and " is left out: " in done.stderr:
            self.skipTest(done.stderr.splitlines()[-1])
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = json.loads(done.stdout)
        for row in rows:
            self.assertLessEqual({"target", "kernel", "registers", "spill_bytes", "private_bytes"}, set(row))
        for target in {row["target"] for row in rows}:
            self.assertEqual({row["kernel"] for row in rows if row["target"] == target}, NAMES, target)
        return rows

    def assert_budget(self, name, *options):
        for row in self.rows(name, *options):
            with self.subTest(target=row["target"], kernel=row["kernel"]):
                shade, is_trace = row["kernel"] == "ec_shade", row["kernel"].endswith("bvh2")
                self.assertEqual(row["spill_bytes"], 0)
                self.assertFalse(row["lane_atomics"])  # None: not known
                self.assertLessEqual(row["private_bytes"], STACK if is_trace else 0)
                most = SHADE[name] if shade else TRACE if is_trace else (64, 64)
                if row["target"] not in INTEL:  # Intel's threads have 128 each, and vary the number of work-items instead
                    self.assertLessEqual(row["registers"], most[row["target"] in AMD])

    def test_diffuse_scene(self):
        self.assert_budget("cornell-box", "--target", ",".join(NVIDIA + AMD))

    def test_showcase(self):
        self.assert_budget("showcase")

    def test_every_core_feature(self):
        self.assert_budget("lamps", "--target", ",".join(NVIDIA + AMD))


if __name__ == "__main__":
    unittest.main()

# tiers: quick, full
"""Every allocation of eclat's own fails once: one clear line and no damaged file, or the complete picture."""
import os
import unittest

from faults import FaultCase, at_once, spread
from tiers import full


class Memory(FaultCase):
    def test_some_allocation_fails(self):
        self.assert_any_fails(30)

    @full
    def test_any_allocation_fails(self):
        self.assert_any_fails(60)

    def assert_any_fails(self, most):
        count = self.count_calls()["malloc"]
        self.assertGreater(count, 50)
        with open(self.path("counted", "a.png"), "rb") as file:
            self.picture = file.read()
        ends = at_once(self.fail_once, [(n,) for n in spread(count, most)])
        self.assertGreater(ends.count("error"), 0.7 * len(ends))  # few allocations are dispensable: kernels in the cache

    def fail_once(self, n):
        run, folder = self.run_with(f"malloc{n}", call="malloc", at=n)
        with self.subTest(n=n):
            files = self.check_files(folder)
            if run.returncode == 0:
                self.assertEqual(files, {"a.exr": "new", "a.png": "new"}, run.stderr)
                with open(os.path.join(folder, "a.png"), "rb") as file:
                    self.assertEqual(file.read(), self.picture, run.stderr)
                return "done"
            self.assertEqual(run.returncode, 1, run.stderr)
            self.assertRegex(run.stderr, r"\Aeclat: error: [^\n]*(memory|allocate)[^\n]*\n\Z")
            return "error"


if __name__ == "__main__":
    unittest.main()

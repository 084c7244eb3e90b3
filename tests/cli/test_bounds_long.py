# tier: long
"""The bounds of thirteen scenes, 200 renders at each of three budgets, against long renders: tools/bench/bounds.py."""
import importlib.util
import os
import subprocess
import sys
import unittest

from support import ECLAT, SOURCE, Case

REFERENCES = os.environ.get("ECLAT_TEST_REFERENCES", os.path.join(os.path.dirname(ECLAT), "references"))  # take an hour to render; kept


@unittest.skipUnless(all(importlib.util.find_spec(name) for name in ("numpy", "OpenEXR")), "numpy and OpenEXR (PyPI) are not installed")
class Bounds(Case):
    def test_what_is_stated_holds_and_harmless_scenes_state_it(self):
        run = subprocess.run([sys.executable, os.path.join(SOURCE, "tools", "bench", "bounds.py"), "--eclat", ECLAT, "--seeds", "200", "--budgets",
                              "16,64,256", "--jobs", "2", "--references", REFERENCES], capture_output=True, text=True, check=False)
        print(run.stdout)
        self.assertEqual(run.returncode, 0, run.stderr[-2000:])


if __name__ == "__main__":
    unittest.main()

# tier: long
"""The add-on in Blender: every case of cases.py with each interpreter that BPY_PYTHONS names, separated by colons. Each interpreter has
another version of bpy:

  python3.11 -m venv b42 && b42/bin/pip install bpy==4.2.23
  BPY_PYTHONS=$PWD/b42/bin/python tools/test -R blender/test_blender"""
import os
import subprocess
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
PYTHONS = [path for path in os.environ.get("BPY_PYTHONS", "").split(":") if path]
if not PYTHONS:
    print("skipped: BPY_PYTHONS names no interpreter that has bpy")
    sys.exit(77)


class Blender(unittest.TestCase):
    def test_cases(self):
        for python in PYTHONS:
            with self.subTest(python):
                run = subprocess.run([python, os.path.join(HERE, "cases.py"), "-v"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                     stderr=subprocess.STDOUT, encoding="utf-8", errors="replace")
                print(run.stdout)
                self.assertEqual(run.returncode, 0)
                self.assertRegex(run.stdout, r"\nRan [1-9]\d* tests in")


if __name__ == "__main__":
    unittest.main()

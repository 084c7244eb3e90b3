"""Shared by the package's tests. They run in an environment that has the wheel; cli/test_python.py starts them."""
import os
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

sys.path.append(os.environ["ECLAT_TEST_HELPERS"])

import eclat
import support

CORNELL = support.CORNELL
SMALL = {"spp": 16, "size": (24, 16)}


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="eclat-python-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        warnings.simplefilter("error", eclat.Warning)
        self.addCleanup(warnings.resetwarnings)

    def program(self, *words):
        """Renders with the program of the build; returns (attributes, planes)."""
        path = str(self.folder / "program.exr")
        run = support.eclat(*words, "-q", "-o", path)
        self.assertEqual(run.returncode, 0, run.stderr)
        return support.read_exr(path)

    def error_of(self, function, *words, kind=None, **options):
        with self.assertRaises(eclat.Error) as caught:
            function(*words, **options)
        text = str(caught.exception)
        self.assertEqual(text.count("\n"), 0, text)
        if kind:
            self.assertEqual(caught.exception.kind, kind, text)
        return text

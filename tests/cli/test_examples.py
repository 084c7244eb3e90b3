# tier: full
"""The manual's examples as a reader runs them: the notebook, and the script that tests a renderer against a reference."""
import ast
import json
import os
import re
import unittest

import support
import wheel
from support import SOURCE

NOTEBOOK = os.path.join(SOURCE, "docs", "examples", "how-many-samples.ipynb")


def recipe():
    """The manual's shell blocks: one makes the reference, others test a picture."""
    with open(os.path.join(SOURCE, "docs", "scripting.md"), encoding="utf-8") as page:
        return re.findall(r"```sh\n(.*?)```", page.read().split("## Check a renderer")[1].split("\n## ")[0], re.DOTALL)


class Examples(support.Case):
    @classmethod
    def setUpClass(cls):
        cls.venv = wheel.Environment(cls)
        cls.venv.pip("install", "-q", wheel.make(cls.venv), "OpenEXR", "nbclient", "ipykernel", "matplotlib")

    def run_here(self, *words, **env):
        path = os.pathsep.join([os.path.join(self.venv.folder, "bin"), self.folder, os.environ["PATH"]])
        return wheel.run(*words, cwd=self.folder, env=wheel.outside(PATH=path, IPYTHONDIR=self.folder, MPLCONFIGDIR=self.folder, **env))

    def test_the_notebook(self):
        out = self.path("done.ipynb")
        self.assert_ok(self.run_here(self.venv.python, os.path.join(SOURCE, "tools", "docs_notebook.py"), NOTEBOOK, out, self.path("a.png")))
        self.assertGreater(support.png_size(self.path("a.png"))[0], 300)
        fresh, kept = (json.load(open(path, encoding="utf-8"))["cells"] for path in (out, NOTEBOOK))
        self.assertEqual([cell["source"] for cell in fresh], [cell["source"] for cell in kept])
        for cell in kept:  # the manual shows the result of running the notebook
            self.assertTrue(cell["cell_type"] == "markdown" or cell["execution_count"])
        answer = ast.literal_eval("".join(fresh[-1]["outputs"][0]["data"]["text/plain"]))
        best, worst = answer["forecast"]
        self.assertTrue(best <= answer["samples"] <= worst, answer)
        self.assertLess(answer["adaptive"], answer["samples"])
        self.assertLessEqual(answer["bound"], answer["target"])
        # The distance to the reference is within both errors: the noise of 96 x 96 pixels is known to a few per cent.
        self.assertLess(answer["distance"], 1.2 * answer["distance of noise"])

    def test_the_page(self):
        """Runs every block of Python unchanged."""
        os.symlink(os.path.join(SOURCE, "scenes"), self.path("scenes"))
        with open(os.path.join(SOURCE, "docs", "python.md"), encoding="utf-8") as page:
            blocks = re.findall(r"```python\n(.*?)```", page.read(), re.DOTALL)
        self.assertGreater(len(blocks), 2)
        for block in blocks:
            run = self.assert_ok(self.run_here(self.venv.python, "-c", block))
        self.assertTrue(100 <= int(re.findall(r"(\d+) spp", run.stdout)[-1]) < 1000)  # the last one stops at its limit
        self.assertTrue(os.path.exists(self.path("picture.exr")) and os.path.exists(self.path("picture.png")))

    def test_the_recipe(self):
        # This renderer does not state its noise. WRONG: options that make it wrong.
        support.stand_in_renderer(self.folder, "--replicates 1 --channels A -q $WRONG")
        os.symlink(os.path.join(SOURCE, "docs"), self.path("docs"))
        reference, check = recipe()
        self.assert_ok(self.run_here("sh", "-ec", reference))
        right = self.assert_ok(self.run_here("sh", "-ec", check))
        self.assertIn("no more different than noise makes them", right.stdout)
        # Noisier, but as right.
        self.assert_ok(self.run_here("sh", "-ec", check, WRONG="--spp 16"))
        for wrong in ("--max-depth 4", "--fov 39"):
            os.remove(self.path("difference.png"))
            run = self.run_here("sh", "-ec", check, WRONG=wrong)
            self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
            self.assertIn("they differ by more than noise", run.stdout)
            self.assertEqual(support.png_size(self.path("difference.png")), (96, 96))


if __name__ == "__main__":
    unittest.main()

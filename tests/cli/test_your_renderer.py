# tier: full
"""The manual's page for authors of renderers, as a reader runs it: wrong pictures fail, and noisy right ones pass."""
import os
import re
import shutil
import unittest

from support import ECLAT, ENVIRONMENT, SOURCE, Case, eclat, png_size, stand_in_renderer


def recipe():
    """Returns the manual's commands: one makes the reference, others test a picture with little noise or much."""
    with open(os.path.join(SOURCE, "docs", "test-your-renderer.md"), encoding="utf-8") as page:
        return re.findall(r"```sh\n(.*?)```", page.read(), re.DOTALL)


class YourRenderer(Case):
    def sh(self, script, how=""):
        if os.path.exists(self.path("difference.png")):
            os.remove(self.path("difference.png"))
        path = os.pathsep.join([self.folder, os.path.dirname(os.path.abspath(ECLAT)), ENVIRONMENT["PATH"]])
        return eclat("-ec", script, program="/bin/sh", cwd=self.folder, env={"PATH": path, "HOW": how})

    def test_the_page(self):
        stand_in_renderer(self.folder, "-q $HOW")  # HOW: options that make it right or wrong
        reference, quiet, noisy, many = recipe()
        self.assert_ok(self.sh(reference))
        right = "--spp 64 --seed 1"
        for script, how, found in (
                # The samples are the reference's, so that the picture has no noise of its own.
                (quiet, "--spp 1024 --seed 100", False), (quiet, "--spp 1024 --seed 100 --tonemap none", True),
                (quiet, "--spp 1024 --seed 100 --fov 39", True), (quiet, right, True),
                (noisy, right, False), (noisy, f"{right} --max-depth 4", True), (noisy, f"{right} --exposure 0.05", True)):
            with self.subTest(how=how):
                run = self.sh(script, how)
                self.assertEqual(run.returncode, found, run.stdout + run.stderr)
                self.assertIn("they differ" if found else "no more different than noise" if script == noisy else "equal in every pixel", run.stdout)
                self.assertEqual(png_size(self.path("difference.png")), (96, 96))
        for folder, file in ("mine", "mine.png"), ("reference", "reference.exr"):
            os.mkdir(self.path(folder))
            shutil.copy(self.path(file), self.path(folder, f"scene{file[-4:]}"))
        self.assertEqual(self.sh(many).returncode, 1)
        self.assertTrue(os.path.exists(self.path("report.html")))


if __name__ == "__main__":
    unittest.main()

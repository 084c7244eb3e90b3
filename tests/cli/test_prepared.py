# tier: quick
"""Kernels that were compiled when eclat was built: a first render begins with them and gets the same bits. Damaged ones are never used."""
import json
import os
import shutil
import unittest

from support import ECLAT, NARROW, Case, eclat, quad_scene, write_gltf

PREPARED = os.path.join(os.path.dirname(os.path.abspath(ECLAT)), "eclat-kernels")


@unittest.skipUnless(os.path.isdir(PREPARED), "no kernels were compiled when this was built: there was no device, or it compiles in time")
class Prepared(Case):
    picture = None  # the picture with the first kernels, whichever those were

    def setUp(self):
        super().setUp()
        write_gltf(self.path("quad.gltf"), quad_scene()[0])

    def assert_begun(self, begun, render):
        Prepared.picture = Prepared.picture or render[1]
        self.assertEqual(render, (begun, Prepared.picture))

    def render(self, cache, kernels, *options):
        where = {"XDG_CACHE_HOME": self.path(cache), "POCL_CACHE_DIR": self.path(cache, "pocl"), "ECLAT_KERNELS": kernels}
        run = eclat("render", "quad.gltf", "--size", "64x48", "--spp", "1", *NARROW, *options, "--json", "-q", "-o", "a.exr", cwd=self.folder, env=where)
        report = json.loads(self.assert_ok(run).stdout)
        return report["first_kernels"], report["image_sha256"]

    def files(self, folder):
        return sorted(os.path.join(where, name) for where, _, names in os.walk(folder) for name in names if name.endswith((".so", ".bc")))

    def test_without_them_a_first_render_begins_with_narrow_ones(self):
        self.assert_begun("narrow", self.render("without", ""))

    def test_a_first_render_begins_with_them(self):
        self.assert_begun("universal", self.render("with", PREPARED))
        copied = [os.path.relpath(path, self.path("with", "pocl")) for path in self.files(self.path("with", "pocl"))]
        kept = [os.path.relpath(path, os.path.join(PREPARED, "files")) for path in self.files(PREPARED)]
        self.assertTrue(copied and set(copied) < set(kept), copied)  # no kernel was compiled, and only those in use were copied

    def test_damaged_ones_are_left_alone(self):
        for kind in (".so", ".bc"):
            folder = shutil.copytree(PREPARED, self.path("damaged" + kind))
            for path in self.files(folder):
                if path.endswith(kind):
                    with open(path, "r+b") as file:
                        file.seek(1000)
                        file.write(b"damage")
            with self.subTest(kind):
                self.assert_begun("narrow", self.render("with" + kind, folder))

    def test_a_cache_that_cannot_be_written(self):
        """Then the prepared kernels cannot be used either: the scene's own are compiled."""
        os.makedirs(self.path("with", "pocl"))
        os.symlink("/proc/none", self.path("with", "eclat"))
        self.assert_begun("narrow", self.render("with", PREPARED))


if __name__ == "__main__":
    unittest.main()

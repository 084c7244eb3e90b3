"""Pictures of the package: equality with the program's bits, arrays, errors, files, notebooks, comparisons."""
import gc
import html
import os
import struct
import unittest

import numpy as np

import eclat
from package_case import CORNELL, SMALL, Case, support

VARIES = {"eclat.command", "eclat.seconds", "eclat.wave", "eclat.lanes", "capDate", "comments"}


class Bits(Case):
    def check(self, words, **options):
        """An EXR of the package equals the program's in all pixels and attributes."""
        options.setdefault("channels", "all")
        mine = self.folder / "mine.exr"
        picture = eclat.load(CORNELL).render(**options)
        picture.save(mine)
        theirs = self.program("render", CORNELL, "--channels", "all", *words)
        attributes, planes = support.read_exr(mine)
        self.assertEqual({name: struct.pack(f"{len(values)}d", *values) for name, values in planes.items()},
                         {name: struct.pack(f"{len(values)}d", *values) for name, values in theirs[1].items()})
        self.assertEqual({k: v for k, v in attributes.items() if k not in VARIES}, {k: v for k, v in theirs[0].items() if k not in VARIES})
        self.assertEqual(attributes["eclat.imageSha256"], picture.attributes["eclat.imageSha256"])
        return picture, dict(attributes["channels"]), planes

    def test_samples(self):
        picture, kinds, planes = self.check(["--size", "24x16", "--spp", "16"], **SMALL)
        self.assertEqual(set(picture.channels), set(planes))
        for name, values in planes.items():
            array = picture.channels[name]
            self.assertEqual((array.shape, array.dtype), ((16, 24), np.float32))
            if kinds[name] == support.HALF:
                array = array.astype(np.float16)
            np.testing.assert_array_equal(array.ravel(), np.array(values, array.dtype), name)

    def test_every_form_of_a_value(self):
        words = ["--size", "16x12", "--spp", "8", "--eye", "0.3,0.25,-0.7", "--look-at", "0.278,0.273,0.28", "--env", "1,0.5,0.25", "--without", "emission",
                 "--without", "back-face-culling", "--max-depth", "5", "--light-choice", "tree", "--clamp", "20", "--lanes", "4", "--adaptive=off", "--rr", "off"]
        options = {"size": "16x12", "spp": 8, "eye": np.array([0.3, 0.25, -0.7]), "look_at": [0.278, 0.273, 0.28], "env": (1, 0.5, 0.25),
                   "without": ["emission", "back-face-culling"], "max_depth": 5, "light_choice": "tree", "clamp": 20.0, "lanes": 4,
                   "adaptive": False, "rr": False, "shutter": None}
        self.check(words, **options)
        words, options = ["--size", "16x12", "--spp", "8", "--max-depth", "inf", "--exposure", "0.5"], {"size": (16, 12), "spp": 8, "max_depth": float("inf"), "exposure": 0.5}
        self.check(words, **options)

    def test_an_error_is_a_fraction(self):
        words = ["--size", "24x16", "--error", "45%", "--adaptive"]
        picture, _, _ = self.check(words, size=(24, 16), error=0.45, adaptive=True)
        self.assertLessEqual(picture.bound, 0.45)
        self.check(words, size=(24, 16), error="45%", adaptive="on")
        for wrong in (2, 1.0, 0, -0.1, float("nan")):
            self.assertIn("0.02", self.error_of(eclat.load(CORNELL).render, error=wrong, kind="usage"))


class Arrays(Case):
    @classmethod
    def setUpClass(cls):
        cls.picture = eclat.load(CORNELL).render(**SMALL)

    def test_shapes(self):
        p = self.picture
        for array in (p.radiance, p.stderr, p.intervals.low, p.intervals.high, p.layer("normal"), p.layer("albedo")):
            self.assertEqual((array.shape, array.dtype, array.flags.writeable), ((16, 24, 3), np.float32, False))
        self.assertEqual((p.width, p.height, p.alpha.shape, p.channels["depth.Z"].shape), (24, 16, (16, 24), (16, 24)))
        np.testing.assert_array_equal(np.asarray(p), p.radiance)
        with self.assertRaisesRegex(KeyError, "depth.Z"):
            p.layer("colour")

    def test_values(self):
        """The left wall is red and the right one green, four columns from the sides. Intervals contain the mean, and are wider where errors
        are."""
        p = self.picture
        left, right = p.layer("albedo")[8, 5], p.layer("albedo")[8, -6]
        self.assertGreater(left[0], 2 * left[1])
        self.assertGreater(right[1], 2 * right[0])
        self.assertTrue(np.all(p.intervals.low <= p.radiance) and np.all(p.radiance <= p.intervals.high))
        self.assertTrue(np.all((p.intervals.high - p.intervals.low > 0) | (p.stderr == 0)))
        luminance = p.radiance @ [0.2126, 0.7152, 0.0722]
        self.assertAlmostEqual(p._stated.mean_luminance, luminance.mean(), 5)

    def test_stated_error(self):
        p = self.picture
        self.assertEqual((p.error, p.bound, p.samples), (p.attributes["eclat.error"], p.attributes["eclat.errorBound"], 16))
        self.assertIsNone(p.why)
        self.assertLess(0, p.error)
        self.assertLess(p.error, p.bound)
        single = eclat.load(CORNELL).render(spp=4, size=(8, 8), replicates=1)
        self.assertEqual((single.error, single.bound, single.stderr, single.intervals), (None,) * 4)
        self.assertTrue(single.why)
        self.assertIn("not known", single.caption)

    def test_denoised(self):
        """cli/test_python provides a denoiser where there is one: the report matches the attributes, and the arrays are the channels."""
        self.assertEqual((self.picture.denoised, self.picture.best), (None, None))
        if not os.environ.get("ECLAT_OIDN"):
            self.skipTest("no Open Image Denoise")
        p = eclat.load(CORNELL).render(spp=48, size=(40, 32), denoise=True)
        for name, clean in (("denoised", p.denoised), ("best", p.best)):
            self.assertEqual(clean.error, p.attributes[f"eclat.{name}.error"])
            self.assertEqual((clean.low, clean.high), (p.attributes[f"eclat.{name}.low95"], p.attributes[f"eclat.{name}.high95"]))
            np.testing.assert_array_equal(clean.radiance, p.layer(name))
        eclat.load(CORNELL).render(spp=48, size=(40, 32), samples=(0, 48), denoise=True).save(self.folder / "slice.exr")
        merged = eclat.merge([self.folder / "slice.exr"], denoise=True)
        self.assertEqual((merged.denoised.error, merged.best.high), (p.denoised.error, p.best.high))
        few = eclat.load(CORNELL).render(spp=2, size=(8, 8), denoise="auto")
        self.assertEqual((few.denoised, few.best), (None, None))

    def test_no_bound_has_a_reason(self):
        """A lamp that samples hardly ever find: see the scene's README."""
        path = os.path.join(os.path.dirname(os.path.dirname(CORNELL)), "pinlamp", "pinlamp.gltf")
        picture = eclat.load(path).render(spp=32, size=(16, 12), light_paths=0)
        self.assertIsNone(picture.bound)
        self.assertTrue(picture.why)
        self.assertEqual(picture.caption, f"error at least {100 * picture.error:.3g} %, no bound: {picture.why}, 32 samples a pixel")
        self.assertIn(html.escape(picture.why), picture._repr_html_())

    def test_arrays_outlive_the_picture(self):
        picture = eclat.load(CORNELL).render(**SMALL)
        plane = picture.channels["R"]
        kept = plane.copy()
        del picture
        gc.collect()
        others = [eclat.load(CORNELL).render(**SMALL, seed=seed) for seed in range(3)]  # to overwrite freed memory
        np.testing.assert_array_equal(plane, kept)
        self.assertEqual(len({other.attributes["eclat.imageSha256"] for other in others}), 3)


class Files(Case):
    def test_what_cannot_be_written_leaves_nothing(self):
        picture = eclat.load(CORNELL).render(spp=1, size=(8, 8))
        for name, told in (("a.gif", "a.gif"), ("none/a.exr", "none/a.exr"), ("", "exr")):
            self.assertIn(told, self.error_of(picture.save, self.folder / name if name else ""))
        self.assertEqual(os.listdir(self.folder), [])

    def test_png(self):
        dark, light = (eclat.load(CORNELL).render(spp=4, size=(24, 16), exposure=stops) for stops in (0, 2))
        for picture in (dark, light):
            picture.save(self.folder / "a.png")
            self.assertEqual((self.folder / "a.png").read_bytes(), picture.png())
            self.assertEqual(picture._repr_png_(), picture.png())
            self.assertEqual(support.png_size(self.folder / "a.png"), (24, 16))
        self.assertNotEqual(dark.png(), light.png())

    def test_notebooks_show_the_error(self):
        picture = eclat.load(CORNELL).render(**SMALL)
        page = picture._repr_html_()
        self.assertIn("data:image/png;base64,", page)
        self.assertRegex(page, rf"<figcaption>error {100 * picture.error:.3g} % \(95 % bound {100 * picture.bound:.3g} %\), 16 samples a pixel</figcaption>")
        self.assertIn("24x16", repr(picture))

    def test_slices_become_one(self):
        scene = eclat.load(CORNELL)
        for name, samples in (("a.exr", (0, 8)), ("b.exr", "8:16")):
            scene.render(**SMALL, samples=samples).save(self.folder / name)
        merged = eclat.merge([self.folder / "b.exr", str(self.folder / "a.exr")])
        self.assertEqual(merged.attributes["eclat.imageSha256"], scene.render(**SMALL).attributes["eclat.imageSha256"])
        self.error_of(eclat.merge, [self.folder / "a.exr"])
        with self.assertWarnsRegex(eclat.Warning, "missing"):
            self.assertEqual(eclat.merge([self.folder / "a.exr"], partial=True).samples, 8)

    def test_layers_are_weighed_anew(self):
        """Without indirect light only the direct light is left; with gains of 1 the picture stays the same; a mix can be mixed again, and
        its errors are upper bounds."""
        picture = eclat.load(CORNELL).render(**SMALL, channels="default,direct,indirect")
        direct = eclat.mix(picture, {"indirect": 0})
        np.testing.assert_array_equal(direct.radiance, picture.layer("direct"))
        self.assertEqual((direct.bound, direct.samples), (None, 16))
        self.assertIn("upper bounds", direct.why)
        direct.save(self.folder / "direct.exr")
        red = eclat.mix(self.folder / "direct.exr", {"direct": (2, 0, 0.5)})
        np.testing.assert_array_equal(red.radiance, direct.radiance * np.array([2, 0, 0.5], np.float32))
        same = eclat.mix(picture, {"direct": 1.0})
        self.assertEqual(same.attributes["eclat.imageSha256"], picture.attributes["eclat.imageSha256"])
        np.testing.assert_allclose(same.error, picture.error, rtol=1e-3)
        self.error_of(eclat.mix, picture, {"direct": -1}, kind="usage")


class Compare(Case):
    def test_noise_and_more(self):
        scene = eclat.load(CORNELL)
        a, b, dim = scene.render(**SMALL), scene.render(**SMALL, seed=1), scene.render(**SMALL, seed=1, max_depth=2)
        b.save(self.folder / "b.exr")
        alike = eclat.compare(a, self.folder / "b.exr")
        self.assertFalse(alike.differ)
        self.assertGreater(alike.p, 0.01)
        self.assertEqual(alike, eclat.compare(a, b))
        self.assertLess(abs(alike.error / alike.error_of_noise - 1), 0.5)
        self.assertIn("no more than noise", str(alike))
        apart = eclat.compare(dim, b, diff=self.folder / "map.png")
        self.assertTrue(apart.differ and apart.p < 0.01)
        self.assertIn("more than noise", str(apart))
        self.assertEqual(support.png_size(self.folder / "map.png"), (24, 16))
        same = eclat.compare(a, a)
        self.assertEqual((same.error, same.psnr, same.flip, same.ssim, same.differ), (0, None, 0, 1, False))
        b.save(self.folder / "b.png")
        shown = eclat.compare(self.folder / "b.png", b, html=self.folder / "page.html")
        self.assertEqual((shown.differ, shown.report["a"]["format"], shown.report["unequal_pixels"]), (False, "8-bit PNG", 0))
        self.assertTrue(0 < shown.flip < 0.05 and (self.folder / "page.html").exists())
        self.assertTrue(eclat.compare(self.folder / "b.png", b, exposure=0.5, estimate_noise=True).differ)
        # The program says the same.
        a.save(self.folder / "a.exr")
        run = support.eclat("compare", str(self.folder / "a.exr"), str(self.folder / "b.exr"), "--json")
        self.assertEqual(run.returncode, 0)
        self.assertIn(f'"rmse":{alike.rmse!r}'[:20], run.stdout)

    def test_what_cannot_be_compared(self):
        picture = eclat.load(CORNELL).render(spp=1, size=(8, 8))
        self.assertIn("nothing.exr", self.error_of(eclat.compare, picture, self.folder / "nothing.exr"))
        self.error_of(eclat.compare, picture, eclat.load(CORNELL).render(spp=1, size=(9, 8)))
        bare = eclat.load(CORNELL).render(**SMALL, channels=["normal"])
        self.assertIn("stderr", self.error_of(eclat.compare, eclat.load(CORNELL).render(**SMALL), bare, kind="usage"))


if __name__ == "__main__":
    unittest.main()

# tiers: quick, full
"""eclat compare with pictures for a screen: PNG, JPEG and WebP against EXR, masks, alpha, exposures, and noise that no file states."""
import base64
import json
import math
import os
import random
import re
import struct
import unittest
import zlib

from support import CORNELL, Case, eclat, write_exr
from tiers import full

W, H = 24, 16
# Pictures of one grey, 188 of 255, made by Pillow.
GREY = {  # the lossy WebP loses one step
    "grey.jpg": "/9j/4AAQSkZJRgABAQAAAQABAAD/2wBDAAIBAQEBAQIBAQECAgICAgQDAgICAgUEBAMEBgUGBgYFBgYGBwkIBgcJBwYGCAsICQoKCgoKBggLDAsKDAkKCgr/wAALCAAQ"
                "ABgBAREA/8QAFQABAQAAAAAAAAAAAAAAAAAAAAj/xAAUEAEAAAAAAAAAAAAAAAAAAAAA/9oACAEBAAA/ALwAB//Z",
    "grey.webp": "UklGRjAAAABXRUJQVlA4ICQAAACwAgCdASoYABAAPm0skUWkIqGYBABABsS0gAA9kAAA/vDvgAA=",
    "kept.webp": "UklGRh4AAABXRUJQVlA4TBEAAAAvF8ADAAdQ3vKWt/+BiOh/AAA=",
}


def encode(linear):
    """The sRGB transfer function (IEC 61966-2-1)."""
    x = min(max(linear, 0), 1)
    return 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055


def decode(encoded):
    return encoded / 12.92 if encoded <= 0.04045 else ((encoded + 0.055) / 1.055) ** 2.4


def write_png(path, width, height, pixels, bits=8):
    """Rows of whole numbers, three or four a pixel."""
    channels, code = len(pixels[0]), "B" if bits == 8 else "H"
    rows = b"".join(b"\0" + struct.pack(f">{width * channels}{code}", *(v for p in pixels[y * width:(y + 1) * width] for v in p)) for y in range(height))
    chunk = lambda name, data: struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, {3: 2, 4: 6}[channels], 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
    return path


class Pictures(Case):
    def compare(self, *arguments, code=0):
        run = eclat("compare", *arguments, "--json", cwd=self.folder)
        self.assertEqual(run.returncode, code, run.stderr + run.stdout)
        return json.loads(run.stdout)

    def ramp(self, factor=1.0):
        return [[factor * (0.02 + 0.03 * (i % W)) * (1 - 0.2 * c) for c in range(3)] for i in range(W * H)]

    def exr(self, name, pixels, error=0, seed=1):
        """error: the relative noise that the file states."""
        noise = random.Random(seed)
        planes = {c: [p[k] * (1 + error * noise.gauss(0, 1)) for p in pixels] for k, c in enumerate("RGB")}
        if error:
            planes.update({f"stderr.{c}": [error * p[k] for p in pixels] for k, c in enumerate("RGB")})
        return write_exr(self.path(name), W, H, planes)

    def png(self, name, pixels, bits=8, alpha=None, off=0):
        most = 2 ** bits - 1
        stored = [tuple(min(max(round(most * encode(v)) + off, 0), most) for v in p) + (() if alpha is None else (alpha[i],)) for i, p in enumerate(pixels)]
        return write_png(self.path(name), W, H, stored, bits)

    def greys(self):
        for name, text in GREY.items():
            with open(self.path(name), "wb") as file:
                file.write(base64.b64decode(text))
        return self.exr("grey.exr", [[decode(188 / 255)] * 3] * (W * H))


class Formats(Pictures):
    def test_eight_and_sixteen_bits_are_equal_within_their_steps(self):
        exr = self.exr("b.exr", self.ramp())
        for bits in 8, 16:
            report = self.compare(self.png("a.png", self.ramp(), bits), exr, "--tonemap", "none")
            self.assertEqual([report["a"]["format"], report["b"]["format"], report["unequal_pixels"], report["space"]], [f"{bits}-bit PNG", None, 0, "srgb"])
            self.assertEqual([report["flip"] < 0.02, report["ssim"] > 0.999], [True, True])
            self.compare(exr, self.path("a.png"), "--tonemap", "none")
            self.assertEqual(self.compare(self.png("off.png", self.ramp(), bits, off=2), exr, "--tonemap", "none", code=1)["unequal_pixels"], W * H)

    def test_jpeg_and_webp(self):
        exr = self.greys()
        for name, said, lost in ("grey.jpg", "JPEG", 0), ("grey.webp", "WebP", 1), ("kept.webp", "lossless WebP", 0):
            self.assertEqual(self.compare(name, exr, "--tonemap", "none", code=lost)["a"]["format"], said)
        bright = self.exr("bright.exr", [[0.9] * 3] * (W * H))
        run = eclat("compare", "grey.jpg", bright, cwd=self.folder)
        self.assertRegex(run.stdout, r"(?m)^lossy +A is a JPEG, whose losses are differences too; save a PNG$")
        self.assertNotIn("lossy  ", eclat("compare", "kept.webp", bright, cwd=self.folder).stdout)

    def test_figures_of_what_is_shown(self):
        a, b = self.png("a.png", [[0.2] * 3] * (W * H)), self.exr("b.exr", [[0.5] * 3] * (W * H))
        report = self.compare(a, b, "--tonemap", "none", "--exposure", "-1", code=1)
        x, y = round(255 * encode(0.2)) / 255, encode(0.25)
        for key, value in ("rmse", y - x), ("error", (y - x) / y), ("psnr", -20 * math.log10(y - x)), ("exposure", -1):
            self.assertAlmostEqual(report[key], value, delta=1e-5 * abs(value))
        run = eclat("compare", a, b, cwd=self.folder)
        self.assertRegex(run.stdout, r"(?m)^compared +sRGB values from 0 to 1, B through the tone curve neutral$")
        self.assertRegex(run.stdout, r"(?m)^seen +FLIP 0\.\d+, SSIM 0\.\d+$")

    def test_linear_pictures_are_shown_on_request(self):
        a, b = self.exr("a.exr", self.ramp()), self.exr("b.exr", self.ramp(1.1))
        self.assertEqual([self.compare(a, b, code=1)["space"], self.compare(a, b, "--tonemap", "none", code=1)["space"]], ["linear", "srgb"])
        self.assertRegex(eclat("compare", a, b).stdout, r"(?m)^seen .*, through the tone curve neutral$")


class Noise(Pictures):
    def test_the_reference_s_noise_goes_through_the_curve(self):
        """A right picture passes whatever the noise. One that is 2 % too dark is found while there are enough pixels."""
        right, dark = self.png("right.png", self.ramp()), self.png("dark.png", self.ramp(0.9))
        for seed in range(5):
            b = self.exr("b.exr", self.ramp(), error=0.05, seed=seed)
            self.assertGreater(self.compare(right, b, "--tonemap", "none")["noise_test"]["p"], 0.01)
            self.compare(dark, b, "--tonemap", "none", code=1)

    def test_much_noise_is_cautioned_of(self):
        a = self.png("a.png", self.ramp(0.2))
        for error, bent in (0.3, False), (0.8, True):
            b = self.exr("b.exr", self.ramp(), error=error)
            self.assertEqual(self.compare(a, b, code=1)["noise_bent"], bent)
            self.assertEqual("caution   tone curves bend noise of more than 40 %" in eclat("compare", a, b).stdout, bent)

    def test_rounding_of_a_whole_surface_is_no_difference(self):
        grey = [[decode(100.45 / 255)] * 3] * (W * H)  # half a step away from a value of 8 bits, many standard errors of the mean
        b = self.exr("b.exr", grey, error=1e-3)
        self.compare(self.png("a.png", grey), b, "--tonemap", "none")
        self.compare(self.png("off.png", grey, off=2), b, "--tonemap", "none", code=1)

    def test_noise_of_a_picture_is_estimated_on_request(self):
        b, noise = self.exr("b.exr", self.ramp(), error=0.005), random.Random(3)
        noisy = lambda factor: [[v * factor * (1 + 0.1 * noise.gauss(0, 1)) for v in p] for p in self.ramp()]
        a = self.png("a.png", noisy(1))
        self.compare(a, b, "--tonemap", "none", code=1)
        report = self.compare(a, b, "--tonemap", "none", "--estimate-noise")
        self.assertEqual([report["noise_estimated"], report["a"]["standard_errors"]], [True, True])
        self.assertAlmostEqual(report["error_of_noise"] / report["error"], 1, delta=0.2)
        self.compare(self.png("dark.png", noisy(0.9)), b, "--tonemap", "none", "--estimate-noise", code=1)
        self.assertIn("standard errors of A estimated from how its difference varies between neighbouring pixels",
                      eclat("compare", a, b, "--estimate-noise").stdout)

    @full
    def test_renders(self):
        run = lambda *words: self.assert_ok(eclat("render", CORNELL, "-q", "--size", "64x64", *words, cwd=self.folder))
        run("--spp", "1024", "--seed", "100", "-o", "b.exr", "-o", "same.png")
        run("--spp", "64", "-o", "noisy.png")
        run("--spp", "64", "--max-depth", "4", "-o", "wrong.png")
        self.compare("same.png", "b.exr")
        for curve in "aces", "agx", "filmic", "none":
            run("--spp", "1024", "--seed", "100", "--tonemap", curve, "-o", f"{curve}.png")
            self.assertEqual(self.compare(f"{curve}.png", "b.exr", "--tonemap", curve)["unequal_pixels"], 0)
            self.compare(f"{curve}.png", "b.exr", code=1)
        self.compare("noisy.png", "b.exr", "--estimate-noise")
        self.compare("wrong.png", "b.exr", "--estimate-noise", code=1)


class Parts(Pictures):
    def test_pixels_that_are_not_opaque_are_left_out(self):
        pixels, alpha = self.ramp(), [255 if i % W < W // 2 else 100 for i in range(W * H)]
        changed = [p if alpha[i] == 255 else [1, 0, 0] for i, p in enumerate(pixels)]
        report = self.compare(self.png("a.png", changed, alpha=alpha), self.exr("b.exr", pixels), "--tonemap", "none")
        self.assertEqual(report["compared_pixels"], W * H // 2)
        self.compare(self.png("opaque.png", changed), "b.exr", "--tonemap", "none", code=1)

    def test_masks(self):
        pixels = self.ramp()
        changed = [[0.9] * 3 if i == 100 else p for i, p in enumerate(pixels)]
        a, b = self.exr("a.exr", changed, error=1e-3), self.exr("b.exr", pixels, error=1e-3, seed=2)
        mask = self.png("mask.png", [[0] * 3 if i == 100 else [1] * 3 for i in range(W * H)])
        self.compare(a, b, code=1)
        report = self.compare(a, b, "--mask", mask)
        self.assertEqual(report["compared_pixels"], W * H - 1)
        self.assertLess(report["flip"], 0.01)
        self.assertRegex(eclat("compare", a, b, "--mask", mask).stdout, rf"(?m)^mask +{W * H - 1} of {W * H} pixels count, 99.7 %$")

    def test_exposure_is_fitted_and_said(self):
        a = self.png("a.png", self.ramp(), bits=16)
        b = self.exr("b.exr", self.ramp(2 ** -1.5))
        self.compare(a, b, "--tonemap", "none", code=1)
        report = self.compare(a, b, "--tonemap", "none", "--fit-exposure")
        self.assertAlmostEqual(report["exposure"], 1.5, delta=1e-3)
        self.assertEqual(report["exposure_fitted"], "B")
        self.compare(self.png("a8.png", self.ramp()), b, "--tonemap", "none", "--fit-exposure")
        self.assertIn("at exposure +1.5, fitted", eclat("compare", a, b, "--tonemap", "none", "--fit-exposure").stdout)
        linear = self.compare(b, self.exr("c.exr", self.ramp()), "--fit-exposure")
        self.assertEqual([linear["exposure_fitted"], linear["space"], round(linear["exposure"], 2)], ["A", "linear", 1.5])
        self.assertLess(linear["error"], 1e-3)


class Several(Pictures):
    def fill(self):
        os.makedirs(self.path("mine"))
        os.makedirs(self.path("theirs"))
        for name, factor in ("one", 1), ("two", 0.5), ("alone", 1):
            self.png(f"mine/{name}.png", self.ramp(factor))
        for name in "one", "two":
            self.exr(f"theirs/{name}.exr", self.ramp())
            self.png(f"theirs/{name}.png", self.ramp(0.1))  # an EXR is preferred

    def test_each_with_the_last_or_folder_with_folder(self):
        self.fill()
        run = eclat("compare", "mine", "theirs", "--tonemap", "none", "--json", cwd=self.folder)
        self.assertEqual([(r["a"]["path"], r["b"]["path"], r["differ"]) for r in json.loads(run.stdout)],
                         [("mine/one.png", "theirs/one.exr", False), ("mine/two.png", "theirs/two.exr", True)])
        self.assertIn("1 picture of 'mine' has no counterpart in 'theirs'", run.stderr)
        self.assertEqual(run.returncode, 1)
        run = eclat("compare", "mine/one.png", "mine/alone.png", "theirs/one.exr", "--tonemap", "none", cwd=self.folder)
        self.assertEqual([run.returncode, len(re.findall("(?m)^verdict ", run.stdout)), run.stdout.splitlines()[-1]], [0, 2, "all       0 of 2 differ"])

    def test_a_page_is_written_whole_or_not_at_all(self):
        self.fill()
        run = eclat("compare", "mine/one.png", "mine/two.png", "theirs/one.exr", "--html", "out.html", cwd=self.folder)
        self.assertEqual([run.returncode, run.stdout.splitlines()[-1]], [1, "page      out.html"])
        with open(self.path("out.html"), encoding="utf-8") as file:
            text = file.read()
        self.assertEqual([len(re.findall("data:image/png;base64,", text)), re.findall(r"@[A-Z]+@|https?://", text)], [8, []])
        with open(self.path("mine/broken.png"), "w") as file:
            file.write("none")
        eclat("compare", "mine/one.png", "mine/broken.png", "theirs/one.exr", "--html", "other.html", cwd=self.folder)
        self.assertFalse(os.path.exists(self.path("other.html")))


class Unusable(Pictures):
    def refused(self, *arguments, says):
        self.assertIn(says, self.assert_one_error(eclat("compare", *arguments, cwd=self.folder), 1))

    def test_one_line_says_why(self):
        exr, png = self.exr("b.exr", self.ramp()), self.png("a.png", self.ramp())
        with open(png, "rb") as whole, open(self.path("cut.png"), "wb") as cut:
            cut.write(whole.read()[:-40])
        self.refused("cut.png", exr, says="cannot read 'cut.png'")
        self.refused("none.png", exr, says="cannot open 'none.png'")
        self.refused(png, self.path("a.png"), "--fit-exposure", says="are both pictures for a screen; leave --fit-exposure out")
        self.refused(png, exr, "--mask", write_png(self.path("small.png"), 1, 1, [(255, 255, 255)]), says="1x1 pixels against 24x16")
        self.refused(png, exr, "--mask", self.png("black.png", [[0] * 3] * (W * H)), says="no pixel is left by the mask (white is compared)")
        self.refused(self.png("glass.png", self.ramp(), alpha=[0] * (W * H)), exr, says="no pixel is left that is opaque")
        self.refused(png, exr, "--mask", "black.png", "--diff", "black.png", says="one of the pictures compared")
        self.refused(png, exr, "--html", "no/out.html", says="cannot write 'no/out.html'")
        os.link(png, self.path("out.html"))
        self.refused(png, exr, "--html", "out.html", says="one of the pictures compared; give --html another name")
        os.makedirs(self.path("empty"))
        self.refused("empty", "empty", says="nothing to compare: no picture in 'empty' has the name of one in 'empty'")
        self.refused(png, "empty", says="cannot read 'empty': it is a folder")
        self.assertIn("--diff is the map of one pair; --html shows those of 2", self.assert_one_error(eclat("compare", png, png, exr, "--diff", "d.png", cwd=self.folder), 2))


if __name__ == "__main__":
    unittest.main()

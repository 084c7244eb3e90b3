# tier: quick
"""--background and files for the screen: PNG of 8 and 16 bits with alpha, JPEG, HDR."""
import json
import math
import os
import shutil
import subprocess
import unittest

from screen import read_png, shown
from support import QUICK, Case, eclat, quad_scene, read_exr, write_gltf

W, H = 24, 16
GREY = {"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0.5, 0.5, 0.5, 1]}}
OPTIONS = (*QUICK, "--size", f"{W}x{H}", "--env", "0.8,0.6,0.4")


def radiance(path):
    """Returns rows of (R, G, B) of a run-length encoded .hdr."""
    with open(path, "rb") as file:
        head, data = file.read().split(b"\n\n", 1)
    assert head.startswith(b"#?RADIANCE"), head
    size, data = data.split(b"\n", 1)
    height, width = int(size.split()[1]), int(size.split()[3])
    at, rows = 0, []
    for _ in range(height):
        assert data[at:at + 4] == bytes([2, 2, width >> 8, width & 255])
        at += 4
        line = bytearray()
        while len(line) < 4 * width:
            count = data[at]
            run = [data[at + 1]] * (count - 128) if count > 128 else data[at + 1:at + 1 + count]
            line += bytes(run)
            at += 2 if count > 128 else 1 + count
        rows.append([tuple(line[c * width + x] * 2.0 ** (line[3 * width + x] - 136) for c in range(3)) for x in range(width)])
    assert at == len(data)
    return rows


class Background(Case):
    def setUp(self):
        super().setUp()
        scene = quad_scene(material=GREY)[0]
        scene["cameras"][0]["perspective"]["yfov"] = 0.97  # the quad's edges lie within pixels
        self.scene = write_gltf(self.path("scene.gltf"), scene)

    def render(self, *names, options=(), background=None):
        outputs = [word for name in names for word in ("-o", self.path(name))]
        chosen = ["--background", background] if background else []
        run = self.assert_ok(eclat("render", self.scene, *OPTIONS, "--spp", "64", "--seed", "2", *chosen, *options, "--json", *outputs))
        return json.loads(run.stdout)

    def pixels(self, name):
        planes = read_exr(self.path(name))[1]
        return list(zip(planes["R"], planes["G"], planes["B"])), planes["A"]

    def test_transparent_is_alpha_and_the_light_is_the_same(self):
        for integrator in ["path", "whitted", "raster"]:
            options = ("--integrator", integrator)
            self.assertEqual(self.render("env.exr", options=options)["background"], "env")
            report = self.render("clear.exr", "clear.png", background="transparent", options=options)
            self.assertEqual(report["background"], "transparent")
            (seen, _), (clear, alpha) = self.pixels("env.exr"), self.pixels("clear.exr")
            self.assertTrue({0.0, 1.0} < set(alpha) and any(0 < a < 1 for a in alpha))
            for c, e, a in zip(clear, seen, alpha):
                if a in (0, 1):
                    self.assertEqual(c, (0, 0, 0) if a == 0 else e)
                else:  # colour and alpha come from the same samples: a pixel's uncovered part is environment
                    for k, env in enumerate([0.8, 0.6, 0.4]):
                        self.assertAlmostEqual(c[k] + (1 - a) * env, e[k], delta=2e-3)
            width, height, channels, bits, rows = read_png(self.path("clear.png"))
            self.assertEqual((width, height, channels, bits), (W, H, 4, 8))
            for i, (c, a) in enumerate(zip(clear, alpha)):
                there = rows[i // W][i % W * 4:i % W * 4 + 4]
                self.assertLessEqual(abs(there[3] - 255 * a), 0.6)
                # the PNG's colours are not multiplied by alpha
                for k, x in enumerate(shown("neutral", [v / a for v in c]) if a else (0, 0, 0)):
                    self.assertLessEqual(abs(there[k] - 255 * x), 1)

    def test_a_colour_is_what_the_screen_shows(self):
        """A background colour is composited after the tone curve and the exposure, in linear light."""
        for word, rgb in [("white", (255, 255, 255)), ("3366cc", (0x33, 0x66, 0xcc)), ("#000000", (0, 0, 0))]:
            self.render("on.exr", "on.png", background=word, options=("--exposure", "-1", "--tonemap", "agx"))
            clear, alpha = self.pixels("on.exr")
            rows = read_png(self.path("on.png"))[4]
            self.assertEqual(rows[0][:3], rgb)
            to_linear = lambda s: s / 12.92 if s <= 0.04045 else ((s + 0.055) / 1.055) ** 2.4  # noqa: E731
            for i, (c, a) in enumerate(zip(clear, alpha)):
                front = [to_linear(x) for x in shown("agx", [v / a for v in c], -1)] if a else (0, 0, 0)
                for k in range(3):
                    value = a * front[k] + (1 - a) * to_linear(rgb[k] / 255)
                    srgb = 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
                    self.assertLessEqual(abs(rows[i // W][i % W * 3 + k] - 255 * srgb), 1)

    def test_a_blurred_environment_is_what_the_screen_shows(self):
        """The environment has radiance 1 + n.d. Its blur by a von Mises-Fisher distribution is 1 + (coth k - 1 / k) n.d, k = 1 / R^2
        (Mardia and Jupp, 9.3.9)."""
        turn, n, width, height = math.radians(40), (0.6, 0.3, 0.5), 256, 128
        at = lambda d: 1 + sum(a * b for a, b in zip(n, d))  # noqa: E731
        data = bytearray()
        for y in range(height):
            for x in range(width):
                phi, theta = 2 * math.pi * ((x + 0.5) / width - 0.5), math.pi * (y + 0.5) / height
                value = at((math.cos(phi) * math.sin(theta), math.cos(theta), math.sin(phi) * math.sin(theta)))
                data += bytes([min(255, round(value * 128))] * 3 + [129])
        with open(self.path("map.hdr"), "wb") as file:
            file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width) + data)
        options = ("--env", self.path("map.hdr"), "--env-rotate", "40", "--tonemap", "none", "--exposure", "-1", "--png-depth", "16")
        for degrees in (20, 50):
            self.assertEqual(self.render("blur.exr", "blur.png", background=f"blur:{degrees}", options=options)["background"], f"blur:{degrees}")
            kappa = 1 / math.radians(degrees) ** 2
            share = 1 / math.tanh(kappa) - 1 / kappa
            clear, alpha = self.pixels("blur.exr")
            rows, tall = read_png(self.path("blur.png"))[4], math.tan(0.97 / 2)
            for i, (c, a) in enumerate(zip(clear, alpha)):
                d = ((2 * (i % W + 0.5) / W - 1) * tall * W / H, (1 - 2 * (i // W + 0.5) / H) * tall, -1)
                norm = math.sqrt(sum(k * k for k in d))
                turned = (math.cos(turn) * d[0] - math.sin(turn) * d[2], d[1], math.sin(turn) * d[0] + math.cos(turn) * d[2])
                far = 1 + share * (at([k / norm for k in turned]) - 1)
                for k in range(3):
                    value = min(1, 0.5 * (c[k] + (1 - a) * far))
                    srgb = 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
                    self.assertAlmostEqual(rows[i // W][i % W * 3 + k] / 65535, srgb, delta=4e-3)
        self.render("env.png"), self.render("alike.png", background="blur")  # this environment has one colour
        for a, b in zip(read_png(self.path("env.png"))[4], read_png(self.path("alike.png"))[4]):
            self.assertLessEqual(max(abs(x - y) for x, y in zip(a, b)), 2)

    def test_alpha_is_of_all_samples(self):
        """With 512 samples a pixel, an edge's alpha is no multiple of 1/64, and a pixel's uncovered part is environment."""
        options = ("--spp", "512")
        self.render("env.exr", options=options)
        self.render("clear.exr", background="transparent", options=options)
        (seen, _), (clear, alpha) = self.pixels("env.exr"), self.pixels("clear.exr")
        edges = [(c, e, a) for c, e, a in zip(clear, seen, alpha) if 0.05 < a < 0.95]
        self.assertTrue(any(abs(64 * a - round(64 * a)) > 0.1 for _, _, a in edges))
        for c, e, a in edges:
            self.assertAlmostEqual(c[0] + (1 - a) * 0.8, e[0], delta=1e-3)
        self.render("adaptive.exr", background="transparent", options=(*options, "--adaptive"))  # the pilot has 32
        alpha = self.pixels("adaptive.exr")[1]
        self.assertTrue(any(abs(64 * a - round(64 * a)) > 0.1 for a in alpha))

    def test_sixteen_bits(self):
        self.render("a.exr", "a.png", options=("--png-depth", "16", "--tonemap", "aces"))
        width, height, channels, bits, rows = read_png(self.path("a.png"))
        self.assertEqual((width, height, channels, bits), (W, H, 3, 16))
        for i, c in enumerate(self.pixels("a.exr")[0]):
            for k, x in enumerate(shown("aces", c)):
                self.assertLessEqual(abs(rows[i // W][i % W * 3 + k] - 65535 * x), 2)
        self.render("b.png", background="transparent", options=("--png-depth", "16"))
        self.assertEqual(read_png(self.path("b.png"))[2:4], (4, 16))

    def test_jpeg_is_the_png_but_for_its_losses(self):
        self.render("a.png", "a.jpg", "b.JPEG", background="white")
        rows = read_png(self.path("a.png"))[4]
        with open(self.path("a.jpg"), "rb") as a, open(self.path("b.JPEG"), "rb") as b:
            data = a.read()
            self.assertEqual(data, b.read())
        self.assertTrue(data.startswith(b"\xff\xd8\xff") and data.endswith(b"\xff\xd9"))
        try:
            raw = subprocess.run(["convert", self.path("a.jpg"), "-depth", "8", "rgb:-"], capture_output=True, check=True).stdout
        except FileNotFoundError:
            self.skipTest("no convert of ImageMagick's")
        difference = [abs(a - b) for a, b in zip(raw, [v for row in rows for v in row])]
        self.assertEqual(len(raw), 3 * W * H)
        self.assertLess(sum(difference) / len(difference), 3)

    def test_avif_and_jxl_are_the_png(self):
        """A build without the library refuses, and names the library."""
        decoders = {"avif": ("avifdec", lambda a, b: ("avifdec", a, b)), "jxl": ("djxl", lambda a, b: ("djxl", a, b))}
        built = {}
        for name in decoders:
            run = eclat("render", self.scene, *OPTIONS, "--spp", "8", "--background", "transparent", "-q", "-o", self.path(f"a.{name}"), "-o", self.path("a.png"))
            built[name] = run.returncode == 0
            if not built[name]:
                self.assertIn(f"needs lib{name}, which this eclat was built without; write a .png, or build eclat with lib{name}-dev", self.assert_one_error(run, 2))
                continue
            program, command = decoders[name]
            if not shutil.which(program):
                continue
            subprocess.run(command(self.path(f"a.{name}"), self.path("back.png")), check=True, capture_output=True)
            a, b = read_png(self.path("a.png")), read_png(self.path("back.png"))
            self.assertEqual(a[:3], b[:3])
            worst = max(abs(x - y) for p, q in zip(a[4], b[4]) for i, (x, y) in enumerate(zip(p, q)) if p[i | 3] == 255)
            self.assertLessEqual(worst, 0 if name == "jxl" else 12)
            self.assertEqual([p[3::4] for p in a[4]], [q[3::4] for q in b[4]])
            left = os.listdir(self.folder)
            self.assertEqual(sorted(left), sorted(set(left) & {"scene.gltf", "a.png", "back.png", "a.avif", "a.jxl"}))
        if not any(built.values()):
            self.skipTest("built without libavif and libjxl")

    def test_hdr_is_radiance(self):
        self.render("a.exr", "a.hdr", options=("--exposure", "3", "--light", "sky:0,3"))
        rows = radiance(self.path("a.hdr"))
        for i, c in enumerate(self.pixels("a.exr")[0]):
            for a, b in zip(rows[i // W][i % W], c):
                self.assertLessEqual(abs(a - b), max(c) / 255)
        self.render("back.exr", options=("--light", self.path("a.hdr")))  # eclat reads it again, as an environment

    def test_what_does_not_go_together(self):
        for options, says in [(["--background", "transparent", "-o", "a.jpg"], "'a.jpg' has no alpha; write a .png or an .exr"),
                              (["--background", "mauve"], "neither env nor transparent, blur, blur:R, white, black or an sRGB colour"),
                              (["--background", "fff"], "neither env nor"),
                              (["--background", "blur:90"], "--background"),
                              (["--png-depth", "12"], "--png-depth"),
                              (["--background", "white", "--samples", "0:8", "-o", "a.exr"], "eclat merge has no backgrounds"),
                              (["--frames", "0:1", "-o", "a.%d.jpg"], "cannot store the identity of the frame's job"),
                              (["-o", "a.gif"], "has no known extension; use .exr (all data), .png, .jpg, .avif or .jxl (picture), or .hdr (radiance)")]:
            self.assertIn(says, self.assert_one_error(eclat("render", self.scene, *OPTIONS, *options, cwd=self.folder), 2))
        run = eclat("render", self.scene, *OPTIONS, "--spp", "1", "-q", "-o", self.path("none", "a.jpg"))
        self.assertIn("create its folder", self.assert_one_error(run, 1))
        self.assertEqual(os.listdir(self.folder), ["scene.gltf"])

    def test_checkpoints_know_the_background(self):
        whole = self.render("whole.exr", background="transparent", options=("--replicates", "2"))
        kept = ("--checkpoint", self.path("kept.exr"), "--spp", "32")
        self.render("begun.exr", background="transparent", options=("--replicates", "2", *kept))
        run = self.assert_ok(eclat("render", "--resume", self.path("kept.exr"), "--spp", "64", "--json", "-o", self.path("rest.exr"), "-o", self.path("rest.png")))
        self.assertEqual(json.loads(run.stdout)["image_sha256"], whole["image_sha256"])
        self.assertEqual(read_png(self.path("rest.png"))[2], 4)


if __name__ == "__main__":
    unittest.main()

# tier: quick
"""eclat render --scenarios: each scenario gives the picture of its command; a page shows all of them with their errors."""
import html.parser
import json
import math
import os
import unittest

from support import LINE, QUICK, SHARED, Case, eclat, png_size, quad_scene, read_exr, write_gltf

SMALL = ["--spp", "4", *QUICK]


class Page(html.parser.HTMLParser):
    """Collects the text of each figure, and its links."""

    def __init__(self, path):
        super().__init__()
        self.figures, self.links = [], []
        with open(path, encoding="utf-8") as file:
            self.feed(file.read())

    def handle_starttag(self, tag, attributes):
        self.figures += [""] if tag == "figure" else []
        self.links += [value for key, value in attributes if key in ("src", "href")]

    def handle_data(self, data):
        if self.figures:
            self.figures[-1] += data


class Scenarios(Case):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path("models"))
        scene, _ = quad_scene(material={"emissiveFactor": [1, 0.5, 0.25], "doubleSided": True})
        write_gltf(self.path("models", "quad.gltf"), scene)
        with open(self.path("models", "map.hdr"), "wb") as file:
            file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + bytes([128, 128, 128, 128]) * 2)

    def write(self, scenarios, **more):
        with open(self.path("models", "list.json"), "w", encoding="utf-8") as file:
            json.dump({"scenarios": scenarios, **more}, file)

    def run_all(self, *options, out="out"):
        run = eclat("render", "--scenarios", "models/list.json", "--out", out, *SMALL, "--json", "-q", *options, cwd=self.folder)
        return run, [json.loads(line) for line in run.stdout.splitlines()]

    def planes(self, *names):
        return read_exr(self.path(*names))[1]

    def test_each_is_the_command_that_it_stands_for(self):
        orbit = {"theta": 30, "phi": 60, "radius": 4}
        eye = [4 * math.sin(math.pi / 3) * math.sin(math.pi / 6), 0.5 + 4 * math.cos(math.pi / 3), 4 * math.sin(math.pi / 3) * math.cos(math.pi / 6)]
        self.write([{"name": "plain", "model": "quad.gltf", "dimensions": {"width": 32}, "orbit": {"radius": 3}},
                    {"name": "turned", "model": "quad.gltf", "orbit": orbit, "target": {"y": 0.5}, "verticalFoV": 30, "lighting": "map.hdr",
                     "toneMapping": "linear", "exposure": 0.5, "exclude": ["other"]},
                    {"name": "arrays", "model": "quad.gltf", "target": [0, 0.5, 0], "orbit": orbit, "dimensions": [20, 10]},
                    {"name": "placed", "model": "quad.gltf", "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0.5, 0, -3, 1]},
                    {"name": "seen", "model": "quad.gltf", "orbit": {"radius": 9}, "lighting": "map.hdr", "renderSkybox": True},
                    {"name": "within", "model": "quad.gltf", "target": {"z": 2}, "orbit": {"radius": 0}}],
                   defaults={"dimensions": {"width": 24, "height": 16}, "orbit": {"theta": 0, "phi": 90, "radius": 1}})
        run, rows = self.run_all()
        self.assert_ok(run)
        self.assertEqual([(row["name"], row["width"], row["height"]) for row in rows[:-1]],
                         [("plain", 32, 16), ("turned", 24, 16), ("arrays", 20, 10), ("placed", 24, 16), ("seen", 24, 16), ("within", 24, 16)])

        def same(name, *options):
            self.assert_ok(eclat("render", "models/quad.gltf", *SMALL, "-q", "-o", "alone.exr", *options, cwd=self.folder))
            ours, alone = self.planes("out", name + ".exr")["R"], self.planes("alone.exr")["R"]
            self.assertEqual(len(ours), len(alone))
            self.assertGreater(max(ours), 0)
            self.assertLess(sum(abs(a - b) for a, b in zip(ours, alone)) / len(ours), 1e-4)
        same("plain", "--eye", "0,0,3", "--look-at", "0,0,0", "--fov", "45", "--size", "32x16")
        same("turned", "--eye", ",".join(map(repr, eye)), "--look-at", "0,0.5,0", "--fov", "30", "--size", "24x16", "--env", "models/map.hdr", "--background", "transparent")
        same("arrays", "--eye", ",".join(map(repr, eye)), "--look-at", "0,0.5,0", "--fov", "45", "--size", "20x10")
        same("placed", "--eye", "0.5,0,-3", "--look-at", "0.5,0,0", "--fov", "45", "--size", "24x16")
        same("within", "--eye", "0,0,2", "--look-at", "0,0,1", "--fov", "45", "--size", "24x16")
        self.assertEqual([self.planes("out", name + ".exr")["G"][0] for name in ("turned", "seen")], [0, 0.5])
        attributes = read_exr(self.path("out", "turned.exr"))[0]
        self.assertEqual((attributes["eclat.png.tonemap"], attributes["eclat.png.exposure"]), ("none", -1))
        os.remove(self.path("out", "turned.exr"))
        self.assert_ok(eclat(*attributes["eclat.command"].split()[1:], "-q", cwd=self.folder))
        self.assertEqual(read_exr(self.path("out", "turned.exr"))[0]["eclat.imageSha256"], attributes["eclat.imageSha256"])

    def test_only_changed_scenarios_are_rendered_again(self):
        scenarios = [{"name": name, "model": "quad.gltf", "dimensions": [16, 16], "orbit": {"radius": 3}} for name in "abc"]
        self.write(scenarios)
        self.assertEqual([row["state"] for row in self.run_all("--shard", "2/3")[1][:-1]], ["rendered"])
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["b.exr", "b.png", "index.html", "index.png"])
        self.assertEqual([row["state"] for row in self.run_all()[1][:-1]], ["rendered", "skipped", "rendered"])
        scenarios[0]["orbit"]["theta"] = 10
        self.write(scenarios)
        self.assertEqual([row["state"] for row in self.run_all()[1][:-1]], ["rendered", "skipped", "skipped"])
        self.assertEqual([row["state"] for row in self.run_all("--max-depth", "3")[1][:-1]], ["rendered"] * 3)

    def test_what_is_wrong_with_one_leaves_the_others(self):
        good = {"model": "quad.gltf", "dimensions": [16, 16], "orbit": {"radius": 3}}
        self.write({"good": good, "no-model": {}, "dark": dict(good, lighting="none.hdr"), "curve": dict(good, toneMapping="sepia"),
                    "gone": dict(good, model="gone.glb"), "letters": dict(good, orbit={"radius": "far"}), "short": dict(good, matrix=[1, 2])})
        run, rows = self.run_all()
        self.assertEqual(run.returncode, 1)
        lines = run.stderr.splitlines()
        for line, says in zip(lines, ('no-model: it has no "model"', "dark: its \"lighting\", 'models/none.hdr', cannot be read; put it there, or give one map for all with "
                                      "--env FILE", "curve: --tonemap", "gone: models/gone.glb: cannot open", 'letters: "orbit" has no number for radius',
                                      'short: "matrix" has 2 numbers', "6 of 7 pictures failed")):
            self.assertTrue(line.startswith("eclat: error: " + says), line)
        self.assertEqual(len(lines), 7)
        page = Page(self.path("out", "index.html"))
        self.assertEqual(len(page.figures), 7)
        self.assertIn('it has no "model"', page.figures[1])
        run, rows = self.run_all("--env", "1,1,1", "--tonemap", "none")
        self.assertEqual([row["state"] for row in rows[:-1]], ["rendered", "failed", "rendered", "rendered", "failed", "failed", "failed"])

    def test_the_page_states_the_errors(self):
        self.write([{"name": "a & <b>", "model": "quad.gltf", "dimensions": [16, 16], "orbit": {"radius": 3, "theta": 40}},
                    {"name": "second", "model": "quad.gltf", "dimensions": [16, 16]}])
        run, rows = self.run_all("--spp", "64", "--shard", "1/2")
        self.assert_ok(run)
        page = Page(self.path("out", "index.html"))
        self.assertEqual(len(page.figures), 2)
        self.assertIn("a & <b>", page.figures[0])
        error = 100 * rows[0]["error"]
        self.assertIn(f"error {error:#.3g} %", page.figures[0])
        self.assertIn(f"95 % confidence under {100 * rows[0]['error_bound']:#.3g} %", page.figures[0])
        self.assertIn("64 samples a pixel", page.figures[0])
        self.assertIn("eclat render models/quad.gltf", page.figures[0])
        self.assertIn("not rendered yet", page.figures[1])
        self.assertEqual(page.links, ["a%20%26%20%3Cb%3E.png"] * 2 + ["a%20%26%20%3Cb%3E.exr"])
        self.assertEqual(png_size(self.path("out", "index.png")), (32, 32 + LINE))

    def refuse(self, says, *options, code=2):
        self.assertIn(says, self.assert_one_error(eclat("render", *options, *SMALL, cwd=self.folder), code))
        self.assertFalse(os.path.exists(self.path("out")))

    def test_what_is_wrong_with_the_file_or_the_options(self):
        listed = ("--scenarios", "models/list.json", "--out", "out")
        self.write([{"name": "a", "model": "quad.gltf"}])
        self.refuse("--scenarios needs --out FOLDER", "--scenarios", "models/list.json")
        self.refuse("--out belongs to --scenarios", "models/quad.gltf", "--out", "out")
        self.refuse("leave 'models/quad.gltf' out", "models/quad.gltf", *listed)
        self.refuse("leave -o out", *listed, "-o", "x.png")
        self.refuse("--scenarios and --frames", *listed, "--orbit", "4")
        self.refuse("--checkpoint works with a single picture", *listed, "--checkpoint", "c.exr")
        self.refuse("cannot open 'none.json'", "--scenarios", "none.json", "--out", "out", code=1)
        for name in ("", "../a", ".a", "index", None):
            self.write([{"name": name, "model": "quad.gltf"}])
            self.refuse("scenario 1 has no usable \"name\"", *listed, code=1)
        self.write([{"name": "a"}, {"name": "a"}])
        self.refuse("two scenarios are called 'a'", *listed, code=1)
        self.write([])
        self.refuse('it has no "scenarios"', *listed, code=1)
        with open(self.path("models", "list.json"), "w", encoding="utf-8") as file:
            file.write('{"scenarios":\n [}')
        self.refuse("models/list.json: line 2 is not valid JSON", *listed, code=1)

    def test_khronos_scenarios(self):
        listed = os.path.join(SHARED, "assets", "fidelity", "scenarios.json")
        if not os.path.exists(listed):
            self.skipTest("no " + listed)
        run = eclat("render", "--scenarios", listed, "--out", "out", "--size", "16x16", "--env", "1,1,1", "--shard", "1/12", *SMALL, "--json", "-q",
                    cwd=self.folder)
        rows = [json.loads(line) for line in run.stdout.splitlines()]
        self.assertEqual(rows[-1]["pictures"], 7)
        self.assertGreater(rows[-1]["rendered"], 1)
        for row in rows[:-1]:
            if row["state"] == "failed":
                self.assertIn("cannot open", row["error"])
        with open(listed, encoding="utf-8") as file:
            self.assertEqual(len(Page(self.path("out", "index.html")).figures), len(json.load(file)["scenarios"]))


if __name__ == "__main__":
    unittest.main()

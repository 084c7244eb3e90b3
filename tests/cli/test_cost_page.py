# tier: full
"""The page of `eclat cost -o` in a real browser: no errors, no requests, curves on the canvas, and the numbers of the JSON."""
import json
import os
import unittest

from browser import PageCase, skip_without
from support import CORNELL, eclat

setUpModule = skip_without


class Page(PageCase):
    @classmethod
    def make(cls, folder):
        path = os.path.join(folder, "report.html")
        figures = os.path.join(folder, "report.json")
        for budget in (12, 24, 48, 96):  # kernels may have to be compiled
            run = eclat("cost", CORNELL, "--size", "24x24", "--budget", f"{budget}s", "-o", path, "--json", figures, cwd=folder)
            if run.returncode:
                raise AssertionError(run.stderr)
            with open(figures, encoding="utf-8") as file:
                cls.report = json.load(file)
            cls.curves = [r for r in cls.report["rungs"] if r.get("curve") and r["group"] not in ("effect", "lights") and any(p["error"] for p in r["curve"])]
            if len(cls.curves) >= 3:
                break
        return path

    def show(self, **how):
        self.browser.show(self.path, **how)

    def tearDown(self):
        self.assertEqual(self.browser.complaints(), [])
        outside = [url for url in self.browser.requests() if not url.startswith(("data:", "file://" + self.path))]
        self.assertEqual(outside, [])

    def test_the_numbers_are_those_of_the_json(self):
        self.show()
        self.assertEqual(self.browser.evaluate("eclat.data"), self.report)
        cells = self.browser.evaluate("""[...document.querySelectorAll("#table tr[data-id]")].map(row => [row.dataset.id,
            Object.fromEntries([...row.querySelectorAll("td[data-value]")].map(c => [c.dataset.column, Number(c.dataset.value)]))])""")
        rungs = {r["id"]: r for r in self.report["rungs"]}
        self.assertEqual([name for name, _ in cells], list(rungs))
        keys = {"time": "relative_time", "slope": "slope", "variance": "variance", "efficiency 1/s": "efficiency", "memory": "device_bytes"}
        for name, columns in cells:
            rung = rungs[name]
            for column, key in keys.items():
                self.assertEqual(columns.get(column), rung.get(key), f"{name}, {column}")
            for column, target in zip(("to 5 %", "to 2 %", "to 1 %", "to 0.5 %"), rung.get("time_to", [])):
                self.assertEqual(columns.get(column), target["seconds"], f"{name}, {column}")
            if rung["state"] != "measured":
                self.assertEqual(columns, {})

    def test_what_the_cells_say(self):
        """Compares the first digits of a few values; the page formats them differently."""
        self.show()
        text = self.browser.evaluate("""Object.fromEntries([...document.querySelectorAll("#table tr[data-id=path] td")].map(c => [c.dataset.column, c.textContent]))""")
        base = self.report["rungs"][0]
        self.assertAlmostEqual(float(text["variance"]), base["variance"], delta=5e-3 * base["variance"])
        self.assertEqual(text["slope"], f"{base['slope']:.2f} ± {base['slope_se']:.3f}" if base["slope"] is not None else "?")

    def test_curves_are_drawn(self):
        self.show()
        drawn = self.browser.evaluate("""eclat.charts().errors.data.datasets.filter(s => s.rung).map(s => [s.rung.id, s.data.map(p => [p.x, p.y])])""")
        expected = [[r["id"], [[p["seconds"], p["error"]] for p in r["curve"] if p["error"]]] for r in self.curves]
        self.assertEqual(drawn, expected)
        self.assertGreaterEqual(len(drawn), 3)
        # The canvas has a curve's colour at its first point when only that curve is drawn.
        for index in range(len(drawn)):
            name = drawn[index][0]
            self.browser.evaluate("document.getElementById('none').click()")
            self.browser.evaluate(f"document.getElementById('curve-{name}').click()")
            seen = self.browser.evaluate(f"""(() => {{
                const chart = eclat.charts().errors, set = chart.data.datasets[{index}], dot = chart.getDatasetMeta({index}).data[0];
                const scale = chart.currentDevicePixelRatio, n = 6 * scale;
                const copy = new OffscreenCanvas(2 * n, 2 * n).getContext("2d");
                copy.drawImage(chart.canvas, dot.x * scale - n, dot.y * scale - n, 2 * n, 2 * n, 0, 0, 2 * n, 2 * n);
                const box = copy.getImageData(0, 0, 2 * n, 2 * n).data;
                const want = [1, 3, 5].map(i => parseInt(set.borderColor.slice(i, i + 2), 16));
                let count = 0;
                for (let i = 0; i < box.length; i += 4) count += want.every((v, k) => Math.abs(v - box[i + k]) < 8) && box[i + 3] > 200;
                return count;
            }})()""")
            self.assertGreater(seen, 4, name)

    def test_the_sentence_and_the_best_are_the_json_s(self):
        self.show(width=1300)
        self.assertEqual(self.browser.evaluate("document.getElementById('verdict').textContent"), self.report["result"])
        marked = self.browser.evaluate("""[...document.querySelectorAll("#table td.best")].map(c => [c.dataset.column, c.parentElement.dataset.id])""")
        self.assertEqual(sorted(marked), sorted([column, name] for column, name in self.report["best"].items() if name))
        self.assertEqual(sorted(self.browser.evaluate("eclat.named")), sorted(r["label"] for r in self.curves))

    def test_columns_fit(self):
        self.show(width=1300)
        self.assertEqual(self.browser.evaluate("(t => t.scrollWidth - t.parentElement.clientWidth)(document.getElementById('table'))"), 0)

    def test_pareto_front_is_the_json_s(self):
        self.show()
        front = self.browser.evaluate("eclat.charts().errors.data.datasets.find(s => s.label == 'Pareto front').data.map(p => [p.x, p.y])")
        expected = [[p["seconds"], p["error"]] for p in self.report["pareto_front"]]
        self.assertEqual(front, expected)

    def test_pictures(self):
        self.show()
        sizes = self.browser.evaluate("[...document.querySelectorAll('#pictures img')].map(i => [i.naturalWidth, i.naturalHeight, !!i.alt])")
        pictured = [r for r in self.report["rungs"] if r.get("curve")]
        self.assertEqual(sizes, [[24, 24, True]] * (1 + 2 * len(pictured)))

    def test_slider_through_time(self):
        """At each stop of the slider, every rung shows the picture with the most samples that was done by then, or says when its first one
        is."""
        self.show()
        pictured = [r for r in self.report["rungs"] if r.get("curve")]
        times = sorted({p["seconds"] for r in pictured for p in r["curve"]})
        self.assertEqual(self.browser.evaluate("Number(document.getElementById('time').max)"), len(times) - 1)
        seen = set()
        for index in (0, len(times) // 2, len(times) - 1):
            shown = self.browser.evaluate(f"""(t => (t.value = {index}, t.dispatchEvent(new Event("input")), [...document.querySelectorAll("#times figure")].map(f =>
                [f.querySelector("img").checkVisibility() ? f.querySelector("img").src : null, f.querySelector("span").textContent])))(document.getElementById("time"))""")
            self.assertEqual(len(shown), len(pictured))
            for rung, (source, caption) in zip(pictured, shown):
                done = [i for i, p in enumerate(rung["curve"]) if p["seconds"] <= times[index]]
                self.assertEqual(source is None, not done, rung["id"])
                if done:
                    self.assertEqual(source, self.browser.evaluate(f"JSON.parse(document.getElementById('images').textContent).stages['{rung['id']}'][{done[-1]}]"))
                    self.assertTrue(caption.startswith(f"{rung['curve'][done[-1]]['samples_per_pixel']} samples"), caption)
            seen.add(str(shown))
        self.assertEqual(len(seen), 3)
        sizes = self.browser.evaluate("Promise.all([...document.querySelectorAll('#times img')].map(i => i.decode().then(() => [i.naturalWidth, i.naturalHeight])))")
        self.assertEqual(sizes, [[24, 24]] * len(pictured))
        self.assertIn("10 s", self.browser.evaluate("document.getElementById('times-reach').textContent"))
        for stop in self.browser.evaluate("[...document.querySelectorAll('#time-stops button')].map(b => (b.click(), [Number(b.dataset.seconds), document.getElementById('time').value]))"):
            self.assertEqual(int(stop[1]), max(i for i, t in enumerate(times) if t <= stop[0]))
        self.assertLess(os.path.getsize(self.path), 3_000_000)

    def test_keyboard(self):
        self.show()
        self.browser.evaluate("document.getElementById('error-chart').focus()")
        said = self.browser.evaluate("document.getElementById('error-live').textContent")
        self.assertIn("the default", said)
        self.browser.press("ArrowRight")
        self.assertNotEqual(self.browser.evaluate("document.getElementById('error-live').textContent"), said)
        self.browser.press("ArrowDown")
        self.assertNotIn("the default", self.browser.evaluate("document.getElementById('error-live').textContent"))
        self.browser.press("Escape")
        self.assertEqual(self.browser.evaluate("document.getElementById('error-live').textContent"), "")
        reached = []
        for _ in range(6):
            self.browser.press("Tab")
            reached.append(self.browser.evaluate("document.activeElement.id"))
        self.assertEqual(reached[:3], ["all", "none", "curve-path"])
        self.browser.evaluate("document.getElementById('curve-path').focus()")
        self.browser.press(" ")
        self.assertTrue(self.browser.evaluate("eclat.charts().errors.data.datasets[0].hidden"))

    def test_another_measure_of_error(self):
        self.show()
        self.browser.evaluate("const m = document.getElementById('metric'); m.value = 'relmse'; m.dispatchEvent(new Event('change'))")
        drawn = self.browser.evaluate("eclat.charts().errors.data.datasets[0].data.map(p => p.y)")
        expected = [p["relmse"] ** 0.5 for p in self.curves[0]["curve"] if p["relmse"] > 0]
        self.assertEqual(len(drawn), len(expected))
        for a, b in zip(drawn, expected):
            self.assertAlmostEqual(a, b, delta=1e-12)

    def test_dark_and_light(self):
        seen = {}
        for scheme in ("light", "dark"):
            self.show(scheme=scheme)
            seen[scheme] = self.browser.evaluate("""[getComputedStyle(document.body).backgroundColor, getComputedStyle(document.body).color,
                eclat.charts().errors.options.scales.x.ticks.color, eclat.charts().errors.data.datasets[0].borderColor]""")
        brightness = {k: [sum(int(x) for x in v[i][4:-1].split(",")) for i in (0, 1)] for k, v in seen.items()}
        self.assertGreater(brightness["light"][0], brightness["light"][1])
        self.assertLess(brightness["dark"][0], brightness["dark"][1])
        for i in (2, 3):
            self.assertNotEqual(seen["light"][i], seen["dark"][i])

    def test_narrow_screens_scroll_nothing_but_tables(self):
        for width in (400, 1200):
            self.show(width=width)
            self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), width)


if __name__ == "__main__":
    unittest.main()

# tier: full
"""The page of `eclat compare --html` in a real browser: no errors, no requests, every view, sorting by each column, narrow and wide."""
import json
import os
import unittest

from browser import PageCase, skip_without
from support import eclat, write_exr
from test_compare_pictures import encode, write_png

W, H = 48, 32
FACTORS = {"same.png": 1, "dark.png": 0.7, "slightly <b>&.png": 0.95}

setUpModule = skip_without


class Page(PageCase):
    @classmethod
    def make(cls, folder):
        ramp = [[0.05 + 0.015 * (i % W), 0.3, 0.02 * (i // W)] for i in range(W * H)]
        for name, factor in FACTORS.items():
            write_png(os.path.join(folder, name), W, H, [tuple(round(255 * encode(factor * v)) for v in p) for p in ramp])
        planes = {c: [p[k] for p in ramp] for k, c in enumerate("RGB")}
        write_exr(os.path.join(folder, "b.exr"), W, H, {**planes, **{f"stderr.{c}": [0.001] * (W * H) for c in "RGB"}})
        path = os.path.join(folder, "out.html")
        run = eclat("compare", *FACTORS, "b.exr", "--tonemap", "none", "--html", "out.html", "--json", cwd=folder)
        if run.returncode != 1:
            raise AssertionError(run.stderr)
        cls.reports = json.loads(run.stdout)
        return path

    def setUp(self):
        self.browser.show(self.path)

    def tearDown(self):
        self.assertEqual(self.browser.complaints(), [])
        self.assertEqual([url for url in self.browser.requests() if not url.startswith(("data:", "file://" + self.path))], [])

    def evaluate(self, expression):
        return self.browser.evaluate(expression)

    def seen(self, view, card=0):
        """Lists the pictures of a card that a view shows."""
        self.evaluate(f"document.getElementById('view-{view}').click()")
        return self.evaluate(f"""[...document.querySelectorAll('article')[{card}].querySelectorAll('.stage img')]
            .filter(i => getComputedStyle(i).display !== 'none').map(i => i.className)""")

    def test_the_reports_are_those_of_the_json(self):
        self.assertEqual(self.evaluate("eclat.pairs.map(p => p.report)"), self.reports)
        self.assertEqual(self.evaluate("[...document.querySelectorAll('article h3')].map(h => h.textContent)"), list(FACTORS))
        self.assertEqual(self.evaluate("document.getElementById('summary').textContent"), "2 of 3 differ.")
        self.assertEqual(self.evaluate("[...document.images].map(i => [i.naturalWidth, i.naturalHeight, !!i.alt])"), [[W, H, True]] * 12)

    def test_views(self):
        self.assertEqual([self.seen(v) for v in ("wipe", "difference", "error", "flip", "a", "b")], [["b", "a"], ["b", "a"], ["error"], ["flip"], ["a"], ["b"]])
        self.assertEqual(self.evaluate("getComputedStyle(document.querySelector('.stage .a')).mixBlendMode"), "normal")
        self.seen("difference")
        self.assertEqual(self.evaluate("getComputedStyle(document.querySelector('.stage .a')).mixBlendMode"), "difference")
        self.evaluate("const g = document.getElementById('gain'); g.value = 5; g.dispatchEvent(new Event('input'))")
        self.assertEqual(self.evaluate("getComputedStyle(document.querySelector('.stage')).filter"), "brightness(32)")

    def test_wipe_by_pointer_and_slider(self):
        at = "document.querySelector('.stage').style.getPropertyValue('--at')"
        self.evaluate("const w = document.querySelector('.wipe'); w.value = 20; w.dispatchEvent(new Event('input'))")
        self.assertEqual(self.evaluate(at), "20%")
        x, y, width = self.evaluate("(() => { const b = document.querySelector('.stage').getBoundingClientRect(); return [b.left, b.top, b.width]; })()")
        self.browser.call("Input.dispatchMouseEvent", type="mousePressed", x=x + 0.75 * width, y=y + 9, button="left", buttons=1, clickCount=1)
        self.browser.call("Input.dispatchMouseEvent", type="mouseReleased", x=x + 0.75 * width, y=y + 9, button="left", clickCount=1)
        self.assertAlmostEqual(float(self.evaluate(at)[:-1]), 75, delta=1)

    def test_blink_stops_and_goes_on(self):
        self.assertIn(self.seen("blink"), (["b"], ["b", "a"]))
        self.assertTrue(self.evaluate("eclat.isBlinking()"))
        self.browser.press(" ")
        self.assertFalse(self.evaluate("eclat.isBlinking()"))
        self.browser.press(" ")
        self.assertTrue(self.evaluate("eclat.isBlinking()"))
        self.seen("wipe")
        self.assertFalse(self.evaluate("eclat.isBlinking()"))

    def test_every_column_sorts_table_and_pictures(self):
        names, keys = list(FACTORS), {"error": lambda r: -r["error"], "FLIP": lambda r: -r["flip"], "SSIM": lambda r: r["ssim"], "PSNR": lambda r: r["psnr"]}
        for title, key in keys.items():
            expected = [names[i] for i in sorted(range(3), key=lambda i: key(self.reports[i]))]
            for order, arrow in (expected, None), (expected[::-1], None):
                self.evaluate(f"[...document.querySelectorAll('th button')].find(b => b.textContent === '{title}').click()")
                self.assertEqual(self.evaluate("[...document.querySelectorAll('tbody td:first-child')].map(t => t.textContent)"), order, title)
                self.assertEqual(self.evaluate("[...document.querySelectorAll('article h3')].map(t => t.textContent)"), order, title)
            self.assertEqual(self.evaluate("document.querySelectorAll('th[aria-sort]').length"), 1)

    def test_only_what_differs(self):
        self.evaluate("document.getElementById('differing').click()")
        self.assertEqual(self.evaluate("[...document.querySelectorAll('article:not([hidden]) h3')].map(t => t.textContent)"), list(FACTORS)[1:])

    def test_widths(self):
        columns = []
        for width in (400, 800, 1200, 2000):
            self.browser.show(self.path, width=width)
            self.assertEqual(self.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth"), 0)
            columns.append(self.evaluate("getComputedStyle(document.getElementById('gallery')).gridTemplateColumns.split(' ').length"))
        self.assertEqual(columns, [1, 1, 2, 4])
        self.evaluate("const s = document.getElementById('size'); s.value = 2; s.dispatchEvent(new Event('change'))")
        self.assertEqual(self.evaluate("document.querySelector('.stage').getBoundingClientRect().width"), 2 * W)


if __name__ == "__main__":
    unittest.main()

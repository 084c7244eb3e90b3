# tier: quick
"""README and manual: links lead somewhere, commands exist, generated parts are up to date, and the site builds and loads nothing from
elsewhere."""
import glob
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import unicodedata
import unittest

from browser import CHROMIUM, Browser
from support import CORNELL, SOURCE, Case, eclat, read_exr

ROOT = os.path.realpath(SOURCE)
MANUAL = [os.path.join(ROOT, "README.md"), *sorted(glob.glob(os.path.join(ROOT, "docs", "*.md")))]
ALL = [*MANUAL, *(os.path.join(ROOT, *names) for names in (["CONTRIBUTING.md"], ["kernels", "README.md"], ["tools", "bench", "README.md"])),
       *sorted(glob.glob(os.path.join(ROOT, "scenes", "**", "README.md"), recursive=True))]
COMMANDS = "render cost info compare merge mix devices selftest view".split()
LINK = re.compile(r"\]\(([^)\s]+)\)")
PICTURE = re.compile(r"^!\[([^\]]*)\]\(([^)]+)\)$", re.M)
README_WORDS, PICTURE_BYTES = 1200, 1.5e6


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def name_of(path):
    return os.path.relpath(path, ROOT)


def without_code(text):
    lines, fenced = [], False
    for line in text.splitlines():
        if line.startswith("```"):
            fenced = not fenced
        elif not fenced and not line.startswith("    "):
            lines.append(re.sub(r"`[^`]*`", "`", line))
    return "\n".join(lines)


def anchors(text):
    """Anchors of headings, as MkDocs and code hosts make them. Only those in which both agree can be links' targets."""
    found = set()
    for heading in re.findall(r"^#+ (.+)$", text, re.M):
        plain = re.sub(r"[^\w\s-]", "", heading).strip().lower()
        ascii_ = unicodedata.normalize("NFKD", plain).encode("ascii", "ignore").decode()
        site, host = re.sub(r"[-\s]+", "-", ascii_), plain.replace(" ", "-")
        if site == host:
            found.add(site)
    return found


def code_lines(text):
    """Lines of indented blocks without comments, and text in backquotes. Fenced blocks are output of other programs."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)
    return [re.sub(r"\s#.*", "", line) for line in re.findall(r"^ {4}(.*)$", text, re.M)] + re.findall(r"`([^`\n]+)`", text)


def eclat_commands(text):
    """eclat's command lines as lists of words, with values in place of shell variables."""
    for line in code_lines(text):
        line = re.sub(r"^tools/render", "eclat render", line)
        for command in re.findall(rf"\beclat (?:{'|'.join(COMMANDS)})\b(?:'[^'|;]*'|[^'|;])*", line):
            command = re.sub(r"\$\(\([^)]*\)\)", "64", command)
            command = re.sub(r"\$\w+|\{\}", "0", command)
            yield shlex.split(re.sub(r"[][…]|>.*", " ", command))[1:]


class Text(Case):
    def test_links_and_anchors_lead_somewhere(self):
        for path in ALL:
            for link in LINK.findall(without_code(read(path))):
                with self.subTest(file=name_of(path), link=link):
                    if re.match(r"https?://", link):
                        continue
                    target, _, anchor = link.partition("#")
                    file = os.path.normpath(os.path.join(os.path.dirname(path), target)) if target else path
                    self.assertTrue(os.path.exists(file), "there is no such file")
                    if anchor:
                        self.assertIn(anchor, anchors(read(file)))

    def test_nothing_to_read_is_on_another_host(self):
        for path in MANUAL:
            self.assertEqual(re.findall(r"https?://\S+", without_code(read(path))), [], name_of(path))

    def test_readme_is_short(self):
        self.assertLessEqual(len(read(MANUAL[0]).split()), README_WORDS)

    def test_commands_are_known(self):
        """With --help at the end the program checks all options, prints help, and does nothing else."""
        count = 0
        for path in MANUAL:
            for words in eclat_commands(read(path)):
                if words[-1] == "--help":
                    continue
                with self.subTest(file=name_of(path), command=" ".join(words)):
                    run = self.assert_ok(eclat(*words, "--help", cwd=self.folder))
                    self.assertTrue(run.stdout.startswith(f"Usage: eclat {words[0]}"))
                    count += 1
        self.assertGreater(count, 50)

    def test_paths_exist(self):
        for path in MANUAL:
            for line in code_lines(read(path)):
                for file in re.findall(r"(?<![\w/.])(?:tools|tests|host|kernels|scenes|docs)/[\w./-]*\w", line):
                    with self.subTest(file=name_of(path), path=file):
                        self.assertTrue(glob.glob(os.path.join(ROOT, file.replace("NAME", "*"))))

    def test_generated_parts_are_fresh(self):
        environment = dict(os.environ, ECLAT=os.path.abspath(os.environ.get("ECLAT", "eclat")))
        for tool in ("docs_cli.py", "docs_tables.py"):
            run = subprocess.run([sys.executable, os.path.join(ROOT, "tools", tool), "--check"], capture_output=True, text=True, env=environment)
            self.assertEqual(run.returncode, 0, run.stderr)


class Facts(Case):
    """Lists in the manual match the program."""

    def test_json_keys_and_channels(self):
        page = read(os.path.join(ROOT, "docs", "scripting.md"))
        keys, channels = (re.findall(r"^\| (`.*?) \|", page.split(head)[1].split("\n\n")[0], re.M) for head in ("| key of a render |", "| channel |"))
        run = self.assert_ok(eclat("render", CORNELL, "--lanes", "4", "--size", "8x8", "--spp", "8", "--clamp", "10", "--channels", "all", "--json", "-q", "-o", "a.exr", cwd=self.folder))
        report, planes = json.loads(run.stdout), read_exr(self.path("a.exr"))[1]
        # channels of a library that may be missing here
        planes = set(planes) | {*(f"{layer}.{c}" for layer in ("denoised", "best") for c in "RGB"), "denoised.stderr"}
        self.assertEqual(set(re.findall(r"`(\w+)`", " ".join(keys))) - set(report), set())
        listed, stem = set(), ""
        for name in re.findall(r"`([\w.]+)`", " ".join(channels)):
            stem = stem if name.startswith(".") else name.split(".")[0]
            listed.add(stem + name if name.startswith(".") else name)
        self.assertEqual(listed, set(planes))

    def test_extensions(self):
        listed = re.findall(r"^\| `((?:KHR|EXT|MSFT)_\w+)` \|", read(os.path.join(ROOT, "docs", "materials.md")).split("## Extensions")[1].split("## ")[0], re.M)
        lists = re.findall(r"(?:supported|optional)_extensions\[\] = \{.*?\};", read(os.path.join(ROOT, "host", "gltf", "gltf_extensions.cpp")), re.S)
        known = re.findall(r'"((?:KHR|EXT|MSFT)_\w+)"', "".join(lists))
        known += ["KHR_materials_" + name for name in re.findall(r', EC_KHR "(\w+)/', read(os.path.join(ROOT, "kernels", "shared", "material_fields.h")))]
        self.assertEqual(sorted(listed), sorted(set(known)))
        self.assertIn(f"[{len(listed)} extensions]", read(MANUAL[0]))


class Pictures(unittest.TestCase):
    def test_every_page_has_one_with_the_command_that_made_it(self):
        for path in MANUAL[1:]:
            text = read(path)
            with self.subTest(file=name_of(path)):
                self.assertTrue(PICTURE.search(text), "no picture")
                for caption, file in PICTURE.findall(text):
                    self.assertTrue(caption, file)
                    if not file.endswith(".svg"):  # these are drawn by hand
                        self.assertTrue(text.split(f"]({file})\n\n", 1)[1].startswith("    "), f"no command below {file}")

    def test_they_are_small_and_all_in_use(self):
        used = {os.path.join(ROOT, "docs", file) for path in MANUAL[1:] for _, file in PICTURE.findall(read(path))}
        there = set(glob.glob(os.path.join(ROOT, "docs", "images", "*")))
        self.assertEqual(there, used)
        self.assertLess(sum(map(os.path.getsize, there)), PICTURE_BYTES)


@unittest.skipUnless(shutil.which("mkdocs"), "no mkdocs: tools/install-dependencies docs")
class Site(Case):
    def setUp(self):
        super().setUp()
        self.site = self.path("site")
        run = subprocess.run(["mkdocs", "build", "--strict", "--config-file", os.path.join(ROOT, ".mkdocs.yml"), "--site-dir", self.site],
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_every_page_exists_and_loads_nothing_from_elsewhere(self):
        for path in MANUAL[1:]:
            page = os.path.basename(path).replace("README.md", "index.html").replace(".md", ".html")
            html = read(os.path.join(self.site, page))
            self.assertEqual(re.findall(r'\b(?:src|href)="(?:https?:)?//[^"]*', html), [], page)

    @unittest.skipUnless(CHROMIUM, "no chromium")
    def test_a_browser_asks_the_network_for_nothing(self):
        browser = Browser()
        self.addCleanup(browser.close)
        for page in ("index.html", "error.html", "benchmarks.html"):
            browser.show(os.path.join(self.site, page))
            self.assertEqual([url for url in browser.requests() if not url.startswith(("file:", "data:", "blob:"))], [])
            self.assertEqual(browser.evaluate("[...document.images].filter(i => !i.naturalWidth).length"), 0, page)


if __name__ == "__main__":
    unittest.main()

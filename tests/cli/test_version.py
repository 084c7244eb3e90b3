# tier: quick
"""eclat.h has the version. All other files that state it agree, and other programs can read the files that describe a release."""
import os
import re
import unittest

from support import ECLAT, SOURCE, Case, eclat


def read(*names):
    with open(os.path.join(SOURCE, *names), encoding="utf-8") as file:
        return file.read()


HEADER = read("host", "include", "eclat", "eclat.h")
VERSION = re.search(r'^#define EC_VERSION "(.*)"$', HEADER, re.M)[1]


class Version(Case):
    def test_it_is_semantic_and_its_parts_agree(self):
        parts = [re.search(rf"^#define EC_VERSION_{part} (\d+)$", HEADER, re.M)[1] for part in ("MAJOR", "MINOR", "PATCH")]
        self.assertEqual(VERSION, ".".join(parts))

    def test_the_program_says_it(self):
        self.assertEqual(self.assert_ok(eclat("--version")).stdout.splitlines()[0], f"eclat {VERSION}")
        self.assertIn(f'"eclat {VERSION}"', self.assert_ok(eclat("help", "--man")).stdout)

    def test_cmake_takes_it_from_the_header(self):
        build = os.path.dirname(os.path.abspath(ECLAT))
        with open(os.path.join(build, "CMakeCache.txt"), encoding="utf-8") as file:
            self.assertIn(f"CMAKE_PROJECT_VERSION:STATIC={VERSION}\n", file.read())
        self.assertNotRegex(read("CMakeLists.txt"), r"VERSION \d+\.\d+\.\d+")

    def test_changelog_begins_with_it(self):
        headings = re.findall(r"^## (.*)$", read("CHANGELOG.md"), re.M)
        self.assertRegex(headings[0], rf"^{re.escape(VERSION)} - \d{{4}}-\d\d-\d\d$")
        numbers = [tuple(map(int, heading.split(" ")[0].split("."))) for heading in headings]
        self.assertEqual(numbers, sorted(numbers, reverse=True))
        self.assertEqual(len(numbers), len(set(numbers)))

    def test_citation(self):
        text = read("CITATION.cff")
        self.assertIn(f"\nversion: {VERSION}\n", text)
        day = re.search(rf"^## {re.escape(VERSION)} - (.*)$", read("CHANGELOG.md"), re.M)[1]
        self.assertIn(f"\ndate-released: {day}\n", text)
        self.assertIn("\nlicense: Apache-2.0\n", text)
        for key in ("cff-version: 1.2.0", "message:", "title:", "authors:"):  # keys that the format requires
            self.assertRegex(text, rf"(?m)^{key}")

    def test_there_is_a_rule_for_versions(self):
        self.assertIn("## Versions", read("CONTRIBUTING.md"))


if __name__ == "__main__":
    unittest.main()

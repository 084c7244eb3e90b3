# tier: quick
"""Rules for all tests: each file names its tier, and no test reads a clock or sleeps, since verdicts must not depend on how busy a machine
is. Measurements of time are in tools/bench; polling.py waits for events."""
import glob
import os
import re
import unittest

import tiers

TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
CLOCKS = {
    "a clock": r"\bimport time\b|\bfrom time import|clock_gettime|gettimeofday|\bclock\(\)|\btime\(NULL\)|\bec_now\(|perf_counter|time_ns\(",
    "a sleep": r"sleep\(|\bsleep (?:\d|infinity)|\"sleep\"",
    "a limit on seconds": r"assert(?:Less|LessEqual|Greater|GreaterEqual)\([^,]*seconds[^,]*, [\d.]*[1-9][\d.]*\)|CHECK\w*\([^,]*seconds\)? *[<>]=? *[1-9]",
}
# two widths where the tier is quick: tests/kernel/kernel_run.h
WIDTHS = re.compile(r"\bkernel_widths\(|\bchi2_build\(|\bopen_tracers\(true")
ALLOWED = {
    "cli/polling.py": "the one place that waits",
    "cli/test_tiers.py": "has the words themselves",
    "robust/fault_shim.c": "a slow device, that nobody waits for",
    "robust/race_team.c": "sources of different speed, that nobody waits for",
}


class Rules(unittest.TestCase):
    def test_every_file_names_its_tier(self):
        files = glob.glob(os.path.join(TESTS, "*", "test_*.c")) + glob.glob(os.path.join(TESTS, "*", "test_*.py"))
        self.assertGreater(len(files), 100)
        without = [os.path.relpath(path, TESTS) for path in sorted(files) if not tiers.of_file(path)]
        self.assertEqual(without, [], "the first line names no tier: '# tier: quick' or '/* tier: quick */'; quick, full, long, 'tiers: quick, full', 'tiers: quick, long' or 'tiers: full, long'")

    def test_parts_are_named_where_there_are_some(self):
        """A marked test in a file whose first line does not name that tier would never run, or run twice."""
        for path in glob.glob(os.path.join(TESTS, "*", "test_*.[cp]*")):
            with open(path, encoding="utf-8") as file:
                text = file.read()
            named = tiers.of_file(path)
            parts = re.search(r"^ *@(?:full|long)$|\btest_tier\(", text, re.M) or ("quick" in named and WIDTHS.search(text))
            with self.subTest(path):
                self.assertEqual(bool(parts), len(named) > 1)

    def test_no_test_reads_a_clock_or_sleeps(self):
        found, read = [], set()
        for path in glob.glob(os.path.join(TESTS, "*", "*")):
            name = os.path.relpath(path, TESTS)
            if not path.endswith((".c", ".h", ".py", ".sh")):
                continue
            read.add(name)
            with open(path, encoding="utf-8") as file:
                for number, line in enumerate(file, 1):
                    found += [f"tests/{name}:{number}: {what}: {line.strip()}" for what, words in CLOCKS.items()
                              if name not in ALLOWED and re.search(words, line)]
        self.assertLessEqual(set(ALLOWED), read)
        self.assertEqual(found, [], "wait for an event with polling.poll_until; what measures time belongs into tools/bench")


if __name__ == "__main__":
    unittest.main()

"""Tiers of tests. The first line of a test file names its tier, '# tier: quick'. A file with '# tiers: quick, full' has parts of both
tiers: @full and @long mark classes or tests that are not quick. A C file asks test_tier() of support/test.h.

usage: python3 -m tiers TIER MODULE   Runs the tests of MODULE that belong to TIER."""
import os
import re
import sys
import unittest

FIRST_LINE = re.compile(r"(?:# (.*)|/\* (.*) \*/)\n")
KINDS = {"tier: quick": ["quick"], "tier: full": ["full"], "tier: long": ["long"], "tiers: quick, full": ["quick", "full"],
         "tiers: quick, long": ["quick", "long"], "tiers: full, long": ["full", "long"], "tiers: quick, full, long": ["quick", "full", "long"]}


def full(marked):
    marked.tier = "full"
    return marked


def long(marked):
    marked.tier = "long"
    return marked


def of_file(path):
    """Returns a file's tiers; [] where the first line names none."""
    with open(path, encoding="utf-8") as file:
        found = FIRST_LINE.fullmatch(file.readline())
    return KINDS.get(found and (found[1] or found[2]), [])


def of_test(test, tiers):
    """Marks count only in files of several tiers, since others may import tests from such files."""
    method = getattr(test, getattr(test, "_testMethodName"))
    return tiers[0] if len(tiers) == 1 else getattr(method, "tier", None) or getattr(test, "tier", None) or tiers[0]


def flat(suite):
    for test in suite:
        if isinstance(test, unittest.TestSuite):
            yield from flat(test)
        else:
            yield test


def main(name, module):
    os.environ["ECLAT_TIER"] = name
    suite = unittest.defaultTestLoader.loadTestsFromName(module)
    tiers = of_file(module + ".py") or ["quick"]
    tests = [test for test in flat(suite) if of_test(test, tiers) == name]
    if not tests:
        sys.exit(f"{module} has no test of tier {name}")
    passed = unittest.TextTestRunner(verbosity=2).run(unittest.TestSuite(tests)).wasSuccessful()
    sys.exit(0 if passed else 1)


if __name__ == "__main__":
    sys.path.insert(0, "")
    main(*sys.argv[1:])

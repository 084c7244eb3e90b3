"""Tiers of tests: the first line of a test file names its own, '# tier: quick'. With '# tiers: quick, full' it has parts of both, and @full
and @long say which classes or tests are not quick; a C file asks test_tier() of support/test.h.
usage: python3 -m tiers TIER MODULE   Runs the tests of MODULE that are of TIER."""
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
    """[] where the first line names none that there is."""
    with open(path, encoding="utf-8") as file:
        found = FIRST_LINE.fullmatch(file.readline())
    return KINDS.get(found and (found[1] or found[2]), [])


def of_test(test, tiers):
    """Marks count in files of several tiers; others may take tests from such files."""
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

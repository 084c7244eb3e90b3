"""Tiers of tests: the first line of a test file names the file's, and @tier another one for a class or a test within it.
usage: python3 -m tiers TIER MODULE   Runs the tests of MODULE that are of TIER."""
import re
import sys
import unittest

TIERS = ("quick", "full", "long")
FIRST_LINE = re.compile(r"(?:# tier: (\w+)|/\* tier: (\w+) \*/)\n")


def tier(name):
    if name not in TIERS:
        raise ValueError(f"'{name}' is no tier; name one of {', '.join(TIERS)}")

    def mark(marked):
        marked.tier = name
        return marked
    return mark


def of_file(path):
    """None where the first line names none that there is."""
    with open(path, encoding="utf-8") as file:
        found = FIRST_LINE.fullmatch(file.readline())
    name = found and (found[1] or found[2])
    return name if name in TIERS else None


def of_test(test, otherwise):
    method = getattr(test, getattr(test, "_testMethodName"))
    return getattr(method, "tier", None) or getattr(test, "tier", None) or otherwise


def flat(suite):
    for test in suite:
        if isinstance(test, unittest.TestSuite):
            yield from flat(test)
        else:
            yield test


def main(name, module):
    suite = unittest.defaultTestLoader.loadTestsFromName(module)
    otherwise = of_file(module + ".py") or "quick"
    tests = [test for test in flat(suite) if of_test(test, otherwise) == name]
    if not tests:
        sys.exit(f"{module} has no test of tier {name}")
    passed = unittest.TextTestRunner(verbosity=2).run(unittest.TestSuite(tests)).wasSuccessful()
    sys.exit(0 if passed else 1)


if __name__ == "__main__":
    sys.path.insert(0, "")
    main(*sys.argv[1:])

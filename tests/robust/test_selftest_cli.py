# tier: quick
"""eclat selftest: its table, its JSON, and its verdict on a device that computes wrongly."""
import json
import os
import re
import unittest

from support import ECLAT, Case, eclat

KEYS = ["name", "expected", "measured", "tolerance", "digits", "pass", "noise", "note", "breaks", "seconds"]
# Rows with different digits; one small kernel.
SOME = ["selftest", "--only", "numbers/functions"]
# tests/robust/wrong_device.c
WRONG = {"LD_PRELOAD": os.path.join(os.path.dirname(os.path.abspath(ECLAT)), "tests", "libwrong_device.so")}


class Selftest(Case):
    def rows(self, text):
        """Returns (state, name, digits) of every row of a table."""
        lines = text.splitlines()
        for word in ["case", "expected", "measured", "tolerance", "digits"]:
            self.assertIn(word, lines[0])
        rows = [re.match(r"(ok|FAILED) +(\S.*?)  +\S+ +\S+ +\S+ +([0-9.]+)", line) for line in lines[1:]]
        return [(row[1], row[2], float(row[3])) for row in rows if row]

    def test_table_is_worst_first(self):
        run = self.assert_ok(eclat(*SOME))
        rows = self.rows(run.stdout)
        self.assertGreater(len(rows), 1)
        self.assertEqual([row[2] for row in rows], sorted(row[2] for row in rows))
        for state, name, _ in rows:
            self.assertEqual(state, "ok")
            self.assertTrue(name.startswith("numbers/functions "), name)
        self.assertRegex(run.stdout.splitlines()[-1], rf"^all {len(rows)} rows passed in .*; the fewest digits are \d")

    def test_json(self):
        run = self.assert_ok(eclat(*SOME, "--json"))
        report = json.loads(run.stdout)
        self.assertIs(report["pass"], True)
        self.assertEqual(report["failed"], 0)
        self.assertTrue(report["device"]["name"])
        self.assertIn(report["lanes"], [1, 4, 8, 16])
        self.assertGreater(len(report["cases"]), 1)
        for row in report["cases"]:
            self.assertEqual(sorted(row), sorted(KEYS))
            self.assertIs(row["pass"], True)
            self.assertLessEqual(abs(row["measured"] - row["expected"]), row["tolerance"])
            self.assertTrue(row["breaks"])
        digits = [row["digits"] for row in report["cases"]]
        self.assertEqual(digits, sorted(digits))

    def test_quiet_says_nothing_where_all_is_well(self):
        run = self.assert_ok(eclat(*SOME, "-q"))
        self.assertEqual(run.stdout + run.stderr, "")

    def test_lanes_are_those_asked_for(self):
        report = json.loads(self.assert_ok(eclat(*SOME, "--lanes", "4", "--json")).stdout)
        self.assertEqual(report["lanes"], 4)

    def test_an_unknown_case_is_one_line(self):
        line = self.assert_one_error(eclat("selftest", "-q", "--only", "no such case"), 1)
        self.assertIn("no such case", line)

    def test_an_operand_is_refused(self):
        line = self.assert_one_error(eclat("selftest", "rays"), 2)
        self.assertIn("--only", line)

    def test_a_device_that_computes_wrongly_fails(self):
        run = eclat(*SOME, env=WRONG)
        self.assertEqual(run.returncode, 1, run.stderr)
        rows = self.rows(run.stdout)
        states = [row[0] for row in rows]
        self.assertIn("FAILED", states)
        self.assertEqual(states, sorted(states))  # failed rows come first
        self.assertEqual(run.stdout.count("what this breaks: "), states.count("FAILED"))
        self.assertRegex(run.stdout.splitlines()[-1], rf"^{states.count('FAILED')} of {len(rows)} rows FAILED in ")

    def test_its_json_says_so(self):
        run = eclat(*SOME, "--json", env=WRONG)
        self.assertEqual(run.returncode, 1, run.stderr)
        report = json.loads(run.stdout)
        self.assertIs(report["pass"], False)
        self.assertEqual(report["failed"], len(report["cases"]))
        rows = {row["name"]: row for row in report["cases"]}
        self.assertTrue(all(row["pass"] is False for row in rows.values()))
        self.assertEqual(rows["numbers/functions exp"]["measured"], 1)  # all results are 0

    def test_quiet_shows_what_failed_and_nothing_else(self):
        run = eclat(*SOME, "-q", env=WRONG)
        self.assertEqual(run.returncode, 1)
        self.assertEqual(run.stderr, "")
        failed = self.rows(run.stdout)
        self.assertEqual({row[0] for row in failed}, {"FAILED"})
        self.assertEqual(len(run.stdout.splitlines()), 1 + 2 * len(failed))


if __name__ == "__main__":
    unittest.main()

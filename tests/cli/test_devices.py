# tier: quick
"""eclat devices."""
import json
import unittest

from support import Case, eclat

KEYS = ["index", "name", "type", "version", "driver", "platform", "compute_units", "native_float_width", "memory_bytes",
        "max_allocation_bytes", "correctly_rounded_divide_sqrt", "denormals", "fma"]


class Devices(Case):
    def test_table_marks_one_default_and_says_why(self):
        run = self.assert_ok(eclat("devices", env={"ECLAT_DEVICE": ""}))
        self.assertEqual(run.stderr, "")
        lines = run.stdout.splitlines()
        for word in ["name", "OpenCL", "units", "lanes", "memory", "max alloc", "exact div", "denormals", "fma"]:
            self.assertIn(word, lines[0])
        self.assertEqual(sum(line.startswith("* ") and "default:" not in line for line in lines), 1)
        self.assertRegex(lines[-1], r"default: \d+ \(.+\)")

    def test_json(self):
        run = self.assert_ok(eclat("devices", "--json"))
        report = json.loads(run.stdout)
        self.assertEqual([device["index"] for device in report["devices"]], list(range(len(report["devices"]))))
        for key in KEYS:
            self.assertIn(key, report["devices"][report["default"]])
        self.assertTrue(report["why"])

    def test_environment_chooses_the_default(self):
        report = json.loads(self.assert_ok(eclat("devices", "--json", env={"ECLAT_DEVICE": "0"})).stdout)
        self.assertEqual(report["default"], 0)

    def test_a_wrong_environment_does_not_hide_the_list(self):
        run = self.assert_ok(eclat("devices", "--json", env={"ECLAT_DEVICE": "no such device"}))
        report = json.loads(run.stdout)
        self.assertIsNone(report["default"])
        self.assertGreater(len(report["devices"]), 0)
        self.assertTrue(run.stderr.startswith("eclat: warning: "), run.stderr)

    def test_no_device_at_all_is_one_clear_line(self):
        line = self.assert_one_error(eclat("devices", env={"OCL_ICD_VENDORS": self.folder}), 1)
        self.assertIn("pocl-opencl-icd", line)


if __name__ == "__main__":
    unittest.main()

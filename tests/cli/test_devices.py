# tier: quick
"""eclat devices."""
import json
import os
import shutil
import unittest

from support import CORNELL, Case, eclat, read_exr

KEYS = ["index", "name", "type", "version", "driver", "platform", "compute_units", "native_float_width", "memory_bytes",
        "max_allocation_bytes", "correctly_rounded_divide_sqrt", "denormals", "fma", "subgroup_ballot", "uses_subgroups"]


class Devices(Case):
    def test_table_marks_one_default_and_says_why(self):
        run = self.assert_ok(eclat("devices", env={"ECLAT_DEVICE": ""}))
        self.assertEqual(run.stderr, "")
        lines = run.stdout.splitlines()
        for word in ["name", "OpenCL", "units", "lanes", "memory", "max alloc", "exact div", "denormals", "fma", "sub-groups"]:
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

    def test_a_processor_taken_for_a_card_gives_the_same_bits(self):
        pictures = []
        for kind in "cpu", "gpu", "accel":
            env = {"ECLAT_DEVICE_TYPE": kind}
            report = json.loads(self.assert_ok(eclat("devices", "--json", env=env)).stdout)
            self.assertEqual({device["type"].lower() for device in report["devices"]}, {kind})
            run = self.assert_ok(eclat("render", CORNELL, "--size", "24x24", "--spp", "8", "-q", "--json", "-o", self.path("a.exr"), env=env))
            report = json.loads(run.stdout)
            if kind == "gpu":
                self.assertEqual(report["lanes"], 1)
            pictures.append(read_exr(self.path("a.exr"))[1])
        self.assertEqual(pictures[1], pictures[0])
        self.assertEqual(pictures[2], pictures[0])

    def test_rows_of_the_table_of_drivers_can_be_forced(self):
        pictures = []
        for row in "", "none", "PoCL", "Oclgrind", "rusticl", "Intel(R) OpenCL":
            self.assert_ok(eclat("render", CORNELL, "--size", "24x24", "--spp", "8", "-q", "-o", self.path("a.exr"), env={"ECLAT_WORKAROUND": row}))
            pictures.append(read_exr(self.path("a.exr"))[1])
            self.assertEqual(pictures[-1], pictures[0], row)

    def test_cards_use_sub_groups_to_the_same_bits(self):
        """A compiler that has none for OpenCL C 1.2, whatever extensions the device lists, takes the kernels too."""
        if "ECLAT_FAULT_SHIM" not in os.environ:
            self.skipTest("no ECLAT_FAULT_SHIM")
        card = {"LD_PRELOAD": os.environ["ECLAT_FAULT_SHIM"], "FAULT_EXTENSIONS": "cl_khr_fp64 cl_khr_subgroup_ballot", "ECLAT_DEVICE_TYPE": "gpu",
                "ECLAT_WORKAROUND": "none", "ECLAT_COMPILE": "first"}
        pictures = []
        for changed, has, uses in [({"FAULT_EXTENSIONS": "cl_khr_fp64 cl_khr_subgroup_ballot_2"}, False, False), ({}, True, True),
                                   ({"ECLAT_DEVICE_TYPE": "cpu"}, True, False), ({"ECLAT_WORKAROUND": "Intel(R) OpenCL"}, True, False)]:
            env = {**card, **changed}
            for device in json.loads(self.assert_ok(eclat("devices", "--json", env=env)).stdout)["devices"]:
                self.assertEqual((device["subgroup_ballot"], device["uses_subgroups"]), (has, uses), changed)
            line = self.assert_ok(eclat("devices", env=env)).stdout.splitlines()[1]
            self.assertEqual(line.split()[-1], "yes" if uses else "no")
            if changed and "ECLAT_WORKAROUND" not in changed:
                continue
            kernels = self.path(str(len(pictures)))
            self.assert_ok(eclat("render", CORNELL, "--size", "24x24", "--spp", "8", "--lanes", "1", "-q", "-o", self.path("a.exr"),
                                 env={**env, "ECLAT_DUMP_KERNELS": kernels}))
            with open(os.path.join(kernels, "lanes1.cl"), encoding="utf-8") as file:
                self.assertEqual("-DSUBGROUPS" in file.readline().split(), uses)
            pictures.append(read_exr(self.path("a.exr"))[1])
        self.assertEqual(pictures[0], pictures[1])

    def test_what_cannot_be_forced_is_one_clear_line(self):
        line = self.assert_one_error(eclat("devices", env={"ECLAT_DEVICE_TYPE": "card"}), 1)
        self.assertIn("ECLAT_DEVICE_TYPE=card: must be cpu, gpu or accel", line)
        line = self.assert_one_error(eclat("devices", env={"ECLAT_WORKAROUND": "nvidia"}), 1)
        self.assertIn("ECLAT_WORKAROUND=nvidia: must be PoCL, Oclgrind, rusticl, Intel(R) OpenCL or none", line)

    def test_no_device_at_all_is_one_clear_line(self):
        line = self.assert_one_error(eclat("devices", env={"OCL_ICD_VENDORS": self.folder}), 1)
        self.assertIn("pocl-opencl-icd", line)

    def test_a_driver_that_the_loader_is_not_told_of(self):
        """Containers may get NVIDIA's libraries from outside, without a file that tells the loader. Any library stands in for the driver
        here."""
        if "ECLAT_FAULT_SHIM" not in os.environ:
            self.skipTest("no ECLAT_FAULT_SHIM")
        shutil.copy(os.environ["ECLAT_FAULT_SHIM"], self.path("libnvidia-opencl.so.1"))
        brought_in = {"LD_LIBRARY_PATH": self.folder, "ECLAT_DEVICE": ""}
        mend = "NVIDIA's driver is installed, but the OpenCL loader does not know of it; to use its devices: echo libnvidia-opencl.so.1 >/etc/OpenCL/vendors/nvidia.icd"
        self.assertEqual(self.assert_ok(eclat("devices", env=brought_in)).stderr, f"eclat: warning: {mend}\n")
        picture = "render", CORNELL, "--size", "24x24", "--spp", "8", "-q", "-o", self.path("a.exr")
        self.assertEqual(self.assert_ok(eclat(*picture, env=brought_in)).stderr, f"eclat: warning: {mend}\n")
        self.assertEqual(self.assert_ok(eclat(*picture, "--device", "0", env=brought_in)).stderr, "")
        drivers = "/etc/OpenCL/vendors"
        if os.path.isdir(drivers):  # a user who names a folder of drivers has chosen
            self.assertEqual(self.assert_ok(eclat("devices", env={**brought_in, "OCL_ICD_VENDORS": drivers})).stderr, "")
        line = self.assert_one_error(eclat("devices", env={**brought_in, "OCL_ICD_VENDORS": self.path("none")}), 1)
        self.assertIn("no OpenCL driver is installed; " + mend, line)


if __name__ == "__main__":
    unittest.main()

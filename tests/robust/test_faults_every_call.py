# tier: long
"""test_faults_device.py's sweep with ten times the moments."""
import unittest

import test_faults_device


class EveryCall(test_faults_device.Device):
    most = 60
    test_device_lost = test_a_command_that_fails_as_it_runs = test_the_report_is_made_all_the_same = None  # once is enough


if __name__ == "__main__":
    unittest.main()

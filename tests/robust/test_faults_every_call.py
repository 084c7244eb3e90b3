# tier: long
"""Repeats test_faults_device.py's sweep over calls with ten times as many uses."""
import unittest

import test_faults_device


class EveryCall(test_faults_device.Device):
    most = 60
    test_device_lost = test_a_command_that_fails_as_it_runs = test_the_report_is_made_all_the_same = None  # these tests run once only


if __name__ == "__main__":
    unittest.main()

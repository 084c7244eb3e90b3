# tier: quick
"""tools/bench/gpu_model.py: its counts from Oclgrind's histograms, and its roofline."""
import os
import sys
import unittest

from support import SOURCE

sys.path.insert(0, os.path.join(SOURCE, "tools", "bench"))
import gpu_model

TEXT = """
Instructions executed for kernel 'ec_shade':
           1,000 - load private (4,000 bytes)
              20 - load global (80 bytes)
              10 - call _Z3fmafff()
               5 - store global (20 bytes)
               3 - fdiv
               2 - load constant (8 bytes)
               9 - call v3_make()

other words
Instructions executed for kernel 'ec_shade':
               1 - fadd
               1 - load global (4 bytes)

Instructions executed for kernel 'ec_connect_bvh2':
               2 - icmp
               7 - br
"""


class Model(unittest.TestCase):
    def test_counts_what_an_optimised_kernel_has_too(self):
        """80 + 20 + 8 + 4 bytes; 10 calls of fma, 3 divisions of 8 and an addition."""
        self.assertEqual(gpu_model.count(TEXT), {"ec_shade": [112, 35], "ec_connect_bvh2": [0, 2]})

    def test_roofline(self):
        memory, arithmetic = gpu_model.bounds(480, 335, "H200")
        self.assertAlmostEqual(memory, 1e10)
        self.assertAlmostEqual(arithmetic, 1e11)


if __name__ == "__main__":
    unittest.main()

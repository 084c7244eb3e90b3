# tier: long
"""AArch64 by QEMU: runs the quick host tests, and renders this machine's picture, bit for bit."""
import os
import shutil
import unittest

import debian
import support
from debian import chroots


class Aarch64(debian.Case):
    def test_host_tests_and_a_render(self):
        picture = os.path.join(chroots.BUILD, "aarch64", "picture.exr")
        shutil.rmtree(os.path.dirname(picture), ignore_errors=True)
        chroots.check("qemu-aarch64-static")
        self.assertEqual(debian.tool("aarch64").main([]), 0)
        if not os.path.exists(picture):
            self.skipTest("host tests pass; for a render this kernel has no private formats of programs (Linux 6.7)")
        here = picture.replace("picture.exr", "here.exr")
        self.assertEqual(support.eclat("render", support.CORNELL, "--size", "32x32", "--spp", "8", "-q", "-o", here).returncode, 0)
        self.assertEqual(*(support.read_exr(file)[0]["eclat.imageSha256"] for file in (picture, here)))


if __name__ == "__main__":
    unittest.main()

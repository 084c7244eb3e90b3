# tier: full
"""kernels/shared/builtins.h declares what kernels call: they call the same functions, of the same types, as with all of OpenCL's functions
declared. Skips without Clang."""
import collections
import glob
import os
import re
import shutil
import subprocess
import unittest

from support import SOURCE, Case

CLANG = shutil.which("clang-15") or shutil.which("clang")
CALL = re.compile(r"\bcall\b[^(]*@(_Z\w+)")  # the mangled name, which has the types of the arguments
OWN, ALL = ["-D_OPENCL_H_", "-DEC_OWN_BUILTINS"], ["-Xclang", "-finclude-default-header"]


def calls(source, lanes, declarations):
    """Counts the calls of each function in a kernel's source; None where the source does not compile for so many lanes."""
    done = subprocess.run([CLANG, "-x", "cl", "-cl-std=CL1.2", "-cl-no-stdinc", "-target", "x86_64", "-S", "-emit-llvm", "-O0", "-w", "-Xclang", "-disable-O0-optnone",
                           f"-DLANES={lanes}", "-DFEATURES=0ul", "-DINTERLEAVE=8", *declarations, source, "-o", "-"], capture_output=True, encoding="utf-8", check=False)
    return collections.Counter(CALL.findall(done.stdout)) if done.returncode == 0 else None


@unittest.skipUnless(CLANG, "no clang")
class Builtins(Case):
    def test_the_same_functions_are_called(self):
        kernels = os.path.join(SOURCE, "kernels")
        compared = 0
        for source in glob.glob(os.path.join(kernels, "stages", "*.cl")) + glob.glob(os.path.join(kernels, "lib", "traverse_*.h")):
            for lanes in 1, 8, 16:
                expected = calls(source, lanes, ALL)
                if expected is None:
                    continue
                with self.subTest(source=os.path.basename(source), lanes=lanes):
                    self.assertEqual(calls(source, lanes, OWN), expected)
                    compared += 1
        self.assertGreater(compared, 30)


if __name__ == "__main__":
    unittest.main()

# tier: long
"""The archive runs on a minimal Debian 12 with an OpenCL driver as the only package, and on every glibc that the manual names."""
import os
import re
import subprocess
import unittest

import debian
import support
from debian import made


def newest(folder, library):
    """The newest symbol version of a system library that the programs and libraries in a folder need."""
    found = set()
    for parent, _, names in os.walk(folder):
        for name in names:
            text = subprocess.run(["objdump", "-T", os.path.join(parent, name)], capture_output=True, text=True).stdout
            found |= {tuple(map(int, version.split("."))) for version in re.findall(rf"\b{library}_(\d+(?:\.\d+)+)", text)}
    return ".".join(map(str, max(found)))


class Archive(debian.Case):
    def test_on_a_bare_debian(self):
        archive = made(debian.packages("bookworm"), "eclat-*.tar.gz")
        chroot = self.fresh("bookworm", "archive")
        subprocess.run(["tar", "-C", chroot.inside("opt"), "-xf", archive], check=True)
        folder = made(chroot.inside("opt"), "eclat-*")
        program = "/opt/" + os.path.basename(folder) + "/bin/eclat"
        self.assertIn("modules   view\n", self.ok(chroot, program, "--version"))
        for file in (program, program.replace("bin/eclat", "lib/eclat/eclat-compile")):
            self.assertNotIn("not found", self.ok(chroot, "ldd", file))
        self.one_error(chroot, program, "devices")
        self.assertIn("libX11", self.one_error(chroot, program, "view", "/root/" + debian.CORNELL))
        self.assertIn("install the package eclat-mpi", self.one_error(chroot, "env", "OMPI_COMM_WORLD_SIZE=2", "OMPI_COMM_WORLD_RANK=0", program, "devices"))
        chroot.install("pocl-opencl-icd")
        self.assertIn("*  0", self.ok(chroot, program, "devices"))
        self.assert_renders(chroot, program)
        with open(os.path.join(support.SOURCE, "docs", "getting-started.md"), encoding="utf-8") as page:
            told = re.search(r"glibc ([\d.]+\d) and libstdc\+\+ with GLIBCXX_([\d.]+\d)", page.read())
        self.assertEqual((newest(folder, "GLIBC"), newest(folder, "GLIBCXX")), told.groups())
        licences = os.listdir(os.path.join(folder, "share", "doc", "eclat", "licences"))
        self.assertIn("libpng16-16", licences)


if __name__ == "__main__":
    unittest.main()

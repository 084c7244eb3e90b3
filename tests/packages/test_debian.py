# tier: long
"""The .deb files, built in a chroot of Debian and installed by dpkg in another, minimal one."""
import unittest

import debian
from debian import made


class Packages(debian.Case):
    def install(self, chroot, file):
        """Installs as a user does: dpkg, then apt for missing dependencies."""
        self.copy(chroot, file)
        chroot.run("sh", "-c", f"dpkg -i /root/{file.split('/')[-1]}")
        self.ok(chroot, "sh", "-c", "apt-get -q update >/dev/null; apt-get -q install -y -f --no-install-recommends >/tmp/log 2>&1 || { cat /tmp/log; exit 1; }")
        name = file.split("/")[-1].split("_")[0]
        self.assertEqual(self.ok(chroot, "dpkg-query", "-W", "-f", "${db:Status-Abbrev}", name), "ii ")

    def on(self, suite):
        folder = debian.packages(suite)
        chroot = self.fresh(suite, "debs")
        self.install(chroot, made(folder, "eclat_*.deb"))
        self.assertIn("modules   none\n", self.ok(chroot, "eclat", "--version"))
        self.assertIn("install the package eclat-view", self.one_error(chroot, "eclat", "view", "/root/" + debian.CORNELL))
        self.assertIn("mpi", self.one_error(chroot, "env", "OMPI_COMM_WORLD_SIZE=2", "OMPI_COMM_WORLD_RANK=0", "eclat", "devices"))
        self.one_error(chroot, "eclat", "devices")  # no driver is installed yet
        self.assertIn("pocl-opencl-icd | opencl-icd", self.ok(chroot, "dpkg-query", "-W", "-f", "${Recommends}", "eclat"))
        chroot.install("pocl-opencl-icd")
        self.assertIn("*  0", self.ok(chroot, "eclat", "devices"))
        self.assert_renders(chroot)
        self.install(chroot, made(folder, "eclat-view_*.deb"))
        self.assertIn("modules   view\n", self.ok(chroot, "eclat", "--version"))
        self.assertRegex(self.one_error(chroot, "env", "XDG_RUNTIME_DIR=/tmp", "eclat", "view", "/root/" + debian.CORNELL), "no preview window: cannot reach a display")
        self.install(chroot, made(folder, "eclat-mpi_*.deb"))
        self.assertIn("modules   mpi, view\n", self.ok(chroot, "eclat", "--version"))
        chroot.install("openmpi-bin")
        words = f"mpirun --allow-run-as-root --oversubscribe -n 2 eclat render /root/{debian.CORNELL} --size 16x16 --spp 8 -o /root/two.exr"
        self.assertIn("with 1 more process", self.ok(chroot, "sh", "-c", words + " 2>&1"))
        self.install(chroot, made(folder, "libeclat-dev_*.deb"))
        self.assertIn("-leclat", self.ok(chroot, "cat", "/usr/lib/pkgconfig/eclat.pc"))
        for file in ("bash-completion/completions/eclat", "fish/vendor_completions.d/eclat.fish", "zsh/vendor-completions/_eclat"):
            self.ok(chroot, "grep", "-q", "integrator", "/usr/share/" + file)
        self.ok(chroot, "dpkg", "-P", "libeclat-dev", "eclat-mpi", "eclat-view", "eclat")
        self.assertEqual(self.ok(chroot, "sh", "-c", "ls -d /usr/lib/eclat /usr/lib/libeclat* /usr/bin/eclat 2>/dev/null || true"), "")

    def test_debian_12(self):
        self.on("bookworm")

    def test_testing(self):
        self.on("testing")


if __name__ == "__main__":
    unittest.main()

# tier: long
"""The add-on in a window of Blender, on a virtual screen: a viewport with rendered shading, and F12. BLENDER names the program, ECLAT
eclat's; Xvfb with software OpenGL."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
BLENDER = os.environ.get("BLENDER", "")
if not BLENDER or not shutil.which("Xvfb"):
    print("skipped: BLENDER names no Blender with windows, or Xvfb is not installed")
    sys.exit(77)
GUARD = 600  # seconds until the test gives up


class Window(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="eclat-window-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        read, write = os.pipe()
        server = subprocess.Popen(["Xvfb", "-screen", "0", "1280x800x24", "-displayfd", str(write), "-nolisten", "tcp"], pass_fds=[write],
                                  stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(server.wait)
        self.addCleanup(server.kill)
        os.close(write)
        with os.fdopen(read) as pipe:
            display = pipe.readline().strip()
        homes = {name: os.path.join(self.folder, name) for name in ("HOME", "BLENDER_USER_RESOURCES")}
        for path in homes.values():
            os.mkdir(path)
        self.environment = dict(os.environ, DISPLAY=":" + display, LIBGL_ALWAYS_SOFTWARE="1", **homes)

    def blender(self, *words):
        return subprocess.run([BLENDER, *words], env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, encoding="utf-8", errors="replace", timeout=GUARD)

    def test_viewport_and_render(self):
        archive = os.path.join(self.folder, "eclat_blender.zip")
        subprocess.run([os.path.join(ROOT, "tools", "blender", "make_zip.py"), archive], check=True, stdout=subprocess.DEVNULL)
        installed = self.blender("--command", "extension", "install-file", "-r", "user_default", "-e", archive)
        self.assertIn("nstalled \"eclat_blender\"", installed.stdout)
        run = self.blender("--window-geometry", "0", "0", "1280", "800", "--python", os.path.join(HERE, "in_window.py"))
        self.assertIn("\nall steps passed\n", run.stdout, run.stdout[-4000:])


if __name__ == "__main__":
    unittest.main()

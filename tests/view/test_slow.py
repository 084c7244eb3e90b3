# tier: full
"""A scene that takes longer to read than a window waits for."""
import unittest

from virtual_screen import ViewCase

WIDTH, HEIGHT = 8192, 4096


class Slow(ViewCase):
    def grey_map(self):
        """A map that is large once read, 400 MB, from a small file. --env-strength processes all of its values again."""
        row = b"".join(bytes([128 + min(127, WIDTH - x), value]) for value in (128, 128, 128, 129) for x in range(0, WIDTH, 127))
        path = self.path("grey.hdr")
        with open(path, "wb") as file:
            file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (HEIGHT, WIDTH))
            file.write((bytes([2, 2, WIDTH >> 8, WIDTH & 255]) + row) * HEIGHT)
        return path

    def test_the_window_is_there_first_and_as_large_as_asked_for(self):
        window = self.open(self.scene, "--size", "300x200", "--spp", "2", "--env", self.grey_map(), "--env-strength", "1.5")
        self.assertEqual(window.size(), (300, 200))

        def lit():
            values = window.picture()[2]
            return sum(value > 100 for value in values) / len(values)
        seen = []
        window.wait_until(lambda: seen.append(lit()) or seen[-1] > 0.2, 0.05)
        self.assertTrue(any(0.005 < share < 0.1 for share in seen), f"no words before the picture: {seen}")
        self.assertGreater(seen[-1], 0.2, "no picture")
        self.assertEqual(window.size(), (300, 200))
        self.assertEqual(window.close(), 0)

    def test_keys_count_before_the_scene_is_there(self):
        slow = ["--size", "300x200", "--spp", "2", "--env", self.grey_map(), "--env-strength", "1.5"]
        window = self.open(self.scene, *slow)
        window.key("3", "c", "f", "r", "comma", "x", "1", "x", "E", "F5")  # some need the scene and do nothing without it; none blocks
        window.rest()
        command = window.save()
        self.assertIn("--integrator=raster", command)
        self.assertIn("--exposure=0.333", command)
        self.assertEqual(window.close(), 0)
        self.assertEqual(self.open(self.scene, *slow).close(), 0)


if __name__ == "__main__":
    unittest.main()

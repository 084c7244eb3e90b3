# tiers: quick, full
"""--channels motion: how many pixels things move by in the picture while the shutter is open, against closed forms."""
import math
import unittest

from support import CORNELL, FLOAT, Case, eclat, read_exr
from test_motion import GLOW, Builder, turn
from tiers import full

WIDE, HIGH = 24, 16


def square(node=None, **camera):
    """A square of 1 x 1 in the plane z = 0, animated as `node` says, and a perspective camera at (0, 0, 5); the tangent of half its field
    is 0.4."""
    b = Builder()
    b.scene["cameras"] = [{"type": "perspective", "perspective": {"yfov": 2 * math.atan(0.4), "znear": 0.1, "aspectRatio": WIDE / HIGH}}]
    b.node(camera=0, translation=[0, 0, 5])
    b.add(dict(GLOW))
    for at, path, values in ([(1, *node)] if node else []) + ([(0, *camera["camera"])] if camera else []):
        b.animate(at, path, values)
    return b


def pixels_at(depth):
    """Pixels a metre."""
    return HIGH / (2 * 0.4 * depth)


class Vectors(Case):
    def render(self, b, *options, spp="64"):
        scene = b.write(self.path("scene.gltf"))
        self.assert_ok(eclat("render", scene, "--size", f"{WIDE}x{HIGH}", "--spp", spp, "-q", "--channels", "default,A,motion", "--shutter", "0:1", *options, "-o", "a.exr", cwd=self.folder))
        attributes, planes = read_exr(self.path("a.exr"))
        self.assertEqual({name: kind for name, kind in attributes["channels"] if "motion" in name}, {"motion.X": FLOAT, "motion.Y": FLOAT})
        return planes

    def test_a_square_that_moves(self):
        """The vector is exactly the square's motion in pixels that it covers all the time, and points down as it sinks. It is 0 where rays
        hit nothing, and elsewhere the motion times A."""
        planes = self.render(square(("translation", [(0, 0, 0), (.25, -.5, 0)])), spp="8")
        x, y = .25 * pixels_at(5), .5 * pixels_at(5)
        for i, alpha in enumerate(planes["A"]):
            self.assertAlmostEqual(planes["motion.X"][i], alpha * x, delta=x / 100)
            self.assertAlmostEqual(planes["motion.Y"][i], alpha * y, delta=y / 100)
        self.assertIn(1, planes["A"])
        self.assertIn(0, planes["A"])

    @full
    def test_a_camera_that_moves(self):
        """A still object moves the other way, by an amount that depends on its depth. At infinity nothing moves."""
        planes = self.render(square(camera=("translation", [(0, 0, 5), (.1, .05, 5)])))
        inside, corner = HIGH // 2 * WIDE + WIDE // 2, 0
        self.assertAlmostEqual(planes["motion.X"][inside], -.1 * pixels_at(5), 4)
        self.assertAlmostEqual(planes["motion.Y"][inside], .05 * pixels_at(5), 4)
        self.assertEqual((planes["motion.X"][corner], planes["motion.Y"][corner]), (0, 0))

    @full
    def test_a_camera_that_turns(self):
        """The whole picture moves alike at all depths. The middle of the view moves to the tangent of the angle by which the camera turns."""
        degrees = 2
        planes = self.render(square(camera=("rotation", [turn(1, -degrees), turn(1, degrees)])), "--env", "1,1,1", spp="256")
        unit = HIGH / (2 * 0.4)  # pixels for a tangent of 1
        for i in (HIGH // 2 * WIDE + WIDE // 2, HIGH // 2 * WIDE + 2):  # on the square, and beside it
            angle = math.atan((i % WIDE + .5 - WIDE / 2) / unit)  # in the middle of the exposure
            before, after = (angle + sign * math.radians(degrees) for sign in (-1, 1))
            way = unit * (math.tan(after) - math.tan(before))
            self.assertAlmostEqual(planes["motion.X"][i], way, delta=0.02 * way)
            down = .5 * math.cos(angle) * (1 / math.cos(after) - 1 / math.cos(before))  # the row's centre is half a pixel below the view's
            self.assertAlmostEqual(planes["motion.Y"][i], down, delta=0.003)

    @full
    def test_same_bits_everywhere(self):
        """And the channels do not change the picture."""
        b = square(("rotation", [turn(2, 0), turn(2, 80)]))
        planes = self.render(b)
        self.assert_ok(eclat("render", self.path("scene.gltf"), "--size", f"{WIDE}x{HIGH}", "--spp", "64", "-q", "--shutter", "0:1", "-o", "b.exr", cwd=self.folder))
        alone = read_exr(self.path("b.exr"))[1]
        self.assertTrue(all(planes[c] == alone[c] for c in alone))
        for other in (["--lanes", "1"], ["--wave", "4096"], ["--accel", "kdtree"]):
            same = self.render(b, *other)
            self.assertTrue(all(planes[c] == same[c] for c in planes))

    def test_refused(self):
        run = eclat("render", CORNELL, "--channels", "motion", "-o", "a.exr", cwd=self.folder)
        self.assertIn("give --shutter A:B too", self.assert_one_error(run, 2))


if __name__ == "__main__":
    unittest.main()

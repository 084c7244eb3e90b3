# tiers: quick, full
"""The bound of the error: harmless scenes state one, and no stated bound is too small. tools/bench/bounds.py counts the same over more
scenes, seeds and budgets.

Each picture is compared with a reference that has the light that its samples can miss. A bound of 95 % may fail once in 20 renders, but
true errors were two to four times the bounds stated before eclat refused any: 61 % and 25 % (lamp), 25 % and 6.5 % (glass), medians of ten
seeds."""
import base64
import json
import math
import os
import struct
import unittest

from dim_rooms import HOLE, SKY, far_room, lamp_room, near_room, point_room, sky_room, sun_room, texel_room
from support import CORNELL, NARROW, SOURCE, Case, eclat, read_exr, write_exr
from tiers import full

SEEDS = range(10)
SIZE = 12
PINLAMP, UNFOLDED = (os.path.join(SOURCE, "scenes", "pinlamp", name + ".gltf") for name in ("pinlamp", "unfolded"))
VASE = os.path.join(SOURCE, "scenes", "vase", "vase.gltf")
# Luminance of the vase under sky(), halves, rows from the top, from a render of 2^20 samples a pixel whose own error is 3.1 %.
VASE_REFERENCE = """
zTTNNM00zTTNNM00zTTNNM00zTTNNM00zTTNNM00zTTJNHU47DbINM00zTTNNM00zTTNNM00zTT7NJY5fzkpNc00zTTNNM00aTtqO207azvLOrM52DnIOmk7aTtpO2k7
OTw5PDk8OTzQOn070DvGOjk8OTw5PDo8Ojw5PDk8HTzkOos7QDs0OyI8OTw5PDk8OTw7PDk8IzyOO4U7bztxOxs8Pjw+PDk8PzxVPFA8PjwoPNE6pDkqOzA8Szw+PDk8
WDxZPBg7KjqBO+g4mjgiOZI8VzxRPEg8iDzWOk05mDqdO5I4fDgnPJg8RTxMPEg8SjznN5g5nThIOd06lzxxPGk8RzxCPD48kTyMO5E8gjybPGo8TzxUPGw8TTxAPDw8
"""


def luminance(path):
    planes = read_exr(path)[1]
    return [0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in zip(planes["R"], planes["G"], planes["B"])]


def mean(values):
    return sum(values) / len(values)


def true_error(picture, reference):
    return math.sqrt(mean([(a - b) ** 2 for a, b in zip(picture, reference)])) / mean(reference)


def sky(path):
    """A grey sky with a sun of one texel, 1.4 degrees across and 40 degrees high, that lights the floor six times as much as the rest."""
    width, height, x, y = 256, 128, 90, 35
    texels = [0.3] * (width * height)
    texels[y * width + x] = 20000.0
    return write_exr(path, width, height, {c: texels for c in "RGB"})


class Bounds(Case):
    def render(self, scene, *options):
        """Returns (bound or None, luminance)."""
        # for four scenes, kernels of their own compile sooner than those with all effects
        out = self.path("out.exr")
        run = self.assert_ok(eclat("render", "-q", *NARROW, "--size", f"{SIZE}x{SIZE}", "--json", "-o", out, *options, scene))
        bound = json.loads(run.stdout).get("error_bound")
        return bound if isinstance(bound, (int, float)) and math.isfinite(bound) else None, luminance(out)

    def missing_light(self, scene, *options, spp=16):
        """Returns how much light so many samples a pixel may miss, relative to the picture's."""
        return json.loads(self.assert_ok(eclat("render", "-q", *NARROW, "--size", f"{SIZE}x{SIZE}", "--spp", str(spp), "--max-depth", "5", "--json",
                                               "-o", self.path("out.exr"), *options, scene)).stdout)["error_unmet"]

    def assert_bounds_hold(self, reference, scene, *options):
        for seed in SEEDS:
            bound, picture = self.render(scene, "--seed", str(seed), *options)
            with self.subTest(seed=seed):
                if bound is not None:
                    self.assertLessEqual(true_error(picture, reference), bound)

    def test_harmless_box_states_a_bound(self):
        # light sampling finds all of its light: there is no reason to refuse a bound
        for seed in SEEDS:
            bound, _ = self.render(CORNELL, "--seed", str(seed), "--spp", "64", "--max-depth", "5")
            with self.subTest(seed=seed):
                self.assertIsNotNone(bound)

    @full
    def test_lamp_with_one_bright_texel_has_a_bound_that_holds(self):
        # when the lamp was sampled uniformly, one of 8 192 rays to it found its light: true errors of 70 % under bounds of 12 %
        room = texel_room(self.path("texel.gltf"))
        _, reference = self.render(room, "--spp", "4096", "--seed", "1000", "--max-depth", "5")
        for seed in range(5):
            bound, picture = self.render(room, "--seed", str(seed), "--spp", "16", "--max-depth", "5")
            with self.subTest(seed=seed):
                self.assertIsNotNone(bound)
                self.assertLess(bound, 0.3)
                self.assertLessEqual(true_error(picture, reference), bound)

    def test_sun_through_a_small_hole_has_no_bound_that_fails(self):
        # one path in 50 000 meets the patch that lights the room: true errors were 66 % under bounds of 20 %
        _, reference = self.render(sun_room(self.path("patch.gltf"), "patch"), "--spp", "4096", "--seed", "1000", "--max-depth", "5")
        hole = sun_room(self.path("hole.gltf"), "hole")
        for seed in range(3):
            bound, picture = self.render(hole, "--seed", str(seed), "--spp", "64", "--max-depth", "5")
            with self.subTest(seed=seed):
                self.assertTrue(bound is None or true_error(picture, reference) <= bound)
        for seed in range(3):  # without the hole, this sun is harmless
            bound, _ = self.render(sun_room(self.path("sealed.gltf"), "sealed"), "--seed", str(seed), "--spp", "64", "--max-depth", "5")
            with self.subTest(seed=seed):
                self.assertIsNotNone(bound)

    @full
    def test_lamp_behind_a_small_hole_is_found(self):
        # 0.025 % of the floor is lit, and brings 15 % of the light
        self.assertGreater(self.missing_light(lamp_room(self.path("hole.gltf"), "hole")), 0.05)
        self.assertEqual(self.missing_light(lamp_room(self.path("sealed.gltf"), "sealed")), 0)

    @full
    def test_sky_through_a_small_hole_has_no_bound_that_fails(self):
        # one sample in a million and a half meets the hole, and it brings 70 % of the light: true errors were 72 % under bounds of 22 %
        even = ["--light", f"{SKY},{SKY},{SKY}"]
        _, reference = self.render(sky_room(self.path("lamp.gltf"), "lamp"), "--spp", "4096", "--seed", "1000", "--max-depth", "5")
        hole, sealed = sky_room(self.path("hole.gltf"), "hole"), sky_room(self.path("sealed.gltf"), "sealed")
        for seed in range(3):
            bound, picture = self.render(hole, *even, "--seed", str(seed), "--spp", "64", "--max-depth", "5")
            with self.subTest(seed=seed):
                self.assertTrue(bound is None or true_error(picture, reference) <= bound)
        # the root mean square of the hole's light is 2.4 times the mean of the lamp's; it is predicted within a factor of two from all of its directions
        above, below = (["--light", write_exr(self.path(f"{name}.exr"), 8, 8, {c: rows for c in "RGB"})]
                        for name, rows in (("above", [SKY] * 32 + [0] * 32), ("below", [0] * 32 + [SKY] * 32)))
        for scene, light in (hole, even), (sky_room(self.path("rug.gltf"), "hole", rug=100), even), (hole, above):
            with self.subTest(scene=scene, light=light):
                missing = self.missing_light(scene, *light)
                self.assertGreater(missing, 1.2)
                self.assertLess(missing, 4.8)
        self.assertEqual(self.missing_light(sealed, *even), 0)
        self.assertLess(self.missing_light(hole, *below), 0.1)
        # as much light through twelve holes
        row = self.missing_light(sky_room(self.path("row.gltf"), "hole", row=12), "--light", ",".join([str(SKY / 12)] * 3))
        self.assertGreater(row, 1.2)
        self.assertLess(row, 4.8)
        # as much light through a hole of 3 cm: one of 40 000 samples meets it
        wide = sky_room(self.path("wide.gltf"), "hole", side=6 * HOLE), "--light", ",".join([str(SKY / 36)] * 3)
        self.assertGreater(self.missing_light(*wide, spp=256), 0.5)
        self.assertEqual(self.missing_light(*wide, spp=4096), 0)

    @full
    def test_hole_is_found_in_a_scene_of_many_triangles(self):
        # the search tries 8 192 of 60 000 edges: uniform choices missed the hole's edges
        self.assertGreater(self.missing_light(sun_room(self.path("hole.gltf"), "hole", rug=100)), 0.1)

    @full
    def test_hole_is_found_in_a_room_on_a_plain(self):
        # the hole is narrower than a ten-thousandth of the scene's radius, the distance at which rays pass edges; and everything outside
        # the room is lit
        self.assertGreater(self.missing_light(sun_room(self.path("hole.gltf"), "hole", ground=400)), 0.1)
        self.assertEqual(self.missing_light(sun_room(self.path("sealed.gltf"), "sealed", ground=400)), 0)

    @full
    def test_point_or_spot_light_behind_a_small_hole_is_found(self):
        for spot in False, True:
            with self.subTest(spot=spot):
                self.assertGreater(self.missing_light(point_room(self.path("hole.gltf"), "hole", spot)), 0.3)
                self.assertEqual(self.missing_light(point_room(self.path("sealed.gltf"), "sealed", spot)), 0)

    @full
    def test_light_behind_a_small_hole_is_found_among_twenty(self):
        for make, least in (lamp_room, 0.05), (point_room, 0.3):
            with self.subTest(make=make.__name__):
                self.assertGreater(self.missing_light(make(self.path("hole.gltf"), "hole", others=20)), least)
                self.assertEqual(self.missing_light(make(self.path("sealed.gltf"), "sealed", others=20)), 0)

    @full
    def test_lamp_that_few_light_paths_start_at_has_no_bound_that_fails(self):
        # one light path in half a million starts at the lamp of the near half: true errors were 37 % under bounds of 23 %
        alone = "--integrator", "light"
        for kind in "lamp", "point":
            room = far_room(self.path(kind + ".gltf"), kind, 300)
            _, reference = self.render(room, "--spp", "1024", "--seed", "1000")
            for seed in range(3):
                bound, picture = self.render(room, *alone, "--spp", "256", "--seed", str(seed))
                with self.subTest(kind=kind, seed=seed):
                    self.assertTrue(bound is None or true_error(picture, reference) <= bound)
            missing = self.missing_light(room, *alone)
            with self.subTest(kind=kind):  # half of the far wall's light
                self.assertGreater(missing, 0.2)
                self.assertLess(missing, 1)
        # one light path in 5 000
        nearer = far_room(self.path("nearer.gltf"), "lamp", 30)
        self.assertGreater(self.missing_light(nearer, *alone), 0.2)
        self.assertEqual(self.missing_light(nearer, *alone, spp=256), 0)
        self.assertEqual(self.missing_light(CORNELL, *alone), 0)
        # a fifth of all directions are in the spot light's cone; a point light in its place would have light paths enough
        spot = far_room(self.path("spot.gltf"), "spot", 10)
        self.assertGreater(self.missing_light(spot, *alone), 0.2)
        self.assertEqual(self.missing_light(far_room(self.path("point.gltf"), "point", 10), *alone), 0)
        self.assertEqual(self.missing_light(spot, *alone, spp=64), 0)

    @full
    def test_point_light_below_a_roof_is_found(self):
        # rays past edges go on behind the light, and end on the roof
        self.assertGreater(self.missing_light(point_room(self.path("hole.gltf"), "hole", roof=True)), 0.3)
        self.assertEqual(self.missing_light(point_room(self.path("sealed.gltf"), "sealed", roof=True)), 0)

    @full
    def test_hole_in_one_of_many_triangles_that_are_kept_once_is_found(self):
        self.assertGreater(self.missing_light(sun_room(self.path("hole.gltf"), "hole", rug=100, twice=True), "--instancing", "on"), 0.1)

    @full
    def test_hole_in_a_mesh_that_is_kept_once_is_found(self):
        self.assertGreater(self.missing_light(sun_room(self.path("hole.gltf"), "hole", twice=True), "--instancing", "on"), 0.1)
        self.assertEqual(self.missing_light(sun_room(self.path("sealed.gltf"), "sealed", twice=True), "--instancing", "on"), 0)

    @full
    def test_hole_behind_panes_is_found(self):
        self.assertGreater(self.missing_light(sun_room(self.path("hole.gltf"), "hole", pane=True)), 0.1)

    @full
    def test_small_spot_lit_from_close_by_is_found(self):
        for kind, distance in ("point", 0.001), ("spot", 0.005), ("lamp", 0.002):
            with self.subTest(kind=kind):
                self.assertGreater(self.missing_light(near_room(self.path("near.gltf"), kind, distance)), 0.05)
                self.assertLess(self.missing_light(near_room(self.path("far.gltf"), kind, 100 * distance)), 0.005)

    @full
    def test_lamp_that_light_paths_find_has_a_bound(self):
        # a screen hides the lamp from the camera. Light paths find it. Camera paths may end where a guided direction leads into a wall; how
        # far they would have gone is unknown.
        bound, _ = self.render(PINLAMP, "--spp", "64")
        self.assertIsNotNone(bound)

    @full
    def test_lamp_that_no_path_meets_has_no_bound_that_fails(self):
        # unfolded.gltf gives the same picture (scenes/pinlamp/README.md)
        _, reference = self.render(UNFOLDED, "--spp", "4096", "--seed", "1000")
        self.assert_bounds_hold(reference, PINLAMP, "--spp", "256")

    @full
    def test_sun_through_glass_has_no_bound_that_fails(self):
        reference = struct.unpack(f"<{SIZE * SIZE}e", base64.b64decode(VASE_REFERENCE))
        self.assert_bounds_hold(reference, VASE, "--env", sky(self.path("sky.exr")), "--spp", "64")


if __name__ == "__main__":
    unittest.main()

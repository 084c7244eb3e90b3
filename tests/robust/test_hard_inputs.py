# tiers: quick, full
"""Numbers at the limits of float, and degenerate scenes. Dropped objects are counted, clamped values are reported, and the rest is the
picture without them."""
import math
import unittest

from hard_scene import LAMP, NORMAL, QUAD, UV, WHITE, HardCase, Scene, one_pixel_png, write_exr
from support import eclat
from tiers import full

FLOAT_1E30 = 1.0000000150474662e30  # 1e30 as a float
STRENGTH = "KHR_materials_emissive_strength"
LIGHTS = "KHR_lights_punctual"


def lamp(strength):
    return dict(LAMP, extensions={STRENGTH: {"emissiveStrength": strength}})


def white_with_light(light, **node):
    scene = Scene(WHITE).extend(LIGHTS, {"lights": [light]}).add(QUAD)
    return scene.node(extensions={LIGHTS: {"light": 0}}, **node)


class Emission(HardCase):
    def test_1e38_is_clamped_and_said(self):
        picture = self.render(Scene(lamp(1e38)).extend(STRENGTH).add(QUAD))
        self.assertIn("factors out of glTF's range; they are clamped", picture.messages)
        self.assertEqual(max(picture.channels["R"]), FLOAT_1E30)

    def test_1e_minus_38_is_kept(self):
        """Below the normal range, floats are 2^-149 apart, which is 1.4e-7 of 1e-38."""
        picture = self.render(Scene(lamp(1e-38)).extend(STRENGTH).add(QUAD))
        self.assertNotIn("warning", picture.messages)
        self.assertAlmostEqual(max(picture.channels["R"]) / 1e-38, 1, delta=1.5e-7)

    def test_environment_of_3e38_is_clamped_and_said(self):
        picture = self.render(Scene(WHITE).add(QUAD), "--env", "3e38,3e38,3e38")
        self.assertIn("3 values are above 1e+30; they are clamped to it", picture.messages)
        self.assertEqual(picture.channels["R"][0], FLOAT_1E30)  # beside the quad

    def test_overflow_at_a_surface_is_counted(self):
        """10^30 W/sr at a micrometre would give 10^42 W/m^2, which no float holds. The samples are dropped, with a warning."""
        scene = white_with_light({"type": "point", "intensity": 1e38}, translation=[0, 0, 1e-6])
        scene.json["cameras"][0]["perspective"]["yfov"] = 1e-8
        picture = self.render(scene, "--size", "4x4", invalid=None)
        self.assertEqual(picture.stats["invalid_samples"], 256)
        self.assertIn("256 samples were not finite and count as black", picture.messages)


@full
class Lights(HardCase):
    def test_emitters_without_area_are_left_out(self):
        with_lamp = Scene(WHITE, LAMP).add(QUAD).add(QUAD, 1, scale=[0.2, 0.2, 1], rotation=[1, 0, 0, 0], translation=[0, 0, 1])
        expected = self.render(with_lamp)
        point, line = [0.5, 0.5, 0.5] * 3, [0, 0, 0.5, 0.25, 0, 0.5, 0.5, 0, 0.5]
        picture = self.render(with_lamp.add(point, 1).add(line, 1))
        self.assertIn("2 triangles without area are left out", picture.messages)
        self.assert_same(picture, expected)

    def test_lights_that_give_nothing(self):
        for light in [{"type": "point", "intensity": 0}, {"type": "directional", "color": [0, 0, 0]},
                      {"type": "spot", "spot": {"innerConeAngle": 0, "outerConeAngle": 1e-38}}, {"type": "point", "range": 1e-38}]:
            with self.subTest(light=light):
                picture = self.render(white_with_light(light, translation=[0, 0, 1]), "--env", "0,0,0")
                self.assertLess(max(picture.channels["R"]), 1e-3)

    def test_lamps_that_are_there_twice(self):
        """Rays meet one of the two lamps, so that it counts once, however light is sampled."""
        def scene(count):
            s = Scene(WHITE, LAMP).add(QUAD, scale=[3, 3, 1])
            s.camera["translation"] = [0, 0, 0.9]
            for _ in range(count):
                s.add(QUAD, 1, rotation=[1, 0, 0, 0], translation=[0, 0, 1])
            return s
        for sample in ["mis", "light", "bsdf"]:
            with self.subTest(sample=sample):
                options = ["--sample", sample, "--max-depth", "2"]
                self.assert_same(self.render(scene(3), *options), self.render(scene(1), *options))


class Environments(HardCase):
    """A Lambertian floor of albedo 1/2 below maps of 8 x 4 texels."""

    def floor(self, rgb, *options):
        down = [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)]  # looks along -y instead of -z
        grey = {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0},
                "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}
        scene = Scene(grey).extend("KHR_materials_specular").add(QUAD, rotation=down)
        scene.camera.update(rotation=down, translation=[0, 3, 0])
        scene.json["cameras"][0]["perspective"]["yfov"] = 0.1
        return self.render(scene, "--env", write_exr(self.path("map.exr"), 8, 4, rgb), *options, spp="64")

    def test_rows_of_zeros(self):
        """Rows of 1 above and 0 below. Between the two middle rows the map falls from 1 to 0, and is 1/2 at the horizon. The expected value
        is the albedo times the integral of 2 L cos sin over the zenith angle."""
        steps, start, expected = 10000, math.radians(67.5), 0
        for i in range(steps):
            angle = (i + 0.5) / steps * math.pi / 2
            radiance = 1 - max(angle - start, 0) / math.radians(45)
            expected += 0.5 * radiance * math.sin(2 * angle) * math.pi / 2 / steps
        for sample in ["mis", "light", "bsdf"]:
            with self.subTest(sample=sample):
                picture = self.floor([1] * 48 + [0] * 48, "--sample", sample)
                self.assertLess(picture.se, 0.01 * expected)
                self.assertAlmostEqual(picture.mean, expected, delta=4 * picture.se)

    def test_texels_that_are_no_radiance(self):
        """Such texels count as black."""
        def rgb(values):
            return [1] * 24 + values + [1] * 69
        picture = self.floor(rgb([math.nan, math.inf, -1]))
        self.assertIn("3 values are NaN, infinite or negative; they are taken as 0", picture.messages)
        self.assert_same(picture, self.floor(rgb([0, 0, 0])))

    def test_a_black_map(self):
        self.assertEqual(max(self.floor([0] * 96).channels["R"]), 0)

    def test_one_texel_of_1e38(self):
        """The texel counts as 1e30, the others as 1e-38. No probability becomes 0 or infinite."""
        picture = self.floor([1e38] * 3 + [1e-38] * 93)
        self.assertIn("3 values are above 1e+30; they are clamped to it", picture.messages)
        self.assertGreater(picture.mean, 0)


@full
class Geometry(HardCase):
    def assert_no_difference(self, scene, message):
        """Adds two more triangles, which the loader must drop."""
        picture = self.render(scene)
        self.assertIn(message, picture.messages)
        self.assert_same(picture, self.render(Scene(LAMP).add(QUAD)))

    def test_positions_that_are_not_finite(self):
        for value in [math.nan, -math.inf, 1e30]:
            with self.subTest(value=value):
                broken = list(QUAD)
                broken[2] = broken[9] = value  # a corner of each triangle
                self.assert_no_difference(Scene(LAMP).add(QUAD).add(broken), "2 triangles are left out: their positions are NaN, infinite or beyond 1e18")

    def test_node_matrices_that_overflow(self):
        scene = Scene(LAMP).add(QUAD).add(QUAD).nest(2, 1e30, 11)
        self.assert_no_difference(scene, "2 triangles are left out: their positions are NaN, infinite or beyond 1e18")

    def test_node_matrices_that_underflow(self):
        scene = Scene(LAMP).add(QUAD).add(QUAD).nest(2, 1e-30, 11)
        self.assert_no_difference(scene, "2 triangles without area are left out")

    def test_singular_node(self):
        scene = Scene(LAMP).add(QUAD).add(QUAD, scale=[1, 0, 1])
        self.assert_no_difference(scene, "2 triangles without area are left out")

    def test_nothing_left_is_an_error(self):
        path = Scene(LAMP).add(QUAD, scale=[0, 0, 0]).write(self.path("scene.gltf"))
        line = self.assert_one_error(eclat("render", path, "-o", self.path("a.exr")), 1)
        self.assertIn("nothing to render: of 2 triangles, 2 have no area and 0 have positions that are NaN, infinite or beyond 1e18", line)

    def test_flattened_along_its_normal(self):
        self.assert_same(self.render(Scene(LAMP).add(QUAD, scale=[1, 1, 0])), self.render(Scene(LAMP).add(QUAD)))

    def test_mirrored(self):
        """A single-sided lamp still shines forwards when mirrored."""
        expected = self.render(Scene(LAMP).add(QUAD))
        for scale in [[-1, 1, 1], [-1, -1, 1]]:
            self.assert_same(self.render(Scene(LAMP).add(QUAD, scale=scale)), expected)

    def test_a_hundred_thousand_coincident_triangles(self):
        count = 100000
        scene = Scene(LAMP).add(QUAD[:9], indices=[0, 1, 2] * count)
        expected = self.render(Scene(LAMP).add(QUAD[:9]), size="4x4", spp="1")
        for accel in ["bvh2", "bvh8", "grid", "kdtree"]:
            with self.subTest(accel=accel):
                # each compiles one kernel for traversal
                picture = self.render(scene, size="4x4", spp="1", kernels=("--lanes", "1", "--accel", accel))
                self.assert_same(picture, expected)


class Cameras(HardCase):
    def picture(self, change):
        scene = Scene(LAMP).add(QUAD)
        change(scene)
        return self.render(scene)

    def test_at_infinity(self):
        picture = self.picture(lambda scene: scene.nest(0, 1e30, 11))
        self.assertIn("stands at infinity; it is left out", picture.messages)
        self.assertIn("no camera in the scene; using one that frames all of it", picture.messages)

    def test_without_size(self):
        expected = self.picture(lambda scene: None)
        for scale in [1e-38, 1e38]:
            self.assert_same(self.picture(lambda scene: scene.camera.update(scale=[scale] * 3)), expected)
        self.picture(lambda scene: scene.camera.update(scale=[0, 0, 0]))

    def test_far_away(self):
        self.assertEqual(self.picture(lambda scene: scene.camera.update(translation=[0, 0, 1e38])).mean, 0)

    def test_fields_of_view(self):
        narrow = self.picture(lambda scene: scene.json["cameras"][0]["perspective"].update(yfov=1e-38))
        self.assertEqual(narrow.mean, 1)
        wide = self.picture(lambda scene: scene.json["cameras"][0]["perspective"].update(yfov=3.14159))
        self.assertIn("yfov 3.14159 is taken as 3", wide.messages)
        for mag, mean in [(1e-38, 1), (1e38, 0)]:
            camera = {"type": "orthographic", "orthographic": {"xmag": mag, "ymag": mag, "znear": 0, "zfar": 1}}
            self.assertEqual(self.picture(lambda scene: scene.json["cameras"].__setitem__(0, camera)).mean, mean)

    def test_values_beyond_float(self):
        scene = Scene(LAMP).add(QUAD)
        scene.json["cameras"][0]["perspective"]["yfov"] = 1e39
        run = eclat("render", scene.write(self.path("scene.gltf")), "-o", self.path("a.exr"))
        self.assertIn("cameras[0].perspective.yfov is too large: 1e+39", self.assert_one_error(run, 1))


class Shading(HardCase):
    """Lit by 1 from everywhere, a surface shows its albedo in that direction: at most 1."""
    MATERIAL = {"pbrMetallicRoughness": {"metallicFactor": 0.5, "roughnessFactor": 0.3}, "normalTexture": {"index": 0}}

    def shade(self, rgb, *streams):
        picture = self.render(Scene(self.MATERIAL).texture(one_pixel_png(rgb)).add(QUAD, streams=streams), "--env", "1,1,1", spp="64")
        self.assertGreater(picture.mean, 0.1)
        self.assertLess(picture.mean, 1 + 4 * picture.se)
        return picture

    def test_normal_maps_of_zeros(self):
        """The texel (0, 0, 0) means a normal of (-1, -1, -1). Texels of 127 and 128 mean one of nearly no length, as close to 0 as bytes
        allow."""
        for level in [0, 127, 128]:
            with self.subTest(level=level):
                self.shade([level] * 3, NORMAL, UV)

    def test_zero_tangents_are_no_tangents(self):
        rgb = (160, 128, 240)
        zero = ("TANGENT", 4, [0, 0, 0, 0] * 6)
        self.assert_same(self.shade(rgb, NORMAL, UV, zero), self.shade(rgb, NORMAL, UV))

    def test_zero_normals_are_no_normals(self):
        self.assert_same(self.shade((160, 128, 240), ("NORMAL", 3, [0, 0, 0] * 6), UV), self.shade((160, 128, 240), UV))

    def test_texture_coordinates_that_are_one_point(self):
        self.shade((160, 128, 240), NORMAL, ("TEXCOORD_0", 2, [0.5] * 12))


if __name__ == "__main__":
    unittest.main()

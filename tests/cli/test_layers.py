# tiers: quick, full
"""Layers of a picture: parts of its light that add up to it bit for bit, light groups, and data of the first surface."""
import array
import math
import os
import struct
import unittest

from support import CORNELL, FLOAT, HALF, NARROW, QUICK, SOURCE, Case, data_uri, eclat, quad_scene, read_exr, write_gltf
from tiers import full

LAMPS = os.path.join(SOURCE, "scenes", "six-lamps", "six-lamps.gltf")
LIGHT = {**dict.fromkeys("RGB", FLOAT), **dict.fromkeys("stderr.R stderr.G stderr.B stderr.Y".split(), HALF)}


def add_up(planes, layers, c):
    """Adds 32-bit floats in the order of the layers."""
    total = array.array("f", planes[f"{layers[0]}.{c}"])
    for layer in layers[1:]:
        total = array.array("f", [a + b for a, b in zip(total, planes[f"{layer}.{c}"])])
    return list(total)


def lit_quad(lamps, environment=False):
    """A white quad before the camera, and point lights (name, x, colour) at (x, 0, 1)."""
    scene, _ = quad_scene(material={"pbrMetallicRoughness": {"metallicFactor": 0}})
    scene["extensionsUsed"] = ["KHR_lights_punctual"]
    scene["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "color": color, "intensity": 3} for _, _, color in lamps]}}
    for i, (name, x, _) in enumerate(lamps):
        scene["scenes"][0]["nodes"].append(len(scene["nodes"]))
        scene["nodes"].append({"name": name, "translation": [x, 0, 1], "extensions": {"KHR_lights_punctual": {"light": i}}})
    return scene


class Layers(Case):
    def render(self, name, *options, scene=CORNELL, size="24x16", spp="16", env=None):
        self.assert_ok(eclat("render", scene, *NARROW, "--size", size, "--spp", spp, "-q", *options, "-o", name, cwd=self.folder, env=env))
        attributes, planes = read_exr(self.path(name))
        return dict(attributes["channels"]), planes


class Light(Layers):
    def test_direct_and_indirect_add_up_to_the_picture(self):
        """The layers add up bit for bit, and do not change the picture. Direct light is light of paths of two segments: rendered alone, it
        differs only by the correction that makes the sum exact."""
        channels, planes = self.render("a.exr", "--channels", "default,direct,indirect")
        self.assertEqual({name: kind for name, kind in channels.items() if "direct" in name}, {f"{layer}.{c}": kind for layer in ("direct", "indirect") for c, kind in LIGHT.items()})
        _, alone = self.render("b.exr")
        _, direct = self.render("c.exr", "--max-depth", "2")
        for c in "RGB":
            self.assertEqual(planes[c], alone[c])
            self.assertEqual(add_up(planes, ["direct", "indirect"], c), planes[c])
            self.assertGreater(sum(planes[f"indirect.{c}"]), 0.1 * sum(planes[c]))
            for a, b, whole in zip(planes[f"direct.{c}"], direct[c], planes[c]):
                self.assertLessEqual(abs(a - b), 1e-6 * whole)
        for a, b in zip(planes["direct.stderr.Y"], direct["stderr.Y"]):
            self.assertTrue(math.isclose(a, b, rel_tol=2e-3, abs_tol=1e-6))

    @full
    def test_light_groups_add_up_to_the_picture(self):
        """Lamps found by the light tree and by BSDF sampling. Bits do not depend on width, wave, structure, the order of names, or other
        layers."""
        names = ["light.bulb-over-table", "light.ceiling", "light.rest"]
        groups = ["--light-groups", "ceiling=ceiling-panel+cove,bulb-over-table"]
        channels, planes = self.render("a.exr", *groups, scene=LAMPS)
        self.assertEqual({name: kind for name, kind in channels.items() if name.startswith("light.")}, {f"{layer}.{c}": kind for layer in names for c, kind in LIGHT.items()})
        _, alone = self.render("b.exr", scene=LAMPS)
        for c in "RGB":
            self.assertEqual(planes[c], alone[c])
            self.assertEqual(add_up(planes, names, c), planes[c])
            self.assertTrue(all(sum(planes[f"{name}.{c}"]) > 0 for name in names))
        self.assert_same_bits(planes, ["--lanes", "8"], ["--wave", "4096"])

    @full
    def test_light_groups_have_the_same_bits(self):
        _, planes = self.render("a.exr", "--light-groups", "ceiling=ceiling-panel+cove,bulb-over-table", scene=LAMPS)
        self.assert_same_bits(planes, ["--lanes", "1"], ["--accel", "kdtree"], ["--accel", "bvh8"], QUICK, ["--channels", "default,direct,position"])

    def assert_same_bits(self, planes, *others):
        groups = ["--light-groups", "bulb-over-table,ceiling=cove+ceiling-panel"]
        for other in others:
            with self.subTest(other=other):
                _, same = self.render("c.exr", *groups, *other, scene=LAMPS)
                self.assertTrue(all(planes[name] == same[name] for name in planes))

    @full
    def test_several_devices_and_an_adaptive_render(self):
        job = ["--light-groups", "all", "--channels", "default,direct,indirect", "--adaptive"]
        _, one = self.render("a.exr", *job, spp="64")
        _, two = self.render("b.exr", *job, "--device", "all", spp="64", env={"POCL_DEVICES": "basic basic"})
        self.assertGreater(len(set(one["samples"])), 1)
        self.assertTrue(all(one[name] == two[name] for name in one))
        for c in "RGB":
            self.assertEqual(add_up(one, ["direct", "indirect"], c), one[c])
            self.assertEqual(one["light.lamp." + c], one[c])

    @full
    def test_a_group_is_the_picture_by_its_light_alone(self):
        """Point lights and an environment, each in a render of its own: sums of pixels agree within 4 standard errors, and the mean squared
        difference is at most 3 times the squared errors."""
        lamps = [("left.lamp", -1, [1, 0, 0]), ("right", 1, [0, 1, 0])]
        sky = ["--env", "0.2,0.2,0.6"]
        path = write_gltf(self.path("all.gltf"), lit_quad(lamps))
        _, planes = self.render("a.exr", "--light-groups", "all", "--light-choice", "power", *sky, scene=path, size="12x8", spp="1024")
        for name, scene, options in [("left_lamp", lit_quad(lamps[:1]), []), ("right", lit_quad(lamps[1:]), []), ("environment", lit_quad([]), sky)]:
            _, alone = self.render("b.exr", *options, scene=write_gltf(self.path("one.gltf"), scene), size="12x8", spp="1024")
            for c in "RGB":
                moved = [a - b for a, b in zip(planes[f"light.{name}.{c}"], alone[c])]
                errors = [math.hypot(a, b) for a, b in zip(planes[f"light.{name}.stderr.{c}"], alone[f"stderr.{c}"])]
                noise = math.sqrt(sum(e * e for e in errors))
                self.assertLess(abs(sum(moved)), 4 * noise + 1e-5)
                self.assertLess(math.sqrt(sum(d * d for d in moved)), 3 * noise + 1e-5)
                self.assertLess(noise, 0.02 * sum(alone["R"]) + 0.02 * sum(alone["G"]))

    def test_refused(self):
        for options, says in [(["--light-groups", "lamp", "--clamp", "3"], "--light-groups and --clamp"), (["--channels", "direct,albedo", "--samples", "0:64", "--spp", "64"], "--channels"),
                              (["--light-groups", "lamp", "--snapshot", "c.exr"], "--light-groups and --snapshot"), (["--light-groups", "all", "-o", "a.png"], "-o names none"),
                              (["--channels", "indirect", "--integrator", "raster"], "--integrator path"), (["--channels", "direct", "--light-paths", "1"], "--light-paths")]:
            self.assertIn(says, self.assert_one_error(eclat("render", CORNELL, *options, cwd=self.folder), 2))
        for groups, says in [("sun", "no light 'sun'; there is lamp"), ("a=lamp,b=lamp", "'lamp' is in two groups"), ("a=", "empty name")]:
            self.assertIn(says, self.assert_one_error(eclat("render", CORNELL, "--light-groups", groups, "-o", "a.exr", cwd=self.folder), 1))
        self.assertEqual(os.listdir(self.folder), [])


class Kept(Layers):
    LAYERS = ["--channels", "direct,indirect", "--light-groups", "ceiling=ceiling-panel+cove,bulb-over-table"]

    @full
    def test_a_resumed_render_has_the_bits_of_one_run(self):
        self.assert_resumed()

    @full
    def test_an_adaptive_one_too(self):
        self.assert_resumed("--adaptive")

    def assert_resumed(self, *options):
        job = [LAMPS, "--size", "24x16", *self.LAYERS, *options, "-q"]
        self.assert_ok(eclat("render", *job, "--spp", "96", "-o", "whole.exr", cwd=self.folder))
        self.assert_ok(eclat("render", *job, "--spp", "40", "--checkpoint", "kept.exr", "-o", "part.exr", cwd=self.folder))
        self.assert_ok(eclat("render", "--resume", "kept.exr", "--spp", "96", "-q", "-o", "on.exr", cwd=self.folder))
        whole, on = read_exr(self.path("whole.exr")), read_exr(self.path("on.exr"))
        self.assertEqual(whole[0]["channels"], on[0]["channels"])
        self.assertTrue(all(whole[1][name] == on[1][name] for name in whole[1]))

    @full
    def test_merged_slices_have_the_bits_of_one_run(self):
        """Slices keep 32-bit standard errors, and a mix of a merged picture has errors. Slices with other layers belong to another job."""
        job = [LAMPS, "--size", "24x16", "--spp", "96", "-q"]
        self.assert_ok(eclat("render", *job, *self.LAYERS, "-o", "whole.exr", cwd=self.folder))
        for name, samples in (("a", "0:40"), ("b", "40:96")):
            self.assert_ok(eclat("render", *job, *self.LAYERS, "--samples", samples, "-o", name + ".exr", cwd=self.folder))
        self.assert_ok(eclat("merge", "a.exr", "b.exr", "-q", "-o", "all.exr", cwd=self.folder))
        whole, merged = read_exr(self.path("whole.exr"))[1], read_exr(self.path("all.exr"))[1]
        for name in (name for name in whole if name.startswith(("direct", "indirect", "light"))):
            near = {True: lambda a, b: math.isclose(a, b, rel_tol=1e-3, abs_tol=1e-6), False: lambda a, b: a == b}["stderr" in name]
            self.assertTrue(all(map(near, whole[name], merged[name])), name)
        self.assertIn("error", self.assert_ok(eclat("mix", "all.exr", "ceiling=0", "-o", "mixed.exr", cwd=self.folder)).stdout)
        for other in (["--channels", "direct"], ["--channels", "direct,indirect", "--light-groups", "ceiling=ceiling-panel,bulb-over-table"]):
            self.assert_ok(eclat("render", *job, *other, "--samples", "40:96", "-o", "c.exr", cwd=self.folder))
            self.assertIn("not from the same job", self.assert_one_error(eclat("merge", "a.exr", "c.exr", "-o", "d.exr", cwd=self.folder), 1))


def far_quad():
    """The quad a kilometre from the world's origin, without a texture; u from left to right and v from top to bottom."""
    scene, _ = quad_scene()
    uvs = struct.pack("<8f", 0, 1, 1, 1, 1, 0, 0, 0)
    scene["buffers"].append({"byteLength": len(uvs), "uri": data_uri(uvs)})
    scene["bufferViews"].append({"buffer": 1, "byteLength": len(uvs)})
    scene["accessors"].append({"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"})
    scene["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 2
    scene["nodes"][0]["translation"] = [1000, 5, -20]
    scene["nodes"][1]["translation"] = [1000, 5, -17]
    return scene


class FirstSurface(Layers):
    @full
    def test_position_and_texture_coordinates(self):
        """For pixels that see only the quad: world coordinates within half a pixel of the pixel's centre, and texture coordinates that
        match them."""
        path, half = write_gltf(self.path("far.gltf"), far_quad()), math.tan(0.4) * 3
        for integrator in ("path", "whitted", "raster"):
            channels, planes = self.render("a.exr", "--integrator", integrator, "--channels", "A,position,uv", scene=path)
            self.assertEqual(channels, {**dict.fromkeys("R G B position.X position.Y position.Z uv.U uv.V".split(), FLOAT), "A": HALF})
            covered = [y * 24 + x for y in range(4, 12) for x in range(8, 16)]
            self.assertEqual({planes["A"][i] for i in covered}, {1})
            for i in covered:
                x, y = planes["position.X"][i] - 1000, planes["position.Y"][i] - 5
                self.assertLess(abs(x - ((i % 24 + 0.5) / 12 - 1) * 1.5 * half), half / 16)
                self.assertLess(abs(y + ((i // 24 + 0.5) / 8 - 1) * half), half / 16)
                self.assertAlmostEqual(planes["position.Z"][i], -20, 5)
                self.assertAlmostEqual(planes["uv.U"][i], (1 + x) / 2, delta=2e-4)  # a float x of this size has steps of 2^-14
                self.assertAlmostEqual(planes["uv.V"][i], (1 - y) / 2, delta=2e-6)
            self.assertEqual({planes[name][0] for name in planes}, {0})

    def test_layers_have_to_be_named(self):
        channels, _ = self.render("a.exr", "--channels", "all")
        self.assertEqual([name for name in channels if name.split(".")[0] in ("direct", "indirect", "position", "uv", "light")], [])


if __name__ == "__main__":
    unittest.main()

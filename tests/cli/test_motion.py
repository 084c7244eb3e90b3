# tiers: quick, full, long
"""Motion blur, from end to end: closed forms, means of stills, equal bits everywhere, refusals.

A picture over the whole shutter time is the mean of stills. The stills are at the middles of M equal intervals. Their mean has an error
that falls as 1/M^2 where the motion is smooth. Edges are compared over blocks of pixels. The tolerance is 1 % of the brightest block, plus
5 standard errors for noise (exceeded by chance once in 2 million blocks)."""
import json
import math
import os
import struct
import unittest

from support import NARROW, SHARED, Case, data_uri, eclat, read_exr, write_gltf
from tiers import full, long

STILLS = 8


class Builder:
    """Builds a glTF scene from meshes of one quad each, [-0.5, 0.5]^2 in the plane z = 0."""

    def __init__(self):
        self.buffer = b""
        self.scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [],
                      "accessors": [], "bufferViews": [], "animations": []}
        self.quad = self.floats("VEC3", [(-.5, -.5, 0), (.5, -.5, 0), (.5, .5, 0), (-.5, .5, 0)])
        self.corners = self.view(struct.pack("<6H", 0, 1, 2, 0, 2, 3), "SCALAR", 5123, 6)

    def view(self, data, kind, component, count, **more):
        self.scene["bufferViews"].append({"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data)})
        self.buffer += data + b"\0" * (-len(data) % 4)
        self.scene["accessors"].append({"bufferView": len(self.scene["bufferViews"]) - 1, "componentType": component, "count": count,
                                        "type": kind, **more})
        return len(self.scene["accessors"]) - 1

    def floats(self, kind, rows):
        rows = [row if isinstance(row, tuple) else (row,) for row in rows]
        flat = [x for row in rows for x in row]
        finite = [row for row in rows if all(math.isfinite(x) for x in row)]
        bounds = {"min": [min(c) for c in zip(*finite)], "max": [max(c) for c in zip(*finite)]}
        return self.view(struct.pack(f"<{len(flat)}f", *flat), kind, 5126, len(rows), **bounds)

    def node(self, **node):
        self.scene["nodes"].append(node)
        self.scene["scenes"][0]["nodes"].append(len(self.scene["nodes"]) - 1)
        return len(self.scene["nodes"]) - 1

    def add(self, material, **node):
        self.scene["materials"].append(material)
        self.scene["meshes"].append({"primitives": [{"attributes": {"POSITION": self.quad}, "indices": self.corners,
                                                     "material": len(self.scene["materials"]) - 1}]})
        return self.node(mesh=len(self.scene["meshes"]) - 1, **node)

    def camera(self, half, **node):
        self.scene["cameras"] = [{"type": "orthographic", "orthographic": {"xmag": half, "ymag": half, "znear": 0.1, "zfar": 20}}]
        return self.node(camera=0, translation=[0, 0, 5], **node)

    def animate(self, node, path, values, times=(0.0, 1.0)):
        kind = {"rotation": "VEC4"}.get(path, "VEC3")
        sampler = {"input": self.floats("SCALAR", times), "output": self.floats(kind, values)}
        self.scene["animations"].append({"samplers": [sampler], "channels": [{"sampler": 0, "target": {"node": node, "path": path}}]})

    def write(self, path):
        self.scene["buffers"] = [{"byteLength": len(self.buffer), "uri": data_uri(self.buffer)}]
        return write_gltf(path, {key: value for key, value in self.scene.items() if value})


GLOW = {"emissiveFactor": [1, 1, 1], "doubleSided": True, "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}}
GREY = {"doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [.6, .6, .6, 1]}}


def turn(axis, degrees):
    half = math.radians(degrees) / 2
    return tuple(math.sin(half) if k == axis else 0.0 for k in range(3)) + (math.cos(half),)


def room():
    """A lamp over a floor, moving and shrinking, seen from behind so that the camera does not see its light; a slab that turns in its
    light; a spot light that turns; a camera that pans."""
    b = Builder()
    b.add(GREY, scale=[6, 6, 6], translation=[0, 0, -1])
    slab = b.add(GREY, translation=[0.3, 0, 0.2])
    lamp = b.add({"emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 20}}},
                 translation=[-1, 0, 1], rotation=turn(0, 180))
    b.scene["extensionsUsed"] = ["KHR_lights_punctual", "KHR_materials_emissive_strength"]
    b.scene["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 4, "spot": {"outerConeAngle": 0.4}}]}}
    spot = b.node(translation=[0, -1, 2], extensions={"KHR_lights_punctual": {"light": 0}})
    camera = b.camera(2)
    b.animate(lamp, "translation", [(-1, 0, 1), (1, 0.5, 1)])
    b.animate(lamp, "scale", [(1, 1, 1), (.2, .4, 1)])
    b.animate(slab, "rotation", [turn(0, 0), turn(0, 140)])
    b.animate(spot, "rotation", [turn(0, -20), turn(0, 30)])
    b.animate(camera, "translation", [(0, 0, 5), (.5, .2, 5)])
    return b


class Motion(Case):
    def render(self, scene, *options, name="picture.exr"):
        run = self.assert_ok(eclat("render", scene, *NARROW, "-o", self.path(name), "--json", *options))
        return json.loads(run.stdout), read_exr(self.path(name))[1]

    @staticmethod
    def called_for(stats):
        return [row["name"] for row in stats["effect_list"] if row["called_for"]]

    def sha(self, scene, *options):
        return self.render(scene, *options)[0]["image_sha256"]

    def blocks(self, planes, side, by):
        """Mean and squared standard error of the G channel in each block. Pixels are independent of each other."""
        for y in range(0, side, by):
            for x in range(0, side, by):
                at = [(y + j) * side + x + i for j in range(by) for i in range(by)]
                yield sum(planes["G"][k] for k in at) / by**2, sum(planes["stderr.G"][k] ** 2 for k in at) / by**4

    def assert_mean_of_stills(self, scene, opens, closes, *options, side=32, by=8):
        common = ["--size", f"{side}x{side}", "--sampler", "independent", "--env", "0.3,0.3,0.3", *options]
        stats, blurred = self.render(scene, "--shutter", f"{opens}:{closes}", "--spp", "128", *common)
        self.assertIn("motion-blur", self.called_for(stats))
        self.assertEqual(stats["invalid_samples"], 0)
        stills = []
        for k in range(STILLS):
            at = opens + (closes - opens) * (k + 0.5) / STILLS
            stills.append(list(self.blocks(self.render(scene, "--at", repr(at), "--spp", "32", "--seed", str(k + 1), *common)[1], side, by)))
        got = list(self.blocks(blurred, side, by))
        brightest = max(mean for mean, _ in got)
        moved = 0
        for k, (mean, variance) in enumerate(got):
            wanted = sum(still[k][0] for still in stills) / STILLS
            variance += sum(still[k][1] for still in stills) / STILLS**2
            self.assertLess(abs(mean - wanted), 5 * math.sqrt(variance) + 0.01 * brightest, f"block {k}: {mean} for {wanted}")
            moved += max(still[k][0] for still in stills) - min(still[k][0] for still in stills) > 0.05 * brightest
        self.assertGreater(moved, 0, "nothing to see")

    def with_camera(self, path, half):
        """A copy with cameras above and at the side, since stills without cameras are framed one by one; all grey, so that all use the same
        kernels."""
        with open(path, encoding="utf-8") as file:
            scene = json.load(file)
        for buffer in scene["buffers"]:
            if not buffer["uri"].startswith("data:"):
                with open(os.path.join(os.path.dirname(path), buffer["uri"]), "rb") as file:
                    buffer["uri"] = data_uri(file.read())
        scene["materials"] = [GREY] * len(scene["materials"])
        scene["cameras"] = [{"type": "orthographic", "orthographic": {"xmag": half, "ymag": half, "znear": 0.1, "zfar": 50}}]
        scene["nodes"].append({"camera": 0, "translation": [12, 18, 12], "rotation": [-.3536, .3536, .1464, .8536]})
        scene["scenes"][scene.get("scene", 0)]["nodes"].append(len(scene["nodes"]) - 1)
        return write_gltf(self.path("model.gltf"), scene)

    def test_a_sliding_quad_is_covered_as_long_as_it_is_there(self):
        """The quad's centre is uniform in [-1, 1]: a pixel sees the quad for |[x - 0.5, x + 0.5] ∩ [-1, 1]| / 2 of the time."""
        b = Builder()
        b.animate(b.add(GLOW), "translation", [(-1, 0, 0), (1, 0, 0)])
        b.camera(2)
        spp, side = 1024, 16
        _, planes = self.render(b.write(self.path("slide.gltf")), "--shutter", "0:1", "--size", f"{side}x{side}", "--spp", str(spp),
                                "--sampler", "independent", "--max-depth", "1")
        for x in range(side):
            steps = [-2 + 4 * (x + (k + 0.5) / 64) / side for k in range(64)]
            wanted = sum(max(0, min(s + .5, 1) - max(s - .5, -1)) / 2 for s in steps) / 64
            row = side // 2
            error = math.sqrt(wanted * (1 - wanted) / spp)
            self.assertLessEqual(abs(planes["G"][row * side + x] - wanted), 4.5 * error + 1e-3 * (0 < wanted), f"column {x}")

    @full
    def test_a_turning_quad_keeps_its_corners(self):
        """At a radius r between 0.5 and that of its corner, a square is seen for 1 - 4 / pi acos(0.5 / r) of a quarter turn."""
        b = Builder()
        b.animate(b.add(GLOW), "rotation", [turn(2, 0), turn(2, 90)])
        b.camera(0.75)
        side, spp = 32, 256
        stats, planes = self.render(b.write(self.path("turn.gltf")), "--shutter", "0:1", "--size", f"{side}x{side}", "--spp", str(spp),
                                    "--sampler", "independent", "--max-depth", "1")
        rings = {}
        for k in range(side * side):
            wanted, fine = 0.0, 8
            for i in range(fine * fine):
                x = (k % side + (i % fine + .5) / fine) / side * 1.5 - .75
                y = (k // side + (i // fine + .5) / fine) / side * 1.5 - .75
                r = math.hypot(x, y)
                wanted += 1 if r <= .5 else max(0.0, 1 - 4 / math.pi * math.acos(min(1, .5 / r)))
            ring = rings.setdefault(int(math.hypot(k % side + .5 - side / 2, k // side + .5 - side / 2)), [0, 0.0, 0.0, 0.0])
            wanted /= fine * fine
            ring[0] += 1
            ring[1] += planes["G"][k]
            ring[2] += wanted
            ring[3] += wanted * (1 - wanted) / spp
        for radius, (count, got, wanted, variance) in rings.items():
            self.assertLess(abs(got - wanted), 4.5 * math.sqrt(variance) + 0.004 * count, f"ring {radius}")
        self.assertIn("straight steps", json.dumps(stats["effect_list"]))

    @full
    def test_lamps_spots_bodies_and_cameras_are_means_of_stills(self):
        scene = room().write(self.path("room.gltf"))
        self.assert_mean_of_stills(scene, 0, 1, "--animation", "all")
        self.assert_mean_of_stills(scene, 0.25, 0.75, "--animation", "all", "--sample", "light")

    @full
    def test_morph_targets_and_skins_are_means_of_stills(self):
        for name, opens, closes, half in (("AnimatedMorphCube", 0.2, 1.2, 2.5), ("RiggedSimple", 0.2, 1.0, 6)):
            path = os.path.join(SHARED, "assets", "gltf", name, "glTF", name + ".gltf")
            if not os.path.exists(path):
                self.skipTest("no " + path)
            with self.subTest(name):
                self.assert_mean_of_stills(self.with_camera(path, half), opens, closes, by=4)

    def assert_same_bits(self, ways):
        scene = room().write(self.path("room.gltf"))
        common = ["--animation", "all", "--shutter", "0:1", "--size", "24x24", "--spp", "16", "--env", "0.3,0.3,0.3"]
        first = self.sha(scene, *common)
        for way in ways:
            self.assertEqual(self.sha(scene, *common, "--wave", "4096", "--accel", *way), first, way)

    @full
    def test_the_same_bits_in_other_structures_and_widths(self):
        self.assert_same_bits([["bvh8", "--lanes", "16"], ["kdtree"], ["twolevel"]])

    @long
    def test_the_same_bits_in_every_structure(self):
        self.assert_same_bits([["bvh2", "--lanes", "4"], ["grid"], ["none", "--lanes", "8"], ["twolevel", "--lanes", "4"]])

    def test_an_instant_is_a_still(self):
        scene = room().write(self.path("room.gltf"))
        common = ["--animation", "all", "--size", "16x16", "--spp", "4"]
        self.assertEqual(self.sha(scene, "--shutter", "0.3:0.3", *common), self.sha(scene, "--at", "0.3", *common))
        without = self.render(scene, "--shutter", "0.1:0.5", "--without", "motion-blur", *common)[0]
        self.assertNotIn("motion-blur", without["effects"])

    def test_what_stands_still_calls_for_nothing(self):
        b = Builder()
        b.animate(b.add(GLOW, rotation=turn(1, 20)), "rotation", [turn(1, 20), turn(1, 20)])
        b.animate(b.camera(2), "translation", [(0, 0, 5), (0, 0, 5)])
        scene, common = b.write(self.path("still.gltf")), ["--animation", "all", "--size", "16x16", "--spp", "4"]
        stats, _ = self.render(scene, "--shutter", "0:1", *common)
        self.assertNotIn("motion-blur", self.called_for(stats))
        self.assertEqual(stats["image_sha256"], self.sha(scene, "--at", "0.5", *common))

    @full
    def test_what_moves_is_not_kept_once(self):
        b = Builder()
        moving = b.add(GREY, translation=[-1, 0, 0])
        for k in range(3):
            b.node(mesh=0, translation=[1, k - 1, 0])
        b.animate(moving, "translation", [(-1, -1, 0), (-1, 1, 0)])
        b.camera(2)
        scene = b.write(self.path("instances.gltf"))
        common = ["--shutter", "0:1", "--size", "16x16", "--spp", "4"]
        on, _ = self.render(scene, "--accel", "auto", "--instancing", "on", *common)
        self.assertEqual(on["instances"], 3)
        self.assertIn("motion-blur", self.called_for(on))
        self.assertEqual(on["image_sha256"], self.sha(scene, "--instancing", "off", *common))

    @full
    def test_objects_that_appear(self):
        """Quads without area at the start, and for one of them also in the middle of the shutter time."""
        b = Builder()
        b.animate(b.add(GLOW), "scale", [(0, 0, 0), (1, 1, 1)])
        b.animate(b.add(GREY, translation=[0, .5, .5]), "scale", [(1, 1, 1), (0, 0, 0), (1, 1, 1)], times=(0.0, 0.5, 1.0))
        b.camera(1)
        stats, planes = self.render(b.write(self.path("grow.gltf")), "--animation", "all", "--shutter", "0:1", "--size", "16x16", "--spp", "64")
        self.assertEqual(stats["invalid_samples"], 0)
        self.assertGreater(max(planes["G"]), 0.3)

    def test_refusals(self):
        scene = room().write(self.path("room.gltf"))
        still = Builder()
        still.add(GLOW)
        still = still.write(self.path("plain.gltf"))
        broken = Builder()
        broken.animate(broken.add(GLOW), "translation", [(0, 0, 0), (math.nan, 0, 0)])
        broken = broken.write(self.path("nan.gltf"))
        for code, words, arguments in (
                (2, "before it begins", [scene, "--shutter", "1:0.5"]), (2, "two numbers", [scene, "--shutter", "1"]),
                (2, "--shutter", [scene, "--shutter", "a:b"]), (2, "one of them", [scene, "--at", "1", "--shutter", "0:1"]),
                (2, "--integrator path", [scene, "--shutter", "0:1", "--integrator", "raster"]),
                (2, "--integrator path", [scene, "--shutter", "0:1", "--integrator", "whitted"]),
                (1, "no animation", [still, "--shutter", "0:1"]), (1, "NaN", [broken, "--shutter", "0:1"])):
            with self.subTest(words=words, arguments=arguments):
                line = self.assert_one_error(eclat("render", *arguments, "-q", "-o", self.path("none.png"), cwd=self.folder), code)
                self.assertIn(words, line)
                self.assertFalse(os.path.exists(self.path("none.png")))


if __name__ == "__main__":
    unittest.main()

# tiers: quick, full, long
"""Light scattered inside bodies (KHR_materials_volume_scatter) against closed forms. A white body loses nothing. A half-space returns what
Chandrasekhar's H function says. A slab scatters once the light of the sky, and that of a sun which shadow rays reach through its wall. Bits
do not depend on what traces rays."""
import json
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "robust"))
from hard_scene import Scene
from support import NARROW, QUICK, SOURCE, Case, eclat, read_exr
from test_caustic_forms import ball
from tiers import full, long


def gauss(n):
    """Points and weights of Gauss-Legendre quadrature on [0, 1], by Newton's method."""
    points = []
    for i in range(n):
        x = math.cos(math.pi * (i + 0.75) / (n + 0.5))
        for _ in range(8):
            p, q = 1, 0
            for k in range(n):
                p, q = ((2 * k + 1) * x * p - k * q) / (k + 1), p
            slope = n * (x * p - q) / (x * x - 1)
            x -= p / slope
        points.append(((x + 1) / 2, 1 / ((1 - x * x) * slope * slope)))
    return points


def returned(albedo, cosine):
    """Part of uniform white light that a half-space with isotropic scattering returns (Chandrasekhar 1960, chapter 5)."""
    points, root = gauss(24), math.sqrt(1 - albedo)
    h = [1] * len(points)
    for _ in range(400):
        h = [1 / (root + albedo / 2 * sum(w * x * k / (x + y) for (x, w), k in zip(points, h))) for y, _ in points]
    return 1 - root / (root + albedo / 2 * sum(w * x * k / (x + cosine) for (x, w), k in zip(points, h)))


def once(albedo, g):
    """Radiance of a slab seen head-on in uniform white light: one mean free path thick, at most one scattering."""
    total, directions = math.exp(-1), gauss(100)
    for t, weight in gauss(40):
        inner = 0
        for u, w in directions:
            c = 2 * u - 1
            phase = (1 - g * g) / (4 * math.pi * (1 + g * g - 2 * g * c) ** 1.5)
            inner += 2 * w * 2 * math.pi * phase * math.exp(-((1 - t) / c if c > 0 else t / -c))
        total += albedo * weight * math.exp(-t) * inner
    return total


def colour(albedo, g):
    """The colour in a file for a single-scattering albedo."""
    low, high = 0, 1
    for _ in range(60):
        c = (low + high) / 2
        s = 4.09712 + 4.20863 * c - math.sqrt(9.59217 + 41.6808 * c + 17.7126 * c * c)
        low, high = (c, high) if (1 - s * s) / (1 - g * s * s) < albedo else (low, c)
    return low


def body(albedo, density, g=0, ior=1, roughness=0, diffuse=False):
    walls = {"KHR_materials_transmission": {"transmissionFactor": 1}}
    if diffuse:
        walls = {"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1}, "KHR_materials_specular": {"specularFactor": 0}}
    return {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": roughness}, "extensions": {
        **walls, "KHR_materials_ior": {"ior": ior},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 0.1, "attenuationColor": [math.exp(-0.1 * d) for d in density]},
        "KHR_materials_volume_scatter": {"multiscatterColorFactor": [colour(a, g) for a in albedo], "scatterAnisotropy": g}}}


def block(half, top, bottom):
    """A box about the z axis."""
    corners = [(x * half, y * half, z) for x in (-1, 1) for y in (-1, 1) for z in (bottom, top)]
    faces = (0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)
    return [c for a, b, d, e in faces for i in (a, b, d, a, d, e) for c in corners[i]]


ALBEDO = [0.3, 0.8, 0.97]
MATT = {"pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}
SUN = {"lights": [{"type": "directional", "intensity": math.pi}]}


def blocks(image, name, size=64, side=8):
    """Sums over squares of pixels."""
    plane = image[name]
    return [[plane[(y + j) * size + x + i] for j in range(side) for i in range(side)] for y in range(0, size, side) for x in range(0, size, side)]


class VolumeScatter(Case):
    def scene_of(self, *materials):
        scene = Scene(*materials)
        for name in sorted({name for m in materials for name in m["extensions"]}):
            scene.extend(name)
        return scene

    def render(self, path, *options):
        sky = [] if "--env" in options else ["--env", "1,1,1"]
        run = self.assert_ok(eclat("render", path, *NARROW, *sky, "--json", "-q", "-o", self.path("a.exr"), *options))
        return json.loads(run.stdout)

    def assert_seen(self, path, expected, *options, accuracy=0):
        said = self.render(path, *options)
        se = said["error"] * said["mean_luminance"] / math.sqrt(said["width"] * said["height"])
        self.assertLess(se, 2e-3)
        for channel, value in zip("RGB", expected):
            pixels = read_exr(self.path("a.exr"))[1][channel]
            mean = sum(pixels) / len(pixels)
            spread = math.sqrt(sum((p - mean) ** 2 for p in pixels)) / len(pixels)
            self.assertLess(abs(mean - value), 4 * spread + accuracy, f"{channel}: {mean:.5f} +- {spread:.5f}, not {value:.5f}")

    @full
    def test_white_body_in_white_light(self):
        positions, normals, indices = ball(24, 0, 0.5)
        for material in body([1, 1, 1], [2, 5, 10], ior=1.5), body([1, 1, 1], [10, 5, 20], -0.5, diffuse=True):
            scene = self.scene_of(material).add(positions, 0, indices=indices, streams=[("NORMAL", 3, normals)])
            self.assert_seen(scene.write(self.path("a.gltf")), [1, 1, 1], "--size", "24x24", "--spp", "128", accuracy=2e-4)

    @long
    def test_half_space(self):
        path = self.scene_of(body(ALBEDO, [1, 1, 1])).add(block(3000, 0, -60)).write(self.path("a.gltf"))
        for eye, cosine in ("0,0,9", 1), ("8.660254,0,5", 0.5):
            self.assert_seen(path, [returned(a, cosine) for a in ALBEDO], "--eye", eye, "--look-at", "0,0,0", "--up", "0,1,0", "--parallel", "1", "--size", "16x16",
                             "--spp", "1024", accuracy=1e-4)

    @full
    def test_scattered_once(self):
        for g in 0, 0.7:
            path = self.scene_of(body(ALBEDO, [1, 1, 1], g)).add(block(300, 0, -1)).write(self.path("a.gltf"))
            self.assert_seen(path, [once(a, g) for a in ALBEDO], "--eye", "0,0,9", "--look-at", "0,0,0", "--up", "0,1,0", "--parallel", "1", "--max-depth", "4",
                             "--size", "16x16", "--spp", "4096", accuracy=1e-4)

    def assert_sun_scattered_once(self, g, *options, spp):
        """A slab one mean free path thick, seen head-on; the cosine of the sun's direction is 0.8. With one segment less there is no light."""
        cosine, gain = 0.8, 1 + 1 / 0.8
        phase = (1 - g * g) / (4 * math.pi * (1 + g * g + 2 * g * cosine) ** 1.5)
        light = math.pi * phase * (1 - math.exp(-gain)) / gain
        scene = self.scene_of(body(ALBEDO, [1, 1, 1], g)).extend("KHR_lights_punctual", SUN).add(block(300, 0, -1))
        half = 0.5 * math.acos(cosine)
        scene.node(rotation=[0, math.sin(half), 0, math.cos(half)], extensions={"KHR_lights_punctual": {"light": 0}})
        path, look = scene.write(self.path("a.gltf")), ["--eye", "0,0,9", "--look-at", "0,0,0", "--up", "0,1,0", "--parallel", "1", "--size", "16x16"]
        self.assert_seen(path, [a * light for a in ALBEDO], *look, "--env", "0,0,0", "--max-depth", "4", "--spp", spp, *options, accuracy=1e-5)
        self.assertEqual(self.render(path, *look, "--env", "0,0,0", "--max-depth", "3", "--spp", "8", *options)["mean_luminance"], 0)

    def test_sun_through_the_wall(self):
        self.assert_sun_scattered_once(0.3, spp="64")

    @long
    def test_sun_through_the_wall_precisely(self):
        for g in -0.4, 0.7:
            self.assert_sun_scattered_once(g, spp="4096")

    @long
    def test_shadow_rays_through_walls_and_paths_agree(self):
        """A lamp over nested clouds with half clear walls: with and without shadow rays."""
        outer, inner = body([1, 0.9, 0.6], [4, 6, 10], 0.5), body([0.9, 0.3, 0.9], [3, 9, 3], roughness=0.6)
        inner["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.5
        lamp = {**MATT, "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [1, 1, 1]}
        scene = self.scene_of(outer, inner, MATT, lamp).add(block(0.5, 0.5, -0.5), 0).add(block(0.25, 0.3, -0.2), 1)
        for material, half, y, turn in (2, 3, -0.8, 1), (3, 0.9, 1.5, -1):
            a, b, c, d = (-half, y, -half), (-half, y, half), (half, y, half), (half, y, -half)
            scene.add([x for p in (a, b, c, a, c, d)[::turn] for x in p], material)
        path, images = scene.write(self.path("a.gltf")), []
        for fog in [], ["--fog", "0.3,0.8,0.3"]:
            for way in "mis", "bsdf":
                self.render(path, "--eye", "1.1,0.9,2.4", "--look-at", "0,0,0", "--up", "0,1,0", "--fov", "40", "--size", "64x64", "--spp", "512", "--env", "0,0,0.01",
                            "--sample", way, "--channels", "all", "--seed", str(len(images)), *fog)
                images.append(read_exr(self.path("a.exr"))[1])
            z = []
            for channel in "RGB":
                a, b, sa, sb = (blocks(image, name) for name in (channel, "stderr." + channel) for image in images[-2:])
                z += [(sum(p) - sum(q)) / math.sqrt(sum(x * x for x in s + t)) for p, q, s, t in zip(a, b, sa, sb) if any(s + t)]
            mean = sum(z) / len(z)
            deviation = math.sqrt(sum((x - mean) ** 2 for x in z) / len(z))
            print(f"z {mean:.3f} +- {deviation:.3f} of {len(z)}")
            self.assertLess(abs(mean), 0.35)
            self.assertTrue(0.75 < deviation < 1.3, deviation)

    @full
    def test_same_bits(self):
        positions, normals, indices = ball(12, 0, 0.5)
        path = self.scene_of(body(ALBEDO, [9, 4, 2], 0.5, 1.4, 0.3)).add(positions, indices=indices, streams=[("NORMAL", 3, normals)]).write(self.path("a.gltf"))
        ways = [], ["--lanes", "1"], ["--lanes", "8"], QUICK, ["--accel", "kdtree"], ["--wave", "4096"]
        self.assertEqual(len({self.render(path, "--size", "32x24", "--spp", "8", *way)["image_sha256"] for way in ways}), 1)

    @long
    def test_white_fog_in_white_light(self):
        """Around a white ball, and around one of glass, which contains no fog."""
        positions, normals, indices = ball(24, 0, 0.5)
        scene = self.scene_of(body([1, 1, 1], [0, 0, 0], ior=1.5))
        scene.json["materials"].append({"pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {"KHR_materials_specular": {"specularFactor": 0}}})
        for k in 0, 1:
            scene.add(positions, k, indices=indices, streams=[("NORMAL", 3, normals)] if k == 0 else [], translation=[1.2 * k - 0.6, 0, 0])
        self.assert_seen(scene.write(self.path("a.gltf")), [1, 1, 1], "--fog", "2,1,0.5", "--size", "24x16", "--spp", "256", accuracy=2e-4)

    @full
    def test_lamp_in_fog(self):
        """Light of a lamp that fog scatters once to a camera that looks past the lamp, and the sky behind, attenuated."""
        density, albedo, g, flux, corner, steps = 0.1, 0.8, 0.6, 10, 5, 20000
        radius = 1.001 * math.sqrt(3) * corner
        light = density * albedo * (1 - g * g) / (4 * math.pi) * flux * radius / steps
        seen = sum(light / (1 + g * g + 2 * g * t / math.hypot(t, 1)) ** 1.5 / (t * t + 1) * math.exp(-density * (t + math.hypot(t, 1)))
                   for t in (radius * (k + 0.5) / steps for k in range(steps)))
        scene = self.scene_of(body(ALBEDO, [0, 0, 0])).extend("KHR_lights_punctual", {"lights": [{"type": "point", "intensity": flux}]})
        scene.add([s * corner + e for s in (1, -1) for e in (0, 0, 0, s * -1e-3, 0, 0, 0, s * -1e-3, 0)])
        scene.node(translation=[0, 1, 0], extensions={"KHR_lights_punctual": {"light": 0}})
        path, look = scene.write(self.path("a.gltf")), ["--fog", f"{density},{albedo},{g}", "--eye", "0,0,0", "--look-at", "1,0,0", "--fov", "0.2", "--size", "8x8"]
        for expected, sky, depth in (seen, "0,0,0", "2"), (math.exp(-density * radius), "1,1,1", "1"):
            self.assert_seen(path, [expected] * 3, *look, "--env", sky, "--max-depth", depth, "--spp", "4096", accuracy=1e-4 * seen)

    def test_no_light_paths_in_fog(self):
        """Light paths do not scatter in fog: none are traced there, and the picture is that without them."""
        job = [os.path.join(SOURCE, "scenes", "ring", "ring.gltf"), *QUICK, "--fog", "0.3,0.9,0", "--size", "16x16", "--spp", "4", "--json"]
        reports = []
        for paths in "0", "1":
            run = self.assert_ok(eclat("render", *job, "--light-paths", paths, "-o", self.path("a.exr")))
            reports.append(json.loads(run.stdout))
        self.assertIn("--light-paths: none are traced", run.stderr)
        self.assertIsNone(reports[1]["light_paths"])
        self.assertEqual(reports[1]["image_sha256"], reports[0]["image_sha256"])

    def test_odd_fog(self):
        for fog, word in ("1,2", "three numbers"), ("-1,0,0", "first"), ("1,1.5,0", "second"), ("1,1,1", "third"):
            run = eclat("render", self.path("none.gltf"), "--fog", fog, "-o", self.path("a.png"))
            self.assertIn(word, self.assert_one_error(run, 2))
        run = eclat("render", self.path("none.gltf"), "--fog", "1,1,0", "--integrator", "whitted", "-o", self.path("a.png"))
        self.assertIn("--fog", self.assert_one_error(run, 2))

    @full
    def test_a_message_says_where_scattering_is_left_out(self):
        path = self.scene_of(body(ALBEDO, [9, 4, 2], ior=1.4)).add(block(1, 0, -1)).write(self.path("a.gltf"))
        for options, word in (["--integrator", "whitted"], "only --integrator path scatters light inside"), (["--light-paths", "1"], "--light-paths: none are traced"):
            run = self.assert_ok(eclat("render", path, "--size", "8x8", "--spp", "8", "-o", self.path("a.png"), *options))
            self.assertIn(word, run.stderr)
            self.assertNotIn("light-paths  ", run.stderr)

    def test_a_texture_of_the_colour_is_left_out(self):
        """A warning says so; eclat info prints it too."""
        jade = body(ALBEDO, [9, 4, 2], ior=1.4)
        jade["extensions"]["KHR_materials_volume_scatter"]["multiscatterColorTexture"] = {"index": 0}
        path = self.scene_of(jade).add(block(1, 0, -1)).write(self.path("a.gltf"))
        run = self.assert_ok(eclat("info", path))
        self.assertRegex(run.stderr, r"materials\[\d+\] has a multiscatterColorTexture, which is left out: a body scatters the same everywhere")


if __name__ == "__main__":
    unittest.main()

# tier: full
"""Caustics against numbers from rays traced in double precision: light through a slab of glass, light in the focus of a ball of glass, and
all light that passes the ball. Light paths, path guiding and both together find them."""
import json
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "robust"))
from hard_scene import Scene
from support import Case, eclat

IOR, ALBEDO, LE, SUN = 1.5, 0.8, 100, 3
MATT = {"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [ALBEDO] * 3 + [1]}, "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}
GLASS = {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
         "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1}, "KHR_materials_ior": {"ior": IOR}}}
LAMP = {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}, "emissiveFactor": [1, 1, 1],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": LE}, "KHR_materials_specular": {"specularFactor": 0}}}
# A sheet that transmits diffusely: light that falls on it from above leaves it below.
SHEET = {"pbrMetallicRoughness": {"metallicFactor": 0}, "doubleSided": True,
         "extensions": {"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1}, "KHR_materials_specular": {"specularFactor": 0}}}
CENTRE, RADIUS, LAMP_AT, LAMP_HALF = 0.9, 0.5, 5.4, 0.2  # heights above the floor; radius; half of the lamp's side


def square(half, y, up=True):
    """Two triangles in the plane of this y, facing up or down."""
    corners = [(-half, y, -half), (-half, y, half), (half, y, half), (half, y, -half)]
    order = (0, 1, 2, 0, 2, 3) if up else (0, 2, 1, 0, 3, 2)
    return [c for i in order for c in corners[i]]


def ball(rings, y, radius):
    """Positions, normals and indices of a sphere about (0, y, 0)."""
    normals, indices, round_ = [], [], 2 * rings
    for i in range(rings + 1):
        theta = math.pi * i / rings
        for j in range(round_ + 1):
            phi = 2 * math.pi * j / round_
            normals += [math.sin(theta) * math.cos(phi), math.cos(theta), math.sin(theta) * math.sin(phi)]
    for i in range(rings):
        for j in range(round_):
            a, b = i * (round_ + 1) + j, (i + 1) * (round_ + 1) + j
            indices += ([] if i == 0 else [a, a + 1, b]) + ([] if i == rings - 1 else [a + 1, b + 1, b])
    return [radius * n + (y if k % 3 == 1 else 0) for k, n in enumerate(normals)], normals, indices


def passes(cosine, ior):
    """Returns the transmittance of a smooth interface (Fresnel 1823), and the cosine behind it."""
    beyond = math.sqrt(1 - (1 - cosine * cosine) / (ior * ior))
    s, p = (cosine - ior * beyond) / (cosine + ior * beyond), (ior * cosine - beyond) / (ior * cosine + beyond)
    return 1 - 0.5 * (s * s + p * p), beyond


def through_ball(x, y, dx, dy):
    """Traces a ray in a plane of the axis: returns point and direction behind the ball, and the transmitted part; None where the ray
    misses."""
    along = x * dx + (y - CENTRE) * dy
    square_ = along * along - (x * x + (y - CENTRE) ** 2 - RADIUS ** 2)
    if square_ <= 0:
        return None
    light = 1
    for ior in (IOR, 1 / IOR):
        t = -along - math.sqrt(square_) if ior > 1 else -2 * along
        x, y = x + t * dx, y + t * dy
        nx, ny = (x / RADIUS, (y - CENTRE) / RADIUS) if ior > 1 else (-x / RADIUS, -(y - CENTRE) / RADIUS)
        cosine = -(dx * nx + dy * ny)
        passed, beyond = passes(cosine, ior)
        light *= passed
        dx, dy = (dx + cosine * nx) / ior - beyond * nx, (dy + cosine * ny) / ior - beyond * ny
        along = x * dx + (y - CENTRE) * dy
    return x, y, dx, dy, light


class CausticForms(Case):
    def mean(self, scene, *options, finds, size="8x8", spp=512):
        """Returns the mean luminance and its standard error."""
        run = self.assert_ok(eclat("render", scene, "--max-depth", "4", "--size", size, "--spp", str(spp), *finds, *options, "--json", "-q",
                                   "-o", self.path("a.exr")))
        said = json.loads(run.stdout)
        pixels = said["width"] * said["height"]
        return said["mean_luminance"], said["error"] * said["mean_luminance"] / math.sqrt(pixels)

    def assert_found(self, scene, expected, *options, ways, accuracy, **more):
        for finds in ways:
            with self.subTest(finds=finds):
                mean, se = self.mean(scene, *options, finds=finds, **more)
                self.assertLess(abs(mean - expected), 4 * se + accuracy * expected, f"{mean:.5g} +- {se:.2g}, not {expected:.5g}")
                self.assertLess(se, 0.03 * expected)

    def scene_of(self, *materials):
        scene = Scene(*materials)
        for name in {name for m in materials for name in m["extensions"]}:
            scene.extend(name)
        return scene

    def look_at(self, x, eye, fov):
        return ["--eye", eye, "--look-at", f"{x},0,0", "--fov", str(fov)]

    WAYS = [["--light-paths", "1"], ["--guiding"], ["--guiding", "--light-paths", "0.5"]]

    def test_slab(self):
        """Irradiance of points under a slab, by integrating over the lamp: rays leave the slab in their old direction, shifted aside."""
        below, thick, lamp_at, half = 1, 0.5, 3, 0.25
        scene = self.scene_of(MATT, GLASS, LAMP)
        scene.add(square(4, 0), 0).add(square(4, below + thick) + square(4, below, up=False), 1).add(square(half, lamp_at, up=False), 2)
        path = scene.write(self.path("slab.gltf"))

        def radial(tangent):
            sine = tangent / math.sqrt(1 + tangent * tangent) / IOR
            return (lamp_at - thick) * tangent + thick * sine / math.sqrt(1 - sine * sine)

        def arriving(r):
            """Radiance times cosine and solid angle over the lamp's area, at a distance r from the axis."""
            low, high = 0, 100
            for _ in range(60):
                middle = (low + high) / 2
                low, high = (middle, high) if radial(middle) < r else (low, middle)
            cosine = 1 / math.sqrt(1 + low * low)
            step = 1e-5
            slope = (radial(low + step) - radial(max(low - step, 0))) / (low + step - max(low - step, 0))
            of_angle = cosine ** 3 * (low / r if r > 1e-9 else 1 / slope) / slope  # sin(theta) d theta / (r dr)
            return LE * passes(cosine, IOR)[0] ** 2 * cosine * of_angle

        for x in 0, 0.6, 1.5:
            cells = 40
            at = [half * (2 * (k + 0.5) / cells - 1) for k in range(cells)]
            irradiance = sum(arriving(math.hypot(a - x, b)) for a in at for b in at) * (2 * half / cells) ** 2
            self.assert_found(path, ALBEDO / math.pi * irradiance, *self.look_at(x, f"{x},0.7,2", 0.5), ways=self.WAYS, accuracy=2e-3, spp=4096)

    def test_focus_of_a_ball(self):
        """Irradiance where a ball makes the lamp's image, by integrating over directions about the axis."""
        scene = self.scene_of(MATT, GLASS, LAMP)
        positions, normals, indices = ball(150, CENTRE, RADIUS)
        scene.add(square(4, 0), 0).add(positions, 1, indices=indices, streams=[("NORMAL", 3, normals)]).add(square(LAMP_HALF, LAMP_AT, up=False), 2)
        path = scene.write(self.path("ball.gltf"))
        steps, turns, irradiance = 4000, 32, 0
        widest = math.asin(RADIUS / CENTRE)
        for i in range(steps):
            theta = widest * (i + 0.5) / steps
            ray = through_ball(0, 0, math.sin(theta), math.cos(theta))
            if not ray or ray[3] <= 0:
                continue
            x, y, dx, dy, light = ray
            r = abs(x + (LAMP_AT - y) / dy * dx)
            inside = sum(r * max(abs(math.cos(a)), abs(math.sin(a))) < LAMP_HALF for a in (math.pi / 4 * (k + 0.5) / turns for k in range(turns))) / turns
            irradiance += 2 * math.pi * LE * light * math.cos(theta) * math.sin(theta) * widest / steps * inside
        self.assert_found(path, ALBEDO / math.pi * irradiance, *self.look_at(0, "1.2,0.6,0", 0.1), ways=self.WAYS, accuracy=0.01)

    def test_flux_through_a_ball(self):
        """All sunlight that a ball transmits or reflects onto a sheet, seen from below. A sun has no area, so that only light paths find
        this light."""
        scene = self.scene_of(SHEET, GLASS).extend("KHR_lights_punctual", {"lights": [{"type": "directional", "intensity": SUN}]})
        positions, normals, indices = ball(100, CENTRE, RADIUS)
        half, steps = 2, 20000
        scene.add(square(half, 0), 0).add(positions, 1, indices=indices, streams=[("NORMAL", 3, normals)])
        scene.node(rotation=[-math.sqrt(0.5), 0, 0, math.sqrt(0.5)], extensions={"KHR_lights_punctual": {"light": 0}})
        flux = SUN * (4 * half * half - math.pi * RADIUS ** 2)
        for i in range(steps):
            b = RADIUS * (i + 0.5) / steps
            cosine = math.sqrt(1 - (b / RADIUS) ** 2)
            mirrored = b, CENTRE + RADIUS * cosine, 2 * cosine * b / RADIUS, 2 * cosine * cosine - 1, 1 - passes(cosine, IOR)[0]
            for x, y, dx, dy, light in through_ball(b, 4, 0, -1), mirrored:
                r = abs(x - y / dy * dx) if dy < 0 else math.inf
                inside = 1 if r < half else 1 - 4 / math.pi * math.acos(half / r) if r < half * math.sqrt(2) else 0
                flux += SUN * 2 * math.pi * b * RADIUS / steps * light * inside
        path = scene.write(self.path("flux.gltf"))
        self.assert_found(path, flux / math.pi / (4 * half * half), "--eye", "0,-3,0.001", "--look-at", "0,0,0", "--parallel", str(2 * half), ways=[["--light-paths", "1"]],
                          accuracy=2e-4, size="32x32", spp=256)


if __name__ == "__main__":
    unittest.main()

# tiers: quick, full
"""EXT_lights_image_based: the cube map of a scene's light is its environment."""
import struct
import unittest
import zlib

from support import QUICK, Case, data_uri, eclat, quad_scene, read_exr, write_gltf
from tiers import full

EXTENSION = "EXT_lights_image_based"
# order of the faces: +x, -x, +y, -y, +z, -z
DIRECTIONS = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
COLOURS = [(255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0), (0, 255, 255), (255, 0, 255)]


def png(size, pixel, channels=3, height=None):
    """A picture of 8 bits; pixel(x, y) gives a tuple."""
    height = height or size
    rows = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(size)) for y in range(height))
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, height, 8, {3: 2, 4: 6}[channels], 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def linear(byte):
    s = byte / 255
    return s / 12.92 if s <= 0.04045 else ((s + 0.055) / 1.055) ** 2.4


def turned(quaternion, v):
    """rotates v by v + 2 w (q x v) + 2 q x (q x v)"""
    q, w = quaternion[:3], quaternion[3]
    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    once = cross(q, v)
    return [v[k] + 2 * w * once[k] + 2 * cross(q, once)[k] for k in range(3)]


def looking(direction):
    """A node's matrix that turns -z to this direction."""
    z = [-d for d in direction]
    up = [0, 1, 0] if abs(z[1]) < 0.9 else [0, 0, 1]
    x = [up[1] * z[2] - up[2] * z[1], up[2] * z[0] - up[0] * z[2], up[0] * z[1] - up[1] * z[0]]
    length = sum(v * v for v in x) ** 0.5
    x = [v / length for v in x]
    y = [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]]
    return [*x, 0, *y, 0, *z, 0, 0, 0, 0, 1]


def lit_scene(faces, material=None, directions=(), size=8, **light):
    """A quad in view of camera 0, and for each direction a camera with a field of one degree that sees only the environment."""
    scene, _ = quad_scene(material=material or {})
    scene["images"] = [{"uri": data_uri(face)} for face in faces]
    scene["extensionsUsed"] = [EXTENSION]
    scene["extensions"] = {EXTENSION: {"lights": [{"specularImages": [list(range(len(faces)))], "specularImageSize": size,
                                                   "irradianceCoefficients": [[1, 1, 1]] * 9, **light}]}}
    scene["scenes"][0]["extensions"] = {EXTENSION: {"light": 0}}
    for direction in directions:
        scene["cameras"].append({"type": "perspective", "perspective": {"yfov": 0.02, "znear": 0.1, "aspectRatio": 1}})
        scene["scenes"][0]["nodes"].append(len(scene["nodes"]))
        # each is 50 behind the quad's plane and off its axis: no camera sees the quad
        scene["nodes"].append({"camera": len(scene["cameras"]) - 1, "matrix": looking(direction)[:12] + [30, 20, -50, 1]})
    return scene


class ImageLight(Case):
    def colour(self, scene, camera, *options):
        """Mean radiance in a camera's view."""
        out = self.path("out.exr")
        self.assert_ok(eclat("render", "-q", *QUICK, "--size", "4x4", "--spp", "16", "--camera", str(camera), "-o", out, *options,
                             write_gltf(self.path("scene.gltf"), scene)))
        return [sum(read_exr(out)[1][c]) / 16 for c in "RGB"]

    def assert_colour(self, found, expected, delta):
        for a, b in zip(found, expected):
            self.assertAlmostEqual(a, b, delta=delta * max(expected))

    def test_each_direction_has_its_face(self):
        # the code is 0.2 in linear light by sRGB's curve
        faces = [png(8, lambda x, y, c=colour: tuple(v * 124 // 255 for v in c)) for colour in COLOURS]
        scene = lit_scene(faces, directions=DIRECTIONS, intensity=3)
        for i, colour in enumerate(COLOURS):
            with self.subTest(direction=DIRECTIONS[i]):
                self.assert_colour(self.colour(scene, i + 1), [3 * linear(v * 124 // 255) for v in colour], 1e-5)

    @full
    def test_pixels_of_a_face_lie_as_opengl_samples_them(self):
        # bright red where s is right of the middle, bright green above it. Face +z has s along +x and its top at +y; face +y has s along +x
        # and its top at -z.
        def quarters(x, y):
            return (200 if x > 3 else 20, 200 if y < 4 else 20, 20)
        faces = [png(8, quarters if i in (2, 4) else lambda x, y: (0, 0, 0)) for i in range(6)]
        corners = {(0.5, 0.5, 1): (200, 200), (-0.5, 0.5, 1): (20, 200), (0.5, -0.5, 1): (200, 20), (-0.5, -0.5, 1): (20, 20),
                   (0.5, 1, -0.5): (200, 200), (-0.5, 1, -0.5): (20, 200), (0.5, 1, 0.5): (200, 20), (-0.5, 1, 0.5): (20, 20)}
        unit = [[v / sum(w * w for w in d) ** 0.5 for v in d] for d in corners]
        scene = lit_scene(faces, directions=unit)
        for i, (direction, seen) in enumerate(corners.items()):
            with self.subTest(direction=direction):
                self.assert_colour(self.colour(scene, i + 1)[:2], [linear(v) for v in seen], 1e-3)

    @full
    def test_rotation_turns_the_cube(self):
        faces = [png(8, lambda x, y, c=colour: c) for colour in COLOURS]
        quaternion = [0.2, 0.7071, -0.3, 0.6]
        length = sum(v * v for v in quaternion) ** 0.5
        unit = [v / length for v in quaternion]
        scene = lit_scene(faces, directions=[turned(unit, d) for d in DIRECTIONS], rotation=quaternion)
        for i, colour in enumerate(COLOURS):
            with self.subTest(face=DIRECTIONS[i]):
                self.assert_colour(self.colour(scene, i + 1), [linear(v) for v in colour], 1e-5)
        # --env-rotate comes after the light's own rotation: another quarter about +y
        scene = lit_scene(faces, directions=[turned([0, 0.5 ** 0.5, 0, 0.5 ** 0.5], turned(unit, (0, 0, 1)))], rotation=quaternion)
        self.assert_colour(self.colour(scene, 1, "--env-rotate", "90"), [linear(v) for v in COLOURS[4]], 1e-5)

    @full
    def test_alpha_divides(self):
        # RGBD: 51 / 255 = 0.2, so 5 times as bright; alpha 0 counts as 1
        for alpha, times in [(51, 5), (255, 1), (1, 255), (0, 255)]:
            with self.subTest(alpha=alpha):
                face = png(4, lambda x, y: (188, 255, 10, alpha), channels=4)
                scene = lit_scene([face] * 6, directions=[(0, 0, 1)], size=4)
                self.assert_colour(self.colour(scene, 1), [times * linear(v) for v in (188, 255, 10)], 1e-5)

    @full
    def test_constant_cube_is_the_constant_environment(self):
        matt = {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}, "doubleSided": True}
        scene = lit_scene([png(8, lambda x, y: (255, 255, 255))] * 6, material=matt)
        furnace = self.colour(scene, 0, "--spp", "4096")
        self.assertGreater(furnace[0], 0.4)
        self.assertEqual(furnace, self.colour(scene, 0, "--spp", "4096", "--env", "1,1,1"))
        # nearly constant, so that it stays a map: texels of 255 and 254 in turn, whose mean is 0.9956
        nearly = lit_scene([png(8, lambda x, y: (255 - (x + y) % 2,) * 3)] * 6, material=matt)
        mapped = self.colour(nearly, 0, "--spp", "4096")
        self.assert_colour(mapped, [v * (1 + linear(254)) / 2 for v in furnace], 0.01)  # each has about 0.2 % of noise

    def test_env_wins_and_says_so(self):
        scene = lit_scene([png(8, lambda x, y: (255, 0, 0))] * 6, directions=[(0, 0, 1)])
        self.assert_colour(self.colour(scene, 1), (1, 0, 0), 1e-6)
        self.assert_colour(self.colour(scene, 1, "--env", "0,2,0"), (0, 2, 0), 1e-6)
        self.assert_colour(self.colour(scene, 1, "--env-strength", "4"), (4, 0, 0), 1e-6)
        run = self.assert_ok(eclat("render", "--size", "4x4", "--spp", "4", "--env", "0,2,0", "-o", self.path("a.exr"),
                                   self.path("scene.gltf")))
        self.assertIn("--light replaces the scene's image-based light", run.stderr)

    def test_called_for_only_where_it_gives_light(self):
        colourful = [png(8, lambda x, y, c=colour: c) for colour in COLOURS]
        run = self.assert_ok(eclat("info", write_gltf(self.path("scene.gltf"), lit_scene(colourful))))
        self.assertIn("the environment is a map of 32 x 16", run.stdout)
        self.assertIn("an environment", run.stdout)
        self.assertIn("unsupported none", run.stdout)
        self.assertNotIn("environment-rotation", run.stdout.split("not built")[0])
        for scene in (lit_scene(colourful, intensity=0), lit_scene([png(8, lambda x, y: (0, 0, 0))] * 6)):
            run = self.assert_ok(eclat("info", write_gltf(self.path("scene.gltf"), scene)))
            self.assertIn("no environment", run.stdout)
            self.assertIn("a render uses the built-in studio", run.stdout)
            self.assertNotIn("a map of 32 x 16", run.stdout)
        unused = lit_scene(colourful)
        del unused["scenes"][0]["extensions"]
        run = self.assert_ok(eclat("info", write_gltf(self.path("scene.gltf"), unused)))
        self.assertIn("no environment", run.stdout)

    @full
    def test_only_the_shown_scene(self):
        scene = lit_scene([png(8, lambda x, y: (255, 0, 0))] * 6, directions=[(0, 0, 1)])
        scene["scenes"].append({"nodes": scene["scenes"][0]["nodes"]})
        self.assert_colour(self.colour(scene, 1), (1, 0, 0), 1e-6)
        self.assert_colour(self.colour(scene, 1, "--scene", "1", "--env", "0,0,1"), (0, 0, 1), 1e-6)
        run = self.assert_ok(eclat("info", "--scene", "1", self.path("scene.gltf")))
        self.assertIn("no environment", run.stdout)

    def test_malformed(self):
        good = png(8, lambda x, y: (255, 9, 9))
        wide, small = png(8, lambda x, y: (1, 2, 3), height=4), png(4, lambda x, y: (1, 2, 3))
        where = "extensions.EXT_lights_image_based.lights[0]."
        rows = [[1, 2, 3]] * 9
        cases = [
            (lit_scene([good] * 5), where + "specularImages[0] must have 6 indices, not 5"),
            (lit_scene([good] * 6, specularImages=[]), where + "specularImages is empty"),
            (lit_scene([good] * 6, specularImages=[0, 1, 2, 3, 4, 5]), where + "specularImages[0] must be an array"),
            (lit_scene([good] * 6, specularImages=[[0, 1, 2, 3, 4, 6]]), where + "specularImages[0][5] is 6 but the file has 6 images"),
            (lit_scene([good] * 6, specularImages=[[0, 1, 2, 3, 4, 5], [0, 1]]), where + "specularImages[1] must have 6 indices"),
            (lit_scene([good] * 5 + [small]), "the -z face of image-based light 0 has 4 x 4 pixels, but the first face has 8 x 8"),
            (lit_scene([good] * 3 + [wide] + [good] * 2), "the -y face of image-based light 0 has 8 x 4 pixels; faces must be square"),
            (lit_scene([b"no picture"] * 6), "the +x face of image-based light 0: images[0] cannot be decoded"),
            (lit_scene([good[:60]] * 6), "images[0] cannot be decoded"),
            (lit_scene([good] * 6, irradianceCoefficients=rows[:8]), where + "irradianceCoefficients must have 9 arrays, not 8"),
            (lit_scene([good] * 6, irradianceCoefficients=rows[:8] + [[1, 2]]), where + "irradianceCoefficients[8] must have 3 numbers"),
            (lit_scene([good] * 6, irradianceCoefficients=rows[:8] + [[1, 2, "x"]]), where + "irradianceCoefficients[8][2] must be a number"),
            (lit_scene([good] * 6, irradianceCoefficients=[1] * 27), where + "irradianceCoefficients must have 9 arrays, not 27"),
            (lit_scene([good] * 6, rotation=[0, 0, 1]), where + "rotation must have 4 numbers"),
            (lit_scene([good] * 6, intensity="bright"), where + "intensity must be a number"),
            (lit_scene([good] * 6, specularImageSize=0), where + "specularImageSize is out of range"),
            (lit_scene([good] * 6, specularImageSize=2.5), where + "specularImageSize must be a non-negative integer"),
        ]
        pointing = lit_scene([good] * 6)
        pointing["scenes"][0]["extensions"][EXTENSION]["light"] = 1
        cases.append((pointing, "scenes[0].extensions.EXT_lights_image_based.light is 1 but the file has 1 image-based lights"))
        nowhere = lit_scene([good] * 6)
        del nowhere["extensions"]
        cases.append((nowhere, "light is 0 but the file has 0 image-based lights"))
        only_coefficients = lit_scene([good] * 6)
        del only_coefficients["extensions"][EXTENSION]["lights"][0]["specularImages"]
        cases.append((only_coefficients, where + "specularImages is missing"))
        for scene, says in cases:
            with self.subTest(says=says):
                run = eclat("render", "--size", "4x4", "--spp", "4", "-o", self.path("a.exr"), write_gltf(self.path("scene.gltf"), scene))
                self.assertIn(says, self.assert_one_error(run, 1))

    @full
    def test_an_intensity_that_is_not_taken_is_told(self):
        for intensity, taken in ((-3, "0"), (1e35, "1e+30")):
            scene = write_gltf(self.path("scene.gltf"), lit_scene([png(8, lambda x, y: (9, 9, 9))] * 6, intensity=intensity))
            run = self.assert_ok(eclat("info", "-q", scene))
            self.assertIn(f"image-based light 0 has intensity {intensity:g}, which is taken as {taken}\n", run.stderr)

    @full
    def test_another_size_than_stated_is_a_warning(self):
        scene = write_gltf(self.path("scene.gltf"), lit_scene([png(8, lambda x, y: (9, 9, 9))] * 6, size=256))
        run = self.assert_ok(eclat("render", "-q", *QUICK, "--size", "4x4", "--spp", "4", "-o", self.path("a.exr"), scene))
        self.assertIn("says that its faces have 256 pixels a side, but they have 8", run.stderr)


if __name__ == "__main__":
    unittest.main()

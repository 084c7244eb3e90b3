# tiers: quick, full, long
"""--integrator light: paths from the lights alone make the path tracer's picture of diffuse surfaces, for every kind of light. Mirrors and
glass stay black, and a note says so."""
import json
import struct

from other_way import OtherWay, scene
from support import CORNELL, data_uri, eclat, read_exr, write_gltf
from tiers import full, long

LAMPS = {"rectangle": (0, "lamp"), "point": (1, {"type": "point", "intensity": 3}), "range": (1, {"type": "point", "intensity": 3, "range": 1.6}),
         "spot": (1, {"type": "spot", "intensity": 9, "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.6}}),
         "sun": (1, {"type": "directional", "intensity": 1.5})}


def quad(*corners):
    a, b, c, d = corners
    return [*a, *b, *c, *a, *c, *d]


def room(path, lamp=None, **material):
    """A floor, a wall and a slanted plate of `material`, under a lamp that shines down. A two-sided lamp also lights the ceiling."""
    shapes = [("matt", quad((-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1))), ("matt", quad((-1, 0, -1), (1, 0, -1), (1, 1.5, -1), (-1, 1.5, -1))),
              ("matt", quad((-1, 1.5, -1), (1, 1.5, -1), (1, 1.5, 1), (-1, 1.5, 1))),
              ("plate", quad((-0.6, 0.3, 0.4), (0.1, 0.3, 0.6), (0.1, 0.6, 0), (-0.6, 0.6, -0.2)))]
    kind, light = LAMPS.get(lamp, (None, None))
    if kind == 0:
        shapes.append(("lamp", quad((0.1, 1.1, -0.1), (0.5, 1.1, -0.1), (0.5, 1.1, 0.2), (0.1, 1.1, 0.2))))
    names = ["matt", "plate", "lamp"]
    materials = [{"name": "matt", "pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.6, 0.5, 1], "metallicFactor": 0}, "doubleSided": True},
                 {"name": "plate", "pbrMetallicRoughness": {"metallicFactor": 0}, "doubleSided": True, **material},
                 {"name": "lamp", "emissiveFactor": [1, 1, 1], "doubleSided": True, "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 9}}}]
    data, views, accessors, primitives = b"", [], [], []
    for name, corners in shapes:
        packed = struct.pack(f"<{len(corners)}f", *corners)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        data += packed
        accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "count": 6, "type": "VEC3",
                          "min": [min(corners[k::3]) for k in range(3)], "max": [max(corners[k::3]) for k in range(3)]})
        primitives.append({"attributes": {"POSITION": len(accessors) - 1}, "material": names.index(name)})
    nodes = [{"mesh": 0}, {"translation": [0, 0.8, 3.2], "camera": 0}]
    extensions = {}
    if kind == 1:
        extensions = {"KHR_lights_punctual": {"lights": [light]}}
        nodes.append({"translation": [0.3, 1.2, 0.2], "rotation": [-0.6372, 0.1, 0.05, 0.7627], "extensions": {"KHR_lights_punctual": {"light": 0}}})
    used = ["KHR_materials_emissive_strength", *extensions, *material.get("extensions", {})]
    return write_gltf(path, {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "extensionsUsed": used, "extensions": extensions,
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}}], "materials": materials, "meshes": [{"primitives": primitives}],
        "buffers": [{"byteLength": len(data), "uri": data_uri(data)}], "bufferViews": views, "accessors": accessors})


class LightTracing(OtherWay):
    WAY = ["--integrator", "light", "--light-paths", "1"]

    def assert_lit_alike(self, lamp, *options, fewer=0, **material):
        self.assert_same_picture([room(self.path("room.gltf"), lamp, **material), "--size", "32x24", *options], 64, fewer)

    def test_rectangle(self):
        self.assert_lit_alike("rectangle")

    @full
    def test_range(self):
        """A window changes the light's range: it counts to the first surface."""
        self.assert_lit_alike("range")

    @full
    def test_lights(self):
        for lamp in ("point", "spot", "sun"):
            with self.subTest(lamp=lamp):
                self.assert_lit_alike(lamp)
        with self.subTest(lamp="environment"):
            self.assert_lit_alike(None, "--env", "1,0.8,0.5")

    @long
    def test_other_render_options(self):
        """Lens, filter, depth limit, roulette, and another projection."""
        for options in (["--fstop", "0.5", "--focus", "3"], ["--filter", "blackman-harris"], ["--max-depth", "2"], ["--rr", "0.7"],
                        ["--screen-window", "-0.5,1,-0.3,0.8"], ["--sampler", "independent"]):
            with self.subTest(options=options):
                self.assert_lit_alike("rectangle", *options)

    @full
    def test_plates(self):
        """A pane between the camera and the wall, with light through it; and a translucent plate."""
        for name, factor in (("KHR_materials_transmission", {"transmissionFactor": 0.9}), ("KHR_materials_diffuse_transmission", {"diffuseTransmissionFactor": 0.7})):
            with self.subTest(material=name):
                smooth = {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}} if "diffuse" not in name else {}
                self.assert_lit_alike("rectangle", extensions={name: factor}, **smooth)

    @full
    def test_cornell_box(self):
        self.assert_same_picture([CORNELL, "--size", "32x32"], 64, fewer=0)

    @full
    def test_bits(self):
        job = [scene("ring"), "--size", "24x18", *self.WAY]
        self.assert_same_bits(job, [["--lanes", "8"], ["--wave", "4096"], ["--accel", "kdtree"]])

    @full
    def test_slices_and_resume(self):
        self.assert_slices_and_resume([scene("ring"), "--size", "24x18", *self.WAY])

    @full
    def test_caustic_and_mirror(self):
        """The ring is a mirror, to which no light path can connect: black. The camera sees the caustic beside it."""
        run = self.assert_ok(eclat("render", scene("ring"), "--integrator", "light", "--size", "32x32", "--spp", "64", "--json", "-o", self.path("l.exr")))
        self.assertIn("mirrors and through glass is missing", run.stderr)
        self.assertEqual(json.loads(run.stdout)["light_paths"], 1)
        green = read_exr(self.path("l.exr"))[1]["G"]
        self.assertEqual(green[6 * 32 + 16], 0)  # on the ring's far side
        self.assertGreater(green[15 * 32 + 20], 0)  # inside the ring

    @full
    def test_bodies_that_scatter(self):
        """Light paths do not scatter in bodies. So no kernel has code for it, not even with all effects, and a note says what bodies do
        instead."""
        for effects, options in (("called", []), ("all", ["--effects", "all"])):
            with self.subTest(effects=effects):
                run = self.assert_ok(eclat("info", scene("wax"), "--integrator", "light", *options, "--json"))
                row = next(row for row in json.loads(run.stdout)["effect_list"] if row["name"] == "volume-scattering")
                self.assertEqual((row["called_for"], row["kernels"]), (True, []))
        run = self.assert_ok(eclat("render", scene("wax"), "--integrator", "light", "--size", "8x8", "--spp", "1", "-o", self.path("w.exr")))
        self.assertIn("bodies absorb the light that they would scatter", run.stderr)

    def test_refused(self):
        self.assert_refused([(["--adaptive"], "--adaptive"), (["--light-paths", "0"], "--light-paths 0")])
        line = self.assert_one_error(eclat("render", CORNELL, "--integrator", "light", "--guiding", "-o", self.path("a.exr")), 2)
        self.assertIn("--guiding belongs to --integrator path", line)

# tiers: quick, full, long
"""--light-paths: the picture converges to that of path tracing alone, sooner. Its bits do not depend on how a job is divided. Nothing
changes in a scene where nothing reflects or refracts specularly."""
import json
import os
import re
import shutil
import struct
import unittest

from other_way import OtherWay, scene
from support import CORNELL, QUICK, RING, SHARED, data_uri, eclat, write_gltf
from tiers import full, long

LADDER = scene("ladder")
JOB = [RING, "--size", "24x18", "--light-paths", "0.5"]
SUN = os.path.join(SHARED, "assets", "env", "polyhaven", "qwantani_afternoon_puresky_1k.hdr")


class LightPaths(OtherWay):
    WAY = ["--light-paths", "1"]

    def test_ring(self):
        """The ring's caustic, which camera paths seldom find."""
        self.assert_same_picture([RING, "--size", "32x32"], 128, fewer=3)

    @full
    def test_bits(self):
        """Bits do not depend on order, width, structure or slices. Narrow kernels have one lane."""
        self.assert_same_bits(JOB, [["--lanes", "8"], ["--wave", "4096"], ["--accel", "kdtree"]])

    @long
    def test_bits_with_all_effects_and_other_lanes(self):
        self.assert_same_bits(JOB, [["--effects", "all", "--lanes", "4"], ["--lanes", "4"]])

    def test_slices_and_resume(self):
        self.assert_slices_and_resume(JOB)

    def test_a_diffuse_scene_has_no_light_paths(self):
        """A box of diffuse walls: no light paths are traced, and no bit changes."""
        job = [CORNELL, "--size", "20x18", "--spp", "8", *QUICK]
        self.assertEqual(self.render(*job)["image_sha256"], self.render(*job, "--light-paths", "1")["image_sha256"])

    @full
    def test_direct_light(self):
        """Direct light on a metal that mirrors the sun: every camera path finds it, in the order of samples. More light paths must not add
        noise."""
        job = [scene("spheres"), "--light", "sky:120,40", "--size", "96x96", "--spp", "64", "--seed", "3", "--light-paths"]
        few, many = (self.render(*job, number)["error"] for number in ("0.015625", "0.25"))
        self.assertLess(many, few)

    def test_refused(self):
        self.assert_refused([(["--clamp", "5"], "--clamp"), (["--sample", "bsdf"], "--sample"),
                            (["--integrator", "whitted"], "--integrator")])
        self.assertIn("0 to 16", self.assert_one_error(eclat("render", RING, "--light-paths", "17", "-o", self.path("a.exr")), 2))

    def test_auto(self):
        """The ring's caustic is most of the noise: light paths are chosen, and a note says so. They are not where another option excludes
        them."""
        job = [RING, "--size", "24x18", "--spp", "16"]
        run = self.assert_ok(eclat("render", *job, "--json", "-o", self.path("a.exr")))
        chosen = json.loads(run.stdout)
        self.assertRegex(run.stderr, r'note: caustics: paths through "ring" to "lamp" .*--light-paths 0')
        self.assertEqual((chosen["light_paths"], chosen["guiding"]), (0.25, True))
        self.assertEqual(chosen["image_sha256"], self.render(*job, "--light-paths", "0.25", "--guiding")["image_sha256"])
        for other in (["--light-paths", "0"], ["--clamp", "10"], ["--sample", "bsdf"]):
            with self.subTest(other=other):
                self.assertIsNone(self.render(*job, *other)["light_paths"])

    @full
    def test_auto_common(self):
        """Camera paths find these caustics, but noisily: light paths are chosen, without guiding."""
        job = [LADDER, "--size", "96x96", "--spp", "8"]
        run = self.assert_ok(eclat("render", *job, "--json", "-o", self.path("a.exr")))
        chosen = json.loads(run.stdout)
        self.assertRegex(run.stderr, r"note: caustics: light paths are traced too, one for every 8 from the camera, .* about \d+ % of the variance .*--light-paths 0")
        self.assertEqual((chosen["light_paths"], chosen.get("guiding")), (0.125, None))
        self.assertEqual(chosen["image_sha256"], self.render(*job, "--light-paths", "0.125")["image_sha256"])

    @full
    def test_auto_predicts(self):
        """The predicted reduction of the variance is about right."""
        job = [LADDER, "--size", "96x96", "--spp", "64"]
        run = self.assert_ok(eclat("render", *job, "--json", "-o", self.path("a.exr")))
        predicted = float(re.search(r"about (\d+) % of the variance", run.stderr)[1]) / 100
        taken = 1 - (json.loads(run.stdout)["error"] / self.render(*job, "--light-paths", "0", "--adaptive=off")["error"]) ** 2
        self.assertAlmostEqual(predicted, taken, delta=0.2)

    def assert_none(self, of):
        job = [of, "--size", "20x18", "--spp", "8", *QUICK]
        run = self.assert_ok(eclat("render", *job, "--json", "-o", self.path("a.exr")))
        self.assertNotIn("caustics", run.stderr)
        self.assertEqual(json.loads(run.stdout)["image_sha256"], self.render(*job, "--light-paths", "0")["image_sha256"])

    def test_auto_not_called_for(self):
        self.assert_none(CORNELL)

    @full
    def test_auto_does_not_pay(self):
        """Light paths would only find light that camera paths find too, that of large lamps: none are chosen."""
        for of in (scene("brushed-metal"), scene("glass")):
            with self.subTest(scene=of):
                self.assert_none(of)

    def test_auto_in_a_mirror(self):
        """Light paths cannot connect to a surface seen in a mirror: none are chosen. The mirror hangs over the ring, and faces down."""
        with open(RING, encoding="utf-8") as file:
            seen = json.load(file)
        corners = struct.pack("<18f", *(k for x, z in [(-9, -9), (9, -9), (9, 9), (-9, -9), (9, 9), (-9, 9)] for k in (x, 3.4, z)))
        seen["buffers"].append({"byteLength": len(corners), "uri": data_uri(corners)})
        seen["bufferViews"].append({"buffer": 1, "byteLength": len(corners)})
        seen["accessors"].append({"bufferView": len(seen["bufferViews"]) - 1, "componentType": 5126, "count": 6, "type": "VEC3", "min": [-9, 3.4, -9], "max": [9, 3.4, 9]})
        seen["materials"].append({"name": "mirror", "pbrMetallicRoughness": {"roughnessFactor": 0}, "doubleSided": True})
        seen["meshes"].append({"primitives": [{"attributes": {"POSITION": len(seen["accessors"]) - 1}, "material": len(seen["materials"]) - 1}]})
        seen["scenes"][0]["nodes"].append(len(seen["nodes"]))
        seen["nodes"].append({"mesh": len(seen["meshes"]) - 1})
        shutil.copy(os.path.join(os.path.dirname(RING), "ring.bin"), self.folder)
        job = [write_gltf(self.path("seen.gltf"), seen), "--size", "24x18", "--spp", "16", "--eye", "0.9,3.2,2.6"]
        self.assertEqual(self.render(*job, "--look-at", "0,0,0")["light_paths"], 0.25)
        self.assertIsNone(self.render(*job, "--look-at", "0,6.8,0")["light_paths"])

    @full
    def test_auto_error(self):
        """A job with --error makes the same choice when it is resumed or divided."""
        job = [RING, "--size", "24x18"]
        found = self.render(*job, "--error", "40%")
        self.assertEqual((found["adaptive"], found["light_paths"]), (True, 0.25))
        self.assertLessEqual(found["error_bound"], 0.4)
        self.assert_slices_and_resume(job)
        self.render(*job, "--error", "60%", "--checkpoint", self.path("e.exr"))
        again = self.render(*job, "--error", "40%", "--resume", self.path("e.exr"))
        self.assertEqual((again["adaptive"], again["image_sha256"]), (True, found["image_sha256"]))

    @full
    def test_adaptive(self):
        """Light paths have a film of their own when pixels have different numbers of samples. Bits do not depend on how the job is run."""
        job = [scene("spheres"), "--light", "sky:120,40", "--size", "48x48", "--light-paths", "0.0625", "--adaptive"]
        whole = self.render(*job, "--spp", "80")
        self.assertLess(whole["allotment_gain"], 0.8)
        self.assertEqual(self.render(*job, "--spp", "80", "--lanes", "8", "--wave", "8192")["image_sha256"], whole["image_sha256"])
        for spp in ("24", "48"):
            with self.subTest(after=spp):
                self.render(*job, "--spp", spp, "--checkpoint", self.path("c.exr"))
                again = self.assert_ok(eclat("render", "--resume", self.path("c.exr"), "--spp", "80", "-o", self.path("a.exr"), "--json"))
                self.assertEqual(json.loads(again.stdout)["image_sha256"], whole["image_sha256"])

    @full
    def test_adaptive_noise(self):
        """Light paths and adaptive sampling together give the picture, with less noise."""
        job = [scene("spheres"), "--light", "sky:120,40", "--size", "64x64", "--seed", "2", "--spp"]
        even = self.render(*job, "512", "--light-paths", "0", name="even.exr")
        found = self.render(*job, "128", "--light-paths", "0.0625", "--adaptive", name="found.exr")
        self.assertLess(found["error"], 0.7 * self.render(*job, "128", "--light-paths", "0.0625", "--adaptive=off")["error"])
        self.assertLess(found["error"], even["error"])
        self.assert_ok(eclat("compare", self.path("found.exr"), self.path("even.exr")))

    def test_info(self):
        """`eclat info` lists the bodies that light paths aim at, as an effect."""
        self.assert_info(r"light-paths +--light-paths 1, aimed at \d+ bodies")

    @full
    def test_ladder(self):
        self.assert_same_picture([LADDER, "--size", "48x48"], 128, fewer=2)

    @long
    def test_scenes(self):
        for name, samples, fewer in [("vase", 64, 0.5), ("glass", 64, 0.9), ("drink", 64, 1), ("prism", 128, 0.9), ("lamps", 64, 0.05),
                                     ("showcase", 64, 0.9), ("veach-plates", 64, 0.9), ("spheres", 64, 0.4), ("soap-film", 64, 0.05),
                                     ("brushed-metal", 64, 0.5), ("stadium", 32, 0.01)]:
            with self.subTest(scene=name):
                self.assert_same_picture([scene(name), "--size", "48x48"], samples, fewer)

    @long
    def test_other_render_options(self):
        """Light paths take into account the lens, the filter, the light tree or its absence, the depth limit, and rough surfaces with
        multiple scattering."""
        for options in [["--fstop", "0.5", "--focus", "3"], ["--filter", "blackman-harris"], ["--max-depth", "4"], ["--light-choice", "power"],
                        ["--scattering", "multiple"], ["--sampler", "independent"], ["--screen-window", "-0.5,1,-0.3,0.8"], ["--rr", "0.7"]]:
            with self.subTest(options=options):
                self.assert_same_picture([LADDER, "--size", "32x32", *options], 128)

    @full
    @unittest.skipUnless(os.path.exists(SUN), "no map with a sun")
    def test_sun_through_a_vase(self):
        """Path tracing alone finds this light so seldom that its noise is unknown: errors are compared, not pictures."""
        job = [scene("vase"), "--env", SUN, "--size", "48x48", "--spp", "64"]
        without, by_light = self.render(*job, "--light-paths", "0")["error"], self.render(*job, "--light-paths", "0.25")["error"]
        self.assertLess(by_light ** 2 * 20, without ** 2)


if __name__ == "__main__":
    unittest.main()

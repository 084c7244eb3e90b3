# tier: quick
"""--scene, --variant, --animation and --at, in every command that reads a scene."""
import json
import struct
import unittest

from support import Case, data_uri, eclat, quad_scene, read_exr, write_gltf


def moving_quad():
    """The emitting quad is in view until 1 s, and far outside it from 3 s on. The second scene has the quad alone, small."""
    scene, _ = quad_scene()
    keys = struct.pack("<8f", 1, 3, 0, 0, 0, 100, 0, 0)
    scene["buffers"].append({"byteLength": len(keys), "uri": data_uri(keys)})
    scene["bufferViews"].append({"buffer": 1, "byteLength": len(keys)})
    scene["accessors"] += [{"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [1], "max": [3]},
                           {"bufferView": 2, "byteOffset": 8, "componentType": 5126, "count": 2, "type": "VEC3"}]
    scene["animations"] = [{"name": "leave", "samplers": [{"input": 2, "output": 3}],
                            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]
    scene["nodes"].append({"mesh": 0, "scale": [0.5, 0.5, 0.5]})
    scene["scenes"].append({"name": "small", "nodes": [2, 1]})
    return scene


class SceneChoice(Case):
    def setUp(self):
        super().setUp()
        self.scene = write_gltf(self.path("move.gltf"), moving_quad())

    def brightness(self, *options):
        out = self.path("out.exr")
        self.assert_ok(eclat("render", "-q", "--integrator", "raster", "--size", "24x16", "--spp", "4", "--env", "0,0,0", "-o", out,
                             *options, self.scene))
        values = read_exr(out)[1]["G"]
        return sum(values) / len(values)

    def test_render_shows_what_is_chosen(self):
        stored = self.brightness()
        self.assertGreater(stored, 0.1)
        self.assertEqual(self.brightness("--at", "1"), stored)
        self.assertEqual(self.brightness("--at", "3"), 0)
        self.assertEqual(self.brightness("--animation", "leave"), stored)
        small = self.brightness("--scene", "small")
        # a quarter of the area; 4 samples a pixel along an edge of 40 pixels
        self.assertAlmostEqual(small / stored, 0.25, delta=0.05)
        self.assertEqual(self.brightness("--scene", "1"), small)

    def test_info_lists_what_there_is(self):
        run = self.assert_ok(eclat("info", self.scene))
        self.assertIn("scenes      0, 1 'small'", run.stdout)
        self.assertIn("animations  0 'leave' (3 s)", run.stdout)
        self.assertIn("--at SECONDS", run.stderr)
        report = json.loads(self.assert_ok(eclat("info", "--json", "--scene", "small", self.scene)).stdout)
        self.assertEqual([report["scenes"], report["scene_shown"], report["variants"]], [[None, "small"], 1, []])
        self.assertEqual(report["animations"], [{"name": "leave", "seconds": 3}])

    def test_what_there_is_not_is_refused(self):
        cases = {"--scene=2": 'no scene "2"; there are: 0, 1 "small"', "--variant=red": 'no variant "red"; the file has none',
                 "--animation=run": 'no animation "run"; there are: 0 "leave"'}
        for command in ("render", "info", "cost"):
            for option, says in cases.items():
                with self.subTest(command=command, option=option):
                    self.assertIn(says, self.assert_one_error(eclat(command, option, self.scene), 1))
            for option in ("--at=-1", "--at=nan", "--at=x", "--scene=", "--animation=", "--variant="):
                with self.subTest(command=command, option=option):
                    self.assert_one_error(eclat(command, option, self.scene), 2)


if __name__ == "__main__":
    unittest.main()

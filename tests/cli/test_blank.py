# tier: quick
"""A picture that shows no surface gets a warning that says why; other pictures get none. The default camera looks at the fronts of
surfaces."""
import struct
import unittest

from support import QUICK, Case, data_uri, eclat, quad_scene, read_exr, write_gltf

SMALL = ("--size", "24x16", "--spp", "2", *QUICK)
WARNING = "the picture will show no surface: "
BACKS = "sees nothing but backs of single-sided materials"


class Blank(Case):
    def render(self, change=lambda scene: None, *options):
        """Returns (the warning, the share of the picture that shows surfaces). Checks that an empty picture has a warning, and that no
        other has one."""
        scene, _ = quad_scene()
        change(scene)
        out = self.path("a.exr")
        run = self.assert_ok(eclat("render", write_gltf(self.path("scene.gltf"), scene), *SMALL, "-o", out, *options))
        alpha = read_exr(out)[1]["A"]
        self.assertEqual(WARNING in run.stderr, sum(alpha) == 0, run.stderr)
        return run.stderr, sum(alpha) / len(alpha)

    def test_what_can_be_seen_is_not_told_of(self):
        for options in [(), ("--eye", "2,1,3"), ("--parallel", "0.01"), ("--screen-window", "0.1,0.2,0.1,0.2"), ("--eye", "0,0,0.001", "--look-at", "0,0,0")]:
            self.render(lambda scene: None, *options)

    def test_backs(self):
        def turn(scene):
            scene["nodes"][0]["rotation"] = [0, 1, 0, 0]
        said, _ = self.render(turn)
        self.assertIn(BACKS, said)
        self.assertNotIn("from within", said)
        self.render(turn, "--without", "back-face-culling")
        self.render(turn, "--eye", "0,0,-3")
        self.assertIn(BACKS, self.render(turn, "--parallel", "2")[0])

        def both(scene):
            turn(scene)
            scene["materials"][0]["doubleSided"] = True
        self.render(both)

    def test_a_camera_within_a_body(self):
        corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        faces = [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3]
        buffer = b"".join(struct.pack("<3f", *c) for c in corners) + struct.pack("<36H", *faces)

        def close(scene):
            scene["buffers"][0] = {"byteLength": len(buffer), "uri": data_uri(buffer)}
            scene["bufferViews"] = [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}]
            scene["accessors"][0].update(count=8, min=[-1, -1, -1], max=[1, 1, 1])
            scene["accessors"][1]["count"] = 36
            scene["nodes"][1]["translation"] = [0.5, 0, 0]
        self.assertIn(BACKS + ", from within the scene", self.render(close)[0])

    def test_above_a_wide_picture(self):
        """The quad is above the picture, at a height that would be in view if the picture were as high as it is wide. To the side, at the
        same distance, it is in view."""
        above, beside = [0, 2.5, 0], [2.5, 0, 0]
        self.assertEqual(self.render(lambda scene: scene["nodes"][0].update(translation=above), "--size", "96x8")[1], 0)
        self.assertGreater(self.render(lambda scene: scene["nodes"][0].update(translation=beside), "--size", "96x8")[1], 0)

    def test_nothing_in_view(self):
        for place in [[0, 0, 4], [9, 0, 0], [0, -9, 0]]:
            said, _ = self.render(lambda scene: scene["nodes"][0].update(translation=place))
            self.assertIn("there is none in the view of camera 0 'front'", said)

    def test_alpha(self):
        for material in [{"alphaMode": "BLEND"}, {"alphaMode": "MASK"}]:
            material["pbrMetallicRoughness"] = {"baseColorFactor": [1, 1, 1, 0]}
            said, _ = self.render(lambda scene: scene.update(materials=[material]))
            self.assertIn("the alpha of all materials is 0, or under their cut-off", said)


class Fronts(Case):
    def test_the_camera_of_a_file_without_one(self):
        """The default camera sees the quad's front whichever way the quad turns. For a two-sided quad both sides are equally good."""
        half = 0.5 ** 0.5
        for rotation in [[0, 0, 0, 1], [0, 1, 0, 0], [half, 0, 0, half], [-half, 0, 0, half], [0, half, 0, half], [0, -half, 0, half]]:
            eyes = []
            for material in [{}, {"doubleSided": True}]:
                scene, _ = quad_scene(material=material)
                scene["nodes"][0]["rotation"] = rotation
                scene["scenes"][0]["nodes"] = [0]
                out = self.path("a.exr")
                self.assert_ok(eclat("render", write_gltf(self.path("scene.gltf"), scene), *SMALL, "-q", "-o", out))
                attributes, planes = read_exr(out)
                self.assertGreater(sum(planes["A"]), 0, rotation)
                eyes.append([float(number) for number in attributes["eclat.camera.eye"].split(",")])
            self.assertTrue(all(coordinate > 0 for coordinate in eyes[1]), eyes)


if __name__ == "__main__":
    unittest.main()

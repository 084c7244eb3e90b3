# tier: full
"""Every ray meets the same one of two faces that overlap in one plane: the picture of both has the bits of that face's own picture wherever
it is. One face shines red, one green, so that one sample a pixel tells which was met."""
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "robust"))
from hard_scene import Scene
from support import NARROW, Case, eclat, read_exr

SIZE = 48
TURN = [0.3, 0.4, 0.2, math.sqrt(1 - 0.3 ** 2 - 0.4 ** 2 - 0.2 ** 2)]
NEXT, OTHER, FAN = [0, 1, 2, 0, 2, 3], [0, 1, 3, 1, 2, 3], [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4]  # indices of the corners and of the middle


def shining(red, green, **material):
    return dict({"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}, "emissiveFactor": [red, green, 0],
                 "doubleSided": True, "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}, **material)


RED, GREEN = shining(1, 0), shining(0, 1)


def turned(point, quaternion=TURN):
    x, y, z, w = quaternion
    t = [2 * (y * point[2] - z * point[1]), 2 * (z * point[0] - x * point[2]), 2 * (x * point[1] - y * point[0])]
    return [point[0] + w * t[0] + y * t[2] - z * t[1], point[1] + w * t[1] + z * t[0] - x * t[2], point[2] + w * t[2] + x * t[1] - y * t[0]]


def face(x0, y0, x1, y1, order, back=False, turn=True, height=0.0):
    """Positions of triangles in a tilted plane."""
    corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1), ((x0 + x1) / 2, (y0 + y1) / 2)]
    points = [turned((*c, height)) if turn else [*c, height] for c in corners]
    if back:
        order = [order[3 * (i // 3) + (0, 2, 1)[i % 3]] for i in range(len(order))]
    return [value for i in order for value in points[i]]


LARGE, SHIFTED = (-1, -0.8, 0.6, 0.9), (-0.7, -1, 0.9, 0.7)
NOTHING = dict(shining(0, 0), pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 0]}, alphaMode="MASK")
WAYS = [(), ("--accel", "bvh2"), ("--accel", "grid"), ("--accel", "kdtree"), ("--accel", "none"), ("--integrator", "raster")]


class Coplanar(Case):
    def picture(self, faces, *options, camera=None):
        """Pixels of faces, each (material, arguments of Scene.add()); (0, 0) where the environment shows. No face is brighter than the
        environment, so that none has rays of its own at its edges, as lamps have."""
        scene = Scene(*(material for material, _ in faces))
        scene.camera.update(camera or {})
        for k, (_, mesh) in enumerate(faces):
            scene.add(material=k, **mesh)
        out = self.path("out.exr")
        self.assert_ok(eclat("render", scene.write(self.path("scene.gltf")), "-q", *NARROW, "--size", f"{SIZE}x{SIZE}", "--spp", "1",
                             "--replicates", "1", "--env", "1,1,1", "-o", out, *options))
        channels = read_exr(out)[1]
        return [(r, g) if b == 0 else (0, 0) for r, g, b in zip(*(channels[c] for c in "RGB"))]

    def check(self, faces, winner, *options, **where):
        """Renders each of two faces by itself, with the other there but invisible; then both."""
        alone = [self.picture([(material if k == i else NOTHING, mesh) for k, (material, mesh) in enumerate(faces)], *options, **where) for i in (0, 1)]
        both = self.picture(faces, *options, **where)
        over, under = alone[winner], alone[1 - winner]
        self.assertGreater(sum(any(a) and any(b) for a, b in zip(over, under)), SIZE, "they do not overlap")
        self.assertEqual(sum(p != (a if any(a) else b) for p, a, b in zip(both, over, under)), 0)

    def test_the_first_in_the_file_in_every_structure(self):
        faces = [(RED, {"positions": face(*LARGE, NEXT)}), (GREEN, {"positions": face(*SHIFTED, FAN)})]
        for way in WAYS:
            with self.subTest(way):
                self.check(faces, 0, *way)
        self.check(faces[::-1], 0)

    def test_the_front_face_is_met(self):
        faces = [(RED, {"positions": face(*LARGE, OTHER)}), (GREEN, {"positions": face(*SHIFTED, FAN, back=True)})]
        self.check(faces, 0)
        self.check(faces[::-1], 1)
        behind = {"translation": [0, 0, -3], "rotation": [0, 1, 0, 0]}
        self.check(faces, 1, camera=behind)
        self.check(faces[::-1], 0, camera=behind)

    def test_one_mesh_in_two_places(self):
        """Nodes turn and move the mesh, so that its corners are rounded differently."""
        moved = turned([0.3, 0.2, 0])
        scene_mesh = {"positions": face(*LARGE, FAN, turn=False), "rotation": TURN}
        self.check([(RED, scene_mesh), (GREEN, dict(scene_mesh, translation=moved))], 0)
        self.check([(RED, dict(scene_mesh, scale=[0.71, 0.71, 1])), (GREEN, scene_mesh)], 0)

    def test_partial_coverage_lies_on_top(self):
        decal = dict(GREEN, pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 0.5], "metallicFactor": 0}, alphaMode="BLEND")
        wall, over = {"positions": face(*LARGE, NEXT)}, {"positions": face(*SHIFTED, FAN)}
        both = [a if any(b) else (0, 0) for a, b in zip(self.picture([(RED, wall), (decal, over)]), self.picture([(NOTHING, wall), (GREEN, over)]))]
        seen = [a for a, b in zip(both, self.picture([(RED, wall), (NOTHING, over)])) if any(b) and any(a)]
        self.assertAlmostEqual(sum(g > 0 for _, g in seen) / len(seen), 0.5, delta=0.1)  # 282 pixels: three standard errors

    def test_sixty_four_ulps_apart_the_nearer_one(self):
        near = face(*SHIFTED, FAN, height=64 * 2 ** -23)
        self.check([(RED, {"positions": face(*LARGE, NEXT)}), (GREEN, {"positions": near})], 1)

    def test_lamps_that_are_hidden_do_not_shine(self):
        """A bright lamp lies under a weak one, over a floor that the camera sees from below."""
        floor = {"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 1}, "doubleSided": True}
        quads = [(RED, {"positions": face(*LARGE, NEXT)}), (shining(9, 9), {"positions": face(*LARGE, FAN)}),
                 (floor, {"positions": face(-2, -2, 2, 2, NEXT, height=-0.5)})]
        means = []
        for faces in (quads, [quads[0], (NOTHING, quads[1][1]), quads[2]]):
            pixels = self.picture(faces, "--spp", "64", "--max-depth", "2")
            means.append([sum(p[c] for p in pixels) / len(pixels) for c in (0, 1)])
        self.assertLess(means[0][1], 1e-5)  # only along the rims
        self.assertAlmostEqual(means[0][0] / means[1][0], 1, delta=0.01)


if __name__ == "__main__":
    unittest.main()

# tiers: quick, full
"""Cryptomatte: hashed names and their coverage of pixels, read by a parser of our own after the specification, and by cryptomatte-api
(PyPI)."""
import json
import os
import struct
import sys
import unittest

import pypi
from support import CORNELL, FLOAT, NARROW, Case, eclat, read_exr
from test_motion import GLOW, GREY, Builder
from tiers import full

KINDS = ("CryptoObject", "CryptoMaterial", "CryptoAsset")


def murmur3(name):
    """MurmurHash3_x86_32 with seed 0, after the reference implementation."""
    data, h, turn = name.encode(), 0, lambda x, r: (x << r | x >> (32 - r)) & 0xffffffff
    padded = data + b"\0" * (-len(data) % 4)
    for i in range(0, len(padded), 4):
        k = turn(int.from_bytes(padded[i:i + 4], "little") * 0xcc9e2d51 & 0xffffffff, 15) * 0x1b873593 & 0xffffffff
        h ^= k
        if i + 4 <= len(data):
            h = (turn(h, 13) * 5 + 0xe6546b64) & 0xffffffff
    h ^= len(data)
    h = (h ^ h >> 16) * 0x85ebca6b & 0xffffffff
    h = (h ^ h >> 13) * 0xc2b2ae35 & 0xffffffff
    return h ^ h >> 16


def id_of(name):
    """The specification's conversion of a hash to a float: never infinite, NaN or denormal."""
    h = murmur3(name)
    return h ^ 1 << 23 if h >> 23 & 255 in (0, 255) else h


def read_mattes(path):
    """Returns {kind: (manifest, [{id: coverage} of each pixel])}, and checks all that the file alone allows to check."""
    attributes, planes = read_exr(path)
    mattes = {}
    for key in [name.split("/")[1] for name in attributes if name.startswith("cryptomatte/") and name.endswith("/name")]:
        about = {field: attributes[f"cryptomatte/{key}/{field}"] for field in ("name", "hash", "conversion", "manifest")}
        assert key == f"{id_of(about['name']):08x}"[:7]
        assert (about["hash"], about["conversion"]) == ("MurmurHash3_32", "uint32_to_float32")
        pixels = [{} for _ in planes["R"]]
        for level in range(3):
            for id_channel, part in ("RG", "BA"):
                ids, parts = (planes[f"{about['name']}{level:02}.{c}"] for c in (id_channel, part))
                for pixel, i, coverage in zip(pixels, ids, parts):
                    number, = struct.unpack("<I", struct.pack("<f", i))
                    assert bool(number) == (coverage > 0) and number not in pixel
                    assert not pixel or coverage <= min(pixel.values())
                    if number:
                        pixel[number] = coverage
        mattes[about["name"]] = ({name: int(h, 16) for name, h in json.loads(about["manifest"]).items()}, pixels)
    return attributes, planes, mattes


def two_quads():
    """A view of 3 x 3 with two nodes in "group": "left" has x from -1 to 0; a node without a name, of the mesh "board", has x from 0 to
    0.7. y is -0.5 to 0.5. One material is "red", the other has no name."""
    b = Builder()
    b.camera(1.5)
    b.add(dict(GLOW, name="red"), name="left", translation=[-.5, 0, 0])
    b.add(dict(GREY), translation=[.35, 0, 0], scale=[.7, 1, 1])
    b.scene["meshes"][1]["name"] = "board"
    b.scene["nodes"].append({"name": "group", "children": [1, 2]})
    b.scene["scenes"][0]["nodes"] = [0, 3]
    return b


class Mattes(Case):
    def render(self, name, *options, scene, size="24x16", spp="16", env=None):
        self.assert_ok(eclat("render", scene, *NARROW, "--size", size, "--spp", spp, "-q", *options, "-o", name, cwd=self.folder, env=env))
        return self.path(name)

    def test_names_and_hashes(self):
        """Hashes match Appleby's test vectors. Names are those of nodes (without one: of their mesh), of materials (without one: a number),
        and of the nodes at the top."""
        self.assertEqual([murmur3(s) for s in ("", "hello", "hello, world", "The quick brown fox jumps over the lazy dog")], [0, 0x248bfa47, 0x149bbb7f, 0x2e4ff723])
        path = self.render("a.exr", "--channels", "A,cryptomatte", scene=two_quads().write(self.path("two.gltf")))
        attributes, _, mattes = read_mattes(path)
        for kind, names in zip(KINDS, (["board", "left"], ["material1", "red"], ["group"])):
            self.assertEqual(mattes[kind][0], {name: id_of(name) for name in names})
        channels = {f"{kind}{level:02}.{c}": FLOAT for kind in KINDS for level in range(3) for c in "RGBA"}
        self.assertEqual({name: kind for name, kind in attributes["channels"] if name.startswith("Crypto")}, channels)

    def test_coverage_is_that_of_the_geometry(self):
        self.assert_coverage()

    @full
    def test_coverage_of_other_integrators(self):
        for integrator in ("whitted", "raster"):
            self.assert_coverage("--integrator", integrator)

    def assert_coverage(self, *options):
        """Pixels (24 x 12) that are covered wholly or not at all are exact. The column at x = 0.7 is covered by 0.6 within the samples'
        discrepancy. An asset is everything below a node."""
        path = self.render("a.exr", "--channels", "A,cryptomatte", *options, scene=two_quads().write(self.path("two.gltf")), size="24x12")
        _, _, mattes = read_mattes(path)
        left, board, red, other, group = (id_of(name) for name in ("left", "board", "red", "material1", "group"))
        for i in range(24 * 12):
            of_object, of_material, of_asset = (mattes[kind][1][i] for kind in KINDS)
            x, inside = i % 24, 4 <= i // 24 < 8
            expected = {left: 1} if inside and 4 <= x < 12 else {board: 1} if inside and 12 <= x < 17 else {}
            if inside and x == 17:
                self.assertEqual(list(of_object), [board])
                self.assertAlmostEqual(of_object[board], 0.6, delta=0.1)
            else:
                self.assertEqual(of_object, expected)
            self.assertEqual({{left: red, board: other}[name]: part for name, part in of_object.items()}, of_material)
            self.assertEqual(dict.fromkeys([group] if of_object else [], sum(of_object.values())), of_asset)

    @full
    def test_same_bits_everywhere(self):
        """Bits do not depend on width, wave, structure or the number of devices, also for meshes that are kept once. Mattes do not change
        the picture."""
        job = ["--channels", "default,cryptomatte", "--filter", "blackman-harris"]
        _, planes = read_exr(self.render("a.exr", *job, scene=CORNELL))
        _, alone = read_exr(self.render("b.exr", "--filter", "blackman-harris", scene=CORNELL))
        self.assertTrue(all(planes[c] == alone[c] for c in alone))
        for other in (["--lanes", "1"], ["--wave", "4096"], ["--accel", "kdtree"], ["--device", "all"]):
            with self.subTest(other=other):
                _, same = read_exr(self.render("c.exr", *job, *other, scene=CORNELL, env={"POCL_DEVICES": "basic basic"} if "--device" in other else None))
                self.assertTrue(all(planes[c] == same[c] for c in planes))

    @full
    def test_meshes_that_are_kept_once(self):
        """Names belong to places: --instancing on and off give the same."""
        b = two_quads()
        b.scene["nodes"][2]["mesh"] = 0
        scene = b.write(self.path("kept.gltf"))
        planes = [read_exr(self.render(f"{way}.exr", "--channels", "A,cryptomatte", "--instancing", way, scene=scene))[1] for way in ("on", "off")]
        self.assertTrue(all(planes[0][c] == planes[1][c] for c in planes[0]))

    @full
    def test_adaptive_samples_all_count(self):
        """Coverages add up although pixels have different numbers of samples."""
        _, planes, mattes = read_mattes(self.render("a.exr", "--channels", "default,CryptoObject", "--adaptive", scene=CORNELL, spp="64"))
        self.assertGreater(len(set(planes["samples"])), 1)
        for samples, seen in zip(planes["samples"], mattes["CryptoObject"][1]):
            for coverage in seen.values():
                self.assertAlmostEqual(coverage * samples, round(coverage * samples), 3)

    @full
    def test_what_moves_keeps_its_name(self):
        """One quad moves by two pixels while the shutter is open; another beside it stays."""
        b = two_quads()
        b.animate(1, "translation", [(-.5, 0, 0), (-.75, 0, 0)])
        path = self.render("a.exr", "--channels", "A,CryptoObject", "--shutter", "0:1", scene=b.write(self.path("moving.gltf")), spp="256")
        _, _, mattes = read_mattes(path)
        row = [mattes["CryptoObject"][1][8 * 24 + x] for x in range(24)]
        left, board = id_of("left"), id_of("board")
        self.assertEqual([set(row[x]) for x in (1, 4, 9, 13, 20)], [set(), {left}, {left}, {board}, set()])
        self.assertAlmostEqual(sum(seen.get(left, 0) for seen in row), 8, delta=0.1)

    @full
    def test_a_kept_reader_sees_the_same(self):
        sys.path.append(pypi.fetch("cryptomatte", "cryptomatte-api==1.0.0"))
        import cryptomatte_api  # pylint: disable=import-outside-toplevel
        path = self.render("a.exr", "--channels", "default,cryptomatte", scene=two_quads().write(self.path("two.gltf")))
        _, _, mattes = read_mattes(path)
        read = cryptomatte_api.Cryptomatte.load(path)
        self.assertEqual(sorted(one.metadata().name() for one in read), sorted(KINDS))
        for one in read:
            manifest, pixels = mattes[one.metadata().name()]
            for name, number in manifest.items():
                mask = [float(x) for x in one.mask(name).ravel()]
                self.assertEqual(mask, [seen.get(number, 0) for seen in pixels])

    def test_refused(self):
        for options, says in [(["--checkpoint", "c.exr"], "--channels cryptomatte and --checkpoint"), (["--clamp", "3"], "--channels cryptomatte and --clamp"),
                              (["-o", "a.png"], "-o names none")]:
            self.assertIn(says, self.assert_one_error(eclat("render", CORNELL, "--channels", "cryptomatte", *options, cwd=self.folder), 2))
        self.assertEqual(os.listdir(self.folder), [])


if __name__ == "__main__":
    unittest.main()

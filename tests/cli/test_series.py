# tier: quick
"""Several pictures in one run: each is that of a command of its own, is skipped where it is done, and does not stop the others when it
fails."""
import json
import os
import struct
import unittest
import zlib

from support import LINE, QUICK, Case, eclat, move_node, png_size, quad_scene, read_exr, write_gltf

SMALL = ["--size", "24x16", "--spp", "4", *QUICK]


def glowing(strength):
    return quad_scene(material={"emissiveFactor": [strength] * 3})[0]


def read_png(path):
    """Returns (width, height, rows of RGB) of an 8-bit PNG that is not interlaced, with any of the five filters."""
    with open(path, "rb") as file:
        data = file.read()
    width, height = png_size(path)
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        packed += data[at + 8:at + 8 + size] if kind == b"IDAT" else b""
        at += 12 + size
    raw, rows, above = zlib.decompress(packed), [], bytes(3 * width)
    for y in range(height):
        start = y * (3 * width + 1)
        row = bytearray(raw[start + 1:start + 1 + 3 * width])
        for i in range(3 * width):
            a, b, c = (row[i - 3] if i >= 3 else 0), above[i], (above[i - 3] if i >= 3 else 0)
            paeth = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, paeth)[raw[start]]) & 255
        rows.append(bytes(row))
        above = row
    return width, height, rows


class Series(Case):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path("out"))
        for name, strength in (("a", 1), ("b", 0.5), ("c", 0.25)):
            write_gltf(self.path(name + ".gltf"), glowing(strength))

    def render(self, *arguments, **options):
        return eclat("render", *arguments, *SMALL, cwd=self.folder, **options)

    def rows(self, *arguments):
        run = self.render(*arguments, "--json", "-q")
        rows = [json.loads(line) for line in run.stdout.splitlines()]
        return run, rows[:-1], rows[-1]

    def refuse(self, says, *arguments, code=2):
        line = self.assert_one_error(self.render(*arguments), code)
        self.assertIn(says, line)
        self.assertEqual(os.listdir(self.path("out")), [])

    def test_each_has_the_bits_of_a_command_alone(self):
        run, rows, last = self.rows("a.gltf", "b.gltf", "-o", "out/{name}.exr", "-o", "out/{name}.png")
        self.assert_ok(run)
        self.assertEqual([(row["name"], row["state"]) for row in rows], [("a.gltf", "rendered"), ("b.gltf", "rendered")])
        self.assertEqual((last["pictures"], last["rendered"], last["failed"]), (2, 2, 0))
        self.assertEqual(rows[1]["shared"]["programs_built"], 0)
        for row in rows:
            name = row["name"][0]
            alone = json.loads(self.assert_ok(self.render(name + ".gltf", "-o", "alone.exr", "--json", "-q")).stdout)
            self.assertEqual(alone["image_sha256"], row["image_sha256"])
            again = self.assert_ok(eclat(*row["command"].split()[1:], "-q", cwd=self.folder))
            self.assertEqual(again.stderr, "")

    def test_what_fails_leaves_the_others_and_is_told_of_at_the_end(self):
        with open(self.path("bad.gltf"), "w", encoding="utf-8") as file:
            file.write('{"asset":')
        run = self.render("a.gltf", "bad.gltf", "none.glb", "b.gltf", "-o", "out/{name}.png", "-q")
        self.assertEqual(run.returncode, 1)
        lines = run.stderr.splitlines()
        self.assertEqual(len(lines), 3, run.stderr)
        for line, says in zip(lines, ("bad.gltf: not valid JSON", "none.glb: cannot open", "2 of 4 pictures failed; once that is fixed, the same command renders only those")):
            self.assertTrue(line.startswith("eclat: error: " + says), line)
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["a.png", "b.png"])

        write_gltf(self.path("bad.gltf"), glowing(0.1))
        _, rows, last = self.rows("a.gltf", "bad.gltf", "none.glb", "b.gltf", "-o", "out/{name}.png", *[])
        self.assertEqual([row["state"] for row in rows], ["skipped", "rendered", "failed", "skipped"])
        self.assertIn("cannot open", rows[2]["error"])
        self.assertEqual((last["rendered"], last["skipped"], last["failed"]), (1, 2, 1))

    def test_what_is_no_longer_the_same_is_rendered_again(self):
        def states(*options):
            return [row["state"] for row in self.rows("a.gltf", "b.gltf", "-o", "out/{name}.png", *options)[1]]
        self.assertEqual(states(), ["rendered", "rendered"])
        self.assertEqual(states(), ["skipped", "skipped"])
        write_gltf(self.path("b.gltf"), glowing(0.75))
        self.assertEqual(states(), ["skipped", "rendered"])
        self.assertEqual(states("--exposure", "1"), ["rendered", "rendered"])
        with open(self.path("out", "a.png"), "r+b") as file:
            file.truncate(100)
        self.assertEqual(states("--exposure", "1"), ["rendered", "skipped"])

    def test_environments_are_each_picture_s_own(self):
        """A map for all scenes is read once. A white sky for a scene without light does not stay for the next scene."""
        scene = glowing(0)
        scene["materials"] = [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}}]
        write_gltf(self.path("dark.gltf"), scene)
        self.assert_ok(self.render("dark.gltf", "a.gltf", "-o", "out/{name}.exr", "-q"))
        corner = [read_exr(self.path("out", name))[1]["R"][0] for name in ("dark.exr", "a.exr")]
        self.assertEqual(corner[1], 0)
        self.assertGreater(corner[0], 0)
        self.assert_ok(self.render("dark.gltf", "a.gltf", "-o", "out/{name}.exr", "-q", "--env", "2,2,2", "--env-strength", "0.5"))
        self.assertEqual([read_exr(self.path("out", name))[1]["R"][0] for name in ("dark.exr", "a.exr")], [1, 1])

    def test_names(self):
        self.refuse("'out/x.png' is one name for all scenes; put {name}", "a.gltf", "b.gltf", "-o", "out/x.png")
        self.refuse("'a.gltf' is given twice", "a.gltf", "a.gltf", "-o", "out/{name}.png")
        for folder in "xy":
            os.mkdir(self.path(folder))
            write_gltf(self.path(folder, "scene.gltf"), glowing(1))
        two = ("x/scene.gltf", "y/scene.gltf")
        self.refuse("would both be written to 'out/scene.png'; put {name} or {folder}", *two, "-o", "out/{name}.png")
        self.refuse("would be written to the same files; give -o with {folder}", *two)
        self.assert_ok(self.render(*two, "-q", "-o", "out/{folder}-{name}.png"))
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["x-scene.png", "y-scene.png"])
        self.assert_ok(self.render("a.gltf", "-q", "-o", "out/one-{name}.png"))
        self.assertTrue(os.path.exists(self.path("out", "one-a.png")))
        self.assert_ok(self.render("a.gltf", "b.gltf", "-q"))
        self.assertTrue(all(os.path.exists(self.path(name)) for name in ("a.exr", "a.png", "b.exr", "b.png")))

    def test_nothing_is_rendered_where_something_is_wrong_with_all(self):
        for option, value in (("checkpoint", "c.exr"), ("samples", "0:4"), ("snapshot", "s.exr"), ("plan", "4")):
            self.refuse(f"--{option} works with a single picture", "a.gltf", "b.gltf", "-o", "out/{name}.exr", "--" + option, value)
        self.refuse("cannot write", "a.gltf", "b.gltf", "-o", "nowhere/{name}.png", code=1)
        self.refuse("cannot write", "a.gltf", "b.gltf", "-o", "out/{name}.png", "--sheet", "nowhere/s.png", code=1)
        self.refuse("is not I/N", "a.gltf", "b.gltf", "--shard", "3")
        self.refuse("--shard: '4' is not a whole number from 1 to 3", "a.gltf", "b.gltf", "--shard", "4/3")

    def test_shards_together_are_complete(self):
        for i in (1, 2):
            self.assert_ok(self.render("a.gltf", "b.gltf", "c.gltf", "-q", "-o", "out/{name}.png", "--shard", f"{i}/2"))
            self.assertEqual(sorted(os.listdir(self.path("out"))), ["a.png", "c.png"] if i == 1 else ["a.png", "b.png", "c.png"])

    def test_a_contact_sheet(self):
        """Three pictures of 24 x 16 whose middles are white, grey and dark grey, 8 apart, from the top left. Below each is its name, in a
        line of 12."""
        self.assert_ok(self.render("a.gltf", "b.gltf", "c.gltf", "-q", "-o", "out/{name}.exr", "--tonemap", "none", "--sheet", "sheet.png"))
        width, height, rows = read_png(self.path("sheet.png"))
        line = height - (2 * 24 + 8)
        self.assertEqual(line, 2 * LINE)
        self.assertEqual(width, 2 * 32 + 8)
        lower = 40 + line // 2
        middle = [rows[y][3 * x] for x, y in ((20, 16), (52, 16), (20, lower), (52, lower), (4, 4))]
        self.assertEqual(middle, [255, 188, 137, 32, 32])
        if not line:
            self.skipTest("no font: libstb-dev is not there")
        letters = [[[rows[y][3 * x] for x in range(left, left + 24)] for y in range(top, top + LINE)] for left, top in ((8, 24), (40, 24), (8, 60), (40, 60))]
        ink = [{(x - min(i for row in rows for i, v in enumerate(row) if v > 32), y) for y, row in enumerate(rows) for x, v in enumerate(row) if v > 32}
               if any(v > 32 for row in rows for v in row) else set() for rows in letters]
        self.assertEqual(ink[3], set())  # there is no fourth picture
        self.assertEqual(len({frozenset(i) for i in ink}), 4)  # three names, a, b and c, and one empty place
        self.assertTrue(all(5 <= len(i) <= 30 for i in ink[:3]), ink)

    def test_long_names_are_cut_on_a_sheet(self):
        name = "very-long-name-" * 10
        write_gltf(self.path(name + "\u00e9.gltf"), glowing(1))
        self.assert_ok(self.render("a.gltf", name + "\u00e9.gltf", "-q", "-o", "out/{name}.png", "--sheet", "sheet.png"))
        width, height, rows = read_png(self.path("sheet.png"))
        self.assertEqual(width, 2 * 32 + 8)
        for y in range(24, height):  # all ink is within the cells
            self.assertEqual({rows[y][3 * x] for x in (*range(8), *range(32, 40), *range(64, 72))}, {32})

    def test_a_sheet_shrinks_light_not_codes(self):
        """An edge in the middle of a cell: the mean light of both sides is 0.5, which is the code 188."""
        scene = glowing(1)
        scene["nodes"][0]["translation"] = [-1 + 1 / 192, 0, 0]
        scene["nodes"][0]["scale"] = [1, 4, 1]
        scene["cameras"][0] = {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 10}}
        write_gltf(self.path("half.gltf"), scene)
        self.assert_ok(eclat("render", "half.gltf", "--size", "384x384", "--spp", "1", *QUICK, "-q", "-o", "out/{name}.png", "--tonemap", "none", "--sheet",
                             "sheet.png", cwd=self.folder))
        width, height, rows = read_png(self.path("sheet.png"))
        self.assertEqual(width, 208)
        row = [rows[100][3 * x] for x in range(208)]
        self.assertEqual(row, [32] * 8 + [255] * 96 + [188] + [0] * 95 + [32] * 8)

    def test_pictures_without_a_surface_are_named_at_the_end(self):
        scene = glowing(1)
        scene["nodes"][0]["rotation"] = [0, 1, 0, 0]
        write_gltf(self.path("back.gltf"), scene)
        run = self.assert_ok(self.render("a.gltf", "back.gltf", "b.gltf", "-q", "-o", "out/{name}.png"))
        self.assertIn("eclat: warning: back.gltf: the picture will show no surface", run.stderr)
        self.assertIn("1 of 3 pictures show no surface, as warned above: back.gltf", run.stderr.splitlines()[-1])
        del scene["cameras"], scene["nodes"][1], scene["scenes"][0]["nodes"][1]
        write_gltf(self.path("back.gltf"), scene)
        self.assertEqual(self.assert_ok(self.render("a.gltf", "back.gltf", "-q", "-o", "out/{name}.exr")).stderr, "")
        self.assertGreater(sum(read_exr(self.path("out", "back.exr"))[1]["A"]), 0)

    def test_a_turntable(self):
        """A quad that glows on one side, off the scene's centre, is not seen from the other side. A frame is what --eye sees from there."""
        scene = glowing(1)
        scene["nodes"] += [{"mesh": 0, "translation": [0, 0, -2], "rotation": [0, 1, 0, 0], "scale": [0.5, 0.5, 0.5]}]
        scene["scenes"][0]["nodes"].append(2)
        scene["nodes"][1]["translation"] = [0, 0, 4]
        scene["cameras"][0]["perspective"]["aspectRatio"] = 1
        path = write_gltf(self.path("two.gltf"), scene)
        run, rows, last = self.rows(path, "--orbit", "4", "-o", "out/%d.exr", "--sheet", "sheet.png")
        self.assert_ok(run)
        self.assertEqual([row["frame_degrees"] for row in rows], [0, 90, 180, 270])
        self.assertEqual([row["frame_seconds"] for row in rows], [0] * 4)
        seen = [sum(read_exr(self.path("out", f"{k}.exr"))[1]["A"]) for k in range(4)]
        self.assertEqual((seen[1], seen[3]), (0, 0), "edge on")
        self.assertGreater(seen[0], 3 * seen[2])
        self.assertGreater(seen[2], 0)
        self.assert_ok(self.render(path, "-q", "-o", "still.exr"))
        self.assertEqual(read_exr(self.path("still.exr"))[1], read_exr(self.path("out", "0.exr"))[1])
        attributes, planes = read_exr(self.path("out", "2.exr"))
        self.assertEqual(attributes["eclat.frame.degrees"], 180)
        self.assert_ok(self.render(path, "-q", "-o", "eye.exr", "--eye", "0,0,-6", "--look-at", "0,0,-1"))
        there = read_exr(self.path("eye.exr"))[1]
        self.assertLess(max(abs(a - b) for a, b in zip(planes["A"], there["A"])), 0.3)
        os.remove(self.path("out", "2.exr"))
        self.assert_ok(eclat(*attributes["eclat.command"].split()[1:], "-q", cwd=self.folder))
        self.assertEqual(read_exr(self.path("out", "2.exr"))[1], planes)
        _, rows, _ = self.rows(path, "--orbit", "8", "--frames", "0:6:2", "-o", "out/%d.exr", "--overwrite")
        self.assertEqual([row["frame_degrees"] for row in rows], [0, 90, 180, 270])
        self.assertEqual([row["state"] for row in rows], ["skipped", "rendered", "rendered", "rendered"])

    def test_a_turntable_whose_scene_moves_and_one_of_its_own(self):
        scene = glowing(1)
        move_node(scene, 0, [0, 0, 0], [8, 0, 0])
        path = write_gltf(self.path("moves.gltf"), scene)

        def means(*options):
            rows = self.rows(path, "--orbit", "2", "-o", "out/%d.exr", "--overwrite", "--look-at", "0,0,0", "--eye", "0,0,3", *options)[1]
            return [row["frame_seconds"] for row in rows], sum(read_exr(self.path("out", "0.exr"))[1]["A"])
        self.assertEqual(means()[0], [0, 0])
        self.assertEqual(means("--fps", "2")[0], [0, 0.5])
        self.assertGreater(means("--at", "0")[1], 0)
        self.assertEqual(means("--at", "1")[1], 0)
        self.refuse_orbit("--frames ends with 4, and --orbit 4 has the frames 0 to 3", "--frames", "0:4")
        self.refuse_orbit("--frames and --at", "--fps", "4", "--at", "1")
        self.refuse_orbit("--frames and --checkpoint", "--checkpoint", "c.exr")
        self.refuse_orbit("is one name for all --frames", "-o", "out.png")

    def refuse_orbit(self, says, *options):
        self.assertIn(says, self.assert_one_error(self.render("a.gltf", "--orbit", "4", *options), 2))

    def test_frames_of_several(self):
        for name in ("a.gltf", "b.gltf"):
            scene = glowing(1)
            move_node(scene, 0, [0, 0, 0], [1, 0, 0])
            write_gltf(self.path(name), scene)
        run, rows, last = self.rows("a.gltf", "b.gltf", "--frames", "0:1", "-o", "out/{name}.%d.png", "--sheet", "sheet.png")
        self.assert_ok(run)
        self.assertEqual([row.get("frame") for row in rows], [0, 1, None, 0, 1, None])
        self.assertEqual(last["rendered"], 2)
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["a.0.png", "a.1.png", "b.0.png", "b.1.png"])
        self.assertEqual(png_size(self.path("sheet.png")), (2 * 32 + 8, 2 * 24 + 8 + 2 * LINE))


if __name__ == "__main__":
    unittest.main()

# tier: quick
"""Bad input to a render: each error gives one clear line and the right exit code, and leaves no partial file."""
import os
import struct
import subprocess
import unittest

from support import Case, data_uri, eclat, quad_scene, write_glb, write_gltf


class BadInput(Case):
    def setUp(self):
        super().setUp()
        self.out = self.path("out")
        os.mkdir(self.out)

    def refuse(self, scene, *options, code=1, says=()):
        run = eclat("render", scene, "--size", "16x16", "--spp", "4", "-o", os.path.join(self.out, "a.exr"), "-o",
                    os.path.join(self.out, "a.png"), *options)
        line = self.assert_one_error(run, code)
        for word in says if isinstance(says, tuple) else (says,):
            self.assertIn(word, line)
        self.assertEqual(os.listdir(self.out), [])
        return line

    def quad(self, change=lambda scene: None):
        scene, _ = quad_scene()
        change(scene)
        return write_gltf(self.path("scene.gltf"), scene)


class BadScenes(BadInput):
    def test_missing_file(self):
        self.refuse(self.path("nothing.gltf"), says="nothing.gltf")

    def test_folder(self):
        self.refuse(self.folder)

    def test_not_gltf(self):
        with open(self.path("text.gltf"), "w") as file:
            file.write("hello")
        self.refuse(self.path("text.gltf"), says="text.gltf")

    def test_empty_file(self):
        for name in ["empty.gltf", "empty.glb"]:
            open(self.path(name), "w").close()
            self.refuse(self.path(name), says=name)

    def test_truncated_glb(self):
        whole = write_glb(self.path("whole.glb"), *quad_scene())
        with open(whole, "rb") as file:
            data = file.read()
        for size in [3, 11, 12, 19, 20, 100, len(data) - 20, len(data) - 1]:
            with self.subTest(size=size):
                with open(self.path("cut.glb"), "wb") as file:
                    file.write(data[:size])
                self.refuse(self.path("cut.glb"), says="cut.glb")

    def test_missing_buffer(self):
        self.refuse(self.quad(lambda scene: scene["buffers"][0].update(uri="missing.bin")), says="missing.bin")

    def test_short_buffer(self):
        with open(self.path("short.bin"), "wb") as file:
            file.write(bytes(10))
        self.refuse(self.quad(lambda scene: scene["buffers"][0].update(uri="short.bin")))

    def test_vertex_index_out_of_range(self):
        buffer = bytearray(quad_scene()[1])
        struct.pack_into("<H", buffer, 48, 60000)
        self.refuse(self.quad(lambda scene: scene["buffers"][0].update(uri=data_uri(bytes(buffer)))))

    def test_references_out_of_range(self):
        changes = {
            "accessor": lambda scene: scene["meshes"][0]["primitives"][0].update(indices=7),
            "material": lambda scene: scene["meshes"][0]["primitives"][0].update(material=7),
            "mesh": lambda scene: scene["nodes"][0].update(mesh=7),
            "node": lambda scene: scene["scenes"][0].update(nodes=[0, 7]),
            "scene": lambda scene: scene.update(scene=7),
            "buffer view": lambda scene: scene["accessors"][0].update(bufferView=7),
            "buffer": lambda scene: scene["bufferViews"][0].update(buffer=7),
            "camera": lambda scene: scene["nodes"][1].update(camera=7),
            "count": lambda scene: scene["accessors"][0].update(count=2 ** 31),
        }
        for name, change in changes.items():
            with self.subTest(name):
                self.refuse(self.quad(change))

    def test_cycle_in_the_node_tree(self):
        self.refuse(self.quad(lambda scene: scene["nodes"][0].update(children=[0])))

    def test_nan_positions_are_refused_or_left_out_and_told(self):
        buffer = bytearray(quad_scene()[1])
        for at in range(0, 48, 4):
            struct.pack_into("<f", buffer, at, float("nan"))
        scene = self.quad(lambda scene: scene["buffers"][0].update(uri=data_uri(bytes(buffer))))
        run = eclat("info", scene)
        self.assertIn(run.returncode, (0, 1), run.stderr)
        self.assertRegex(run.stderr, r"(?i)eclat: (warning|error): .*(finite|nan)")

    def test_uris_stay_in_the_scene_folder(self):
        inner = self.path("inner")
        os.mkdir(inner)
        with open(self.path("outside.bin"), "wb") as file:
            file.write(quad_scene()[1])
        outside = self.path("outside.bin")
        for uri in ["../outside.bin", "%2e%2e/outside.bin", "..%2Foutside.bin", "a/../../outside.bin", outside,
                    "file://" + outside, "http://127.0.0.1:9/outside.bin", "https://127.0.0.1:9/x.bin", "..\\outside.bin"]:
            with self.subTest(uri=uri):
                self.refuse(write_gltf(os.path.join(inner, "scene.gltf"), quad_scene(uri=uri)[0]))

    def test_links_out_of_the_scene_folder(self):
        """Links out of the folder are followed only on request. Links within it are always followed, as is a link that is the folder
        itself."""
        os.makedirs(self.path("inner", "deep"))
        for name in ["outside.bin", os.path.join("inner", "deep", "inside.bin")]:
            with open(self.path(name), "wb") as file:
                file.write(quad_scene()[1])
        os.symlink("inner", self.path("other"))
        scene = self.path("inner", "scene.gltf")
        for link, target in [("out.bin", "../outside.bin"), ("in.bin", "deep/inside.bin"), ("up", "..")]:
            os.symlink(target, self.path("inner", link))
        for uri in ["out.bin", "up/outside.bin"]:
            line = self.refuse(write_gltf(scene, quad_scene(uri=uri)[0]), says="it is a symbolic link out of the scene's folder")
            self.assertIn("--follow-links", line)
            self.assert_ok(eclat("info", scene, "--follow-links"))
        write_gltf(scene, quad_scene(uri="in.bin")[0])
        for path in [scene, self.path("other", "scene.gltf")]:
            self.assert_ok(eclat("info", path))
        self.assert_ok(eclat("info", "scene.gltf", cwd=self.path("other")))

    def test_a_damaged_jpeg_is_told_of(self):
        scene, _ = quad_scene(material={"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})
        scene.update(images=[{"uri": "cut.jpg"}], textures=[{"source": 0}])
        scene["accessors"].append({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC2"})
        scene["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 2
        subprocess.run(["convert", "-size", "64x64", "plasma:", self.path("whole.jpg")], check=True)
        with open(self.path("whole.jpg"), "rb") as file:
            data = file.read()
        for length in [len(data), 2 * len(data) // 3]:
            with open(self.path("cut.jpg"), "wb") as file:
                file.write(data[:length])
            run = self.assert_ok(eclat("info", write_gltf(self.path("scene.gltf"), scene)))
            self.assertEqual("images[0] is damaged or truncated: " in run.stderr, length < len(data), run.stderr)


    def test_an_exposure_that_is_not_applied_is_told_of(self):
        for line, is_told in [(b"", False), (b"EXPOSURE=2\n", True), (b"EXPOSURE=2\nEXPOSURE=0.5\n", False)]:
            with open(self.path("map.hdr"), "wb") as file:
                file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + line + b"\n-Y 1 +X 2\n" + bytes([128, 128, 128, 128]) * 2)
            run = self.assert_ok(eclat("info", self.quad(), "--env", self.path("map.hdr")))
            self.assertEqual("map.hdr: its EXPOSURE is not applied" in run.stderr, is_told, line)


class BadRequests(BadInput):
    def test_too_many_pixels(self):
        for size in ["100000x100000", "100000x1", "65536x65536"]:
            self.refuse(self.quad(), "--size", size, code=2, says="pixels")

    def test_unwritable_output(self):
        for path in ["/nonexistent-folder/a.png", "/dev/null/a.exr", self.path("scene.gltf", "a.png")]:
            with self.subTest(path=path):
                self.refuse(self.quad(), "-o", path, says=path)

    def test_output_that_is_a_folder(self):
        os.mkdir(self.path("folder.png"))
        self.refuse(self.quad(), "-o", self.path("folder.png"), says="folder.png")

    def test_outputs_are_checked_before_the_scene_is_read(self):
        self.refuse(self.path("nothing.gltf"), "-o", "/nonexistent-folder/a.png", says="/nonexistent-folder/a.png")

    def test_output_over_an_input(self):
        with open(self.path("map.exr"), "wb") as file:
            file.write(b"precious")
        self.refuse(self.quad(), "--env", self.path("map.exr"), "-o", self.path("map.exr"), says="map.exr")
        with open(self.path("map.exr"), "rb") as file:
            self.assertEqual(file.read(), b"precious")

    def test_output_over_a_file_that_the_scene_is_read_from(self):
        """Refused under any name of the file, and for whichever option names the output."""
        scene = quad_scene(uri="quad%20data.exr")[0]
        scene["images"] = [{"uri": "./map.png"}, {"uri": data_uri(b"")}, {"uri": "missing.png"}]
        scene = write_gltf(self.path("scene.gltf"), scene)
        contents = {"quad data.exr": quad_scene()[1], "map.png": b"precious"}
        for name, content in contents.items():
            with open(self.path(name), "wb") as file:
                file.write(content)
        os.symlink("map.png", self.path("link.png"))
        for option, name in [("-o", "quad data.exr"), ("-o", "map.png"), ("-o", "link.png"),
                             ("--checkpoint", "quad data.exr")]:
            self.refuse(scene, option, self.path(name), says=f"{name}' is an input of this job; ")
        run = eclat("cost", scene, "--json", self.path("map.png"))
        self.assertIn("is an input of this job", self.assert_one_error(run, 1))
        for name, content in contents.items():
            with open(self.path(name), "rb") as file:
                self.assertEqual(file.read(), content)
        self.assertEqual(len(os.listdir(self.folder)), 5)

    def test_pipes_and_folders_instead_of_pictures(self):
        """Nobody writes into the pipe: a program that opened it would wait for ever."""
        pipe, folder, other = self.path("pipe.exr"), self.path("folder.exr"), self.path("a.exr")
        os.mkfifo(pipe)
        os.mkdir(folder)
        for path, says in [(pipe, "it is not a regular file"), (folder, "it is a folder")]:
            for command in [["render", "--resume", path], ["merge", path, "-o", other], ["compare", path, other],
                            ["render", self.quad(), "--env", path, "-o", other]]:
                with self.subTest(command=command):
                    line = self.assert_one_error(eclat(*command, "-q"), 1)
                    self.assertIn(f"'{path}': {says}", line)

    def test_unknown_device(self):
        self.refuse(self.quad(), "--device", "no such device", says="no such device")
        self.refuse(self.quad(), "--device", "999", says="999")

    def test_unknown_camera(self):
        self.refuse(self.quad(), "--camera", "nobody", says=("nobody", "front"))
        self.refuse(self.quad(), "--camera", "7", says="7")

    def test_bad_environment(self):
        for spec in ["1,2", "1,2,x", "nan,0,0", "-1,0,0", "0x1,0,0", "missing.hdr", self.quad()]:
            with self.subTest(spec=spec):
                self.refuse(self.quad(), "--env", spec)


if __name__ == "__main__":
    unittest.main()

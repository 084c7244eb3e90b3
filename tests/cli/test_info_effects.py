# tier: quick
"""eclat info: which effects a scene calls for, and why."""
import json
import struct
import unittest

from support import CORNELL, data_uri, eclat, quad_scene, write_gltf
from test_info import InfoCase, png


class Effects(InfoCase):
    def effects(self, roughness=1.0, metallic=0.0, rough_texture=None, texture=None, transmission=None, ior=None, volume=None):
        """Effects of glass that a quad with this material needs; textures are lists of texels."""
        pbr = {"roughnessFactor": roughness, "metallicFactor": metallic}
        extensions = {"KHR_materials_ior": {"ior": ior}} if ior is not None else {}
        images = [t for t in (rough_texture, texture) if t]
        if rough_texture:
            pbr["metallicRoughnessTexture"] = {"index": 0}
        if transmission is not None:
            extensions["KHR_materials_transmission"] = {"transmissionFactor": transmission}
            if texture:
                extensions["KHR_materials_transmission"]["transmissionTexture"] = {"index": len(images) - 1}
        if volume is not None:
            extensions["KHR_materials_volume"] = volume
        scene, _ = quad_scene(material={"pbrMetallicRoughness": pbr, "extensions": extensions})
        if images:
            scene["images"] = [{"uri": png(*t)} for t in images]
            scene["textures"] = [{"source": i} for i in range(len(images))]
            scene["accessors"].append({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC2"})
            scene["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 2
        found = set(self.info(write_gltf(self.path("glass.gltf"), scene))["effects"])
        return found & {"smooth-surfaces", "transmission", "transmission-texture", "absorption", "transparent-shadows", "transparent-bodies"}

    def test_glass_calls_for_what_it_has(self):
        body, brown = {"thicknessFactor": 1}, {"attenuationDistance": 1, "attenuationColor": [1, 1, 0.9]}
        smooth, passes, textured, absorbs = "smooth-surfaces", "transmission", "transmission-texture", "absorption"
        pane, straight = "transparent-shadows", "transparent-bodies"
        black, grey, white = (0, 0, 0), (128, 128, 128), (255, 255, 255)
        cases = [
            (set(), {}),
            ({smooth}, {"roughness": 0}),
            # smooth where alpha = roughness^2 < 1e-4
            ({smooth}, {"roughness": 0.0099}),
            (set(), {"roughness": 0.0102}),
            ({smooth}, {"roughness": 0.5, "rough_texture": [white, black]}),
            ({smooth}, {"roughness": 0.015, "rough_texture": [white, grey]}),
            (set(), {"roughness": 0.5, "rough_texture": [white, grey]}),
            (set(), {"transmission": 0}),
            ({passes}, {"transmission": 0.1}),
            # shadow rays pass a smooth surface without a volume
            ({passes, smooth, pane}, {"transmission": 1, "roughness": 0}),
            ({passes, smooth, pane}, {"transmission": 1, "roughness": 0.5, "rough_texture": [white, black]}),
            ({passes, smooth, pane}, {"transmission": 1, "roughness": 0, "volume": brown}),
            ({passes, smooth, pane}, {"transmission": 1, "roughness": 0, "volume": body, "ior": 0}),
            ({passes, smooth}, {"transmission": 1, "roughness": 0, "volume": body}),
            ({smooth}, {"transmission": 1, "roughness": 0, "texture": [black]}),
            ({passes, textured}, {"transmission": 1, "texture": [black, grey]}),
            # transmission is in the red channel
            (set(), {"transmission": 1, "texture": [black, (0, 255, 255)]}),
            (set(), {"transmission": 0, "texture": [white]}),
            # metal transmits nothing; metalness is in the blue channel
            (set(), {"transmission": 1, "metallic": 1}),
            ({passes}, {"transmission": 1, "metallic": 1, "rough_texture": [white, (255, 255, 254)]}),
            (set(), {"transmission": 1, "metallic": 1, "rough_texture": [white, (0, 255, 255)]}),
            # a body absorbs if its colour is not white and rays can enter it
            ({passes}, {"transmission": 1, "volume": body}),
            ({passes, absorbs}, {"transmission": 1, "volume": {**body, **brown}}),
            ({passes}, {"transmission": 1, "volume": brown}),
            ({passes}, {"transmission": 1, "volume": {**body, "attenuationColor": [0, 0, 0]}}),
            ({passes}, {"transmission": 1, "volume": {**body, **brown}, "ior": 0}),
            (set(), {"transmission": 0, "volume": {**body, **brown}}),
            (set(), {"transmission": 1, "volume": {**body, **brown}, "texture": [black]}),
            (set(), {"volume": {**body, **brown}}),
            # without refraction, roughness has no effect, and shadow rays pass
            ({passes, smooth, pane, straight}, {"transmission": 1, "volume": body, "ior": 1}),
            ({passes, smooth}, {"transmission": 1, "volume": body, "ior": 1.00009}),
            ({passes}, {"transmission": 1, "volume": body, "ior": 1.00011}),
            ({passes}, {"transmission": 1, "ior": 1}),
            (set(), {"transmission": 1, "volume": body, "ior": 1, "metallic": 1}),
        ]
        for expected, material in cases:
            with self.subTest(material=material):
                self.assertEqual(self.effects(**material), expected)

    def test_bodies_call_for_nesting_where_they_may_be_nested(self):
        def nested(apart, same=False, thin=False):
            scene, _ = quad_scene(material={"pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {
                "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1}}})
            other = json.loads(json.dumps(scene["materials"][0]))
            other["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 0 if thin else 1
            scene["materials"].append(other)
            primitive = dict(scene["meshes"][0]["primitives"][0], material=0 if same else 1)
            scene["meshes"].append({"primitives": [primitive]})
            scene["nodes"].append({"mesh": len(scene["meshes"]) - 1, "translation": [0, 0, apart]})
            scene["scenes"][0]["nodes"].append(len(scene["nodes"]) - 1)
            return "nested-bodies" in self.info(write_gltf(self.path("nested.gltf"), scene))["effects"]
        self.assertTrue(nested(0))
        self.assertFalse(nested(0.1))
        self.assertFalse(nested(0, same=True))
        self.assertFalse(nested(0, thin=True))

    def layers(self, extension, *texels, roughness=1.0, unlit=False):
        """Effects that a quad with this extension needs; the extension names textures by index."""
        extensions = dict(extension, **({"KHR_materials_unlit": {}} if unlit else {}))
        scene, _ = quad_scene(material={"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": roughness}, "extensions": extensions})
        scene["images"] = [{"uri": png(*t)} for t in texels]
        scene["textures"] = [{"source": i} for i in range(len(texels))]
        scene["accessors"].append({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC2"})
        scene["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 2
        return set(self.info(write_gltf(self.path("layers.gltf"), scene))["effects"])

    def check_layers(self, name, words, cases):
        for expected, members, *texels in cases:
            with self.subTest(extension=name, members=members, texels=texels):
                self.assertEqual(self.layers({name: members}, *texels) & words, expected)
                self.assertEqual(self.layers({name: members}, *texels, unlit=True) & words, set())

    def test_coats_call_for_what_they_have(self):
        coat, textured, bent, smooth = "clearcoat", "clearcoat-texture", "clearcoat-normal-texture", "smooth-surfaces"
        black, green, white = [(0, 0, 0)], [(0, 255, 0)], [(0, 0, 0), (255, 255, 255)]
        one = {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 1}
        self.check_layers("KHR_materials_clearcoat", {coat, textured, bent, smooth}, [
            (set(), {}),
            (set(), {"clearcoatFactor": 0, "clearcoatTexture": {"index": 0}, "clearcoatNormalTexture": {"index": 0}}, white),
            ({coat}, one),
            ({coat, smooth}, {"clearcoatFactor": 0.1}),
            ({coat, smooth}, {"clearcoatFactor": 0.1, "clearcoatRoughnessFactor": 0.0099}),
            ({coat}, {"clearcoatFactor": 0.1, "clearcoatRoughnessFactor": 0.0102}),
            # the weight is in red, roughness in green
            (set(), {**one, "clearcoatTexture": {"index": 0}}, green),
            ({coat, textured}, {**one, "clearcoatTexture": {"index": 0}}, white),
            ({coat, textured, smooth}, {**one, "clearcoatRoughnessTexture": {"index": 0}}, white),
            # a texture of one value is folded into the factor
            ({coat}, {**one, "clearcoatRoughnessTexture": {"index": 0}}, green),
            ({coat, smooth}, {**one, "clearcoatRoughnessTexture": {"index": 0}}, black),
            ({coat, bent}, {**one, "clearcoatNormalTexture": {"index": 0}}, white),
        ])

    def test_sheen_calls_for_what_it_has(self):
        sheen, textured = "sheen", "sheen-texture"
        black, green, white = [(0, 0, 0)], [(0, 255, 0)], [(0, 0, 0), (255, 255, 255)]
        self.check_layers("KHR_materials_sheen", {sheen, textured}, [
            (set(), {}),
            (set(), {"sheenRoughnessFactor": 1, "sheenRoughnessTexture": {"index": 0}}, white),
            ({sheen}, {"sheenColorFactor": [0, 0, 0.1]}),
            (set(), {"sheenColorFactor": [1, 1, 1], "sheenColorTexture": {"index": 0}}, black),
            (set(), {"sheenColorFactor": [1, 0, 1], "sheenColorTexture": {"index": 0}}, green),
            ({sheen}, {"sheenColorFactor": [0, 1, 0], "sheenColorTexture": {"index": 0}}, green),
            ({sheen, textured}, {"sheenColorFactor": [0, 1, 0], "sheenColorTexture": {"index": 0}}, white),
            ({sheen}, {"sheenColorFactor": [0, 1, 0], "sheenRoughnessTexture": {"index": 0}}, white),  # the factor is 0
        ])

    def test_anisotropy_calls_for_what_it_has(self):
        one = {"anisotropyStrength": 0.5}
        long, textured, blue, yellow = "anisotropy", "anisotropy-texture", [(0, 0, 255)], [(255, 255, 0)]
        cases = [(set(), {}), (set(), {"anisotropyRotation": 1}), (set(), one)]
        self.check_layers("KHR_materials_anisotropy", {long, textured}, cases)  # the roughness is 1
        turned = {"index": 0, "extensions": {"KHR_texture_transform": {"rotation": 1}}}
        for expected, members, *texels in [({long}, one), ({long, textured}, {**one, "anisotropyTexture": {"index": 0}}, blue + [(0, 9, 255)]),
                                           # a texture of one direction is folded into the rotation
                                           ({long}, {**one, "anisotropyTexture": {"index": 0}}, blue),
                                           ({long, textured}, {**one, "anisotropyTexture": turned}, blue),
                                           (set(), {**one, "anisotropyTexture": {"index": 0}}, yellow)]:
            found = self.layers({"KHR_materials_anisotropy": members}, *texels, roughness=0.5)
            self.assertEqual(found & {long, textured}, expected)

    def reasons(self, scene, *arguments):
        run = self.assert_ok(eclat("info", "--json", *arguments, write_gltf(self.path("why.gltf"), scene)))
        report = json.loads(run.stdout)
        rows = {row["name"]: row for row in report["effect_list"]}
        self.assertEqual([name for name in rows if rows[name]["called_for"]], report["effects"])
        for row in rows.values():  # an effect has all of these, or none: reason, kernels, buffers
            self.assertEqual(row["called_for"], bool(row["why"]))
            self.assertEqual(row["called_for"], bool(row["kernels"]), row)
            self.assertEqual(bool(row["buffers"]), row["buffer_bytes"] > 0, row)
            self.assertLessEqual(set(row["kernels"]), set(report["kernels"]))
        return report, rows

    def test_each_effect_says_why(self):
        scene, _ = quad_scene(material={"name": "velvet", "pbrMetallicRoughness": {"metallicFactor": 0},
                                        "extensions": {"KHR_materials_sheen": {"sheenColorFactor": [0, 0, 1]}}})
        report, rows = self.reasons(scene)
        self.assertEqual(rows["sheen"]["why"], 'material 0 "velvet" has sheen')
        self.assertEqual(rows["sheen"]["kernels"], ["shade"])
        self.assertEqual(rows["sheen"]["buffers"], [])
        self.assertEqual(rows["sobol-sampler"]["why"], "--sampler sobol")
        # the built-in studio, which lights a scene without light
        self.assertEqual(rows["environment"]["why"], "the environment map shines")
        self.assertIsNone(rows["clearcoat"]["why"])
        self.assertEqual(report["kernels"], ["generate", "intersect", "shade", "connect", "accumulate", "features"])

    def test_an_option_that_calls_for_an_effect_says_so(self):
        metal = write_gltf(self.path("metal.gltf"), quad_scene(material={"pbrMetallicRoughness": {"roughnessFactor": 0.5}})[0])
        def rows(*options, scene=metal):
            report = json.loads(self.assert_ok(eclat("info", "--json", scene, *options)).stdout)
            return report, {row["name"]: row for row in report["effect_list"]}
        for options, effect, why in ((["--fstop", "2", "--focus", "3"], "depth-of-field", "--fstop 2"),
                                     (["--filter", "blackman-harris", "--filter-width", "2"], "pixel-filter", "--filter"),
                                     (["--scattering", "multiple"], "multiple-scattering", "material 0 is metal of roughness 0.5"),
                                     (["--env", "0,1,0"], "environment", "the environment shines")):
            with self.subTest(effect):
                self.assertEqual(rows(*options)[1][effect]["why"], why)
        self.assertIsNone(rows("--sampler", "independent")[1]["sobol-sampler"]["why"])
        self.assertIsNone(rows("--env", "0,0,0")[1]["environment"]["why"])
        self.assertIn("raster", rows("--integrator", "raster")[0]["kernels"])
        self.assertIn("sheen", rows("--effects", "all")[0]["effects"])
        less, without = rows("--without", "emission", "--without", "back-face-culling", scene=CORNELL)
        self.assertEqual([name for name, row in without.items() if row["left_out"]], ["emission", "back-face-culling"])
        self.assertEqual(less["effects"], ["sobol-sampler"])
        run = self.assert_ok(eclat("info", CORNELL, "--light-choice", "tree"))
        self.assertRegex(run.stdout, r"(?m)^  light-tree +\d+ lights are chosen among")
        for options, says in ((["--fstop", "2"], "go together"), (["--without", "sheep"], "can be left out"), (["--env-strength", "2"], "no environment"),
                              (["--filter-width", "2"], "--filter-width belongs"), (["--shutter", "0:1", "--at", "1"], "give one of them")):
            run = eclat("info", metal, *options)
            self.assertIn(says, self.assert_one_error(run, run.returncode))

    def test_lights_by_their_nodes(self):
        scene, _ = quad_scene(material={})
        light = [{"type": "point"}, {"type": "spot"}]
        scene["extensions"] = {"KHR_lights_punctual": {"lights": light}}
        scene["nodes"] += [{"name": "bulb", "extensions": {"KHR_lights_punctual": {"light": 0}}},
                           {"name": "torch", "extensions": {"KHR_lights_punctual": {"light": 1}}}]
        scene["scenes"][0]["nodes"] = [0, 1, 2, 3]
        _, rows = self.reasons(scene)
        self.assertEqual(rows["punctual-lights"]["why"], 'point light "bulb", and 1 other')
        # two entries each of ec_light_data and ec_distribution_entry
        self.assertEqual(rows["punctual-lights"]["buffers"], ["lights", "light table"])
        self.assertEqual(rows["punctual-lights"]["buffer_bytes"], 2 * (64 + 8))

    def test_of_another_scene_nothing_counts(self):
        scene, _ = quad_scene(material={"pbrMetallicRoughness": {"metallicFactor": 0}})
        scene["materials"].append({"extensions": {"KHR_materials_sheen": {"sheenColorFactor": [0, 0, 1]}}})
        scene["meshes"].append({"primitives": [{**scene["meshes"][0]["primitives"][0], "material": 1}]})
        scene["nodes"].append({"mesh": 1})
        scene["scenes"].append({"nodes": [1, 2]})
        for chosen, called in ((0, False), (1, True)):
            _, rows = self.reasons({**scene, "scene": chosen})
            self.assertEqual(rows["sheen"]["called_for"], called)

    def test_no_light_to_join_no_shadow_rays(self):
        scene, _ = quad_scene(material={"extensions": {"KHR_materials_unlit": {}}})
        report, rows = self.reasons(scene)
        self.assertEqual(report["kernels"], ["generate", "intersect", "shade", "accumulate", "features"])
        self.assertEqual(rows["unlit"]["why"], "material 0 is unlit")

    def test_films_call_for_what_they_have(self):
        film, textured = "iridescence", "iridescence-texture"
        black, green, white = [(0, 0, 0)], [(0, 255, 0)], [(0, 0, 0), (255, 255, 255)]
        thickness = {"iridescenceFactor": 1, "iridescenceThicknessTexture": {"index": 0}}
        self.check_layers("KHR_materials_iridescence", {film, textured}, [
            (set(), {}),
            ({film}, {"iridescenceFactor": 0.1}),
            (set(), {"iridescenceFactor": 1, "iridescenceIor": 1}),
            (set(), {"iridescenceFactor": 1, "iridescenceThicknessMaximum": 0}),
            # the weight is in red, thickness in green
            (set(), {"iridescenceFactor": 1, "iridescenceTexture": {"index": 0}}, green),
            ({film, textured}, {"iridescenceFactor": 1, "iridescenceTexture": {"index": 0}}, white),
            ({film, textured}, thickness, white),
            ({film}, thickness, black),  # a texture of one thickness is folded
            ({film}, {**thickness, "iridescenceThicknessMinimum": 400}, white),
            (set(), {**thickness, "iridescenceThicknessMinimum": 0}, black),
            (set(), {**thickness, "iridescenceThicknessMaximum": 0}, green),
            ({film}, {**thickness, "iridescenceThicknessMinimum": 0}, green),
        ])

    def test_diffuse_transmission_calls_for_what_it_has(self):
        through, textured, dimmed = "diffuse-transmission", "diffuse-transmission-texture", "absorption"
        name, half = "KHR_materials_diffuse_transmission", {"diffuseTransmissionFactor": 0.5}
        clear, open_, both = [(255, 255, 255, 0)], [(0, 0, 0, 255)], [(255, 255, 255, 0), (0, 0, 0, 255)]
        self.check_layers(name, {through, textured, dimmed}, [
            (set(), {}),
            ({through}, half),
            ({through}, {**half, "diffuseTransmissionColorFactor": [0, 0, 0]}),
            (set(), {**half, "diffuseTransmissionTexture": {"index": 0}}, clear),
            ({through}, {**half, "diffuseTransmissionTexture": {"index": 0}}, open_),  # a texture of one value is folded into the factor
            ({through}, {**half, "diffuseTransmissionColorTexture": {"index": 0}}, clear),
            ({through, textured}, {**half, "diffuseTransmissionTexture": {"index": 0}}, both),
            ({through, textured}, {**half, "diffuseTransmissionColorTexture": {"index": 0}}, both),
        ])
        brown = {"attenuationDistance": 1, "attenuationColor": [1, 0.5, 0.2]}
        for expected, volume in [({through}, brown), ({through, dimmed}, {**brown, "thicknessFactor": 1})]:
            self.assertEqual(self.layers({name: half, "KHR_materials_volume": volume}) & {through, textured, dimmed}, expected)
        self.assertEqual(self.layers({name: half, "KHR_materials_transmission": {"transmissionFactor": 1}}) & {through}, set())

    def test_dispersion_wants_a_body_that_bends(self):
        glass, body = {"KHR_materials_transmission": {"transmissionFactor": 1}}, {"KHR_materials_volume": {"thicknessFactor": 1}}
        flat, parts, none = {"KHR_materials_ior": {"ior": 1}}, {"KHR_materials_dispersion": {"dispersion": 1}}, {"KHR_materials_dispersion": {}}
        for expected, extensions in [({"dispersion"}, {**glass, **body, **parts}), (set(), {**glass, **body, **none}), (set(), {**glass, **parts}),
                                     (set(), {**glass, **body, **flat, **parts}), (set(), {**body, **parts})]:
            self.assertEqual(self.layers(extensions) & {"dispersion"}, expected)

    def test_alpha_of_opaque_materials_is_ignored(self):
        varied = [(9, 99, 200, 255), (9, 99, 200, 5)]
        for mode, expected in ("OPAQUE", set()), ("BLEND", {"alpha", "base-color-texture"}):
            scene, _ = quad_scene(material={"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "alphaMode": mode})
            scene["images"], scene["textures"] = [{"uri": png(*varied)}], [{"source": 0}]
            scene["accessors"].append({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC2"})
            scene["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 2
            found = set(self.info(write_gltf(self.path("alpha.gltf"), scene))["effects"])
            self.assertEqual(found & {"alpha", "base-color-texture"}, expected, mode)

    def test_vertex_colours_call_for_what_they_change(self):
        names = {"alpha", "vertex-colors", "sheen"}
        for mode, rgba, expected in [
                ("OPAQUE", (1, 1, 1, 1), {"sheen"}), ("OPAQUE", (1, 1, 1, 0.5), {"sheen"}), ("OPAQUE", (1, 0.5, 1, 1), {"sheen", "vertex-colors"}),
                ("BLEND", (1, 1, 1, 1), {"sheen"}), ("BLEND", (1, 1, 1, 0.5), names),
                # fully transparent
                ("BLEND", (1, 1, 1, 0), {"alpha", "vertex-colors"}), ("MASK", (1, 1, 1, 0.4), {"alpha", "vertex-colors"})]:
            scene, buffer = quad_scene(material={"alphaMode": mode, "extensions": {"KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1]}}})
            buffer += struct.pack("<16f", *rgba * 4)
            scene["buffers"][0] = {"byteLength": len(buffer), "uri": data_uri(buffer)}
            scene["bufferViews"].append({"buffer": 0, "byteOffset": 60, "byteLength": 64})
            scene["accessors"].append({"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC4"})
            scene["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 2
            found = set(self.info(write_gltf(self.path("colours.gltf"), scene))["effects"])
            self.assertEqual(found & names, expected, (mode, rgba))


if __name__ == "__main__":
    unittest.main()

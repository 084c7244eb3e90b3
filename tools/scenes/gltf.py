"""Writes glTF 2.0: one .gltf, one .bin, float32, one buffer view per accessor, everything named."""
import json
import math
import os
import re
import struct

GENERATOR = "eclat make_scenes"
LICENCE = "Apache-2.0, the eclat authors"

FLOAT, UNSIGNED_INT, UNSIGNED_SHORT, UNSIGNED_BYTE = 5126, 5125, 5123, 5121
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
REPEAT, CLAMP, MIRROR = 10497, 33071, 33648
NEAREST, LINEAR = 9728, 9729
_CODE = {FLOAT: "f", UNSIGNED_INT: "I", UNSIGNED_SHORT: "H", UNSIGNED_BYTE: "B"}
_TYPE = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


def float32(x):
    """Returns the nearest float32 as a Python float. It is the value in the buffer, so min and max are exact."""
    return struct.unpack("<f", struct.pack("<f", x))[0]


def clean(x):
    """Returns a number for the JSON part: short, and never -0."""
    return round(float(x), 7) + 0.0


class Gltf:
    def __init__(self):
        self.doc = {"asset": {"version": "2.0", "generator": GENERATOR, "copyright": LICENCE},
                    "scene": 0, "scenes": [{"nodes": []}], "nodes": []}
        self.bin = bytearray()
        self.files = {}  # textures: name -> bytes
        self._lights = []

    # ---- parts -------------------------------------------------------------------------------------------------

    def _add(self, kind, item):
        self.doc.setdefault(kind, []).append(item)
        return len(self.doc[kind]) - 1

    def _use(self, extension):
        used = self.doc.setdefault("extensionsUsed", [])
        if extension not in used:
            used.append(extension)
            used.sort()

    def accessor(self, rows, width, component=FLOAT, target=ARRAY_BUFFER, bounds=False, normalized=False):
        """rows: tuples of `width` numbers (or plain numbers for width 1)."""
        flat = [x for row in rows for x in row] if width > 1 else list(rows)
        self.bin += b"\0" * (-len(self.bin) % 4)
        offset = len(self.bin)
        self.bin += struct.pack(f"<{len(flat)}{_CODE[component]}", *flat)
        view = {"buffer": 0, "byteOffset": offset, "byteLength": len(self.bin) - offset}
        if target:
            view["target"] = target
        item = {"bufferView": self._add("bufferViews", view), "componentType": component,
                "count": len(flat) // width, "type": _TYPE[width]}
        if normalized:
            item["normalized"] = True
        if bounds:
            columns = [[float32(x) for x in flat[i::width]] for i in range(width)]
            item["min"] = [min(c) for c in columns]
            item["max"] = [max(c) for c in columns]
        return self._add("accessors", item)

    def texture(self, name, png, wrap=(REPEAT, REPEAT), mag=LINEAR):
        """png: the file's bytes. Textures of the same name share an image."""
        images = self.doc.get("images", [])
        image = next((i for i, x in enumerate(images) if x["name"] == name), None)
        if image is None:
            self.files[name + ".png"] = png
            image = self._add("images", {"name": name, "uri": name + ".png"})
        sampler = {"magFilter": mag, "minFilter": mag, "wrapS": wrap[0], "wrapT": wrap[1]}
        samplers = self.doc.get("samplers", [])
        index = samplers.index(sampler) if sampler in samplers else self._add("samplers", sampler)
        return self._add("textures", {"name": name, "source": image, "sampler": index})

    def texture_use(self, texture, uv_set=0, offset=None, scale=None, rotation=None):
        use = {"index": texture}
        if uv_set:
            use["texCoord"] = uv_set
        transform = {}
        if offset:
            transform["offset"] = list(offset)
        if rotation:
            transform["rotation"] = rotation
        if scale:
            transform["scale"] = list(scale)
        if transform:
            use["extensions"] = {"KHR_texture_transform": transform}
            self._use("KHR_texture_transform")
        return use

    def material(self, name, base=(0.8, 0.8, 0.8), alpha=1.0, metallic=0.0, roughness=1.0, emission=None, lambert=False,
                 specular=None, double_sided=False, alpha_mode=None, cutoff=None, unlit=False, base_texture=None,
                 metallic_roughness_texture=None, normal_texture=None, normal_scale=None, emission_texture=None, transmission=None, ior=None, body=False, attenuation=None, extensions=None):
        """emission is radiance. lambert: no dielectric reflection at all (specularFactor 0). *_texture: texture_use().
        body: light is refracted; attenuation: (colour, metres): what is left of white light after that distance.
        extensions: others, by name."""
        pbr = {"baseColorFactor": [clean(c) for c in base] + [alpha], "metallicFactor": clean(metallic),
               "roughnessFactor": clean(roughness)}
        if base_texture:
            pbr["baseColorTexture"] = base_texture
        if metallic_roughness_texture:
            pbr["metallicRoughnessTexture"] = metallic_roughness_texture
        item = {"name": name, "pbrMetallicRoughness": pbr}
        extensions = dict(extensions or {})
        if lambert:
            specular = 0.0
        if specular is not None:
            extensions["KHR_materials_specular"] = {"specularFactor": specular}
        if transmission is not None:
            extensions["KHR_materials_transmission"] = {"transmissionFactor": clean(transmission)}
        if ior is not None:
            extensions["KHR_materials_ior"] = {"ior": clean(ior)}
        if body:
            extensions["KHR_materials_volume"] = {"thicknessFactor": 1.0}
            if attenuation:
                extensions["KHR_materials_volume"]["attenuationColor"] = [clean(c) for c in attenuation[0]]
                extensions["KHR_materials_volume"]["attenuationDistance"] = clean(attenuation[1])
        if emission:
            strength = max(emission)
            if strength > 1.0:
                extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": clean(strength)}
                emission = [c / strength for c in emission]
            item["emissiveFactor"] = [clean(c) for c in emission]
        if emission_texture:
            item["emissiveTexture"] = emission_texture
        if normal_texture:
            item["normalTexture"] = dict(normal_texture)
            if normal_scale is not None:
                item["normalTexture"]["scale"] = normal_scale
        if unlit:
            extensions["KHR_materials_unlit"] = {}
        if double_sided:
            item["doubleSided"] = True
        if alpha_mode:
            item["alphaMode"] = alpha_mode
        if cutoff is not None:
            item["alphaCutoff"] = cutoff
        for extension in extensions:
            self._use(extension)
        if extensions:
            item["extensions"] = extensions
        return self._add("materials", item)

    def mesh(self, name, shape, material):
        """shape: a mesh.Mesh. Its accessors are written only once, however many meshes use it."""
        key = id(self)
        if shape.accessors.get(key) is None:
            shape.check(name)
            attributes = {"POSITION": self.accessor(shape.positions, 3, bounds=True)}
            if shape.normals:
                attributes["NORMAL"] = self.accessor(shape.normals, 3)
            if shape.tangents:
                attributes["TANGENT"] = self.accessor(shape.tangents, 4)
            if shape.uvs:
                attributes["TEXCOORD_0"] = self.accessor(shape.uvs, 2)
            if shape.uvs1:
                attributes["TEXCOORD_1"] = self.accessor(shape.uvs1, 2)
            if shape.colors:
                attributes["COLOR_0"] = self.accessor(shape.colors, 4, UNSIGNED_BYTE, normalized=True)
            short = len(shape.positions) < 65535
            indices = self.accessor([i for t in shape.triangles for i in t], 1,
                                    UNSIGNED_SHORT if short else UNSIGNED_INT, ELEMENT_ARRAY_BUFFER)
            shape.accessors[key] = (attributes, indices)
        attributes, indices = shape.accessors[key]
        return self._add("meshes", {"name": name, "primitives": [
            {"attributes": dict(attributes), "indices": indices, "material": material}]})

    def node(self, name, mesh=None, translation=None, rotation=None, scale=None, camera=None, light=None):
        item = {"name": name}
        if mesh is not None:
            item["mesh"] = mesh
        if camera is not None:
            item["camera"] = camera
        if light is not None:
            item["extensions"] = {"KHR_lights_punctual": {"light": light}}
        if translation:
            item["translation"] = [clean(x) for x in translation]
        if rotation:
            item["rotation"] = [clean(x) for x in rotation]
        if scale:
            item["scale"] = [clean(x) for x in (scale if isinstance(scale, (tuple, list)) else (scale,) * 3)]
        index = self._add("nodes", item)
        self.doc["scenes"][0]["nodes"].append(index)
        return index

    def add(self, name, shape, material, **placing):
        """Adds a mesh and its node."""
        return self.node(name, mesh=self.mesh(name, shape, material), **placing)

    def perspective(self, name, eye, target, yfov_degrees, aspect):
        camera = self._add("cameras", {"name": name, "type": "perspective", "perspective": {
            "yfov": clean(math.radians(yfov_degrees)), "aspectRatio": clean(aspect), "znear": 0.01}})
        return self.node(name, camera=camera, translation=eye, rotation=look_rotation(eye, target))

    def orthographic(self, name, eye, target, xmag, ymag, far=100.0):
        camera = self._add("cameras", {"name": name, "type": "orthographic", "orthographic": {
            "xmag": clean(xmag), "ymag": clean(ymag), "znear": 0.0, "zfar": far}})
        return self.node(name, camera=camera, translation=eye, rotation=look_rotation(eye, target))

    def light(self, name, kind, position, color, intensity, target=None, inner=None, outer=None):
        self._use("KHR_lights_punctual")
        item = {"name": name, "type": kind, "color": [clean(c) for c in color], "intensity": intensity}
        if kind == "spot":
            item["spot"] = {"innerConeAngle": clean(math.radians(inner)), "outerConeAngle": clean(math.radians(outer))}
        self._lights.append(item)
        return self.node(name, light=len(self._lights) - 1, translation=position,
                         rotation=look_rotation(position, target) if target else None)

    # ---- file --------------------------------------------------------------------------------------------------

    def write(self, folder, stem):
        os.makedirs(folder, exist_ok=True)
        if self._lights:
            self.doc["extensions"] = {"KHR_lights_punctual": {"lights": self._lights}}
        self.doc["buffers"] = [{"uri": stem + ".bin", "byteLength": len(self.bin)}]
        order = ["asset", "extensionsUsed", "extensions", "scene", "scenes", "nodes", "cameras", "meshes", "materials",
                 "textures", "samplers", "images", "accessors", "bufferViews", "buffers"]
        text = json.dumps({k: self.doc[k] for k in order if k in self.doc}, indent=1)
        # Arrays of plain numbers go on one line, so that people can read the file.
        text = re.sub(r"\[([-+0-9.eE,\s]+)\]", lambda m: "[" + ", ".join(m.group(1).replace(",", " ").split()) + "]", text)
        files = {stem + ".gltf": text.encode() + b"\n", stem + ".bin": bytes(self.bin), **self.files}
        for name, data in files.items():
            with open(os.path.join(folder, name), "wb") as f:
                f.write(data)
        return list(files)


# ---- rotations -----------------------------------------------------------------------------------------------------

def normalize(v):
    n = math.sqrt(sum(x * x for x in v))
    return tuple(x / n for x in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def look_rotation(eye, target, up=(0.0, 1.0, 0.0)):
    """Returns the quaternion (x, y, z, w) that turns -z towards the target, for glTF's cameras, spots and directional lights."""
    back = normalize([e - t for e, t in zip(eye, target)])
    if abs(back[1]) > 0.999999:
        up = (0.0, 0.0, -1.0)
    right = normalize(cross(up, back))
    return quaternion(right, cross(back, right), back)


def quaternion(x, y, z):
    """Returns the quaternion of the rotation whose matrix has the columns x, y, z."""
    m = ((x[0], y[0], z[0]), (x[1], y[1], z[1]), (x[2], y[2], z[2]))
    trace = m[0][0] + m[1][1] + m[2][2]
    if trace > 0:
        s = 2 * math.sqrt(1 + trace)
        q = ((m[2][1] - m[1][2]) / s, (m[0][2] - m[2][0]) / s, (m[1][0] - m[0][1]) / s, s / 4)
    else:
        i = max(range(3), key=lambda k: m[k][k])
        j, k = (i + 1) % 3, (i + 2) % 3
        s = 2 * math.sqrt(1 + m[i][i] - m[j][j] - m[k][k])
        q = [0.0, 0.0, 0.0, (m[k][j] - m[j][k]) / s]
        q[i], q[j], q[k] = s / 4, (m[j][i] + m[i][j]) / s, (m[k][i] + m[i][k]) / s
    return normalize(q)


def axis_angle(axis, degrees):
    half = math.radians(degrees) / 2
    return tuple(x * math.sin(half) for x in normalize(axis)) + (math.cos(half),)

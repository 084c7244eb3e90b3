"""The scenes of bench_render.py for Mitsuba 3, and a Mitsuba to render them with.

Run by an interpreter that can import mitsuba, this file is also the process that renders: it reads one JSON request a
line ({"seed": n, "spp": n}) and answers each with one ({"seconds": s}); "image" in a request names a .npy file to write.
"""
import ctypes.util
import glob
import json
import os
import re
import struct
import subprocess
import sys
import time

VARIANT = "llvm_ad_rgb"


# --- finding a Mitsuba -------------------------------------------------------------------------------------------------

def find_llvm():
    """Dr.Jit loads LLVM at run time. Debian's libllvm19 is the version this was measured with."""
    if os.environ.get("DRJIT_LIBLLVM_PATH"):
        return os.environ["DRJIT_LIBLLVM_PATH"]
    found = glob.glob("/usr/lib/*/libLLVM*.so*") + glob.glob("/usr/lib/llvm-*/lib/libLLVM*.so*")
    versions = {}
    for path in found:
        match = re.search(r"libLLVM[-.](?:so\.)?(\d+)", os.path.basename(path))
        if match:
            versions.setdefault(int(match.group(1)), path)
    for version in [19] + sorted(versions, reverse=True):
        if version in versions:
            return versions[version]
    return ctypes.util.find_library("LLVM")


def can_import(python):
    return subprocess.run([python, "-c", "import mitsuba, numpy"], capture_output=True).returncode == 0


def find_python(say):
    """$MITSUBA_PYTHON, this interpreter, or a virtual environment made for it in the cache directory."""
    for python in (os.environ.get("MITSUBA_PYTHON"), sys.executable):
        if python and can_import(python):
            return python
    cache = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    folder = os.path.join(cache, "eclat", "bench-venv")
    python = os.path.join(folder, "bin", "python")
    if not (os.path.exists(python) and can_import(python)):
        say(f"Mitsuba is not importable: making a virtual environment with it in {folder}")
        made = subprocess.run([sys.executable, "-m", "venv", folder], capture_output=True, text=True)
        if made.returncode == 0:
            made = subprocess.run([python, "-m", "pip", "install", "--quiet", "mitsuba", "numpy"], capture_output=True, text=True)
        if made.returncode:
            say("that failed (Debian: is python3-venv installed?): " + (made.stderr or made.stdout).strip()[-400:])
            return None
    return python


class Mitsuba:
    """A process that has loaded one scene and renders it on demand."""

    def __init__(self, python, llvm, scene, arguments):
        environment = dict(os.environ, DRJIT_LIBLLVM_PATH=llvm)
        self.process = subprocess.Popen([python, os.path.abspath(__file__), scene, json.dumps(arguments)], env=environment,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.about = self.read()

    def read(self):
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"Mitsuba's process ended with {self.process.wait()}")
        return json.loads(line)

    def render(self, **request):
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()
        return self.read()

    def close(self):
        self.process.stdin.close()
        self.process.wait()


# --- scenes, in the process that renders -------------------------------------------------------------------------------

def film(width, height):
    return {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"}, "pixel_format": "rgb",
            "component_format": "float32"}


def integrator(arguments):
    return {"type": "path", "max_depth": arguments.get("max_depth", 8), "rr_depth": 5}


def cornell(mi, arguments):
    scene = mi.cornell_box()
    scene["sensor"]["film"] = film(arguments["width"], arguments["height"])
    scene["sensor"]["sampler"] = {"type": "independent"}
    scene["integrator"] = integrator(arguments)
    return mi.load_dict(scene)


class Gltf:
    """The little of glTF that the test scenes need: triangles with float vertices in external buffers."""

    COMPONENTS = {5121: "u1", 5123: "u2", 5125: "u4", 5126: "f4"}
    WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}

    def __init__(self, path):
        import numpy
        self.np = numpy
        self.folder = os.path.dirname(path)
        with open(path, encoding="utf-8") as file:
            self.json = json.load(file)
        self.buffers = [numpy.fromfile(os.path.join(self.folder, b["uri"]), dtype=numpy.uint8) for b in self.json["buffers"]]

    def accessor(self, index):
        a = self.json["accessors"][index]
        view = self.json["bufferViews"][a["bufferView"]]
        kind = self.np.dtype("<" + self.COMPONENTS[a["componentType"]])
        width = self.WIDTHS[a["type"]]
        assert "sparse" not in a and view.get("byteStride", width * kind.itemsize) == width * kind.itemsize
        start = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        data = self.buffers[view["buffer"]][start:start + a["count"] * width * kind.itemsize]
        return data.view(kind).reshape(a["count"], width)

    def matrix(self, node):
        np = self.np
        if "matrix" in node:
            return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
        x, y, z, w = node.get("rotation", [0, 0, 0, 1])
        rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                             [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                             [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
        m = np.eye(4)
        m[:3, :3] = rotation * np.array(node.get("scale", [1, 1, 1]))
        m[:3, 3] = node.get("translation", [0, 0, 0])
        return m

    def nodes(self):
        """(node, world matrix), parents before children."""
        scene = self.json["scenes"][self.json.get("scene", 0)]
        stack = [(i, self.np.eye(4)) for i in scene["nodes"]]
        while stack:
            index, parent = stack.pop()
            node = self.json["nodes"][index]
            world = parent @ self.matrix(node)
            yield node, world
            stack += [(child, world) for child in node.get("children", [])]


def material_of(gltf, index):
    """Diffuse on both sides, and the emitter if there is one."""
    m = gltf.json["materials"][index]
    pbr = m.get("pbrMetallicRoughness", {})
    factor = pbr.get("baseColorFactor", [1, 1, 1, 1])[:3]
    reflectance = {"type": "rgb", "value": factor}
    if "baseColorTexture" in pbr:
        assert factor == [1, 1, 1], "a factor on top of a texture is not converted"
        texture = gltf.json["textures"][pbr["baseColorTexture"]["index"]]
        image = gltf.json["images"][texture["source"]]["uri"]
        # v points down in glTF and in Mitsuba (its OBJ loader turns v for that reason). No mip maps on either side.
        reflectance = {"type": "bitmap", "filename": os.path.join(gltf.folder, image), "filter_type": "bilinear",
                       "wrap_mode": "repeat", "raw": False}
    bsdf = {"type": "diffuse", "reflectance": reflectance}
    if m.get("doubleSided"):
        bsdf = {"type": "twosided", "material": bsdf}
    strength = m.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
    emission = [c * strength for c in m.get("emissiveFactor", [0, 0, 0])]
    return bsdf, emission


def mesh_of(mi, gltf, name, primitive, world, bsdf, emission):
    np = gltf.np
    attributes = primitive["attributes"]
    assert primitive.get("mode", 4) == 4
    positions = gltf.accessor(attributes["POSITION"]).astype(np.float64) @ world[:3, :3].T + world[:3, 3]
    faces = gltf.accessor(primitive["indices"]).astype(np.uint32).ravel()
    if np.linalg.det(world[:3, :3]) < 0:
        faces = faces.reshape(-1, 3)[:, ::-1].ravel()
    properties = mi.Properties()
    properties["mesh_bsdf"] = mi.load_dict(bsdf)
    if any(emission):
        properties["mesh_emitter"] = mi.load_dict({"type": "area", "radiance": {"type": "rgb", "value": emission}})
    # The lamp goes without vertex normals; whether they matter to Mitsuba's light sampling was not shown.
    smooth = "NORMAL" in attributes and not any(emission)
    mesh = mi.Mesh(name, vertex_count=len(positions), face_count=len(faces) // 3, props=properties,
                   has_vertex_normals=smooth, has_vertex_texcoords="TEXCOORD_0" in attributes)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = positions.astype(np.float32).ravel()
    parameters["faces"] = faces
    if smooth:
        normals = gltf.accessor(attributes["NORMAL"]).astype(np.float64) @ np.linalg.inv(world[:3, :3])
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        parameters["vertex_normals"] = (normals / np.where(length > 0, length, 1)).astype(np.float32).ravel()
    if "TEXCOORD_0" in attributes:
        parameters["vertex_texcoords"] = gltf.accessor(attributes["TEXCOORD_0"]).astype(np.float32).ravel()
    parameters.update()
    return mesh


def sponza(mi, arguments):
    import math
    np = __import__("numpy")
    gltf = Gltf(arguments["scene"])
    scene = {"type": "scene", "integrator": integrator(arguments)}
    for node, world in gltf.nodes():
        if "mesh" in node:
            for primitive in gltf.json["meshes"][node["mesh"]]["primitives"]:
                bsdf, emission = material_of(gltf, primitive["material"])
                name = f"mesh{len(scene)}"
                scene[name] = mesh_of(mi, gltf, name, primitive, world, bsdf, emission)
        if "camera" in node:
            yfov = gltf.json["cameras"][node["camera"]]["perspective"]["yfov"]
            # A camera looks along -z in glTF and along +z, with x to the left, in Mitsuba.
            to_world = world @ np.diag([-1.0, 1.0, -1.0, 1.0])
            scene["sensor"] = {"type": "perspective", "fov_axis": "y", "fov": math.degrees(yfov), "near_clip": 1e-3,
                               "far_clip": 1e4, "to_world": mi.ScalarTransform4f(to_world),
                               "film": film(arguments["width"], arguments["height"]), "sampler": {"type": "independent"}}
    if arguments.get("environment"):
        # Ours: u = 0.5 + atan2(z, x) / 2 pi. Mitsuba's: u = atan2(x, -z) / 2 pi. A quarter turn about y makes them one.
        turn = mi.ScalarTransform4f().rotate([0, 1, 0], 90.0)
        scene["environment"] = {"type": "envmap", "filename": arguments["environment"], "to_world": turn}
    return mi.load_dict(scene)


SCENES = {"cornell": cornell, "sponza": sponza}


def serve(name, arguments):
    import mitsuba as mi
    mi.set_variant(VARIANT)
    import drjit as dr
    scene = SCENES[name](mi, arguments)

    def answer(data):
        print(json.dumps(data), flush=True)

    answer({"version": mi.__version__, "variant": VARIANT, "threads": dr.thread_count() if hasattr(dr, "thread_count") else None})
    for line in sys.stdin:
        request = json.loads(line)
        start = time.perf_counter()
        image = mi.render(scene, spp=request["spp"], seed=request["seed"])
        dr.eval(image)
        dr.sync_thread()
        seconds = time.perf_counter() - start
        pixels = image.numpy()
        if request.get("image"):
            import numpy
            numpy.save(request["image"], pixels)
        answer({"seconds": seconds, "mean": [float(x) for x in pixels.reshape(-1, 3).mean(axis=0)]})


if __name__ == "__main__":
    serve(sys.argv[1], json.loads(sys.argv[2]))

"""Mitsuba 3's side of a race: finds Mitsuba and LLVM, and translates a glTF scene for it."""
import glob
import math
import os
import re
import subprocess
import sys

VARIANT = "llvm_ad_rgb"
MISSING = "Mitsuba 3 is missing: pip install mitsuba numpy, or name a Python that has them in MITSUBA_PYTHON"


def find_llvm():
    """Dr.Jit loads LLVM, 15 or later, at run time. Debian's libllvm19 is the version this was measured with."""
    versions = {}
    for path in glob.glob("/usr/lib/*/libLLVM*.so*") + glob.glob("/usr/lib/llvm-*/lib/libLLVM*.so*"):
        match = re.search(r"libLLVM[-.](?:so\.)?(\d+)", os.path.basename(path))
        if match and int(match.group(1)) >= 15:
            versions.setdefault(int(match.group(1)), path)
    return versions.get(19) or (versions[max(versions)] if versions else None)


def enter(fail):
    """Makes sure that mitsuba can be imported: here, or by starting the program again with $MITSUBA_PYTHON. Otherwise calls fail(line)."""
    if not os.environ.get("DRJIT_LIBLLVM_PATH"):
        llvm = find_llvm()
        if not llvm:
            fail("Mitsuba needs LLVM: apt-get install libllvm19, or name the library in DRJIT_LIBLLVM_PATH")
        os.environ["DRJIT_LIBLLVM_PATH"] = llvm
    try:
        import mitsuba  # noqa: F401
        import numpy  # noqa: F401
    except ImportError:
        other = os.environ.get("MITSUBA_PYTHON")
        if not other or subprocess.run([other, "-c", "import mitsuba, numpy"], capture_output=True).returncode:
            fail(MISSING)
        os.execv(other, [other, *sys.argv])


def texture(gltf, use, factor):
    if any(c != 1 for c in factor):
        raise SystemExit("a factor on top of a texture is not translated for Mitsuba")
    # v points down in glTF and in Mitsuba. No mip maps on either side.
    return {"type": "bitmap", "filename": gltf.image(use), "filter_type": "bilinear", "wrap_mode": "repeat", "raw": False}


def bsdf(gltf, m, diffuse):
    """Returns Mitsuba's nearest equivalent of a material. Diffuse ones are the same; `principled` has glTF's GGX, but another diffuse lobe."""
    surface, extensions = m.get("pbrMetallicRoughness", {}), m.get("extensions", {})
    factor = surface.get("baseColorFactor", [1, 1, 1, 1])[:3]
    base = texture(gltf, surface["baseColorTexture"], factor) if "baseColorTexture" in surface else {"type": "rgb", "value": factor}
    metallic, roughness = surface.get("metallicFactor", 1.0), surface.get("roughnessFactor", 1.0)
    if not diffuse and extensions.get("KHR_materials_transmission", {}).get("transmissionFactor", 0) > 0.5:
        ior = extensions.get("KHR_materials_ior", {}).get("ior", 1.5)
        if roughness < 0.02:
            return {"type": "dielectric", "int_ior": ior}
        return {"type": "roughdielectric", "distribution": "ggx", "alpha": roughness ** 2, "int_ior": ior}
    if diffuse or (metallic == 0 and extensions.get("KHR_materials_specular", {}).get("specularFactor", 1) == 0):
        made = {"type": "diffuse", "reflectance": base}
    else:
        made = {"type": "principled", "base_color": base, "roughness": max(roughness, 0.03), "metallic": metallic, "specular": 0.5}
    return {"type": "twosided", "material": made} if m.get("doubleSided") else made


def mesh(mi, gltf, name, primitive, world, diffuse):
    import numpy as np
    attributes, m = primitive["attributes"], gltf.material(primitive)
    positions = gltf.accessor(attributes["POSITION"]).astype(float) @ world[:3, :3].T + world[:3, 3]
    if "indices" in primitive:
        faces = gltf.accessor(primitive["indices"]).astype(np.uint32).reshape(-1, 3)
    else:
        faces = np.arange(len(positions), dtype=np.uint32).reshape(-1, 3)
    if np.linalg.det(world[:3, :3]) < 0:
        faces = faces[:, ::-1]
    strength = m.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
    emission = [c * strength for c in m.get("emissiveFactor", [0, 0, 0])]
    properties = mi.Properties()
    properties["mesh_bsdf"] = mi.load_dict(bsdf(gltf, m, diffuse))
    if any(emission):
        properties["mesh_emitter"] = mi.load_dict({"type": "area", "radiance": {"type": "rgb", "value": emission}})
    smooth, textured = "NORMAL" in attributes and not any(emission), "TEXCOORD_0" in attributes
    made = mi.Mesh(name, len(positions), len(faces), props=properties, has_vertex_normals=smooth, has_vertex_texcoords=textured)
    parameters = mi.traverse(made)
    parameters["vertex_positions"] = positions.astype(np.float32).ravel()
    parameters["faces"] = np.ascontiguousarray(faces).ravel()
    if smooth:
        normals = gltf.accessor(attributes["NORMAL"]).astype(float) @ np.linalg.inv(world[:3, :3])
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        parameters["vertex_normals"] = (normals / np.where(length > 0, length, 1)).astype(np.float32).ravel()
    if textured:
        parameters["vertex_texcoords"] = gltf.accessor(attributes["TEXCOORD_0"]).astype(np.float32).ravel()
    parameters.update()
    return made, len(faces)


def sensor(mi, camera, world, size):
    import numpy as np
    # In glTF a camera looks along -z; in Mitsuba along +z, with x to the left.
    return {"type": "perspective", "fov_axis": "y", "fov": math.degrees(camera["perspective"]["yfov"]), "near_clip": 1e-4, "far_clip": 1e5,
            "to_world": mi.ScalarTransform4f(world @ np.diag([-1.0, 1, -1, 1])),
            "film": {"type": "hdrfilm", "width": size[0], "height": size[1], "rfilter": {"type": "box"}, "pixel_format": "rgb",
                     "component_format": "float32"}}


def scene(mi, gltf, size, depth, environment, diffuse):
    """Returns (scene, the dictionary of its sensor without a sampler, number of triangles). Roulette starts at the sixth segment, as in eclat."""
    parts, camera, triangles = {"type": "scene", "integrator": {"type": "path", "max_depth": depth, "rr_depth": 5}}, None, 0
    for node, world in gltf.nodes():
        if "camera" in node and camera is None:
            camera = sensor(mi, gltf.json["cameras"][node["camera"]], world, size)
        for primitive in gltf.json["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
            if primitive.get("mode", 4) == 4:
                name = f"mesh{len(parts)}"
                parts[name], count = mesh(mi, gltf, name, primitive, world, diffuse)
                triangles += count
    if environment:
        # Ours: u = 0.5 + atan2(z, x) / 2 pi. Mitsuba's: u = atan2(x, -z) / 2 pi. A quarter turn about y makes them equal.
        parts["environment"] = {"type": "envmap", "filename": environment, "to_world": mi.ScalarTransform4f().rotate([0, 1, 0], 90.0)}
    return mi.load_dict(parts), camera, triangles

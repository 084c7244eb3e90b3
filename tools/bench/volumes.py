#!/usr/bin/env python3
"""usage: tools/bench/volumes.py [--spp N] [--size N]
Compares light inside bodies and in fog with Mitsuba 3's volpathmis, on three scenes of the same geometry: a block of milky glass, a cloud in a
block of index 1, and a lamp, a block and fog in a ball. For each block of 8 x 8 pixels it takes the difference over its standard error, which
should be normally distributed: mean 0, deviation 1. Run it by hand: it takes minutes. Needs mitsuba and numpy, or MITSUBA_PYTHON with the path of a
Python that has them; eclat in $ECLAT, or build/eclat."""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

import bench_common as common
import race_mitsuba

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [os.path.join(ROOT, "tests", "robust"), os.path.join(ROOT, "tests", "cli")]
from hard_scene import Scene  # noqa: E402
from support import read_exr  # noqa: E402
from test_volume_scatter import block, body  # noqa: E402

MILK = {"albedo": [0.95, 0.8, 0.5], "density": [6, 9, 14], "g": 0.4, "ior": 1.5}
CLOUD = {"albedo": [1, 0.9, 0.6], "density": [4, 6, 10], "g": 0.8, "ior": 1}
FOG = {"density": 0.25, "albedo": 0.85, "g": 0.6}
MATT = {"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0.6, 0.4, 0.3, 1]}, "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}
LAMP = {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}, "emissiveFactor": [1, 1, 1],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 30}, "KHR_materials_specular": {"specularFactor": 0}}}
LAMP_SQUARE = [-0.3, 1.5, -0.3, 0.3, 1.5, -0.3, 0.3, 1.5, 0.3, -0.3, 1.5, -0.3, 0.3, 1.5, 0.3, -0.3, 1.5, 0.3]  # faces down
EYE, TARGET, FOV, SKY = [1.1, 0.9, 2.4], [0, 0, 0], 30, [0.7, 0.85, 1]


def eclat_scene(kind, path):
    """Writes the scene. Returns options of the render."""
    materials = [MATT, LAMP] if kind == "fog" else [body(*[kind[k] for k in ("albedo", "density", "g", "ior")])]
    scene = Scene(*materials)
    for name in {name for m in materials for name in m["extensions"]}:
        scene.extend(name)
    scene.add(block(0.5, 0.5, -0.5), 0)
    if kind == "fog":
        scene.add(LAMP_SQUARE, 1)
    scene.write(path)
    return ["--fog", ",".join(str(FOG[k]) for k in ("density", "albedo", "g"))] if kind == "fog" else []


def with_eclat(kind, size, spp, folder):
    path, out = os.path.join(folder, "a.gltf"), os.path.join(folder, "a.exr")
    options = eclat_scene(kind, path)
    words = [os.environ.get("ECLAT", os.path.join(ROOT, "build", "eclat")), "render", path, "--eye", ",".join(map(str, EYE)), "--look-at", ",".join(map(str, TARGET)), "--up", "0,1,0",
             "--fov", str(FOV), "--env", ",".join(map(str, SKY)), "--size", f"{size}x{size}", "--spp", str(spp), "--channels", "all", "--json", "-q", "-o", out, *options]
    json.loads(subprocess.run(words, check=True, stdout=subprocess.PIPE, encoding="utf-8").stdout)
    return read_exr(out)[1]


def triangles(mi, name, corners, bsdf, extra):
    import numpy as np
    properties = mi.Properties()
    properties["mesh_bsdf"] = mi.load_dict(bsdf)
    for key, value in extra.items():
        properties[key] = value
    made = mi.Mesh(name, len(corners) // 3, len(corners) // 9, props=properties)
    parameters = mi.traverse(made)
    parameters["vertex_positions"] = np.array(corners, dtype=np.float32)
    parameters["faces"] = np.arange(len(corners) // 3, dtype=np.uint32)
    parameters.update()
    return made


def medium(mi, albedo, density, g):
    scale = max(density)  # colours are at most 1
    return mi.load_dict({"type": "homogeneous", "albedo": {"type": "rgb", "value": albedo}, "scale": scale, "phase": {"type": "hg", "g": g},
                         "sigma_t": {"type": "rgb", "value": [d / scale for d in density]}})


def with_mitsuba(mi, kind, size, spp, runs):
    """Returns pictures of `runs` seeds."""
    import numpy as np
    parts = {"type": "scene", "integrator": {"type": "volpathmis", "max_depth": -1, "rr_depth": 1000},
             "sky": {"type": "constant", "radiance": {"type": "rgb", "value": SKY}}}
    film = {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}, "pixel_format": "rgb", "component_format": "float32"}
    sensor = {"type": "perspective", "fov_axis": "y", "fov": FOV, "to_world": mi.ScalarTransform4f().look_at(origin=EYE, target=TARGET, up=[0, 1, 0]), "film": film,
              "sampler": {"type": "independent", "sample_count": spp}}
    if kind == "fog":
        fog = medium(mi, [FOG["albedo"]] * 3, [FOG["density"]] * 3, FOG["g"])
        low, high = [-0.5] * 3, [0.5, 1.5, 0.5]
        centre = [(a + b) / 2 for a, b in zip(low, high)]
        radius = 1.001 * math.dist(low, high) / 2
        parts["ball"] = {"type": "sphere", "center": centre, "radius": radius, "bsdf": {"type": "null"}, "interior": fog}
        parts["block"] = triangles(mi, "block", block(0.5, 0.5, -0.5), {"type": "diffuse", "reflectance": {"type": "rgb", "value": MATT["pbrMetallicRoughness"]["baseColorFactor"][:3]}}, {})
        black = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0}}
        parts["lamp"] = triangles(mi, "lamp", LAMP_SQUARE, black, {"mesh_emitter": mi.load_dict({"type": "area", "radiance": {"type": "rgb", "value": 30}})})
    else:
        glass = {"type": "null"} if kind["ior"] == 1 else {"type": "dielectric", "int_ior": kind["ior"]}  # rough ones differ: Mitsuba's masking is not height-correlated
        parts["block"] = triangles(mi, "block", block(0.5, 0.5, -0.5), glass, {"interior": medium(mi, kind["albedo"], kind["density"], kind["g"])})
    parts["sensor"] = sensor
    scene = mi.load_dict(parts)
    return [np.array(mi.render(scene, spp=spp, seed=k)) for k in range(runs)]


def blocks(np, picture, side=8):
    """Returns the means of square blocks of pixels."""
    n = picture.shape[0] // side
    return picture.reshape(n, side, n, side, 3).mean(axis=(1, 3))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--spp", type=int, default=1024)
    parser.add_argument("--size", type=int, default=64)
    options = parser.parse_args()
    race_mitsuba.enter(common.fail)
    import mitsuba as mi
    import numpy as np
    mi.set_variant("scalar_rgb")  # needs no LLVM
    runs = 8
    for name, kind in ("milk", MILK), ("cloud", CLOUD), ("fog", "fog"):
        with tempfile.TemporaryDirectory() as folder:
            channels = with_eclat(kind, options.size, options.spp, folder)
        stack = lambda prefix: np.stack([np.array(channels[prefix + c]).reshape(options.size, options.size) for c in "RGB"], axis=-1)  # noqa: E731
        ours, variance = blocks(np, stack("")), blocks(np, stack("stderr.") ** 2) / 64
        theirs = np.stack([blocks(np, p) for p in with_mitsuba(mi, kind, options.size, options.spp // runs, runs)])
        variance += theirs.var(axis=0, ddof=1) / runs
        noisy = variance > 1e-10  # others show only the sky
        z = (ours - theirs.mean(axis=0))[noisy] / np.sqrt(variance[noisy])
        print(f"{name}: eclat {ours.mean(axis=(0, 1)).round(5)}, Mitsuba {theirs.mean(axis=(0, 1, 2)).round(5)}; {z.size} differences over their errors: mean {z.mean():.2f}, "
              f"deviation {z.std():.2f}, largest {np.abs(z).max():.1f}", flush=True)


if __name__ == "__main__":
    main()

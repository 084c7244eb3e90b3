#!/usr/bin/env python3
"""Compares pictures with Blender's Cycles, which reads the same glTF by Blender's importer: where do the two interpret it differently?

Both render each scene from eclat's camera, under the same environment map. The script prints the ratio of the means. It also prints how much
averages of 8 x 8 pixels differ, as fractions of the picture's mean: their mean, and the value that 95 % of them are below. Beside the mean
it prints how much of it comes from eclat's own noise. Punctual lights are left out on both sides, since Blender measures them in other units.
Needs PyPI's bpy (4.5 for Python 3.11), numpy, OpenEXR and pillow: CYCLES_PYTHON names the interpreter that has them."""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

import bench_common as common

BLOCK = 8


# --- in the process that has Blender -----------------------------------------------------------------------------------

def blender_camera(bpy, description):
    from mathutils import Matrix
    columns = [description["matrix"][4 * i:4 * i + 4] for i in range(4)]
    to_world = Matrix([[columns[c][r] for c in range(4)] for r in range(4)])
    y_up = Matrix([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    data = bpy.data.cameras.new("eclat")
    data.clip_start, data.clip_end = 1e-6, 1e6
    if description["type"] == "perspective":
        data.sensor_fit, data.angle = "VERTICAL", description["yfov"]
    else:
        data.type, data.sensor_fit = "ORTHO", "VERTICAL"
        data.ortho_scale = 2 * description["ymag"]
    camera = bpy.data.objects.new("eclat", data)
    camera.matrix_world = y_up @ to_world
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def blender_world(bpy, environment):
    world = bpy.data.worlds.new("eclat")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    background = nodes["Background"]
    if environment is None:
        background.inputs["Color"].default_value = (0, 0, 0, 1)
        return
    # u = 0.5 - atan2(y, x) / 2 pi with Blender's y, which is glTF's -z: eclat's map as it is.
    image = nodes.new("ShaderNodeTexEnvironment")
    image.image = bpy.data.images.load(environment)
    image.interpolation = "Linear"
    links.new(image.outputs["Color"], background.inputs["Color"])


def blender_render(job):
    import bpy
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=job["scene"])
    scene = bpy.context.scene
    for item in [o for o in bpy.data.objects if o.type in ("LIGHT", "CAMERA")]:
        bpy.data.objects.remove(item)
    for material in bpy.data.materials:
        for node in material.node_tree.nodes if material.use_nodes else ():
            if node.type == "BSDF_PRINCIPLED":
                node.distribution = "MULTI_GGX" if job["scattering"] == "multiple" else "GGX"
    blender_camera(bpy, job["camera"])
    blender_world(bpy, job["environment"])
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.seed = "CPU", job["spp"], 1
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = 64
    cycles.transparent_max_bounces = 64
    cycles.sample_clamp_indirect = cycles.blur_glossy = cycles.light_sampling_threshold = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    render = scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = job["width"], job["height"], 100
    render.film_transparent = False
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.filepath = job["output"]
    bpy.ops.render.render(write_still=True)


def read_rgb(path, layer=None):
    import numpy
    import OpenEXR
    channels = OpenEXR.File(path).channels()
    for name in [layer] if layer else ["RGB", "RGBA"]:
        if name in channels:
            return channels[name].pixels[..., :3]
    return numpy.stack([channels[f"{layer}.{name}" if layer else name].pixels for name in "RGB"], axis=-1)


def to_png(numpy, rgb, scale):
    from PIL import Image
    x = numpy.clip(rgb * scale, 0, 1)
    return Image.fromarray((255 * numpy.where(x < 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055) + 0.5).astype("uint8"))


def compare(job):
    """Returns the means, and how much block averages differ as fractions of the picture's mean. Writes a PNG of both pictures and of their difference."""
    import numpy
    ours, theirs = (read_rgb(path).astype(float) for path in (job["ours"], job["theirs"]))
    rows, columns = ours.shape[0] // BLOCK, ours.shape[1] // BLOCK
    blocks = [x[:rows * BLOCK, :columns * BLOCK].reshape(rows, BLOCK, columns, BLOCK, 3).mean((1, 3)) for x in (ours, theirs)]
    apart = numpy.abs(blocks[0] - blocks[1]).mean(-1) / theirs.mean()
    noise = read_rgb(job["ours"], "stderr")[:rows * BLOCK, :columns * BLOCK].astype(float).reshape(rows, BLOCK, columns, BLOCK, 3)
    noise = numpy.sqrt((noise ** 2).sum((1, 3))) / BLOCK ** 2 * math.sqrt(2 / math.pi) / theirs.mean()  # mean |error|
    if job["png"]:
        scale = 0.7 / numpy.percentile(theirs, 90)
        from PIL import Image
        strip = Image.new("RGB", (3 * ours.shape[1], ours.shape[0]))
        for i, picture in enumerate([ours, theirs, numpy.abs(ours - theirs)]):
            strip.paste(to_png(numpy, picture, scale), (i * ours.shape[1], 0))
        strip.save(job["png"])
    return {"mean_ratio": (ours.mean((0, 1)) / theirs.mean((0, 1))).tolist(), "apart": float(apart.mean()), "noise": float(noise.mean()),
            "apart_95": float(numpy.percentile(apart, 95))}


def serve():
    for line in sys.stdin:
        job = json.loads(line)
        log = os.open(os.devnull, os.O_WRONLY)
        stdout = os.dup(1)
        os.dup2(log, 1)  # Blender prints a lot
        try:
            answer = blender_render(job) if job["do"] == "render" else compare(job)
        except Exception as error:  # noqa: BLE001 - Blender may raise anything
            answer = {"error": str(error).strip().splitlines()[-1]}
        os.dup2(stdout, 1)
        os.close(stdout)
        os.close(log)
        print(json.dumps(answer or {}), flush=True)


# --- the benchmark -----------------------------------------------------------------------------------------------------

class Cycles:
    def __init__(self):
        self.python = os.environ.get("CYCLES_PYTHON", sys.executable)
        probe = subprocess.run([self.python, "-c", "import bpy, numpy, OpenEXR, PIL"], capture_output=True, text=True)
        if probe.returncode:
            common.fail("no Python with bpy, numpy, OpenEXR and pillow; name one with CYCLES_PYTHON: "
                        + (probe.stderr.strip().splitlines() or ["?"])[-1])

    def ask(self, **job):
        """Runs in a separate process: Blender keeps what it has loaded, and may end its process."""
        done = subprocess.run([self.python, os.path.abspath(__file__), "--serve"], input=json.dumps(job) + "\n", capture_output=True, text=True)
        lines = done.stdout.strip().splitlines()
        return json.loads(lines[-1]) if lines else {"error": f"Blender ended with {done.returncode}"}


def one(eclat, cycles, scene, options, folder):
    info = subprocess.run([eclat, "info", "--json", "--quiet", scene], capture_output=True, text=True)
    if info.returncode:
        return {"error": info.stderr.strip()}
    info = json.loads(info.stdout)
    punctual = any(info["lights"][kind] for kind in ("point", "spot", "directional"))
    camera = info["cameras"][info["default_camera"]]
    width = height = options.size
    ours, theirs = os.path.join(folder, "eclat.exr"), os.path.join(folder, "cycles.exr")
    common.run_eclat(eclat, [scene, "--env", options.env, "--size", f"{width}x{height}", "--spp", str(options.spp), "--scattering", options.scattering,
                             "-o", ours]
                     + (["--without", "punctual-lights"] if punctual else []))
    answer = cycles.ask(do="render", scene=scene, camera=camera, environment=options.env, width=width,
                        height=height, spp=options.spp, scattering=options.scattering, output=theirs)
    if "error" in answer:
        return answer
    png = options.pictures and os.path.join(options.pictures, os.path.splitext(os.path.basename(scene))[0] + ".png")
    return cycles.ask(do="compare", ours=ours, theirs=theirs, png=png)


def main():
    if sys.argv[1:] == ["--serve"]:
        return serve()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", metavar="SCENE", help=".gltf or .glb")
    parser.add_argument("--eclat", help="the program (default: build-bench's or build's)")
    parser.add_argument("--env", help="an equirectangular .hdr (default: ../shared's studio.hdr)")
    parser.add_argument("--size", type=int, default=256, help="pixels a side (default: 256)")
    parser.add_argument("--spp", type=int, default=64, help="samples a pixel (default: 64)")
    parser.add_argument("--scattering", choices=["single", "multiple"], default="single", help="of rough facets, in both (default: single)")
    parser.add_argument("--pictures", metavar="DIR", help="write eclat's, Cycles' and their difference side by side there")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args()
    options.env = options.env or common.shared("assets", "env", "pmndrs-assets", "studio.hdr") or common.fail("no ../shared here; name a map with --env")
    eclat, cycles, found = common.eclat_path(options.eclat), Cycles(), {}
    if not options.json:
        print(f"{'scene':<34} {'mean R':>7} {'G':>7} {'B':>7} {'apart':>8} {'noise':>8} {'95 %':>8}   (means: eclat / Cycles)")
    for scene in options.scenes:
        with tempfile.TemporaryDirectory() as folder:
            answer = found[scene] = one(eclat, cycles, os.path.abspath(scene), options, folder)
        if not options.json:
            name = os.path.basename(scene)
            print(f"{name:<34} " + (answer["error"] if "error" in answer else
                  " ".join(f"{x:7.4f}" for x in answer["mean_ratio"]) + f" {100 * answer['apart']:7.2f}% {100 * answer['noise']:7.2f}% {100 * answer['apart_95']:7.2f}%"), flush=True)
    if options.json:
        print(json.dumps(found))


if __name__ == "__main__":
    main()

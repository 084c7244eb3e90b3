"""Exports a scene: meshes and materials by Blender's own glTF exporter; camera and lights by this add-on, since glTF expresses less of them."""
import contextlib
import os

import bpy

from . import camera, gather, glb, lights, materials, motion
from .trouble import Trouble

# Deformations are applied to the vertices: the exporter's skins and morph targets would lose some of what Blender can do.
EXPORT = dict(export_format="GLB", use_active_scene=True, export_yup=True, export_apply=True, export_animations=False, export_skins=False,
              export_morph=False, export_current_frame=True, export_cameras=False, export_lights=False, export_extras=False, export_tangents=False,
              export_gn_mesh=True, check_existing=False)


def exposure(scene):
    """Returns when the shutter opens and closes, in frames relative to the current one; None: there is no motion blur."""
    render = scene.render
    if not render.use_motion_blur or render.motion_blur_shutter <= 0:
        return None
    start = {"START": 0.0, "CENTER": -0.5, "END": -1.0}[getattr(render, "motion_blur_position", "CENTER")] * render.motion_blur_shutter
    return start, start + render.motion_blur_shutter


def scene_to_file(scene, layer, folder, for_render=True):
    """Writes scene.glb into the folder. Returns its path, options for the shutter, the lens and the frame of the camera (None in the viewport), and
    names of what was lost."""
    path, lost, shutter = os.path.join(folder, "scene.glb"), [], []
    frame = gather.frame(scene)
    with as_active(scene, layer), rendered_state(scene) if for_render else contextlib.nullcontext():
        span = exposure(scene) if for_render else None
        now = scene.frame_current + scene.frame_subframe
        if span is None:
            document, buffer, lens, found = moment(scene, folder, frame, for_render)
            lost += found
        else:
            count = scene.eclat.motion_steps
            offsets = [span[0] + (span[1] - span[0]) * k / (count - 1) for k in range(count)]
            per_second = scene.render.fps / scene.render.fps_base
            moments = []
            try:
                for offset in offsets:
                    set_frame(scene, now + offset)
                    moments.append(moment(scene, folder, frame, for_render))
            finally:
                set_frame(scene, now)
            lens, lost = moments[count // 2][2], list(moments[0][3])
            document, buffer, left = motion.merge([one[:2] for one in moments], [(offset - span[0]) / per_second for offset in offsets])
            lost += [f"motion blur of {what}" for what in left]
            if "animations" in document:
                shutter = [f"--shutter=0:{(span[1] - span[0]) / per_second:.9g}"]
    glb.write(path, document, buffer)
    return path, shutter, lens, frame, lost


def set_frame(scene, time):
    scene.frame_set(int(time // 1), subframe=time % 1)


def moment(scene, folder, frame, for_render):
    """Returns the scene as it is now: document, buffer, lens, names of what was lost."""
    document, buffer = meshes(folder, for_render)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    eye = gather.camera_of(scene, depsgraph) if for_render or scene.camera else None
    lens = eye and gather.lens(eye)
    if eye:
        document["cameras"] = [{"name": eye.name, **camera.gltf_camera(lens, frame)}]
        glb.add_node(document, {"name": eye.name, "matrix": lights.rigid(gather.columns(eye.matrix_world)), "camera": 0})
    found, lost = gather.lights(depsgraph, for_render)
    for light in found:
        lights.add(document, buffer, light)
    materials.make_solid(document)
    return document, buffer, lens, lost


def meshes(folder, for_render):
    path = os.path.join(folder, "meshes.glb")
    known = bpy.ops.export_scene.gltf.get_rna_type().properties.keys() if exporter_is_there() else ()
    arguments = {name: value for name, value in EXPORT.items() if name in known}
    try:
        with quiet():
            bpy.ops.export_scene.gltf(filepath=path, use_renderable=for_render, use_visible=not for_render, **arguments)
        return glb.read(path)
    except RuntimeError as why:
        raise Trouble(f"Blender's glTF exporter failed: {str(why).strip().splitlines()[-1]}") from why
    except FileNotFoundError:
        raise Trouble("Blender's glTF exporter wrote nothing; its messages are in the console") from None


def exporter_is_there():
    if not hasattr(bpy.types, "EXPORT_SCENE_OT_gltf"):
        raise Trouble("Blender's add-on glTF 2.0 is not enabled; eclat needs its exporter; enable it in the preferences")
    return True


@contextlib.contextmanager
def quiet():
    """Silences the exporter, which reports its progress by a logger and by print."""
    with open(os.devnull, "w", encoding="utf-8") as nowhere, contextlib.redirect_stdout(nowhere):
        yield


@contextlib.contextmanager
def as_active(scene, layer):
    """Makes a scene and layer the active ones: the exporter takes what the window shows."""
    window = bpy.context.window
    if window is None:
        raise Trouble("Blender has no window that could show the scene, which its glTF exporter needs")
    before = window.scene, window.view_layer
    try:
        window.scene = scene
        window.view_layer = scene.view_layers[layer]
        yield
    finally:
        window.scene = before[0]
        window.view_layer = before[1]


@contextlib.contextmanager
def rendered_state(scene):
    """Sets modifiers and visibility as in renders, since the exporter takes those of viewports."""
    changed = []

    def change(owner, name, value):
        if getattr(owner, name) != value:
            changed.append((owner, name, getattr(owner, name)))
            setattr(owner, name, value)
    try:
        for one in scene.objects:
            change(one, "hide_viewport", one.hide_render)
            for modifier in one.modifiers:
                change(modifier, "show_viewport", modifier.show_render)
                if hasattr(modifier, "render_levels"):
                    change(modifier, "levels", modifier.render_levels)
        bpy.context.view_layer.update()
        yield
    finally:
        for owner, name, value in reversed(changed):
            setattr(owner, name, value)
        if changed:
            bpy.context.view_layer.update()

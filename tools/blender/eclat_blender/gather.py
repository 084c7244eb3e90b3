"""Reads Blender's camera and lights into the plain data of camera.py and lights.py."""
import math

from mathutils import Matrix

from . import nodes
from .camera import Frame, Lens
from .lights import Light
from .trouble import Trouble

TO_GLTF = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))  # y up


def columns(matrix):
    """Returns the world matrix, in glTF's axes, of a thing that looks along its -z."""
    return tuple((TO_GLTF @ matrix)[row][column] for column in range(4) for row in range(4))


def frame(scene):
    render = scene.render
    scale = render.resolution_percentage / 100
    border = (render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y) if render.use_border else None
    return Frame(max(1, int(render.resolution_x * scale)), max(1, int(render.resolution_y * scale)), render.pixel_aspect_y / render.pixel_aspect_x, border)


def camera_of(scene, depsgraph):
    if scene.camera is None:
        raise Trouble(f"scene {scene.name} has no camera; add one, and make it the active camera")
    if scene.camera.type != "CAMERA":
        raise Trouble(f"the camera of scene {scene.name} is {scene.camera.name}, a {scene.camera.type.lower()}; choose a camera")
    return scene.camera.evaluated_get(depsgraph)


def lens(camera_object):
    data, dof = camera_object.data, camera_object.data.dof
    return Lens(kind=data.type, focal_length=data.lens, sensor_width=data.sensor_width, sensor_height=data.sensor_height, sensor_fit=data.sensor_fit,
                ortho_scale=data.ortho_scale, shift=(data.shift_x, data.shift_y), fstop=dof.aperture_fstop if dof.use_dof else 0.0,
                focus=focus(camera_object) if dof.use_dof else 0.0)


def focus(camera_object):
    """Returns the focus distance in metres along the axis."""
    dof = camera_object.data.dof
    if dof.focus_object is None:
        return dof.focus_distance
    target = dof.focus_object.matrix_world
    bone = dof.focus_object.pose.bones.get(dof.focus_subtarget) if dof.focus_subtarget and dof.focus_object.pose else None
    point = (target @ bone.matrix if bone else target).translation
    return max(1e-6, abs((point - camera_object.matrix_world.translation).dot(camera_object.matrix_world.col[2].xyz.normalized())))


def lights(depsgraph, for_render):
    """Returns the lights that shine, instances included, and names of the properties that glTF lacks."""
    found, lost = [], []
    for instance in depsgraph.object_instances:
        one = instance.object
        if one.type != "LIGHT" or not instance.show_self or (one.original.hide_render if for_render else not one.original.visible_get()):
            continue
        found.append(light(one, instance.matrix_world.copy(), lost))
    return found, lost


def light(one, matrix, lost):
    data = one.data
    color, factor = shade(data, lost)
    kind = {"POINT": "POINT", "SPOT": "SPOT", "SUN": "SUN", "AREA": "AREA"}[data.type]
    lost += [f"light {data.name}: {what}" for what in lacks(data)]
    extra = {}
    if kind == "SPOT":
        extra = {"cone": data.spot_size, "blend": data.spot_blend}
    if kind == "AREA":
        extra = {"shape": data.shape, "size": (data.size, data.size_y)}
    return Light(name=one.name, kind=kind, matrix=columns(matrix), color=tuple(c * factor for c in color), energy=data.energy * unit(data, matrix), **extra)


def unit(data, matrix):
    """Returns the factor of two settings of Blender 4.5 and later: exposure in stops, and power given for a light of 1 m2 (or radius 1 m) whatever its size."""
    factor = 2.0 ** getattr(data, "exposure", 0.0)
    if not getattr(data, "normalize", True):
        if data.type == "AREA":
            scale = matrix.to_scale()
            x, y = data.size * scale.x, (data.size_y if data.shape in ("RECTANGLE", "ELLIPSE") else data.size) * scale.y
            factor *= abs(x * y) * (math.pi / 4 if data.shape in ("DISK", "ELLIPSE") else 1)
        elif data.type in ("POINT", "SPOT") and data.shadow_soft_size > 0:
            factor *= math.pi * data.shadow_soft_size ** 2
    return factor


def shade(data, lost):
    """Returns a colour and a factor, from the light's own colour, its temperature and its emission node."""
    color = list(data.color)
    if getattr(data, "use_temperature", False):
        color = [c * t for c, t in zip(color, data.temperature_color)]
    tree = nodes.tree(data, since=(5, 2))
    for node in tree.nodes if tree else ():
        if node.bl_idname == "ShaderNodeOutputLight" and node.is_active_output and node.inputs["Surface"].is_linked:
            emission = node.inputs["Surface"].links[0].from_node
            if emission.bl_idname != "ShaderNodeEmission":
                lost.append(f"light {data.name}: node {emission.name}")
                return color, 1.0
            lost += [f"light {data.name}: what is linked to the {name.lower()} of its emission" for name in ("Color", "Strength") if emission.inputs[name].is_linked]
            return [c * e for c, e in zip(color, emission.inputs["Color"].default_value)], emission.inputs["Strength"].default_value
    return color, 1.0


def lacks(data):
    if data.type in ("POINT", "SPOT") and data.shadow_soft_size > 0:
        yield f"the radius of {data.shadow_soft_size:g} m, so that its shadows are hard"
    if data.type == "SUN" and data.angle > 0:
        yield f"the angle of {math.degrees(data.angle):.3g} degrees, so that its shadows are hard"
    if data.type == "SPOT" and data.use_square:
        yield "the square cone, which is round here"
    if data.type == "AREA" and data.spread < math.pi - 1e-4:
        yield "the spread, so that it shines to all sides of its front"
    if not getattr(data, "use_shadow", True):
        yield "that it casts no shadows"

"""Turns the world into the option --env: a colour, or an equirectangular picture with its strength and rotation."""
import math
import os

import numpy

from . import exr, nodes
from .options import number


def words(world, folder):
    """Returns options, and names of what they cannot express. A picture that is not already an .hdr or .exr file is written into the folder."""
    if world is None:
        return ["--env=0,0,0"], []
    tree = nodes.tree(world)
    if tree is None:
        return [constant(world.color)], []
    background = surface(tree)
    if background is None or background.bl_idname != "ShaderNodeBackground":
        what = "no surface" if background is None else f"a node {background.bl_label or background.name}"
        return [constant(world.color)], [f"world {world.name}: {what}; its viewport colour is taken"]
    lost = []
    if background.inputs["Strength"].is_linked:
        lost.append(f"world {world.name}: the strength is linked to a node; its own value is taken")
    strength = background.inputs["Strength"].default_value
    source = linked(background.inputs["Color"])
    if source is None:
        return [constant([c * strength for c in background.inputs["Color"].default_value[:3]])], lost
    if source.bl_idname != "ShaderNodeTexEnvironment" or source.image is None or source.projection != "EQUIRECTANGULAR":
        lost.append(f"world {world.name}: node {source.name} instead of an equirectangular environment picture; the background's own colour is taken")
        return [constant([c * strength for c in background.inputs["Color"].default_value[:3]])], lost
    degrees, more = rotation(world, linked(source.inputs["Vector"]))
    found = [f"--env={picture(source.image, folder)}"]
    if strength != 1:
        found.append(f"--env-strength={number(strength)}")
    if degrees:
        found.append(f"--env-rotate={number(degrees)}")
    return found, lost + more


def constant(color):
    return "--env=" + ",".join(number(max(0.0, c)) for c in color[:3])


def linked(socket):
    """Returns the node that a socket gets its value from, behind any reroutes."""
    while socket is not None and socket.is_linked:
        node = socket.links[0].from_node
        if node.bl_idname != "NodeReroute":
            return node
        socket = node.inputs[0]
    return None


def surface(tree):
    for node in tree.nodes:
        if node.bl_idname == "ShaderNodeOutputWorld" and node.is_active_output:
            return linked(node.inputs["Surface"])
    return None


def rotation(world, mapping):
    """Returns the degrees by which the picture turns counter-clockwise. A mapping node turns the lookup direction, so its angle has the opposite sign."""
    if mapping is None or mapping.bl_idname == "ShaderNodeTexCoord":
        return 0.0, []
    if mapping.bl_idname != "ShaderNodeMapping":
        return 0.0, [f"world {world.name}: node {mapping.name} before the environment picture"]
    lost = [f"world {world.name}: what is linked to node {mapping.name}"] if any(mapping.inputs[n].is_linked for n in ("Rotation", "Scale")) else []
    turn, scale = mapping.inputs["Rotation"].default_value, mapping.inputs["Scale"].default_value
    if abs(turn[0]) > 1e-6 or abs(turn[1]) > 1e-6 or any(abs(s - 1) > 1e-6 for s in scale):
        lost.append(f"world {world.name}: scale, and rotation about X and Y, of node {mapping.name}")
    return math.degrees(turn[2]) * (1 if mapping.vector_type == "TEXTURE" else -1), lost


def picture(image, folder):
    import bpy
    path = os.path.abspath(bpy.path.abspath(image.filepath, library=image.library)) if image.filepath else ""
    is_plain = image.source == "FILE" and not image.packed_file and not image.is_dirty and image.colorspace_settings.name in LINEAR
    if is_plain and os.path.isfile(path) and path.lower().endswith((".hdr", ".exr")):
        return path
    made = os.path.join(folder, "world.exr")
    exr.write(made, pixels(image))
    return made


LINEAR = ("Linear Rec.709", "Linear", "Non-Color", "Linear BT.709")


def pixels(image):
    """Returns linear pixels, rows from the top."""
    width, height = image.size
    values = numpy.empty(width * height * 4, numpy.float32)
    image.pixels.foreach_get(values)
    rgb = numpy.maximum(values.reshape(height, width, 4)[::-1, :, :3], 0)
    if image.colorspace_settings.name == "sRGB" and not image.is_float:
        rgb = numpy.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return rgb

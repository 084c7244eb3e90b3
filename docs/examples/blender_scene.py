#!/usr/bin/env python3
"""usage: blender_scene.py PICTURE.png   Needs bpy (PyPI's, or Blender's: blender -b -P blender_scene.py -- PICTURE.png). ECLAT names the program.
Makes a still life with bpy and renders it through the add-on of tools/blender."""
import math
import os
import sys

import bpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools", "blender"))
import eclat_blender  # noqa: E402


def material(name, color, **values):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = next(node for node in made.node_tree.nodes if node.bl_idname == "ShaderNodeBsdfPrincipled")
    for socket, value in {"Base Color": (*color, 1), **values}.items():
        shader.inputs[socket].default_value = value
    return made


def finish(made, smooth=True):
    bpy.context.object.data.materials.append(made)
    if smooth:
        bpy.ops.object.shade_smooth()
    return bpy.context.object


def lamp(scene, color, energy, size, location, target=(0, 0, 0.6)):
    data = bpy.data.lights.new("Lamp", "AREA")
    data.color, data.energy, data.shape, data.size = color, energy, "DISK", size
    aim(scene, bpy.data.objects.new("Lamp", data), location, target)


def aim(scene, one, location, target):
    from mathutils import Vector
    scene.collection.objects.link(one)
    one.location = location
    one.rotation_euler = (Vector(location) - Vector(target)).to_track_quat("Z", "Y").to_euler()
    return one


bpy.ops.wm.read_factory_settings(use_empty=True)
eclat_blender.register()
scene = bpy.context.scene
bpy.ops.mesh.primitive_plane_add(size=40)
finish(material("Table", (0.35, 0.17, 0.08), Roughness=0.35), smooth=False)
bpy.ops.mesh.primitive_monkey_add(size=1.3, location=(-0.95, 0.3, 0.62), rotation=(-0.62, 0, -0.35))
bpy.context.object.modifiers.new("Smooth", "SUBSURF").render_levels = 3
finish(material("Copper", (0.93, 0.5, 0.33), Metallic=1.0, Roughness=0.22))
bpy.ops.mesh.primitive_uv_sphere_add(radius=0.6, location=(0.5, -0.35, 0.6), segments=96, ring_count=48)
finish(material("Glass", (0.75, 0.95, 0.9), Roughness=0.0, IOR=1.5, **{"Transmission Weight": 1.0}))
bpy.ops.mesh.primitive_torus_add(location=(1.35, 0.9, 0.62), rotation=(1.25, 0.2, 0.4), major_radius=0.52, minor_radius=0.2, major_segments=96, minor_segments=32)
finish(material("Lacquer", (0.05, 0.2, 0.6), Roughness=0.3, **{"Coat Weight": 1.0}))
lamp(scene, (1.0, 0.82, 0.6), 260, 1.5, (-3, -1.5, 4))
lamp(scene, (0.5, 0.7, 1.0), 160, 2.5, (4, 1.5, 3))
scene.world = bpy.data.worlds.new("World")
scene.world.use_nodes = True
next(node for node in scene.world.node_tree.nodes if node.bl_idname == "ShaderNodeBackground").inputs["Color"].default_value = (0.06, 0.07, 0.1, 1)
data = bpy.data.cameras.new("Camera")
scene.camera = aim(scene, bpy.data.objects.new("Camera", data), (0.4, -6.5, 2.2), (0.15, 0, 0.62))
data.lens, data.dof.use_dof, data.dof.aperture_fstop, data.dof.focus_distance = 60, True, 0.5, 6.4
data.shift_y = 0.02
scene.render.engine = "ECLAT"
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 320, 200, 100
scene.eclat.spp = int(os.environ.get("SPP", "432"))
scene.render.filepath = os.path.abspath(sys.argv[-1])
scene.render.image_settings.file_format = "PNG"
bpy.ops.render.render(write_still=True)
os._exit(0)  # PyPI's bpy 4.2.23 crashes at its end once its glTF exporter has run

"""Scenes made with bpy that render in seconds."""
import math

import bpy

WIDTH, HEIGHT, SAMPLES = 48, 32, 16


def fresh(camera=(3.0, -5.0, 3.0), look=(62, 0, 31)):
    """A floor, a cube and a camera in an empty file, in a grey world. All tests use the same kernels."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "ECLAT"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 2 * WIDTH, 2 * HEIGHT, 50
    scene.eclat.spp, scene.eclat.lanes, scene.eclat.effects = SAMPLES, "4", "all"
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    background(scene).inputs["Color"].default_value = (0.2, 0.3, 0.4, 1)
    data = bpy.data.cameras.new("Camera")
    scene.camera = link(scene, bpy.data.objects.new("Camera", data), camera)
    scene.camera.rotation_euler = [math.radians(angle) for angle in look]
    bpy.ops.mesh.primitive_plane_add(size=20)
    bpy.context.object.data.materials.append(material("Floor", (0.8, 0.5, 0.3, 1)))
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0.6, 0.3, 0.5))
    bpy.context.object.data.materials.append(material("Paint", (0.1, 0.3, 0.8, 1)))
    return scene


def link(scene, one, location=(0, 0, 0)):
    scene.collection.objects.link(one)
    one.location = location
    return one


def background(scene):
    return next(node for node in scene.world.node_tree.nodes if node.bl_idname == "ShaderNodeBackground")


def principled(material):
    return next(node for node in material.node_tree.nodes if node.bl_idname == "ShaderNodeBsdfPrincipled")


def material(name, color, **values):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = principled(made)
    for socket, value in {"Base Color": color, "Roughness": 0.6, **values}.items():
        shader.inputs[socket].default_value = value
    return made


def light(scene, kind, energy, location=(-1, -1, 3), **values):
    data = bpy.data.lights.new(kind.title(), kind)
    data.energy = energy
    for name, value in values.items():
        setattr(data, name, value)
    return link(scene, bpy.data.objects.new(kind.title(), data), location)


def cube_and_lamp():
    scene = fresh()
    light(scene, "POINT", 100, shadow_soft_size=0)
    light(scene, "AREA", 50, (2, 1, 3), shape="DISK", size=1.5)
    return scene


def glass_and_hdri():
    """A picture for the world, rotated, packed into the file."""
    scene = fresh()
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.8, location=(-0.6, -0.6, 1))
    bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(material("Glass", (1, 1, 1, 1), Roughness=0.0, IOR=1.5, **{"Transmission Weight": 1.0}))
    picture = bpy.data.images.new("Sky", 16, 8, float_buffer=True)
    picture.pixels.foreach_set([v for y in range(8) for x in range(16) for v in (x / 16, y / 8, 4.0 * (x == 3 and y == 6), 1)])
    picture.pack()
    nodes, links = scene.world.node_tree.nodes, scene.world.node_tree.links
    sky, place, mapping = (nodes.new("ShaderNode" + kind) for kind in ("TexEnvironment", "TexCoord", "Mapping"))
    sky.image = picture
    mapping.inputs["Rotation"].default_value[2] = math.radians(40)
    for a, b in ((place.outputs["Generated"], mapping.inputs["Vector"]), (mapping.outputs["Vector"], sky.inputs["Vector"]),
                 (sky.outputs["Color"], background(scene).inputs["Color"])):
        links.new(a, b)
    background(scene).inputs["Strength"].default_value = 0.5
    return scene


def depth_of_field():
    scene = fresh()
    light(scene, "SUN", 2, angle=0).rotation_euler = (0.5, 0.3, 0)
    camera = scene.camera.data
    camera.lens, camera.shift_x, camera.shift_y = 35, 0.125, -0.25
    camera.dof.use_dof, camera.dof.aperture_fstop, camera.dof.focus_distance = True, 0.25, 4.5
    return scene


def motion_blur():
    """A cube that moves and rotates, a wave from a modifier, and a moving camera."""
    scene = fresh()
    light(scene, "SUN", 2, angle=0).rotation_euler = (0.5, 0.3, 0)
    cube = bpy.data.objects["Cube"]
    for frame, x in ((1, 0.6), (3, -1.4)):
        cube.location.x, cube.rotation_euler.z, scene.camera.location.x = x, x, 3 + 0.1 * x
        for one, paths in ((cube, ("location", "rotation_euler")), (scene.camera, ("location",))):
            for path in paths:
                one.keyframe_insert(path, frame=frame)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=8, y_subdivisions=8, size=2, location=(-1.2, 0, 0.6))
    wave = bpy.context.object.modifiers.new("Wave", "WAVE")
    wave.height, wave.width, wave.speed = 0.6, 0.8, 0.5
    scene.frame_set(2)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.5
    return scene


def armature():
    """A bone bends a column over three frames."""
    scene = fresh()
    bpy.data.objects["Cube"].hide_render = True
    bpy.ops.mesh.primitive_cylinder_add(radius=0.3, depth=2, location=(0, 0, 1))
    column = bpy.context.object
    column.modifiers.new("Bend", "ARMATURE").object = rig = link(scene, bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig")))
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bone = rig.data.edit_bones.new("Upper")
    bone.head, bone.tail = (0, 0, 1), (0, 0, 2)
    bpy.ops.object.mode_set(mode="OBJECT")
    column.vertex_groups.new(name="Upper").add([v.index for v in column.data.vertices if v.co.z > 0], 1.0, "REPLACE")
    pose = rig.pose.bones["Upper"]
    pose.rotation_mode = "XYZ"
    for frame, angle in ((1, 0.0), (3, 1.2)):
        pose.rotation_euler.x = angle
        pose.keyframe_insert("rotation_euler", frame=frame)
    scene.frame_start, scene.frame_end = 1, 3
    return scene

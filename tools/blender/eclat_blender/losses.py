"""Lists by name what glTF, its exporter or eclat cannot carry over from a scene."""
CARRIED = {
    "ShaderNodeOutputMaterial", "ShaderNodeBsdfPrincipled", "ShaderNodeEmission", "ShaderNodeTexImage", "ShaderNodeUVMap", "ShaderNodeTexCoord",
    "ShaderNodeMapping", "ShaderNodeNormalMap", "ShaderNodeSeparateColor", "ShaderNodeSeparateRGB", "ShaderNodeCombineColor", "ShaderNodeVertexColor",
    "ShaderNodeAttribute", "ShaderNodeMix", "ShaderNodeMixRGB", "ShaderNodeMath", "ShaderNodeValue", "ShaderNodeRGB", "ShaderNodeGroup", "NodeReroute",
    "NodeFrame", "NodeGroupInput", "NodeGroupOutput", "ShaderNodeMixShader", "ShaderNodeBsdfTransparent", "ShaderNodeLightPath", "ShaderNodeBackground",
}
KINDS = {"VOLUME": "volumes", "CURVES": "hair curves", "GPENCIL": "grease pencil", "GREASEPENCIL": "grease pencil", "POINTCLOUD": "point clouds"}


def of_scene(scene, for_render=True):
    """Returns a line for each thing that is lost."""
    found = []
    used = [one for one in scene.objects if not (one.hide_render if for_render else one.hide_viewport)]
    for one in used:
        if one.type in KINDS:
            found.append(f"object {one.name}: {KINDS[one.type]}")
        found += [f"object {one.name}: particle system {system.name}" for system in getattr(one, "particle_systems", ())]
        if getattr(one, "is_holdout", False):
            found.append(f"object {one.name}: that it is a holdout")
    seen = {slot.material for one in used for slot in one.material_slots if slot.material}
    for material in sorted(seen, key=lambda material: material.name):
        found += of_material(material)
    if for_render and scene.render.film_transparent:
        found.append("the transparent film: the environment is in the picture")
    if for_render and scene.camera and scene.camera.type == "CAMERA":
        found += of_camera(scene.camera.data)
    return found


def of_material(material):
    from . import nodes
    tree = nodes.tree(material)
    output = tree and next((node for node in tree.nodes if node.bl_idname == "ShaderNodeOutputMaterial" and node.is_active_output), None)
    if not output:
        return []
    found = [f"material {material.name}: {name.lower()}" for name in ("Volume", "Displacement") if output.inputs[name].is_linked]
    found_nodes = before(output.inputs["Surface"], set())
    lost = sorted({node.bl_label or node.name for node in found_nodes if node.bl_idname not in CARRIED})
    if lost:
        found.append(f"material {material.name}: node{'s' if len(lost) > 1 else ''} {', '.join(lost)}")
    for node in found_nodes:
        weight = node.inputs.get("Subsurface Weight") if node.bl_idname == "ShaderNodeBsdfPrincipled" else None
        if weight and (weight.is_linked or weight.default_value > 0):
            found.append(f"material {material.name}: subsurface scattering")
    return found


def before(socket, seen):
    """Returns the nodes that a socket depends on."""
    for link in socket.links:
        if link.from_node not in seen:
            seen.add(link.from_node)
            for one in link.from_node.inputs:
                before(one, seen)
    return seen


def of_camera(data):
    dof = data.dof
    if not dof.use_dof:
        return []
    if data.type == "ORTHO":
        return [f"camera {data.name}: depth of field of an orthographic camera"]
    found = []
    if dof.aperture_blades > 2:
        found.append(f"camera {data.name}: the blades of the aperture, which is round here")
    if abs(dof.aperture_ratio - 1) > 1e-6:
        found.append(f"camera {data.name}: the ratio of the aperture, which is round here")
    return found


class Teller:
    """Says each thing once."""

    def __init__(self):
        self.told = set()

    def news(self, lines):
        new = [line for line in dict.fromkeys(lines) if line not in self.told]
        self.told.update(new)
        return new

"""Translates Blender's lights into glTF: points, spots and suns by KHR_lights_punctual, area lights as emissive triangles."""
import math
from typing import NamedTuple, Tuple

from . import glb

ROUND_SIDES = 64  # corners of a disk; its radiance is raised to make up for the missing area


class Light(NamedTuple):
    name: str
    kind: str                          # "POINT", "SPOT", "SUN" or "AREA"
    matrix: Tuple[float, ...]          # 16 numbers, column by column, in glTF's axes; it shines along its -z
    color: Tuple[float, float, float]  # with all factors but the energy
    energy: float                      # watts; for a sun W/m2
    cone: float = math.pi              # for a spot: the whole angle, and how much of it is soft
    blend: float = 0.0
    shape: str = "SQUARE"              # for an area light: or "RECTANGLE", "DISK", "ELLIPSE"
    size: Tuple[float, float] = (1.0, 1.0)


def add(document, buffer, light):
    if light.kind == "AREA":
        add_area(document, buffer, light)
    else:
        add_punctual(document, light)


def peak(color):
    """Returns a factor and the colour that it multiplies, with no channel above 1."""
    most = max(color)
    return (most, [c / most for c in color]) if most > 0 else (0.0, [0.0, 0.0, 0.0])


def rigid(matrix):
    """Returns the matrix without scale, which glTF's lights ignore."""
    columns = [matrix[4 * k:4 * k + 3] for k in range(3)]
    lengths = [math.sqrt(sum(v * v for v in column)) or 1.0 for column in columns]
    turned = [[v / length for v in column] + [0.0] for column, length in zip(columns, lengths)]
    return [*turned[0], *turned[1], *turned[2], *matrix[12:16]]


def add_punctual(document, light):
    """Adds a point, spot or sun. A point of P watts has P / 4 pi W/sr in all directions, and a spot the same within its cone."""
    factor, color = peak(light.color)
    entry = {"name": light.name, "type": {"POINT": "point", "SPOT": "spot", "SUN": "directional"}[light.kind], "color": color,
             "intensity": light.energy * factor / (1 if light.kind == "SUN" else 4 * math.pi)}
    if light.kind == "SPOT":
        entry["spot"] = dict(zip(("innerConeAngle", "outerConeAngle"), cone(light)))
    glb.use(document, "KHR_lights_punctual")
    lights = document.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {}).setdefault("lights", [])
    lights.append(entry)
    glb.add_node(document, {"name": light.name, "matrix": rigid(light.matrix), "extensions": {"KHR_lights_punctual": {"light": len(lights) - 1}}})


def cone(light):
    """Returns the inner and outer angle. Towards the rim Blender falls off by 3 t^2 - 2 t^3, over a share (blend) of the cosine's range. glTF falls off
    by t^2: over 3/4 of that range it loses as much light."""
    outer = min(light.cone / 2, math.pi / 2)
    inner = math.acos(min(1.0, math.cos(outer) + 0.75 * light.blend * (1 - math.cos(outer))))
    return max(0.0, min(inner, outer - 1e-4)), outer


def outline(shape, size):
    """Returns the corners in the light's own plane, counter-clockwise as seen from its front, which is -z."""
    x, y = size[0] / 2, (size[1] if shape in ("RECTANGLE", "ELLIPSE") else size[0]) / 2
    if shape in ("SQUARE", "RECTANGLE"):
        return [(-x, -y), (-x, y), (x, y), (x, -y)]
    return [(x * math.cos(angle), -y * math.sin(angle)) for angle in (2 * math.pi * k / ROUND_SIDES for k in range(ROUND_SIDES))]


def world_area(corners, matrix):
    """Returns the area of a convex outline under the matrix."""
    a, b = matrix[0:3], matrix[4:7]
    normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    flat = sum(x * v - u * y for (x, y), (u, v) in zip(corners, corners[1:] + corners[:1])) / 2
    return abs(flat) * math.sqrt(sum(n * n for n in normal))


def add_area(document, buffer, light):
    """Adds P watts from one side, with the same radiance in all directions: P / (pi A). A glTF material can reflect nothing and shine from its front only."""
    corners = outline(light.shape, light.size)
    area = world_area(corners, light.matrix)
    if not area > 0:
        return
    factor, color = peak(light.color)
    positions = [(x, y, 0.0) for x, y in corners]
    fan = [corner for k in range(1, len(positions) - 1) for corner in (positions[0], positions[k], positions[k + 1])]
    strength = light.energy * factor / (math.pi * area)
    for extension in ("KHR_materials_emissive_strength", "KHR_materials_specular"):
        glb.use(document, extension)
    materials, meshes = document.setdefault("materials", []), document.setdefault("meshes", [])
    materials.append({"name": light.name, "emissiveFactor": color if strength > 0 else [0.0, 0.0, 0.0],
                      "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0, "roughnessFactor": 1},
                      "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": strength}, "KHR_materials_specular": {"specularFactor": 0}}})
    meshes.append({"name": light.name, "primitives": [{"attributes": {"POSITION": glb.add_floats(document, buffer, fan, "VEC3")},
                                                       "material": len(materials) - 1}]})
    glb.add_node(document, {"name": light.name, "matrix": list(light.matrix), "mesh": len(meshes) - 1})

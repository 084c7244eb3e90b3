"""Merges a scene at several moments into one document with an animation: nodes move, meshes change shape, the camera zooms. Pure functions."""
import math

from . import glb

IDENTITY = {"translation": [0.0, 0.0, 0.0], "rotation": [0.0, 0.0, 0.0, 1.0], "scale": [1.0, 1.0, 1.0]}
KIND = {"translation": "VEC3", "rotation": "VEC4", "scale": "VEC3"}


def merge(moments, times):
    """moments: (document, buffer) at each of `times`, in seconds from 0. Returns the first document with an
    animation, and names of things that keep their first state, since they are not the same thing at other moments."""
    document, buffer = moments[0]
    others = [other for other, _ in moments[1:]]
    if any(shape_of(other) != shape_of(document) for other in others):
        return document, buffer, ["the scene, which has other objects at other moments of the exposure"]
    left, animation = [], {"samplers": [], "channels": []}
    at = glb.add_floats(document, buffer, [[t] for t in times], "SCALAR")

    def track(target, values, kind):
        animation["samplers"].append({"input": at, "output": glb.add_floats(document, buffer, values, kind, bounds=False), "interpolation": "LINEAR"})
        animation["channels"].append({"sampler": len(animation["samplers"]) - 1, "target": target})

    for index in range(len(document["nodes"])):
        places = [placing(one["nodes"][index]) for one in (document, *others)]
        moving = [path for path in KIND if any(place[path] != places[0][path] for place in places)]
        if moving:
            document["nodes"][index].pop("matrix", None)
            document["nodes"][index].update(places[0])
        for path in moving:
            track({"node": index, "path": path}, [place[path] for place in places], KIND[path])
    for index, mesh in enumerate(document.get("meshes", [])):
        change = deform(index, mesh, moments)
        if change == "other":
            left.append(f"mesh {mesh.get('name', index)}, which has other vertices at other moments of the exposure")
        elif change:
            weights = [[float(row == column + 1) for column in range(len(others))] for row in range(len(moments))]
            for node in (n for n, one in enumerate(document["nodes"]) if one.get("mesh") == index):
                track({"node": node, "path": "weights"}, [[w] for row in weights for w in row], "SCALAR")
    zoom(document, others, track)
    if animation["channels"]:
        document["animations"] = [animation]
    return document, buffer, left


def shape_of(document):
    """Returns what two moments must have in common."""
    return [(node.get("name"), node.get("mesh"), node.get("camera"), node.get("children"), node.get("extensions", {}).get("KHR_lights_punctual"))
            for node in document["nodes"]], [len(mesh["primitives"]) for mesh in document.get("meshes", [])]


def placing(node):
    """Returns translation, rotation and scale, also from a matrix."""
    if "matrix" not in node:
        return {path: list(node.get(path, value)) for path, value in IDENTITY.items()}
    m = node["matrix"]
    columns = [list(m[4 * k:4 * k + 3]) for k in range(3)]
    scale = [math.sqrt(sum(v * v for v in column)) for column in columns]
    cross = [columns[0][1] * columns[1][2] - columns[0][2] * columns[1][1], columns[0][2] * columns[1][0] - columns[0][0] * columns[1][2],
             columns[0][0] * columns[1][1] - columns[0][1] * columns[1][0]]
    if sum(a * b for a, b in zip(cross, columns[2])) < 0:
        scale[0] = -scale[0]
    turned = [[v / s if s else float(i == k) for i, v in enumerate(column)] for k, (column, s) in enumerate(zip(columns, scale))]
    return {"translation": list(m[12:15]), "rotation": quaternion(turned), "scale": scale}


def quaternion(c):
    """Returns the quaternion x y z w of an orthonormal frame given by columns; computed from the largest of the four (Shepperd 1978)."""
    trace = c[0][0] + c[1][1] + c[2][2]
    values = [c[0][0], c[1][1], c[2][2], trace]
    k = values.index(max(values))
    if k == 3:
        q = [c[1][2] - c[2][1], c[2][0] - c[0][2], c[0][1] - c[1][0], 1 + trace]
    else:
        i, j = (k + 1) % 3, (k + 2) % 3
        q = [0.0, 0.0, 0.0, c[i][j] - c[j][i]]
        q[k] = 1 + c[k][k] - c[i][i] - c[j][j]
        q[i], q[j] = c[k][i] + c[i][k], c[k][j] + c[j][k]
    length = math.sqrt(sum(v * v for v in q))
    return [v / length for v in q]


def deform(index, mesh, moments):
    """Gives the mesh a morph target for each moment but the first. Returns True, False if nothing changes, "other" if it cannot be done."""
    document, buffer = moments[0]
    made = []
    for number, primitive in enumerate(mesh["primitives"]):
        targets, changes = [], False
        for other, its_buffer in moments[1:]:
            there, target = other["meshes"][index]["primitives"][number]["attributes"], {}
            for name in ("POSITION", "NORMAL"):
                if name not in primitive["attributes"] or name not in there:
                    continue
                a = glb.floats(document, buffer, primitive["attributes"][name])
                b = glb.floats(other, its_buffer, there[name])
                if a.shape != b.shape:
                    return "other"
                target[name] = b - a
                changes |= bool((a != b).any())
            targets.append(target)
        made.append((primitive, targets, changes))
    if not any(changes for _, _, changes in made):
        return False
    for primitive, targets, _ in made:
        primitive["targets"] = [{name: glb.add_floats(document, buffer, values, "VEC3") for name, values in target.items()} for target in targets]
    return True


def zoom(document, others, track):
    for index, camera in enumerate(document.get("cameras", [])):
        angles = [one["cameras"][index].get("perspective", {}).get("yfov") for one in (document, *others)]
        if len(set(angles)) > 1 and None not in angles:
            glb.use(document, "KHR_animation_pointer")
            pointer = {"pointer": f"/cameras/{index}/perspective/yfov"}
            track({"path": "pointer", "extensions": {"KHR_animation_pointer": pointer}}, [[angle] for angle in angles], "SCALAR")

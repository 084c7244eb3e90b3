"""Rooms whose light is hard to find, rendered by test_bounds.py. Metres; y up; standard library only."""
import base64
import math
import struct
import zlib

from support import data_uri, write_gltf

SUN, HOLE = (0.3, -1.0, 0.1), 0.005  # direction of the sun's light; side of the hole
SKY = 1e5  # radiance
SIDES = [(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1)]


def png(side, grey):
    """A square picture of one grey, 16 bits."""
    rows = b"".join(b"\0" + struct.pack(f">{side}H", *grey[side * y:side * y + side]) for y in range(side))
    chunks = (b"IHDR", struct.pack(">IIBBBBB", side, side, 16, 0, 0, 0, 0)), (b"IDAT", zlib.compress(rows)), (b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(struct.pack(">I", len(d)) + k + d + struct.pack(">I", zlib.crc32(k + d)) for k, d in chunks)


class Room:
    """A white box of 4 x 3 x 4 with an open top, and a camera in a corner."""

    def __init__(self, albedo):
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "accessors": [],
                     "bufferViews": [], "materials": [], "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.01}}],
                     "extensionsUsed": ["KHR_materials_specular", "KHR_materials_emissive_strength"]}
        self.buffer = b""
        self.white = self.material(albedo)
        for at, u, v in (((-2, 0, -2), (0, 0, 4), (4, 0, 0)), ((-2, 0, -2), (0, 3, 0), (0, 0, 4)), ((2, 0, -2), (0, 0, 4), (0, 3, 0)),
                         ((-2, 0, -2), (4, 0, 0), (0, 3, 0)), ((-2, 0, 2), (0, 3, 0), (4, 0, 0))):
            self.quad(self.white, at, u, v)
        # the camera is at (1.7, 1.6, 1.8), looks a little downwards, and 37 degrees to the left of -z
        turn, tilt = math.radians(37) / 2, math.radians(-6) / 2
        c, s, d, t = math.cos(turn), math.sin(turn), math.cos(tilt), math.sin(tilt)
        rotation = [c * t, s * d, -s * t, c * d]
        self.node(camera=0, translation=[1.7, 1.6, 1.8], rotation=rotation)

    def node(self, **node):
        self.json["nodes"].append(node)
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)

    def material(self, albedo, radiance=0, **more):
        matt = {"KHR_materials_specular": {"specularFactor": 0}, "KHR_materials_emissive_strength": {"emissiveStrength": max(radiance, 1)}}
        base = {"baseColorFactor": [albedo] * 3 + [1], "metallicFactor": 0}
        self.json["materials"].append({"pbrMetallicRoughness": base, "emissiveFactor": [min(radiance, 1)] * 3, "extensions": matt, **more})
        return len(self.json["materials"]) - 1

    def floats(self, width, values):
        data = struct.pack(f"<{len(values)}f", *values)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data)})
        accessor = {"bufferView": len(self.json["bufferViews"]) - 1, "componentType": 5126, "count": len(values) // width, "type": f"VEC{width}"}
        if width == 3:
            accessor.update(min=[min(values[k::3]) for k in range(3)], max=[max(values[k::3]) for k in range(3)])
        self.json["accessors"].append(accessor)
        self.buffer += data
        return len(self.json["accessors"]) - 1

    def quad(self, material, at, u, v):
        """A parallelogram with the edges u and v, which faces u x v."""
        self.mesh(material, [(at, u, v)])

    def mesh(self, material, quads):
        """Returns its number."""
        points = [at[k] + a * u[k] + b * v[k] for at, u, v in quads for a, b in SIDES for k in range(3)]
        streams = {"POSITION": self.floats(3, points), "TEXCOORD_0": self.floats(2, [c for side in SIDES * len(quads) for c in side])}
        self.json["meshes"].append({"primitives": [{"attributes": streams, "material": material}]})
        self.node(mesh=len(self.json["meshes"]) - 1)
        return len(self.json["meshes"]) - 1

    def ceiling(self, hole=None, row=1):
        """Returns its mesh. row: so many such holes, 5 cm apart."""
        a, b, c, d = hole or (0, 0, 0, 0)
        between = [(b + 0.05 * i, a + 0.05 * i + 0.05, c, d) for i in range(row - 1)]
        ends = (-2, 2, -2, c), (-2, 2, d, 2), (-2, a, c, d), (b + 0.05 * (row - 1), 2, c, d)
        sides = [s for s in (*ends, *between) if s[0] < s[1] and s[2] < s[3]]
        return self.mesh(self.white, [((x0, 3, z0), (x1 - x0, 0, 0), (0, 0, z1 - z0)) for x0, x1, z0, z1 in sides])

    def dim_lamp(self):
        """5 W"""
        self.quad(self.material(0, 5 / (math.pi * 0.25)), (1, 2.9, 1.3), (0.5, 0, 0), (0, 0, 0.5))

    def pane(self, at, u, v):
        glass = self.material(1, doubleSided=True)
        self.json["materials"][glass]["pbrMetallicRoughness"]["roughnessFactor"] = 0
        self.json["materials"][glass]["extensions"] = {"KHR_materials_transmission": {"transmissionFactor": 1}}
        self.json["extensionsUsed"].append("KHR_materials_transmission")
        self.quad(glass, at, u, v)

    def rug(self, side):
        """side x side small squares on the floor, each at its own height."""
        material, points = self.material(0.5), []
        for i in range(side * side):
            x, z, y = -1.5 + i % side / side, -1.5 + i // side / side, 0.01 + 0.001 * (i * 7 % 11)
            points += [c for a, b in SIDES for c in (x + b * 0.9 / side, y, z + a * 0.9 / side)]
        self.json["meshes"].append({"primitives": [{"attributes": {"POSITION": self.floats(3, points)}, "material": material}]})
        self.node(mesh=len(self.json["meshes"]) - 1)

    def light(self, light, **node):
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append(light)
        self.node(extensions={"KHR_lights_punctual": {"light": len(lights) - 1}}, **node)
        if len(lights) == 1:
            self.json["extensionsUsed"].append("KHR_lights_punctual")

    def sun(self, irradiance):
        length = math.sqrt(sum(c * c for c in SUN))
        x, y, z = (c / length for c in SUN)
        axis, cosine = (y, -x, 0), -z  # turns -z to SUN, about their cross product
        w = math.sqrt((1 + cosine) / 2)
        self.light({"type": "directional", "intensity": irradiance}, rotation=[c / (2 * w) for c in axis] + [w])

    def write(self, path):
        self.json["buffers"] = [{"byteLength": len(self.buffer), "uri": data_uri(self.buffer)}]
        write_gltf(path, self.json)
        return path


def texel_room(path):
    """A lamp of 1 m^2 with a texture of 128 x 128, one texel of which is 10^4 times as bright as the others."""
    room, side = Room(0.6), 128
    room.ceiling()
    grey = [round(65535 * 12.92e-4)] * side ** 2
    grey[50 * side + 37] = 65535
    room.json.update(images=[{"uri": "data:image/png;base64," + base64.b64encode(png(side, grey)).decode()}], textures=[{"source": 0}])
    lamp = room.material(0, 2e4, emissiveTexture={"index": 0})
    room.quad(lamp, (-0.5, 2.9, -0.5), (1, 0, 0), (0, 0, 1))
    return room.write(path)


def sun_room(path, kind, rug=0, ground=0, pane=False, twice=False):
    """A room with a dim lamp of 5 W, and a sun of 10^5 W/m^2 outside. kind: "hole": the sun lights a patch of the floor through a hole of 5
    mm; "sealed": no hole; "patch": no sun and no hole, but a patch that emits what it would reflect. rug: squares along each side of a rug
    on the floor, 0: none. ground: side of the plain that the room stands on, 0: none. pane: one pane lies over the hole and another one below
    it. twice: a second node has the ceiling's mesh, far below."""
    room, irradiance = Room(0.7), 1e5
    x, z = 0.5, 0.3
    room.dim_lamp()
    ceiling = room.ceiling((x, x + HOLE, z, z + HOLE) if kind == "hole" else None)
    if kind == "patch":
        cosine = -SUN[1] / math.sqrt(sum(c * c for c in SUN))
        lit = room.material(0.7, 0.7 * irradiance * cosine / math.pi)
        room.quad(lit, (x - 3 * SUN[0] / SUN[1], 1e-5, z - 3 * SUN[2] / SUN[1]), (0, 0, HOLE), (HOLE, 0, 0))
    else:
        room.sun(irradiance)
    if twice:
        room.node(mesh=ceiling, translation=[0, -6.5, 0])
    if pane:
        room.pane((x - 0.1, 3.01, z - 0.1), (0, 0, 0.2), (0.2, 0, 0))
        room.pane((x, 1, z), (0, 0, 1), (1, 0, 0))
    if rug:
        room.rug(rug)
    if ground:
        room.quad(room.white, (-ground / 2, -0.01, -ground / 2), (0, 0, ground), (ground, 0, 0))
    return room.write(path)


def sky_room(path, kind, rug=0, side=HOLE, row=1):
    """A dim lamp of 5 W, for a sky of SKY W/(m^2 sr) outside. kind: "hole": the sky shines through a hole of 5 mm, or another side, with 8 W; "sealed":
    no hole; "lamp": a lamp of the sky's radiance in place of the hole. rug: as in sun_room. row: so many holes."""
    room, x, z = Room(0.7), 0.5, 0.3
    room.dim_lamp()
    room.ceiling(None if kind == "sealed" else (x, x + side, z, z + side), row)
    if kind == "lamp":
        room.quad(room.material(0, SKY), (x, 3, z), (HOLE, 0, 0), (0, 0, HOLE))
    if rug:
        room.rug(rug)
    return room.write(path)


def lamp_room(path, kind, others=0):
    """A room with a dim lamp of 5 W, and a lamp of 125 kW, 2 mm across, a metre above the ceiling. kind: "hole": it lights a patch of the
    floor through a hole of 5 mm; "sealed": no hole. others: lamps of twice its power far below the room, each of its own material."""
    room, x, z, side = Room(0.7), 0.5, 0.3, 0.002
    room.dim_lamp()
    for i in range(others):
        room.quad(room.material(0, 2e10), (i - others / 2, -4, 0), (side, 0, 0), (0, 0, side))
    room.ceiling((x, x + HOLE, z, z + HOLE) if kind == "hole" else None)
    room.quad(room.material(0, 1e10), (x - side / 2, 4, z - side / 2), (side, 0, 0), (0, 0, side))
    return room.write(path)


def point_room(path, kind, spot=False, roof=False, others=0):
    """A dim lamp of 5 W, and a metre above the ceiling a point light of 4 x 10^5 W/sr, or a spot light that shines down. Through a "hole" of 5 mm it
    lights 4 cm^2 of the floor, with 10 W; or the room is "sealed". roof: the light hangs below one. others: lights of twice its
    intensity far below the room."""
    room, x, z = Room(0.7), 0.5, 0.3
    room.dim_lamp()
    for i in range(others):
        room.light({"type": "point", "intensity": 8e5}, translation=[i - others / 2, -4, 0])
    room.ceiling((x, x + HOLE, z, z + HOLE) if kind == "hole" else None)
    light = {"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}} if spot else {"type": "point"}
    if roof:
        room.quad(room.white, (-2, 4.5, -2), (4, 0, 0), (0, 0, 4))
    room.light({**light, "intensity": 4e5}, translation=[x + HOLE / 2, 4, z + HOLE / 2], rotation=[-math.sqrt(0.5), 0, 0, math.sqrt(0.5)])
    return room.write(path)


def near_room(path, kind, distance):
    """A dim lamp of 5 W, and at so many metres from a surface another light of about as much: a "point" light below the ceiling, a "spot" light that
    shines onto the floor, or a "lamp" of 1 mm that faces the ceiling."""
    room, x, z, side = Room(0.7), 0.5, 0.3, 0.001
    room.dim_lamp()
    room.ceiling()
    if kind == "lamp":
        room.quad(room.material(0, 5 / (math.pi * side * side)), (x, 3 - distance, z), (0, 0, side), (side, 0, 0))
    elif kind == "point":
        room.light({"type": "point", "intensity": 1}, translation=[x, 3 - distance, z])
    else:
        room.light({"type": "spot", "intensity": 20, "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.5}}, translation=[x, distance, z],
                   rotation=[-math.sqrt(0.5), 0, 0, math.sqrt(0.5)])
    return room.write(path)


def far_room(path, kind, far):
    """A wall 1 m away that hides half of another one, `far` metres away, and lights of about the same irradiance for both: a lamp for the far one, and a "lamp",
    "point" or "spot" light for the near one. Neither wall is lit by the other's. Behind the camera is a black wall."""
    room, side = Room(0.7), 0.01
    room.json["scenes"][0]["nodes"] = []
    room.node(camera=0)
    room.quad(room.white, (-2, -2, -1), (2, 0, 0), (0, 4, 0))
    room.quad(room.material(0), (-20, 20, 2), (40, 0, 0), (0, -40, 0))
    if kind == "lamp":
        room.quad(room.material(0, 0.9 / (math.pi * side * side)), (-0.3, 0.6, -0.5), (0, side, 0), (side, 0, 0))
    else:
        cone = {"spot": {"innerConeAngle": 0.9, "outerConeAngle": 1.0}} if kind == "spot" else {}
        room.light({"type": kind, "intensity": 0.29, **cone}, translation=[-0.3, 0.6, -0.5])
    room.quad(room.white, (-2 * far, -2 * far, -far), (4 * far, 0, 0), (0, 4 * far, 0))
    side = far / 10
    room.quad(room.material(0, 4.8 * far * far / (math.pi * side * side)), (0.3 * far, 0.6 * far, -0.5 * far), (0, side, 0), (side, 0, 0))
    return room.write(path)

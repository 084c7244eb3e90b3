# tier: full
"""A million lights: read, built, packed and rendered in memory that grows linearly with their number.

A step of quadratic time, 10^12, would end in the timeout of five minutes."""
import array
import unittest

from hard_scene import QUAD, WHITE, LAMP, HardCase, Scene
from support import write_glb

LIGHTS = "KHR_lights_punctual"
FEW, MANY = 100000, 1000000


def specks(count):
    """Emitting triangles of a millimetre, on a grid above a floor, as a .glb."""
    scene = Scene(WHITE, LAMP).add(QUAD, scale=[2, 2, 1])
    positions, side = array.array("f"), round(count ** 0.5)
    for i in range(count):
        x, y = (i % side) / side * 2 - 1, (i // side) / side * 2 - 1
        positions.extend((x, y, 0.5, x, y + 0.001, 0.5, x + 0.001, y, 0.5))  # facing down
    scene.json["bufferViews"].append({"buffer": 0, "byteOffset": len(scene.buffer), "byteLength": 4 * len(positions)})
    scene.buffer += positions.tobytes()
    scene.json["accessors"].append({"bufferView": 1, "componentType": 5126, "count": 3 * count, "type": "VEC3"})
    scene.json["meshes"].append({"primitives": [{"attributes": {"POSITION": 1}, "material": 1}]})
    return scene.node(mesh=1)


def bulbs(count):
    scene = Scene(WHITE).extend(LIGHTS, {"lights": [{"type": "point", "intensity": 1 / count}]}).add(QUAD, scale=[2, 2, 1])
    side = round(count ** 0.5)
    for i in range(count):
        scene.node(extensions={LIGHTS: {"light": 0}}, translation=[(i % side) / side * 2 - 1, (i // side) / side * 2 - 1, 0.5])
    return scene


class ManyLights(HardCase):
    def picture(self, make, count):
        scene = make(count)
        scene.json["buffers"] = [{"byteLength": len(scene.buffer), "uri": ""}]
        path = write_glb(self.path("scene.glb"), scene.json, bytes(scene.buffer))
        return self.render(path, "--max-depth", "3")

    def compare(self, make, brighter):
        """Compares a floor under a tenth of the lights and under all, which must give `brighter` times its light."""
        few, many = self.picture(make, FEW), self.picture(make, MANY)
        se = ((brighter * few.se) ** 2 + many.se ** 2) ** 0.5
        self.assertGreater(few.mean, 10 * few.se)
        self.assertLess(abs(many.mean - brighter * few.mean), 4 * se)  # fails once in 16 000 by chance
        self.assertLess(many.stats["peak_memory_bytes"], MANY / FEW * few.stats["peak_memory_bytes"])

    def test_bulbs(self):
        """Each light has an equal share of one candela."""
        self.compare(bulbs, 1)

    def test_triangles(self):
        self.compare(specks, MANY / FEW)


if __name__ == "__main__":
    unittest.main()

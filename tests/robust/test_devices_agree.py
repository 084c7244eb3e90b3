# tier: full
"""All OpenCL devices make the same picture: every number of every channel, bit for bit, at each lane width. The kernels' arithmetic is
correctly rounded everywhere (tests/kernel/test_rounding.c), and nothing depends on an order."""
import os
import struct
import sys
import unittest

from support import CORNELL, ECLAT, RING, SOURCE, Case, eclat, read_exr, write_gltf
from test_image_light import COLOURS, lit_scene, png
from test_motion import room

sys.path.insert(0, os.path.join(SOURCE, "tools"))
import opencl_devices

# Every stage, light, material and accelerator. The picture is small, since some drivers compile each kernel for seconds.
LAMPS = os.path.join(SOURCE, "scenes", "lamps", "lamps.gltf")
GLASS = os.path.join(SOURCE, "scenes", "glass", "glass.gltf")
PICTURES = {
    "path": [CORNELL, "--spp", "20"],
    "lamps": [LAMPS, "--spp", "4", "--env", "0.1,0.2,0.3"],
    "glass": [GLASS, "--spp", "4", "--accel", "grid"],
    "whitted": [GLASS, "--spp", "4", "--integrator", "whitted"],
    "raster": [LAMPS, "--spp", "4", "--integrator", "raster"],
}
# Kernels that reserve places in queues, with waves of many parts.
QUEUES = {
    "many waves": [CORNELL, "--spp", "20", "--wave", "256"],
    "light paths": [RING, "--spp", "4", "--light-paths", "1"],
}
VELVET, FILM, BRUSHED, PRISM = (os.path.join(SOURCE, "scenes", name, name + ".gltf") for name in ("velvet", "soap-film", "brushed-metal", "prism"))
# Effects that other files or options ask for. Each needs kernels of its own, which is slower.
MORE = {
    "motion": ["MOTION", "--animation", "all", "--shutter", "0:1", "--spp", "4", "--env", "0.3,0.3,0.3"],
    "image light": ["IMAGE LIGHT", "--spp", "4"],
    "scattering": [GLASS, "--spp", "4", "--scattering", "multiple"],
    "instances": [LAMPS, "--spp", "4", "--instancing", "on", "--accel", "twolevel", "--light-choice", "tree"],
    "velvet": [VELVET, "--spp", "2"],
    "soap film": [FILM, "--spp", "2"],
    "brushed metal": [BRUSHED, "--spp", "2", "--fstop", "4", "--focus", "2"],
    "prism": [PRISM, "--spp", "2", "--filter", "blackman-harris", "--terminator", "smooth"],
}
LANES = ["1", "4", "8", "16"]
BUILD = os.path.dirname(os.path.abspath(ECLAT))
SLOW = "llvmpipe"  # compiles and renders for minutes, and has one lane only: tested if ECLAT_SLOW_DEVICES is set


def bits(planes):
    return {name: struct.pack(f"<{len(values)}f", *values) for name, values in planes.items()}


DEVICES = opencl_devices.find(ECLAT, BUILD)
FAST = [pair for pair in DEVICES if SLOW not in pair[0]["name"]]


def setUpModule():
    if len(DEVICES) < 2:
        print("skipped: fewer than two OpenCL devices; tools/test --all-devices installs others")
        sys.exit(77)


class DevicesAgree(Case):
    def made(self, what):
        """Makes scenes that are not in files."""
        if what == "MOTION":
            return room().write(self.path("motion.gltf"))
        faces = [png(8, lambda x, y, c=colour: tuple((v + 16 * x) % 256 for v in c)) for colour in COLOURS]
        return write_gltf(self.path("lit.gltf"), lit_scene(faces, rotation=[0.5, 0.5, 0.5, 0.5]))

    def render(self, name, environment, lanes):
        path = self.path("picture.exr")
        scene, *options = {**PICTURES, **MORE, **QUEUES}[name]
        scene = scene if os.path.exists(scene) else self.made(scene)
        self.assert_ok(eclat("render", scene, *options, "--size", "32x24", "--lanes", lanes, "-o", path, "-q", env=environment,
                             timeout=600))
        return bits(read_exr(path)[1])

    def check(self, name, devices, lanes):
        first, environment = devices[0]
        expected = self.render(name, environment, "1")
        self.assertTrue(any(any(plane) for channel, plane in expected.items() if channel in "RGB"))
        for device, environment in devices:
            for width in lanes:
                picture = self.render(name, environment, width)
                self.assertEqual(picture.keys(), expected.keys())
                other = [channel for channel in expected if picture[channel] != expected[channel]]
                self.assertEqual(other, [], f"{name}: {opencl_devices.title(device)} with {width} lanes gives other bits than "
                                            f"{opencl_devices.title(first)} with 1")

    def test_every_lane_width(self):
        for name in PICTURES:
            with self.subTest(name):
                self.check(name, FAST, LANES)

    def test_every_effect(self):
        """Renders the reference with one lane, and others with the number that they choose."""
        for name in MORE:
            with self.subTest(name):
                self.check(name, FAST, ["auto"])

    def test_sub_groups(self):
        """Places in queues reserved once for a sub-group, as on a card."""
        as_card = {"ECLAT_DEVICE_TYPE": "gpu", "ECLAT_WORKAROUND": "none"}
        able = [(device, {**environment, **as_card}) for device, environment in FAST if device["subgroup_ballot"]]
        if not able:
            self.skipTest("no device has cl_khr_subgroup_ballot")
        for device, environment in able:
            self.assertTrue(opencl_devices.devices_of(ECLAT, environment)[0][device["index"]]["uses_subgroups"])
        for name in ["path", "lamps", "whitted", *QUEUES]:
            with self.subTest(name):
                self.check(name, [FAST[0], *able], ["1"])

    def test_slow_devices(self):
        slow = [pair for pair in DEVICES if SLOW in pair[0]["name"]]
        if not slow or not os.environ.get("ECLAT_SLOW_DEVICES"):
            self.skipTest("no slow device, or ECLAT_SLOW_DEVICES is not set")
        for name in ["path", "raster"]:
            with self.subTest(name):
                self.check(name, [DEVICES[0], *slow], ["1"])


if __name__ == "__main__":
    unittest.main()

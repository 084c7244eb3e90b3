"""The same picture on every OpenCL device: each number of each channel, bit for bit, at each lane width. What the kernels compute
with is correctly rounded everywhere (tests/kernel/test_rounding.c), and nothing depends on an order.

ctest label: slow"""
import os
import struct
import sys
import unittest

from support import CORNELL, ECLAT, SOURCE, Case, eclat, read_exr

sys.path.insert(0, os.path.join(SOURCE, "tools"))
import opencl_devices

# Every stage, light, material and accelerator; small, since a driver that compiles for seconds a kernel is no reason to wait.
LAMPS = os.path.join(SOURCE, "scenes", "lamps", "lamps.gltf")
GLASS = os.path.join(SOURCE, "scenes", "glass", "glass.gltf")
PICTURES = {
    "path": [CORNELL, "--spp", "8", "--batch", "4"],
    "lamps": [LAMPS, "--spp", "4", "--batch", "2", "--env", "0.1,0.2,0.3"],
    "glass": [GLASS, "--spp", "4", "--batch", "2", "--accel", "grid"],
    "whitted": [GLASS, "--spp", "4", "--batch", "2", "--integrator", "whitted"],
    "raster": [LAMPS, "--spp", "4", "--batch", "2", "--integrator", "raster"],
}
LANES = ["1", "4", "8", "16"]
BUILD = os.path.dirname(os.path.abspath(ECLAT))
SLOW = "llvmpipe"  # compiles and renders for minutes, and can have one lane only: takes part if ECLAT_SLOW_DEVICES is set


def bits(planes):
    return {name: struct.pack(f"<{len(values)}f", *values) for name, values in planes.items()}


DEVICES = opencl_devices.find(ECLAT, BUILD)


def setUpModule():
    if len(DEVICES) < 2:
        print("skipped: fewer than two OpenCL devices; tools/test --all-devices installs others")
        sys.exit(77)


class DevicesAgree(Case):
    def render(self, name, environment, lanes):
        path = self.path("picture.exr")
        self.assert_ok(eclat("render", *PICTURES[name], "--size", "32x24", "--lanes", lanes, "-o", path, "-q", env=environment,
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
        fast = [pair for pair in DEVICES if SLOW not in pair[0]["name"]]
        for name in PICTURES:
            with self.subTest(name):
                self.check(name, fast, LANES)

    def test_slow_devices(self):
        slow = [pair for pair in DEVICES if SLOW in pair[0]["name"]]
        if not slow or not os.environ.get("ECLAT_SLOW_DEVICES"):
            self.skipTest("no slow device, or ECLAT_SLOW_DEVICES is not set")
        for name in ["path", "raster"]:
            with self.subTest(name):
                self.check(name, [DEVICES[0], *slow], ["1"])


if __name__ == "__main__":
    unittest.main()

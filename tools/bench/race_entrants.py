"""The entrants of a race: Mitsuba with one of its samplers, eclat with some options. Each renders one seed at a time."""
import os
import resource
import time

import numpy as np

import bench_common as common

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


class Lap:
    """One render: luminance (height, width), mean of R, G and B, seconds by both clocks, samples a pixel, the stated error or None."""

    def __init__(self, rgb, cpu, wall, samples, stated=None, image=None):
        self.luminance, self.mean = rgb @ LUMINANCE, rgb.mean(axis=(0, 1))
        self.cpu, self.wall, self.samples, self.stated, self.variance = cpu, wall, samples, stated, image


def cpu_now():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


class Mitsuba:
    """Runs in this process. Its seconds are those of mi.render and of the wait for its result. After two renders nothing is left to compile."""

    warm_ups = 2

    def __init__(self, mi, scene, sensor, sampler, spp):
        self.mi, self.scene, self.spp, self.name = mi, scene, spp, f"Mitsuba, {sampler}"
        self.sensor = mi.load_dict({**sensor, "sampler": {"type": sampler, "sample_count": spp}})

    def run(self, seed):
        import drjit as dr
        cpu, wall = cpu_now(), time.perf_counter()
        image = self.mi.render(self.scene, sensor=self.sensor, spp=self.spp, seed=seed)
        dr.eval(image)
        dr.sync_thread()
        cpu, wall = cpu_now() - cpu, time.perf_counter() - wall
        # multijitter needs a product of two nearly equal numbers: a few samples more
        return Lap(np.array(image)[..., :3].astype(float), cpu, wall, self.sensor.sampler().sample_count())


class Eclat:
    """Runs a process for each render. Its seconds are the report's rendering time, without set-up and compiling."""

    warm_ups = 1

    def __init__(self, mi, program, scene, options, folder, name):
        self.mi, self.program, self.name = mi, program, name
        self.options, self.file = [scene, *options], os.path.join(folder, "eclat.exr")

    def run(self, seed):
        report = common.run_eclat(self.program, self.options + ["--seed", str(seed), "-o", self.file])
        bitmap = self.mi.Bitmap(self.file)
        names = [field.name for field in bitmap.struct_()]
        pixels = np.array(bitmap)
        at = lambda *channels: pixels[..., [names.index(c) for c in channels]].astype(float)
        error = at("stderr.Y")[..., 0] ** 2 if "stderr.Y" in names else None
        return Lap(at("R", "G", "B"), report["cpu_seconds"], report["seconds"], report["samples"] / pixels[..., 0].size, report["error"], error)

"""AMD: compiles with clang to assembly, and reads LLVM's figures from its comments and metadata."""
import os
import re
import time

from clang import compile_to
from table import Row

WAVES = {"gfx906": 10, "gfx1030": 16, "gfx1100": 16}  # waves that a SIMD unit holds
FIELDS = re.compile(r"^\s+\.(name|private_segment_fixed_size|vgpr_count|vgpr_spill_count|sgpr_spill_count):\s+(\S+)", re.M)
FUNCTION = re.compile(r"^(ec_\w+):(.*?); codeLenInByte = (\d+).*?; Occupancy: (\d+)", re.M | re.S)
# One atomic operation for all lanes of a wavefront that add to the same word. The later LLVM of the drivers does this by default.
JOINS_ATOMICS = ("-mllvm", "-amdgpu-atomic-optimizations=true")


def kernels_of(metadata):
    """Yields the fields of each kernel. Keys are in alphabetical order: the kernel's name comes before its registers, but after its arguments' names."""
    kernel = {}
    for key, value in FIELDS.findall(metadata):
        kernel[key] = value
        if key == "vgpr_spill_count":
            yield kernel
            kernel = {}


def compile_source(target, source, tools, folder):
    start = time.monotonic()
    text = compile_to(os.path.join(folder, "k.s"), source, tools, "amdgcn-amd-amdhsa", "-S", f"-mcpu={target}", "-nogpulib",
                      *JOINS_ATOMICS, library="amdgcn--amdhsa.bc")
    seconds = time.monotonic() - start
    code = {name: (int(size), int(waves), body.count("global_atomic_add") - body.count("v_mbcnt_lo"))
            for name, body, size, waves in FUNCTION.findall(text)}
    rows = []
    for kernel in kernels_of(text[text.rindex("amdhsa.kernels:"):]):
        # Spilled scalars go to lanes of vector registers, and to memory only if those are spilled too.
        spilled = 4 * int(kernel["vgpr_spill_count"])
        size, waves, lane_atomics = code[kernel["name"]]
        rows.append(Row(target, kernel["name"], source, registers=int(kernel["vgpr_count"]), spill_bytes=spilled,
                        private_bytes=max(0, int(kernel["private_segment_fixed_size"]) - spilled), occupancy=waves / WAVES[target],
                        code_bytes=size, lane_atomics=lane_atomics, compile_seconds=seconds))
    return rows

"""NVIDIA: compiles with clang to PTX, and with ptxas to machine code."""
import os
import re
import time

import elf
from clang import CompileError, compile_to, first_error
from table import Row

PTX_OF = "sm_75"      # the target that clang 15 writes for; every later card takes it, and ptxas is told the card
PTX_VERSION = "7.8"   # version of the language that sm_90 needs
WARPS = {"sm_75": 32, "sm_90": 64}  # warps that a multiprocessor holds
REGISTERS, WARP, GRANULE, WARP_GRANULE = 65536, 32, 256, 4
ENTRY = re.compile(r"Compiling entry function '(\w+)'.*?(\d+) bytes stack frame, (\d+) bytes spill stores, \d+ bytes spill loads.*?Used (\d+) registers", re.S)


def occupancy(target, registers):
    warps = REGISTERS // (-(-registers * WARP // GRANULE) * GRANULE) // WARP_GRANULE * WARP_GRANULE
    return min(warps, WARPS[target]) / WARPS[target]


def compile_source(target, source, tools, folder):
    start = time.monotonic()
    ptx, cubin = os.path.join(folder, "k.ptx"), os.path.join(folder, "k.cubin")
    text = compile_to(ptx, source, tools, "nvptx64-unknown-nvidiacl", "-S", "-Xclang", "-target-cpu", "-Xclang", PTX_OF,
                      library="nvptx64--nvidiacl.bc")
    text = re.sub(r"(?m)^\.version.*$", f".version {PTX_VERSION}", re.sub(r"(?m)^\.target.*$", f".target {target}", text))
    with open(ptx, "w", encoding="utf-8") as file:
        file.write(text)
    run = tools.run("ptxas", "-v", f"-arch={target}", ptx, "-o", cubin)
    if run.returncode:
        raise CompileError(first_error(run))
    seconds = time.monotonic() - start
    code = elf.sections(cubin)
    # A frame holds both spills and arrays.
    return [Row(target, name, source, registers=int(registers), spill_bytes=int(spilled), private_bytes=max(0, int(frame) - int(spilled)),
                occupancy=occupancy(target, int(registers)), code_bytes=code.get(".text." + name), compile_seconds=seconds)
            for name, frame, spilled, registers in ENTRY.findall(run.stdout + run.stderr)]

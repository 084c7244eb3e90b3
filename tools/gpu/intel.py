"""Intel: compiles with ocloc. Its disassembler writes out what the driver is told about each kernel."""
import glob
import os
import re
import struct
import time

from clang import CompileError, first_error
from table import Row

DEVICES = {"tgllp": "tgllp", "dg2": "dg2-g10"}
REGISTERS, BYTES = 128, 32  # registers of a thread; bytes of a register
SPILLED = re.compile(r"kernel (\w+)\s+compiled SIMD(\d+) allocated \d+ regs and spilled around (\d+)")
TOKEN = re.compile(r"Token (\d+)\s+4 Size \d+\s+Hex ([0-9a-f ]+)")
SCRATCH, ENVIRONMENT, PRIVATE = 18, 23, 38  # tokens of NEO's patch list: MEDIA_VFE_STATE, EXECUTION_ENVIRONMENT, ALLOCATE_STATELESS_PRIVATE_MEMORY


def patches(text):
    """Returns {token: its words} of one kernel."""
    found = {}
    for token, digits in TOKEN.findall(text):
        data = bytes(int(byte, 16) for byte in digits.split())
        found.setdefault(int(token), struct.unpack(f"<{len(data) // 4}I", data[:len(data) // 4 * 4]))
    return found


def compile_source(target, source, tools, folder):
    start = time.monotonic()
    work = os.path.join(folder, "intel")
    for old in glob.glob(os.path.join(work, "**", "*.*"), recursive=True):
        os.remove(old)
    os.makedirs(os.path.join(work, "parts"), exist_ok=True)
    run = tools.run("ocloc", "compile", "-file", source.path, "-device", DEVICES[target], "-options", " ".join(source.options), "-out_dir", work)
    binary = glob.glob(os.path.join(work, "*.bin"))
    if run.returncode or not binary:
        raise CompileError(first_error(run))
    seconds = time.monotonic() - start
    spills = {name: int(count) * BYTES // int(width) for name, width, count in SPILLED.findall(run.stdout + run.stderr)}
    told = tools.run("ocloc", "disasm", "-file", binary[0], "-device", DEVICES[target], "-dump", os.path.join(work, "parts"))
    if told.returncode:
        raise CompileError(first_error(told))
    with open(os.path.join(work, "parts", "PTM.txt"), encoding="utf-8") as file:
        parts = re.split(r"KernelName (\w+)", file.read())
    rows = []
    for before, name, text in zip(parts[0::2], parts[1::2], parts[2::2]):
        patch = patches(text)
        width = patch[ENVIRONMENT][3]  # work-items per thread
        spilled, (_, _, _, private, of_item) = spills.get(name, 0), patch.get(PRIVATE, (0, 0, 0, 0, 1))
        scratch = max(patch.get(SCRATCH, (0, 0))[1] // width, private if of_item else private // width)  # the scratch size is rounded up to a power of two
        size = int(re.findall(r"KernelUnpaddedSize (\d+)", before)[-1])
        rows.append(Row(target, name, source, registers=REGISTERS * BYTES // 4 // width, spill_bytes=spilled, private_bytes=max(0, scratch - spilled),
                        code_bytes=size, compile_seconds=seconds))
    return rows

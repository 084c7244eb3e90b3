"""SPIR-V, which rusticl and others take: checks that it is valid OpenCL 1.2 and, with sub-groups, valid SPIR-V 1.3. Not optimised, since the
translator would write loop hints that OpenCL lacks."""
import os
import re
import time

from clang import CompileError, compile_to, first_error
from table import Row

# Versions of SPIR-V, what they are checked against, and the options of the kernels.
FORMS = [("1.0", "opencl1.2", []), ("1.3", "spv1.3", ["-DSUBGROUPS", "-Dcl_khr_subgroup_ballot=1"])]


def compile_source(target, source, tools, folder):
    start = time.monotonic()
    text, bitcode, binary = (os.path.join(folder, "k." + end) for end in ("ll", "bc", "spv"))
    for version, environment, options in FORMS:
        compile_to(bitcode, source, tools, "spir64-unknown-unknown", "-emit-llvm", "-c", "-w", *options, optimise="-O0")
        for run in (tools.run("llvm-spirv", f"--spirv-max-version={version}", "-o", binary, bitcode),
                    tools.run("spirv-val", "--target-env", environment, binary), tools.run("llvm-spirv", "-to-text", "-o", text, binary)):
            if run.returncode:
                raise CompileError(first_error(run))
    with open(text, encoding="utf-8", errors="replace") as file:
        names = re.findall(r'^\d+ EntryPoint 6 \d+ "(\w+)"', file.read(), re.M)
    return [Row(target, name, source, compile_seconds=time.monotonic() - start) for name in names]

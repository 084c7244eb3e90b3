"""Compiles OpenCL C with clang and libclc, for libclc's targets."""
import os

FOLDED = {"-cl-std=CL1.2"}  # given below anyway


class CompileError(Exception):
    pass


def first_error(run):
    lines = (run.stderr + run.stdout).strip().splitlines()
    return next((line for line in lines if "error" in line.lower()), lines[0] if lines else f"exit code {run.returncode}")


def compile_to(output, source, tools, triple, *options, library=None, optimise="-O3"):
    arguments = ["-x", "cl", "-cl-std=CL1.2", "-Xclang", "-finclude-default-header", optimise, f"--target={triple}", *options,
                 *(option for option in source.options if option not in FOLDED), "-o", output, source.path]
    if library:
        arguments[:0] = ["-Xclang", "-mlink-builtin-bitcode", "-Xclang", os.path.join(tools.paths["libclc"], library)]
    run = tools.run("clang", *arguments)
    if run.returncode:
        raise CompileError(first_error(run))
    with open(output, encoding="utf-8", errors="replace") as file:
        return file.read()

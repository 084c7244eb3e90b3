"""All targets, each with the function that compiles a source for it: from (target, source, tools, folder) to a list of rows."""
import amd
import intel
import nvidia
import spirv
from clang import CompileError  # exported for callers

ALL = {"sm_75": nvidia.compile_source, "sm_90": nvidia.compile_source, "gfx906": amd.compile_source, "gfx1030": amd.compile_source,
       "gfx1100": amd.compile_source, "tgllp": intel.compile_source, "dg2": intel.compile_source, "spirv": spirv.compile_source}
__all__ = ["ALL", "CompileError"]

/* Tells how this library was built, and which of its modules are installed. */
#include <limits.h>

#include "base/module.h"
#include "cl/cl.h"
#include "lib/internal.h"

#if defined __clang__
#define COMPILER "Clang " __clang_version__
#else
#define COMPILER "GCC " __VERSION__
#endif

#if defined __x86_64__
#define PROCESSOR "x86-64"
#elif defined __aarch64__
#define PROCESSOR "AArch64"
#else
#define PROCESSOR "another processor"
#endif

#if CL_TARGET_OPENCL_VERSION == 120
#define OPENCL "1.2"
#else
#error "name the version of OpenCL here"
#endif

static bool is_there(const char *module)
{
    char path[PATH_MAX];
    return ec_module_find(module, path, NULL) == EC_OK;
}

static const char *modules(void)
{
    static const char *const texts[] = {"none", "view", "mpi", "mpi, view"};
    return texts[is_there("eclat-view.so") + 2 * is_there("eclat-mpi.so")];
}

eclat_note eclat_build_at(size_t i)
{
    static const char *const terms[] = {"compiler", "OpenCL", "readers", "modules"};
    const char *const texts[] = {COMPILER ", " ECLAT_BUILD_TYPE " for " PROCESSOR, OPENCL, ECLAT_READERS, modules()};
    if (i >= sizeof terms / sizeof terms[0]) return (eclat_note){0};
    return (eclat_note){.heading = "Build", .term = terms[i], .text = texts[i]};
}

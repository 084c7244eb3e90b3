/* The table of drivers that need something else. A row goes when the driver is mended; `seen` says what to try.
 *
 * PoCL compiles a kernel at its first launch, for the local size of that launch, and keeps the result in its own cache below
 * XDG_CACHE_HOME. Asking it for binaries compiles every kernel once more, for any local size, which takes as long as the first
 * launches did (the sketch's five kernels: 1.2-1.5 s), and the result lacks what launches use unless they ran before. Warm, its
 * cache is as good: 0.03-0.05 s instead of 0.01 s. It compiles under one lock for the process, so threads do not help, nor do
 * contexts, and each program more costs 0.1-0.2 s: see ec_kernel_sources_join. It reads its header of built-in functions, 0.9 MB,
 * for each program and in every run; _OPENCL_H_, the header's guard, keeps it out (in 3.1, and in the newest source).
 *
 * rusticl was still busy with kernels of eight lanes after five minutes of processor time. It ends the process over a binary that it
 * does not know, and has a cache of its own.
 *
 * Of Intel's runtime and llvmpipe tests/kernel/test_rounding.c has seen that they round division and square root correctly. */
#include "cl/workarounds.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const ec_workaround workarounds[] = {
    {"PoCL", "3.1, 2026-11", "its binaries lack what launches need", .source_only = true, .compiles_late = true, .slow_header = true},
    {"Oclgrind", "21.10, 2026-11", "it names lines of the source; what inactive lanes read counts as uninitialised once another part of the buffer is written",
     .source_only = true, .no_touch = true},
    {"rusticl", "Mesa 22.3.6, 2026-11", "its compiler takes gigabytes and many minutes for kernels of more than one lane", .most_lanes = 1,
     .source_only = true, .rounds = true},
    {"Intel(R) OpenCL", "2026.22.10, 2026-11", "it rounds correctly but does not say so; its compiler for cards joins the atomic operations of work-items in step",
     .rounds = true, .no_subgroups = true},
};

enum { ROWS = sizeof workarounds / sizeof *workarounds };

/* Returns the row that ECLAT_WORKAROUND names, so that drivers that are not at hand can be tried; NULL: each driver has its own. */
static const char *forced(void)
{
    const char *name = getenv("ECLAT_WORKAROUND");
    return name && *name ? name : NULL;
}

static const ec_workaround *row_named(const char *name)
{
    for (size_t i = 0; i < ROWS; i++)
        if (!strcasecmp(name, workarounds[i].driver)) return &workarounds[i];
    return NULL;
}

ec_result ec_workaround_check(ec_error *err)
{
    char names[256] = "";
    if (!forced() || !strcasecmp(forced(), "none") || row_named(forced())) return EC_OK;
    for (size_t i = 0; i < ROWS; i++) snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i ? ", " : "", workarounds[i].driver);
    return ec_fail(err, "ECLAT_WORKAROUND=%s: must be %s or none", forced(), names);
}

const ec_workaround *ec_workaround_for(const ec_device_info *device)
{
    if (forced()) return row_named(forced());
    for (size_t i = 0; i < ROWS; i++)
        if (strstr(device->platform_name, workarounds[i].driver) || strstr(device->platform_version, workarounds[i].driver))
            return &workarounds[i];
    return NULL;
}

bool ec_compiles_late(const ec_device_info *device)
{
    const ec_workaround *driver = ec_workaround_for(device);
    return driver && driver->compiles_late;
}

const char *ec_builtin_options(const ec_device_info *device)
{
    const ec_workaround *driver = ec_workaround_for(device);
    return driver && driver->slow_header ? " -D_OPENCL_H_ -DEC_OWN_BUILTINS" : "";
}

bool ec_device_rounds(const ec_device_info *device)
{
    const ec_workaround *driver = ec_workaround_for(device);
    return device->correctly_rounded_divide_sqrt || (driver && driver->rounds);
}

bool ec_device_joins(const ec_device_info *device)
{
    const ec_workaround *driver = ec_workaround_for(device);
    return device->subgroup_ballot && !(device->type & CL_DEVICE_TYPE_CPU) && !(driver && driver->no_subgroups);
}

void ec_device_drivers(const ec_device_info *devices, uint32_t count, char *text, size_t size)
{
    text[0] = 0;
    for (uint32_t i = 0; i < count; i++) {
        char one[520];
        const size_t used = strlen(text);
        snprintf(one, sizeof one, "%s (%s)", devices[i].name, devices[i].driver);
        if (!strstr(text, one)) snprintf(text + used, size - used, "%s%s", used ? " + " : "", one);
    }
}

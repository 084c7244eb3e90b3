/* Builds programs from source, through the binary cache unless the driver needs the source (cl/workarounds.c). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "cl/ahead.h"
#include "cl/build_log.h"
#include "cl/cache.h"
#include "cl/kept.h"
#include "cl/workarounds.h"

typedef struct build {
    const ec_cl *cl;
    const char *label, *source;
    char *options;       /* with the flags added */
    char folder[4096];   /* of the cache; "" = none */
    ec_cache_key key;
} build;

static bool driver_needs_source(const ec_device_info *info)
{
    const ec_workaround *w = ec_workaround_for(info);
    return w && w->source_only;
}

static char *all_options(const ec_device_info *info, const char *options)
{
    const char *standard = "-cl-std=CL1.2";
    const char *divide = info->correctly_rounded_divide_sqrt && !strstr(options, EC_FAST_MATH)
                             ? " -cl-fp32-correctly-rounded-divide-sqrt"
                             : "";
    size_t size = strlen(options) + strlen(standard) + strlen(divide) + 2;
    char *all = malloc(size);
    if (all) snprintf(all, size, "%s%s%s%s", standard, divide, *options ? " " : "", options);
    return all;
}

/* Returns false on a miss: nothing in the cache, or a driver that does not take it (any more). */
static bool build_from_cache(build *b, cl_program *program)
{
    unsigned char *binary;
    size_t bytes;
    if (!*b->folder || !ec_cache_load(b->folder, &b->key, &binary, &bytes)) return false;
    cl_device_id device = b->cl->info.id;
    cl_int status = CL_SUCCESS, code;
    cl_program made = clCreateProgramWithBinary(b->cl->context, 1, &device, &bytes, (const unsigned char **)&binary,
                                                &status, &code);
    free(binary);
    if (code == CL_SUCCESS && status == CL_SUCCESS &&
        clBuildProgram(made, 1, &device, b->options, NULL, NULL) == CL_SUCCESS) {
        *program = made;
        return true;
    }
    if (code == CL_SUCCESS) clReleaseProgram(made);
    return false;
}

static ec_result build_from_source(const build *b, cl_program *program, ec_error *err)
{
    cl_int code;
    cl_program made = clCreateProgramWithSource(b->cl->context, 1, (const char **)&b->source, NULL, &code);
    EC_TRY(ec_cl_check(code, "clCreateProgramWithSource", b->label, err));
    code = clBuildProgram(made, 1, &b->cl->info.id, b->options, NULL, NULL);
    char *log = ec_build_log(b->cl, made);
    ec_result result = ec_build_log_dump(b->label, b->source, b->options, log, err);
    if (code != CL_SUCCESS) result = ec_build_log_fail(b->cl, b->label, b->source, log, code, err);
    if (result == EC_OK) *program = made;
    else clReleaseProgram(made);
    free(log);
    return result;
}

ec_result ec_program_build_source(const ec_cl *cl, const char *label, const char *source, const char *options, cl_program *program, ec_error *err)
{
    build b = {.cl = cl, .label = label, .source = source, .options = all_options(&cl->info, options)};
    ec_result result = b.options ? build_from_source(&b, program, err) : ec_fail(err, "out of memory while building kernels %s", label);
    free(b.options);
    return result;
}

/* Stores the binary. A cache that cannot be written costs time at the next start, nothing else. */
static void store(const build *b, cl_program program)
{
    size_t bytes = 0;
    if (clGetProgramInfo(program, CL_PROGRAM_BINARY_SIZES, sizeof bytes, &bytes, NULL) != CL_SUCCESS || bytes == 0)
        return;
    unsigned char *binary = malloc(bytes);
    if (binary && clGetProgramInfo(program, CL_PROGRAM_BINARIES, sizeof binary, &binary, NULL) == CL_SUCCESS)
        ec_cache_store(b->folder, &b->key, binary, bytes);
    free(binary);
}

ec_result ec_program_build(ec_cl *cl, const char *label, const char *source, const char *options, cl_program *program,
                           ec_error *err) {
    *program = NULL;
    double start = ec_now();
    build b = {.cl = cl, .label = label, .source = source, .options = all_options(&cl->info, options ? options : "")};
    if (!b.options) return ec_fail(err, "out of memory while building kernels %s", label);
    bool use = cl->cache == EC_CACHE_ON || (cl->cache == EC_CACHE_AUTO && !driver_needs_source(&cl->info));
    if (!use || !ec_cache_folder(cl->cache_dir, b.folder, sizeof b.folder)) b.folder[0] = 0;
    if (*b.folder || cl->keeps_programs) b.key = ec_cache_key_of(&cl->info, source, b.options);
    bool dump = ec_build_log_wanted();
    ec_result result = EC_OK;
    cl_program kept = cl->keeps_programs ? ec_kept_find(cl, &b.key) : NULL;
    if (kept) {
        if (clRetainProgram(kept) == CL_SUCCESS) *program = kept, cl->programs_found++;
        else result = ec_fail(err, "cannot retain kernels %s", label);
    } else if (ec_ahead_take(cl, source, options ? options : "", program, err)) {
        result = *program ? EC_OK : EC_FAILED;
    } else if (!dump && build_from_cache(&b, program)) {
        cl->cache_hits++;
    } else {
        result = build_from_source(&b, program, err);
        if (*b.folder) cl->cache_misses++;
        if (result == EC_OK && *b.folder) store(&b, *program);
    }
    if (cl->keeps_programs && !kept && result == EC_OK) ec_kept_add(cl, &b.key, *program);
    free(b.options);
    cl->build_seconds += ec_now() - start;
    return result;
}

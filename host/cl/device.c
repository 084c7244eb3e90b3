/* Lists devices and what they can do, and chooses one. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cl/cl.h"
#include "cl/drivers.h"
#include "cl/workarounds.h"

#define EC_PLATFORM_NOT_FOUND_KHR (-1001) /* the ICD loader's code if no driver is installed */
#define EC_INSTALL_HINT "install a driver, for instance for the CPU: apt-get install pocl-opencl-icd, or with Python and without root: pip install eclat[cpu]"

/* Drivers pad names with spaces (Intel in front, NVIDIA behind). */
static void trim(char *text)
{
    size_t start = strspn(text, " \t\n"), length = strlen(text + start);
    memmove(text, text + start, length + 1);
    while (length && isspace((unsigned char)text[length - 1])) text[--length] = 0;
}

/* Texts that do not fit are cut; a query that fails leaves "". */
static void device_text(cl_device_id device, cl_device_info what, char text[256])
{
    char all[4096] = "";
    if (clGetDeviceInfo(device, what, sizeof all, all, NULL) != CL_SUCCESS) all[0] = 0;
    snprintf(text, 256, "%.255s", all);
    trim(text);
}

static void platform_text(cl_platform_id platform, cl_platform_info what, char text[256])
{
    char all[4096] = "";
    if (clGetPlatformInfo(platform, what, sizeof all, all, NULL) != CL_SUCCESS) all[0] = 0;
    snprintf(text, 256, "%.255s", all);
    trim(text);
}

/* Returns whether the device lists an extension. */
static bool has_extension(cl_device_id device, const char *name)
{
    size_t size = 0;
    if (clGetDeviceInfo(device, CL_DEVICE_EXTENSIONS, 0, NULL, &size) != CL_SUCCESS || !size) return false;
    char *all = calloc(1, size + 1), *rest = NULL;
    bool found = false;
    if (all && clGetDeviceInfo(device, CL_DEVICE_EXTENSIONS, size, all, NULL) != CL_SUCCESS) all[0] = 0;
    for (char *word = all ? strtok_r(all, " ", &rest) : NULL; word && !found; word = strtok_r(NULL, " ", &rest)) found = !strcmp(word, name);
    free(all);
    return found;
}

/* The value must have exactly the size the standard gives it; 0 where the query fails. */
#define DEVICE_NUMBER(device, what, type, to)                                                      \
    do {                                                                                           \
        type number = 0;                                                                           \
        if (clGetDeviceInfo(device, what, sizeof number, &number, NULL) != CL_SUCCESS) number = 0; \
        (to) = number;                                                                             \
    } while (0)

/* Sets the type that ECLAT_DEVICE_TYPE gives to all devices, so that what is done on cards can be tried on processors; 0: each has its own. */
static ec_result forced_type(cl_device_type *type, ec_error *err)
{
    static const struct { const char *name; cl_device_type type; } types[] = {
        {"cpu", CL_DEVICE_TYPE_CPU}, {"gpu", CL_DEVICE_TYPE_GPU}, {"accel", CL_DEVICE_TYPE_ACCELERATOR}};
    const char *name = getenv("ECLAT_DEVICE_TYPE");
    *type = 0;
    if (!name || !*name) return EC_OK;
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (!strcasecmp(name, types[i].name)) *type = types[i].type;
    return *type ? EC_OK : ec_fail(err, "ECLAT_DEVICE_TYPE=%s: must be cpu, gpu or accel", name);
}

static void describe(cl_platform_id platform, cl_device_id device, ec_device_info *info)
{
    memset(info, 0, sizeof *info);
    info->platform = platform;
    info->id = device;
    device_text(device, CL_DEVICE_NAME, info->name);
    device_text(device, CL_DEVICE_VENDOR, info->vendor);
    device_text(device, CL_DEVICE_VERSION, info->version);
    device_text(device, CL_DRIVER_VERSION, info->driver);
    device_text(device, CL_DEVICE_OPENCL_C_VERSION, info->c_version);
    platform_text(platform, CL_PLATFORM_NAME, info->platform_name);
    platform_text(platform, CL_PLATFORM_VERSION, info->platform_version);
    DEVICE_NUMBER(device, CL_DEVICE_TYPE, cl_device_type, info->type);
    DEVICE_NUMBER(device, CL_DEVICE_MAX_COMPUTE_UNITS, cl_uint, info->compute_units);
    DEVICE_NUMBER(device, CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT, cl_uint, info->native_float_width);
    DEVICE_NUMBER(device, CL_DEVICE_GLOBAL_MEM_SIZE, cl_ulong, info->memory_bytes);
    DEVICE_NUMBER(device, CL_DEVICE_MAX_MEM_ALLOC_SIZE, cl_ulong, info->max_allocation_bytes);
    DEVICE_NUMBER(device, CL_DEVICE_GLOBAL_MEM_CACHE_SIZE, cl_ulong, info->cache_bytes);
    DEVICE_NUMBER(device, CL_DEVICE_LOCAL_MEM_SIZE, cl_ulong, info->local_bytes);
    DEVICE_NUMBER(device, CL_DEVICE_MAX_WORK_GROUP_SIZE, size_t, info->max_work_group_size);
    DEVICE_NUMBER(device, CL_DEVICE_AVAILABLE, cl_bool, info->available);
    DEVICE_NUMBER(device, CL_DEVICE_COMPILER_AVAILABLE, cl_bool, info->compiler_available);
    info->subgroup_ballot = has_extension(device, "cl_khr_subgroup_ballot");
    cl_device_fp_config fp;
    DEVICE_NUMBER(device, CL_DEVICE_SINGLE_FP_CONFIG, cl_device_fp_config, fp);
    info->correctly_rounded_divide_sqrt = fp & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT;
    info->denormals = fp & CL_FP_DENORM;
    info->fma = fp & CL_FP_FMA;
    info->inf_nan = fp & CL_FP_INF_NAN;
}

/* Adds the devices of one platform to the list. A platform without any is no failure. */
static ec_result add_platform(cl_platform_id platform, ec_device_info **list, uint32_t *count, ec_error *err)
{
    cl_uint found = 0;
    cl_int code = clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, NULL, &found);
    if (code != CL_SUCCESS || found == 0) return EC_OK;
    cl_device_id *ids = calloc(found, sizeof *ids);
    ec_device_info *larger = realloc(*list, (*count + found) * sizeof *larger);
    if (larger) *list = larger;
    if (!ids || !larger) {
        free(ids);
        return ec_fail(err, "out of memory while listing OpenCL devices");
    }
    code = clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, found, ids, NULL);
    if (code == CL_SUCCESS)
        for (cl_uint i = 0; i < found; i++) describe(platform, ids[i], &larger[(*count)++]);
    free(ids);
    return EC_OK;
}

ec_result ec_devices_list(ec_device_info **devices, uint32_t *count, ec_error *err)
{
    *devices = NULL;
    *count = 0;
    cl_platform_id platforms[64];
    cl_device_type type;
    cl_uint found = 0;
    EC_TRY(forced_type(&type, err));
    EC_TRY(ec_workaround_check(err));
    cl_int code = clGetPlatformIDs(64, platforms, &found);
    if (code == EC_PLATFORM_NOT_FOUND_KHR || (code == CL_SUCCESS && found == 0)) {
        char unnamed[256];
        if (ec_drivers_explain(err)) return EC_FAILED;
        return ec_fail(err, "no OpenCL driver is installed; %s", ec_drivers_unnamed(unnamed, sizeof unnamed) ? unnamed : EC_INSTALL_HINT);
    }
    EC_TRY(ec_cl_check(code, "clGetPlatformIDs", NULL, err));
    ec_result result = EC_OK;
    for (cl_uint i = 0; i < found && i < 64 && result == EC_OK; i++)
        result = add_platform(platforms[i], devices, count, err);
    for (uint32_t i = 0; type && i < *count; i++) (*devices)[i].type = type;
    if (result == EC_OK && *count == 0)
        result = ec_fail(err, "the installed OpenCL driver (%u platform%s) offers no device; PoCL needs a writable folder, "
                              "which POCL_CACHE_DIR=FOLDER names, and enough memory and open files (ulimit -a); otherwise " EC_INSTALL_HINT, (unsigned)found, found == 1 ? "" : "s");
    if (result != EC_OK) {
        free(*devices);
        *devices = NULL;
        *count = 0;
    }
    return result;
}

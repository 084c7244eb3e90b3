#include "report/device_report.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "cl/workarounds.h"
#include "report/format.h"
#include "report/json.h"

static const char *type_name(cl_device_type type)
{
    if (type & CL_DEVICE_TYPE_GPU) return "GPU";
    if (type & CL_DEVICE_TYPE_CPU) return "CPU";
    if (type & CL_DEVICE_TYPE_ACCELERATOR) return "accel";
    return "other";
}

/* "OpenCL 3.0 PoCL HSTR: ..." -> "3.0" */
static void short_version(const char *version, char *text, size_t size)
{
    if (!strncmp(version, "OpenCL ", 7)) version += 7;
    snprintf(text, size, "%.*s", (int)strcspn(version, " "), version);
}

static const char *yes(bool value) { return value ? "yes" : "no"; }

static void print_row(const ec_device_report *report, uint32_t i, int name_width, FILE *to)
{
    const ec_device_info *device = &report->devices[i];
    char version[16];
    short_version(device->version, version, sizeof version);
    fprintf(to, "%c %2u  %-*s  %-5s  %-6s  %5u  %5u  %10s  %10s  %-9s  %-9s  %-3s  %s%s\n",
            report->chosen == (int64_t)i ? '*' : ' ', i, name_width, device->name, type_name(device->type),
            version, device->compute_units, device->native_float_width, ec_bytes(device->memory_bytes).text,
            ec_bytes(device->max_allocation_bytes).text,
            yes(device->correctly_rounded_divide_sqrt), yes(device->denormals), yes(device->fma), yes(ec_device_joins(device)),
            !device->available ? "  (not available)" : !device->compiler_available ? "  (no compiler)" : "");
}

void ec_device_report_text(const ec_device_report *report, FILE *to)
{
    int width = 4;
    for (uint32_t i = 0; i < report->count; i++) {
        int size = (int)strlen(report->devices[i].name);
        if (size > width) width = size;
    }
    fprintf(to, "   #  %-*s  %-5s  OpenCL  units  lanes  %10s  %10s  exact div  denormals  fma  sub-groups\n", width, "name", "type",
            "memory", "max alloc");
    for (uint32_t i = 0; i < report->count; i++) print_row(report, i, width, to);
    if (report->chosen >= 0)
        fprintf(to, "* default: %" PRId64 " (%s); --device or ECLAT_DEVICE chooses another\n", report->chosen, report->why);
}

cJSON *ec_device_json(const ec_device_info *device, uint32_t index)
{
    cJSON *object = cJSON_CreateObject();
    EC_JSON(object, EC_WHOLE("index", index), EC_STRING("name", device->name), EC_STRING("type", type_name(device->type)),
            EC_STRING("vendor", device->vendor), EC_STRING("version", device->version), EC_STRING("c_version", device->c_version),
            EC_STRING("driver", device->driver), EC_STRING("platform", device->platform_name), EC_STRING("platform_version", device->platform_version),
            EC_WHOLE("compute_units", device->compute_units), EC_WHOLE("native_float_width", device->native_float_width),
            EC_WHOLE("memory_bytes", device->memory_bytes), EC_WHOLE("max_allocation_bytes", device->max_allocation_bytes),
            EC_WHOLE("cache_bytes", device->cache_bytes), EC_WHOLE("local_bytes", device->local_bytes),
            EC_WHOLE("max_work_group_size", device->max_work_group_size),
            EC_FLAG("correctly_rounded_divide_sqrt", device->correctly_rounded_divide_sqrt), EC_FLAG("denormals", device->denormals),
            EC_FLAG("fma", device->fma), EC_FLAG("inf_nan", device->inf_nan), EC_FLAG("subgroup_ballot", device->subgroup_ballot),
            EC_FLAG("uses_subgroups", ec_device_joins(device)), EC_FLAG("available", device->available),
            EC_FLAG("compiler_available", device->compiler_available));
    return object;
}

ec_result ec_device_report_json(const ec_device_report *report, FILE *to, ec_error *err)
{
    cJSON *root = cJSON_CreateObject();
    cJSON *devices = cJSON_AddArrayToObject(root, "devices");
    for (uint32_t i = 0; i < report->count; i++)
        cJSON_AddItemToArray(devices, ec_device_json(&report->devices[i], i));
    ec_json_real(root, "default", report->chosen >= 0 ? (double)report->chosen : NAN);
    ec_json_text(root, "why", report->why);
    return ec_json_print(root, to, err);
}

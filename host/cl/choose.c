/* The rule by which one device of the list is taken. Pure: tests hand it lists that no machine has. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cl/cl.h"

static bool contains(const char *text, const char *part)
{
    size_t length = strlen(part);
    for (; *text; text++)
        if (strncasecmp(text, part, length) == 0) return true;
    return false;
}

static bool usable(const ec_device_info *device) { return device->available && device->compiler_available; }

/* "0: pthread-AMD EPYC, 1: NVIDIA H200": what there is, for a message. */
static void list_names(const ec_device_info *devices, uint32_t count, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (uint32_t i = 0; i < count && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%u: %s", i ? ", " : "", i, devices[i].name);
}

/* A number is an index if there is one like it, else part of a name such as "3090". The platform's name counts too, but
 * after the devices' own: "pocl" and "intel" mean something to users. */
static bool find(const ec_device_info *devices, uint32_t count, const char *id, uint32_t *index)
{
    char *end;
    unsigned long number = strtoul(id, &end, 10);
    if (id[0] >= '0' && id[0] <= '9' && *end == 0 && number < count) {
        *index = (uint32_t)number;
        return true;
    }
    for (*index = 0; *index < count; ++*index)
        if (contains(devices[*index].name, id)) return true;
    for (*index = 0; *index < count; ++*index)
        if (contains(devices[*index].platform_name, id) || contains(devices[*index].platform_version, id)) return true;
    return false;
}

static bool first_of(const ec_device_info *devices, uint32_t count, cl_device_type type, uint32_t *index)
{
    for (*index = 0; *index < count; ++*index)
        if ((devices[*index].type & type) && usable(&devices[*index])) return true;
    return false;
}

ec_result ec_device_choose(const ec_device_info *devices, uint32_t count, const char *id, uint32_t *index,
                           const char **why, ec_error *err) {
    const char *from = "--device", *unused;
    if (!why) why = &unused;
    if (!id || !*id) {
        id = getenv("ECLAT_DEVICE");
        from = "ECLAT_DEVICE";
    }
    if (id && *id) {
        if (!find(devices, count, id, index)) {
            char names[1024];
            list_names(devices, count, names, sizeof names);
            return ec_fail(err, "%s %s: no such device; there %s %s (an index or a part of the name)", from, id,
                           count == 1 ? "is" : "are", names);
        }
        if (!usable(&devices[*index]))
            return ec_fail(err, "%s %s: %s is not available or has no compiler; see eclat devices", from, id,
                           devices[*index].name);
        *why = from[0] == '-' ? "chosen by --device" : "chosen by ECLAT_DEVICE";
        return EC_OK;
    }
    if (first_of(devices, count, CL_DEVICE_TYPE_GPU, index)) *why = "first GPU";
    else if (first_of(devices, count, CL_DEVICE_TYPE_CPU, index)) *why = "first CPU";
    else if (first_of(devices, count, CL_DEVICE_TYPE_ALL, index)) *why = "first device";
    else return ec_fail(err, "none of the %u OpenCL devices is available and has a compiler; see eclat devices", count);
    return EC_OK;
}

ec_result ec_device_find(const char *id, ec_device_info *device, uint32_t *index, const char **why, ec_error *err)
{
    ec_device_info *devices = NULL;
    uint32_t count = 0, chosen = 0;
    EC_TRY(ec_devices_list(&devices, &count, err));
    ec_result result = ec_device_choose(devices, count, id, &chosen, why, err);
    if (result == EC_OK) *device = devices[chosen];
    if (result == EC_OK && index) *index = chosen;
    free(devices);
    return result;
}

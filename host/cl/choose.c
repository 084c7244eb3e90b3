/* The rule by which one device of the list is taken. Pure: tests hand it lists that no machine has. */
#include <ctype.h>
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

/* Lists the devices for a message: "0: pthread-AMD EPYC, 1: NVIDIA H200". */
static void list_names(const ec_device_info *devices, uint32_t count, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (uint32_t i = 0; i < count && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%u: %s", i ? ", " : "", i, devices[i].name);
}

/* Returns whether the name has this number in it, as 3090. A number of one or two digits is an index or nothing: "Ryzen 7", "8-Core". */
static bool has_number(const char *name, const char *number)
{
    const size_t length = strlen(number);
    for (size_t run; length > 2 && *(name += strcspn(name, "0123456789")); name += run) {
        run = strspn(name, "0123456789");
        if (run == length && !memcmp(name, number, run)) return true;
    }
    return false;
}

static bool has_letter(const char *text)
{
    while (*text && !isalpha((unsigned char)*text)) text++;
    return *text;
}

/* Finds a device by an index, else by a part of the name. The platform's name counts too, but after the devices' own: "pocl" and "intel" mean
 * something to users; the numbers that are in its version do not. */
static bool find(const ec_device_info *devices, uint32_t count, const char *id, uint32_t *index)
{
    const bool is_number = *id && !id[strspn(id, "0123456789")];
    unsigned long number = is_number ? strtoul(id, NULL, 10) : count;
    if (number < count) {
        *index = (uint32_t)number;
        return true;
    }
    if (!is_number && !has_letter(id)) return false;
    for (*index = 0; *index < count; ++*index)
        if (is_number ? has_number(devices[*index].name, id) : contains(devices[*index].name, id)) return true;
    for (*index = 0; !is_number && *index < count; ++*index)
        if (contains(devices[*index].platform_name, id) || contains(devices[*index].platform_version, id)) return true;
    return false;
}

static bool first_of(const ec_device_info *devices, uint32_t count, cl_device_type type, uint32_t *index)
{
    for (*index = 0; *index < count; ++*index)
        if ((devices[*index].type & type) && usable(&devices[*index])) return true;
    return false;
}

/* Returns what was asked for, and by what (*from); NULL: nothing. */
static const char *asked_for(const char *id, const char **from)
{
    *from = id && *id ? "--device" : "ECLAT_DEVICE";
    if (!id || !*id) id = getenv("ECLAT_DEVICE");
    return id && *id ? id : NULL;
}

static bool is_all(const char *id) { return !strcasecmp(id, "all"); }

/* Returns whether id is a list; a name may have a comma in it, too. */
static bool is_list(const ec_device_info *devices, uint32_t count, const char *id)
{
    uint32_t index;
    return is_all(id) || (strchr(id, ',') && !find(devices, count, id, &index));
}

enum { ID_SIZE = 256 };

/* Copies an id without the blanks around it. */
static void trim(const char *id, size_t size, char one[ID_SIZE])
{
    while (size && isspace((unsigned char)*id)) id++, size--;
    while (size && isspace((unsigned char)id[size - 1])) size--;
    snprintf(one, ID_SIZE, "%.*s", (int)size, id);
}

static ec_result choose_named(const ec_device_info *devices, uint32_t count, const char *from, const char *id,
                              uint32_t *index, ec_error *err)
{
    char names[1024];
    if (!find(devices, count, id, index)) {
        list_names(devices, count, names, sizeof names);
        return ec_fail(err, "%s %s: no such device; there %s %s (an index or a part of the name)", from, id,
                       count == 1 ? "is" : "are", names);
    }
    if (usable(&devices[*index])) return EC_OK;
    return ec_fail(err, "%s %s: %s is not available or has no compiler; see eclat devices", from, id,
                   devices[*index].name);
}

ec_result ec_device_choose(const ec_device_info *devices, uint32_t count, const char *id, uint32_t *index,
                           const char **why, ec_error *err) {
    const char *from, *unused;
    if (!why) why = &unused;
    id = asked_for(id, &from);
    if (id) {
        *why = from[0] == '-' ? "chosen by --device" : "chosen by ECLAT_DEVICE";
        if (is_list(devices, count, id))
            return ec_fail(err, "%s %s: this takes one device; only eclat render takes several; name one of them", from,
                           id);
        char one[ID_SIZE];
        trim(id, strlen(id), one);
        return choose_named(devices, count, from, one, index, err);
    }
    if (first_of(devices, count, CL_DEVICE_TYPE_GPU, index)) *why = "first GPU";
    else if (first_of(devices, count, CL_DEVICE_TYPE_CPU, index)) *why = "first CPU";
    else if (first_of(devices, count, CL_DEVICE_TYPE_ALL, index)) *why = "first device";
    else return ec_fail(err, "none of the %u OpenCL devices is available and has a compiler; see eclat devices", count);
    return EC_OK;
}

static ec_result choose_all(const ec_device_info *devices, uint32_t count, uint32_t *indices, uint32_t most,
                            uint32_t *chosen, ec_error *err)
{
    *chosen = 0;
    for (uint32_t i = 0; i < count && *chosen < most; i++)
        if (usable(&devices[i])) indices[(*chosen)++] = i;
    return *chosen ? EC_OK
                   : ec_fail(err, "none of the %u OpenCL devices is available and has a compiler; see eclat devices",
                             count);
}

static ec_result choose_next(const ec_device_info *devices, uint32_t count, const char *from, const char *list,
                             const char *id, uint32_t *indices, uint32_t most, uint32_t *chosen, ec_error *err)
{
    if (!*id)
        return ec_fail(err, "the list of devices '%s' has an empty entry; give numbers or names separated by commas",
                       list);
    if (is_all(id))
        return ec_fail(err, "the list of devices '%s' contains all; give all alone, or numbers and names", list);
    if (*chosen == most) return ec_fail(err, "the list of devices '%s' is too long; name at most %u", list, most);
    EC_TRY(choose_named(devices, count, from, id, &indices[*chosen], err));
    ++*chosen;
    return EC_OK;
}

ec_result ec_device_choose_several(const ec_device_info *devices, uint32_t count, const char *id, uint32_t *indices, uint32_t most,
                                   uint32_t *chosen, const char **why, ec_error *err)
{
    const char *from;
    const char *list = asked_for(id, &from);
    *chosen = 1;
    if (most == 1 || !list || !is_list(devices, count, list)) return ec_device_choose(devices, count, id, indices, why, err);
    if (why) *why = from[0] == '-' ? "chosen by --device" : "chosen by ECLAT_DEVICE";
    if (is_all(list)) return choose_all(devices, count, indices, most, chosen, err);
    *chosen = 0;
    for (const char *at = list, *end; at; at = *end ? end + 1 : NULL) {
        char one[ID_SIZE];
        end = at + strcspn(at, ",");
        trim(at, (size_t)(end - at), one);
        EC_TRY(choose_next(devices, count, from, list, one, indices, most, chosen, err));
    }
    return EC_OK;
}

/* Divides the memory of a device that is named several times between its queues. */
static void share_memory(const uint32_t *indices, uint32_t count, ec_device_info *devices)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t queues = 0;
        for (uint32_t k = 0; k < count; k++) queues += indices[k] == indices[i];
        devices[i].memory_bytes /= queues;
    }
}

ec_result ec_device_find_several(const char *id, ec_device_info *devices, uint32_t *indices, uint32_t most,
                                 uint32_t *chosen, const char **why, ec_error *err)
{
    ec_device_info *all = NULL;
    uint32_t count = 0;
    EC_TRY(ec_devices_list(&all, &count, err));
    ec_result result = ec_device_choose_several(all, count, id, indices, most, chosen, why, err);
    for (uint32_t i = 0; result == EC_OK && i < *chosen; i++) devices[i] = all[indices[i]];
    if (result == EC_OK) share_memory(indices, *chosen, devices);
    free(all);
    return result;
}

ec_result ec_device_find(const char *id, ec_device_info *device, uint32_t *index, const char **why, ec_error *err)
{
    uint32_t own, chosen;
    return ec_device_find_several(id, device, index ? index : &own, 1, &chosen, why, err);
}

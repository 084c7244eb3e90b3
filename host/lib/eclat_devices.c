#include <stdlib.h>

#include "cl/cl.h"
#include "lib/internal.h"

/* The list that a caller gets, together with the texts it points to. */
typedef struct device_list {
    ec_device_info *infos; /* owned */
    eclat_device devices[];
} device_list;

eclat_result eclat_devices_list(eclat_device **devices, size_t *count, eclat_error *err)
{
    ec_error why = {0};
    ec_device_info *infos = NULL;
    uint32_t found = 0;
    *devices = NULL;
    *count = 0;
    if (ec_devices_list(&infos, &found, &why) != EC_OK) return ec_lib_end(EC_FAILED, &why, err);
    device_list *list = malloc(sizeof *list + found * sizeof *list->devices);
    if (!list) {
        free(infos);
        return ec_lib_end(ec_fail(&why, "out of memory for %u devices", found), &why, err);
    }
    list->infos = infos;
    for (uint32_t i = 0; i < found; i++)
        list->devices[i] = (eclat_device){.name = infos[i].name, .vendor = infos[i].vendor, .driver = infos[i].driver, .platform = infos[i].platform_name,
                                          .memory_bytes = infos[i].memory_bytes, .compute_units = infos[i].compute_units,
                                          .is_usable = infos[i].available && infos[i].compiler_available};
    *devices = list->devices;
    *count = found;
    return ec_lib_end(EC_OK, &why, err);
}

void eclat_devices_free(eclat_device *devices)
{
    if (!devices) return;
    device_list *list = (device_list *)((char *)devices - offsetof(device_list, devices));
    free(list->infos);
    free(list);
}

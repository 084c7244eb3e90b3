/* Workarounds for drivers: the only place where eclat depends on which driver it runs on. */
#ifndef EC_CL_WORKAROUNDS_H
#define EC_CL_WORKAROUNDS_H

#include "cl/cl.h"

typedef struct ec_workaround {
    const char *driver;     /* a part of the platform's name or version */
    const char *seen;       /* version and date it was last seen with: try again when there is a newer one */
    const char *what;       /* what is wrong, for messages */
    bool source_only;       /* its programs do not go through eclat's binary cache */
    uint32_t most_lanes;    /* 0: any */
    bool compiles_late;     /* at a kernel's first launch, under one lock, into a cache that processes share */
    bool rounds;            /* divides and takes square roots correctly rounded, though it does not say so */
    bool slow_header;       /* its header of built-in functions, which has Clang's guard, is slow: kernels declare what they call
                             * (kernels/shared/builtins.h) */
    bool no_subgroups;      /* kernels of one lane do not use its sub-groups */
    bool no_touch;          /* buffers are not written to only to see whether there is memory for them */
} ec_workaround;

/* Returns the row for a device, or NULL. ECLAT_WORKAROUND=DRIVER takes that row for all devices, none takes none. */
const ec_workaround *ec_workaround_for(const ec_device_info *device);

/* Fails if ECLAT_WORKAROUND names a row that does not exist. */
ec_result ec_workaround_check(ec_error *err);

bool ec_compiles_late(const ec_device_info *device);

/* Returns build options for kernels of the pipeline: " -D…" or "". */
const char *ec_builtin_options(const ec_device_info *device);

/* Returns whether kernels of one lane, if they inline all functions, reserve places in queues once for a sub-group (kernels/lib/reserve.h). They do on a
 * device that is no processor and has cl_khr_subgroup_ballot, unless its row says otherwise. */
bool ec_device_joins(const ec_device_info *device);

/* Returns whether arithmetic gives the same bits as on other devices for which this is true. */
bool ec_device_rounds(const ec_device_info *device);

/* Writes the devices' drivers, on which that may depend: "pthread-… (3.1) + NVIDIA H100 (535.54)", each driver once. */
void ec_device_drivers(const ec_device_info *devices, uint32_t count, char *text, size_t size);

#endif

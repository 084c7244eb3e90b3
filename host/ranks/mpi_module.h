/* The functions of ranks.h that the MPI module implements, under the same names. */
#ifndef EC_RANKS_MPI_MODULE_H
#define EC_RANKS_MPI_MODULE_H

#include "ranks/ranks.h"

typedef struct ec_ranks_module {
    ec_result (*join)(ec_ranks **ranks, ec_error *err);
    ec_peers (*peers)(ec_ranks *ranks, const char *device, const char *own, bool own_round);
    void (*share_devices)(const ec_ranks *ranks, ec_device_info *devices, uint32_t *indices, uint32_t *count);
    void (*note_binding)(const ec_device_info *devices, uint32_t count, const ec_log *log);
    void (*leave)(ec_ranks *ranks);
    ec_result (*serve)(ec_ranks *ranks, const ec_log *log, ec_error *err);
} ec_ranks_module;

/* The first member of an ec_ranks. */
typedef struct ec_ranks_head {
    const ec_ranks_module *module;
    int number, count;
} ec_ranks_head;

#endif

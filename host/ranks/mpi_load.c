#include "base/module.h"
#include "ranks/mpi_module.h"

static const ec_ranks_head *head_of(const ec_ranks *ranks) { return (const ec_ranks_head *)ranks; }
static const ec_ranks_module *module_of(const ec_ranks *ranks) { return head_of(ranks)->module; }

ec_result ec_ranks_join(ec_ranks **ranks, ec_error *err)
{
    const void *symbol = NULL;
    *ranks = NULL;
    EC_TRY(ec_module_load("mpi", "this eclat has no MPI, so each of these processes would render the whole picture; install the package eclat-mpi, "
                                 "build eclat with libopenmpi-dev, or divide the samples by hand with --samples and eclat merge", &symbol, err));
    const ec_ranks_module *module = symbol;
    const ec_result result = module->join(ranks, err);
    if (*ranks) ((ec_ranks_head *)*ranks)->module = module;
    return result;
}

int ec_ranks_number(const ec_ranks *ranks) { return head_of(ranks)->number; }
int ec_ranks_count(const ec_ranks *ranks) { return head_of(ranks)->count; }

ec_peers ec_ranks_peers(ec_ranks *ranks, const char *device, const char *own, bool own_round)
{
    return module_of(ranks)->peers(ranks, device, own, own_round);
}

void ec_ranks_share_devices(const ec_ranks *ranks, ec_device_info *devices, uint32_t *indices, uint32_t *count)
{
    module_of(ranks)->share_devices(ranks, devices, indices, count);
}

void ec_ranks_note_binding(const ec_ranks *ranks, const ec_device_info *devices, uint32_t count, const ec_log *log)
{
    module_of(ranks)->note_binding(devices, count, log);
}

void ec_ranks_leave(ec_ranks *ranks)
{
    if (ranks) module_of(ranks)->leave(ranks);
}

ec_result ec_ranks_serve(ec_ranks *ranks, const ec_log *log, ec_error *err) { return module_of(ranks)->serve(ranks, log, err); }

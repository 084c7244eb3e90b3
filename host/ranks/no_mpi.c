/* In place of the rest of ranks/ in a build without MPI: then a launcher's processes cannot find one another. */
#include "ranks/ranks.h"

ec_result ec_ranks_join(ec_ranks **ranks, ec_error *err)
{
    *ranks = NULL;
    return ec_fail(err, "this eclat was built without MPI, so that each of these processes would render all of the picture: install libopenmpi-dev "
                        "and build again with -DECLAT_MPI=ON, or share the samples out by hand with --samples and eclat merge");
}

int ec_ranks_number(const ec_ranks *ranks) { return (void)ranks, 0; }
int ec_ranks_count(const ec_ranks *ranks) { return (void)ranks, 1; }
void ec_ranks_leave(ec_ranks *ranks) { (void)ranks; }
ec_result ec_ranks_serve(ec_ranks *ranks, const ec_log *log, ec_error *err) { return (void)ranks, (void)log, (void)err, EC_OK; }
ec_allies ec_ranks_allies(ec_ranks *ranks, const char *device, const char *own, bool own_round)
{
    return (void)ranks, (void)device, (void)own, (void)own_round, (ec_allies){0};
}
void ec_ranks_share_devices(const ec_ranks *ranks, ec_device_info *devices, uint32_t *indices, uint32_t *count)
{
    (void)ranks, (void)devices, (void)indices, (void)count;
}
void ec_ranks_note_binding(const ec_device_info *devices, uint32_t count, const ec_log *log)
{
    (void)devices, (void)count, (void)log;
}

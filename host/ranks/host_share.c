/* Divides a host's devices among its ranks, and notes if the launcher binds these to cores. Open MPI binds each to a single core if there are one or
 * two ranks; a device that is the processor then has only that core. */
#define _GNU_SOURCE
#include <sched.h>
#include <unistd.h>

#include "ranks/ranks_internal.h"

void ec_mpi_note_binding(const ec_device_info *devices, uint32_t count, const ec_log *log)
{
    cpu_set_t own;
    const long all = sysconf(_SC_NPROCESSORS_ONLN);
    bool is_processor = false;
    for (uint32_t i = 0; i < count; i++) is_processor |= (devices[i].type & CL_DEVICE_TYPE_CPU) != 0;
    if (!is_processor || sched_getaffinity(0, sizeof own, &own) != 0 || CPU_COUNT(&own) >= all) return;
    ec_note(log, "the launcher gave this process %d of %ld cores, and the others hardly more; 'mpirun --bind-to none' gives them all",
            CPU_COUNT(&own), all);
}

void ec_mpi_share_devices(const ec_ranks *r, ec_device_info *devices, uint32_t *indices, uint32_t *count)
{
    const uint32_t of = (uint32_t)r->place->local_size, first = (uint32_t)r->place->local_rank % *count;
    uint32_t kept = 0;
    for (uint32_t i = first; i < *count; i += of) {
        devices[kept] = devices[i];
        indices[kept++] = indices[i];
    }
    *count = kept;
}

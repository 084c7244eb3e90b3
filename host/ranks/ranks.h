/* The processes of an MPI job (mpirun -n 8 eclat render …), its ranks, as one renderer. Rank 0 reads the command line, loads the scene and sends what
 * devices need of it to all others, which read no files. Pieces of batches go down a tree of ranks (transport.h) as ranks become free: a rank is a team of
 * its own devices and its children, and a single source for its parent. What comes up are sums over the samples of a batch, or of a block of batches
 * if they are fast, so that the picture has the same bits as that of one process.
 * The functions that call MPI are in a module (mpi_module.h), which is loaded by processes that a launcher started. */
#ifndef EC_RANKS_RANKS_H
#define EC_RANKS_RANKS_H

#include <stdbool.h>
#include <stdint.h>

#include "render/sources.h"

/* launcher.c: the number of processes that an MPI launcher started together with this one, and whether this is the first, by the environment and
 * without MPI. */
int ec_ranks_launched(void);
bool ec_ranks_launched_first(void);
/* Returns the number of processes that srun started without MPI, each of which would do all of the work; 1 for all but the first. */
int ec_ranks_apart(void);

typedef struct ec_ranks ec_ranks;

/* Joins the other ranks. *ranks, if not NULL, must be left on failure too. */
ec_result ec_ranks_join(ec_ranks **ranks, ec_error *err);
int ec_ranks_number(const ec_ranks *ranks); /* the number of this process */
int ec_ranks_count(const ec_ranks *ranks);

/* On rank 0: returns the others as peers of a render (render/sources.h), which find their devices by --device (NULL: not given). own: drivers of rank
 * 0's devices (ec_device_drivers), which must last; own_round: these round correctly. Warns of ranks with other devices, unless both round correctly. */
ec_peers ec_ranks_peers(ec_ranks *ranks, const char *device, const char *own, bool own_round);
/* Keeps the devices of this process, if several processes on one host are to use several devices: every n-th, or a single one if there are fewer
 * devices. */
void ec_ranks_share_devices(const ec_ranks *ranks, ec_device_info *devices, uint32_t *indices, uint32_t *count);
/* Notes if devices are processors, and the launcher lets this process use only some of the cores. */
void ec_ranks_note_binding(const ec_ranks *ranks, const ec_device_info *devices, uint32_t count, const ec_log *log);

void ec_ranks_leave(ec_ranks *ranks); /* ends the job of all ranks below, and frees; NULL is fine */

/* For ranks other than 0: waits for jobs of rank 0 and takes part in them, until it leaves. Devices and ranks below that cannot take part are
 * reported to log. */
ec_result ec_ranks_serve(ec_ranks *ranks, const ec_log *log, ec_error *err);

#endif

/* The processes of an MPI job (mpirun -n 8 eclat render …), its ranks, as one renderer. Rank 0 reads the command line, loads the scene and
 * sends what a device is given of it to all others; they know no files. Pieces of batches go down a tree of ranks (post.h) as ranks get free: a
 * rank is a team of its own devices and its children, and to its parent one source. What comes up are sums over the samples of a batch, or of a
 * block of batches where they come fast: the picture has the same bits as that of one process.
 * Those that call MPI are a module (mpi_module.h), loaded by processes that a launcher started. */
#ifndef EC_RANKS_RANKS_H
#define EC_RANKS_RANKS_H

#include <stdbool.h>
#include <stdint.h>

#include "render/sources.h"

/* launcher.c: as one of how many was this process started, by an MPI launcher? And as the first of them? Tells by its environment, without MPI. */
int ec_ranks_launched(void);
bool ec_ranks_launched_first(void);
/* Counts processes that srun started without MPI, so that each does all of the work: how many; 1 for all but the first of them. */
int ec_ranks_apart(void);

typedef struct ec_ranks ec_ranks;

/* Joins the others. *ranks is to be left on failure too, where it is not NULL. */
ec_result ec_ranks_join(ec_ranks **ranks, ec_error *err);
int ec_ranks_number(const ec_ranks *ranks); /* this process' */
int ec_ranks_count(const ec_ranks *ranks);

/* On rank 0: the others as peers of a render (render/sources.h), which find their devices by --device (NULL: not given). Where one has other
 * devices than rank 0, `own` by ec_device_drivers, a text that stays, and not all round alike (own_round: these do), there is a warning. */
ec_peers ec_ranks_peers(ec_ranks *ranks, const char *device, const char *own, bool own_round);
/* Leaves those that are this process', where several on one host are to use several devices: every n-th, or if there are fewer devices one. */
void ec_ranks_share_devices(const ec_ranks *ranks, ec_device_info *devices, uint32_t *indices, uint32_t *count);
/* Where these are processors and the launcher lets this process use some of the cores only. */
void ec_ranks_note_binding(const ec_ranks *ranks, const ec_device_info *devices, uint32_t count, const ec_log *log);

void ec_ranks_leave(ec_ranks *ranks); /* ends the job of all ranks below. NULL is fine */

/* All that other ranks do: waits for rank 0's word, and renders as it says, if it does. log is told which devices and ranks below are out. */
ec_result ec_ranks_serve(ec_ranks *ranks, const ec_log *log, ec_error *err);

#endif

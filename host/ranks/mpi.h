/* The functions of ranks.h by MPI. Internal to ranks/. */
#ifndef EC_RANKS_MPI_H
#define EC_RANKS_MPI_H

#include "ranks/ranks.h"

ec_result ec_mpi_join(ec_ranks **ranks, ec_error *err);
int ec_mpi_number(const ec_ranks *ranks);
int ec_mpi_count(const ec_ranks *ranks);
ec_peers ec_mpi_peers(ec_ranks *ranks, const char *device, const char *own, bool own_round);
void ec_mpi_share_devices(const ec_ranks *ranks, ec_device_info *devices, uint32_t *indices, uint32_t *count);
void ec_mpi_note_binding(const ec_device_info *devices, uint32_t count, const ec_log *log);
void ec_mpi_leave(ec_ranks *ranks);
ec_result ec_mpi_serve(ec_ranks *ranks, const ec_log *log, ec_error *err);

#endif

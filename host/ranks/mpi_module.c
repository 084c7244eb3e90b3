#include "ranks/mpi_module.h"

#include "base/module.h"
#include "ranks/mpi.h"

EC_MODULE_EXPORT extern const ec_ranks_module EC_MODULE_SYMBOL;
const ec_ranks_module EC_MODULE_SYMBOL = {ec_mpi_join,          ec_mpi_number,       ec_mpi_count, ec_mpi_peers,
                                          ec_mpi_share_devices, ec_mpi_note_binding, ec_mpi_leave, ec_mpi_serve};

#include <stdlib.h>
#include <string.h>

#include "ranks/ranks.h"

/* Reads the variables of Open MPI; of MPICH, Intel MPI and srun --mpi=pmi2; of srun --mpi=pmix, which leaves the count to Slurm. Slurm's own
 * variables alone mean nothing, as a job's script has them too. */
int ec_ranks_launched(void)
{
    const char *size = getenv("OMPI_COMM_WORLD_SIZE");
    if (!size) size = getenv("PMI_SIZE");
    if (!size && getenv("PMIX_RANK")) size = getenv("SLURM_STEP_NUM_TASKS");
    return size ? atoi(size) : 1;
}

int ec_ranks_apart(void)
{
    const char *tasks = getenv("SLURM_STEP_NUM_TASKS"), *number = getenv("SLURM_PROCID");
    return tasks && number && !strcmp(number, "0") && ec_ranks_launched() < 2 ? atoi(tasks) : 1;
}

bool ec_ranks_launched_first(void)
{
    static const char *const numbers[] = {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (getenv(numbers[i])) return !strcmp(getenv(numbers[i]), "0");
    return true;
}

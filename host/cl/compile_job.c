#include "cl/compile_job.h"

#include <stdlib.h>
#include <string.h>

void ec_compile_job_for(const ec_cl *cl, ec_compile_job *job)
{
    memset(job, 0, sizeof *job);
    snprintf(job->platform, sizeof job->platform, "%s", cl->info.platform_name);
    snprintf(job->device, sizeof job->device, "%s", cl->info.name);
    snprintf(job->driver, sizeof job->driver, "%s", cl->info.driver);
    snprintf(job->cache_dir, sizeof job->cache_dir, "%s", cl->cache_dir ? cl->cache_dir : "");
}

void ec_compile_job_free(ec_compile_job *job)
{
    for (uint32_t i = 0; i < job->program_count; i++) free(job->programs[i].source);
    job->program_count = 0;
}

/* Writes the struct as it is in memory, since both processes are of one build; then the sources. */
bool ec_compile_job_write(const ec_compile_job *job, FILE *to)
{
    bool good = fwrite(job, sizeof *job, 1, to) == 1;
    for (uint32_t i = 0; good && i < job->program_count; i++) {
        const uint64_t size = strlen(job->programs[i].source) + 1;
        good = fwrite(&size, sizeof size, 1, to) == 1 && fwrite(job->programs[i].source, size, 1, to) == 1;
    }
    return good && fflush(to) == 0;
}

bool ec_compile_job_read(ec_compile_job *job, FILE *from)
{
    uint64_t size = 0;
    bool good = fread(job, sizeof *job, 1, from) == 1 && job->program_count <= EC_COMPILE_PROGRAMS && job->kernel_count <= EC_COMPILE_KERNELS;
    const uint32_t count = good ? job->program_count : 0;
    for (job->program_count = 0; good && job->program_count < count;) {
        char *source = NULL;
        good = fread(&size, sizeof size, 1, from) == 1 && size > 0 && size < (uint64_t)1 << 24 && (source = malloc(size)) != NULL;
        if (good) job->programs[job->program_count++].source = source;
        good = good && fread(source, size, 1, from) == 1 && source[size - 1] == 0;
    }
    return good;
}

/* What is known of the driver's own cache, which cannot be asked: a file for each job that was compiled into it, good while that folder stands. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cl/cache.h"
#include "cl/compile_job.h"

/* Where PoCL keeps its cache, as it chooses itself. */
static bool driver_folder(char path[4096])
{
    const char *own = getenv("POCL_CACHE_DIR"), *xdg = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    int size = -1;
    if (own && *own) size = snprintf(path, 4096, "%s", own);
    else if (xdg && *xdg) size = snprintf(path, 4096, "%s/pocl/kcache", xdg);
    else if (home && *home) size = snprintf(path, 4096, "%s/.cache/pocl/kcache", home);
    return size > 0 && size < 4096;
}

/* The key of all that it was compiled from and for, and where to. False where there is no cache to speak of. */
static bool key_of(const ec_cl *cl, const ec_compile_job *job, char folder[4096], ec_cache_key *key)
{
    char path[4096], where[4300];
    struct stat status;
    const char *all_or_none = getenv("POCL_KERNEL_CACHE");
    if (all_or_none && !strcmp(all_or_none, "0")) return false;
    if (!ec_cache_folder(cl->cache_dir, folder, 4096) || !driver_folder(path) || stat(path, &status) != 0) return false;
    snprintf(where, sizeof where, "%s %llu %llu", path, (unsigned long long)status.st_dev, (unsigned long long)status.st_ino);
    *key = ec_cache_key_of(&cl->info, where, "");
    for (uint32_t i = 0; i < job->program_count; i++) {
        char options[256];
        snprintf(options, sizeof options, "%s %s", job->programs[i].options, key->hex);
        *key = ec_cache_key_of(&cl->info, job->programs[i].source, options);
    }
    for (uint32_t i = 0; i < job->kernel_count; i++) {
        const ec_compile_kernel *k = &job->kernels[i];
        char launch[256];
        snprintf(launch, sizeof launch, "%s %u %d %s", k->name, k->local, k->global < 65536, key->hex); /* see ec_kernel_run */
        *key = ec_cache_key_of(&cl->info, launch, "");
    }
    return true;
}

bool ec_compile_job_is_done(const ec_cl *cl, const ec_compile_job *job)
{
    char folder[4096];
    ec_cache_key key;
    unsigned char *byte = NULL;
    size_t bytes = 0;
    const bool is_done = key_of(cl, job, folder, &key) && ec_cache_load(folder, &key, &byte, &bytes);
    free(byte);
    return is_done;
}

void ec_compile_job_done(const ec_cl *cl, const ec_compile_job *job)
{
    char folder[4096];
    ec_cache_key key;
    if (key_of(cl, job, folder, &key)) ec_cache_store(folder, &key, (const unsigned char *)"1", 1);
}

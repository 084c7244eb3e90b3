/* Keeps a list, for each job that was compiled, of the files in the driver's own cache and their hashes, since the cache cannot be asked.
 * A driver loads whatever it finds, and a damaged file ends the process; so each file is checked first. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cl/ahead.h"
#include "cl/cache.h"
#include "cl/compile_job.h"
#include "cl/file_mark.h"
#include "cl/prepared.h"

#define PATH_SIZE 4096
#define LIST_FORMAT "2" /* lists of another format are not found: their files would seem damaged */
#define PROGRAM "program.bc" /* PoCL's file of a program, two folders above the kernels */

/* Writes the folder in which PoCL keeps its cache, by PoCL's own rule. */
static bool driver_folder(char path[PATH_SIZE])
{
    const char *own = getenv("POCL_CACHE_DIR"), *xdg = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    int size = -1;
    if (own && *own) size = snprintf(path, PATH_SIZE, "%s", own);
    else if (xdg && *xdg) size = snprintf(path, PATH_SIZE, "%s/pocl/kcache", xdg);
    else if (home && *home) size = snprintf(path, PATH_SIZE, "%s/.cache/pocl/kcache", home);
    return size > 0 && size < PATH_SIZE;
}

/* Returns the key of a job: what it was compiled from and for, and in which cache (`where`). */
static ec_cache_key key_in(const ec_cl *cl, const ec_compile_job *job, const char *where)
{
    ec_cache_key key = ec_cache_key_of(&cl->info, where, "");
    for (uint32_t i = 0; i < job->program_count; i++) {
        char options[256];
        snprintf(options, sizeof options, "%s %s", job->programs[i].options, key.hex);
        key = ec_cache_key_of(&cl->info, job->programs[i].source, options);
    }
    for (uint32_t i = 0; i < job->kernel_count; i++) {
        const ec_compile_kernel *k = &job->kernels[i];
        char launch[256];
        snprintf(launch, sizeof launch, "%s %u %d %s", k->name, k->local, ec_compile_is_small(k), key.hex);
        key = ec_cache_key_of(&cl->info, launch, "");
    }
    return key;
}

static ec_cache_key prepared_key(const ec_cl *cl, const ec_compile_job *job)
{
    return key_in(cl, job, LIST_FORMAT " prepared");
}

/* Sets the key of the list, and the folder of lists. Returns false if there is no cache to speak of. */
static bool key_of(const ec_cl *cl, const ec_compile_job *job, char folder[PATH_SIZE], ec_cache_key *key)
{
    char path[PATH_SIZE], where[PATH_SIZE + 64];
    struct stat status;
    const char *is_used = getenv("POCL_KERNEL_CACHE");
    if (is_used && !strcmp(is_used, "0")) return false;
    if (!ec_cache_folder(cl->cache_dir, folder, PATH_SIZE) || !driver_folder(path) || stat(path, &status) != 0) return false;
    snprintf(where, sizeof where, LIST_FORMAT " %s %llu %llu", path, (unsigned long long)status.st_dev, (unsigned long long)status.st_ino);
    *key = key_in(cl, job, where);
    return true;
}

/* Takes the program that a damaged file belongs to out of the driver's way. */
static void set_aside(const ec_cl *cl, const char *path, const char *driver)
{
    char program[PATH_SIZE], aside[PATH_SIZE + 32];
    size_t length = strlen(driver) + 1;
    for (int levels = 0; levels < 2; levels++) length += strcspn(path + length, "/") + 1; /* XX, and the rest of the hash */
    snprintf(program, sizeof program, "%.*s", (int)length - 1, path);
    snprintf(aside, sizeof aside, "%s.damaged-%ld", program, (long)getpid());
    if (rename(program, aside) == 0) ec_warn(cl->log, "a damaged file in the driver's cache, '%s', is set aside; its kernels are compiled again", aside);
}

/* Returns whether each file of the list is as it was. One that is gone is compiled again by the driver; one that has changed would end the process. */
static bool is_intact(const ec_cl *cl, char *list, bool mends)
{
    char driver[PATH_SIZE], mark[EC_FILE_MARK], *rest = NULL;
    bool is_whole = driver_folder(driver);
    for (char *line = strtok_r(list, "\n", &rest); line && is_whole; line = strtok_r(NULL, "\n", &rest)) {
        char *path = strchr(line, ' ');
        if (!path) return false;
        *path++ = 0;
        is_whole = ec_file_mark(path, mark) && !strcmp(mark, line);
        if (!is_whole && mends && access(path, F_OK) == 0 && !strncmp(path, driver, strlen(driver))) set_aside(cl, path, driver);
    }
    return is_whole;
}

/* Copies files that came with the program into the driver's cache. */
static bool take_prepared(const ec_cl *cl, const ec_compile_job *job, const char *folder, const ec_cache_key *key)
{
    char driver[PATH_SIZE], *text = NULL;
    size_t size = 0;
    const ec_cache_key prepared = prepared_key(cl, job);
    FILE *list = driver_folder(driver) ? open_memstream(&text, &size) : NULL;
    bool is_there = list && ec_prepared_take(&prepared, driver, list);
    if (list) is_there = fclose(list) == 0 && is_there && ec_cache_store(folder, key, (const unsigned char *)text, size);
    free(text);
    return is_there;
}

bool ec_compile_job_look(const ec_cl *cl, const ec_compile_job *job, bool mends)
{
    char folder[PATH_SIZE], *list = NULL;
    ec_cache_key key;
    unsigned char *found = NULL;
    size_t bytes = 0;
    if (!key_of(cl, job, folder, &key)) return false;
    if (!ec_cache_load(folder, &key, &found, &bytes)) return take_prepared(cl, job, folder, &key);
    list = strndup((char *)found, bytes);
    const bool is_done = list && is_intact(cl, list, mends);
    free(list);
    free(found);
    return is_done;
}

bool ec_compile_job_is_done(const ec_cl *cl, const ec_compile_job *job)
{
    return ec_ahead_is_done(cl, job) || ec_compile_job_look(cl, job, true);
}

static void add_file(FILE *list, const char *path)
{
    char mark[EC_FILE_MARK];
    if (ec_file_mark(path, mark)) fprintf(list, "%s %s\n", mark, path);
}

/* Adds a kernel's own file, and its program's: .../program.bc for .../kernel/size/kernel.so. */
static void add_kernel(FILE *list, const char *path)
{
    char program[PATH_SIZE + 16];
    int length = (int)strlen(path);
    add_file(list, path);
    for (int levels = 0; levels < 3 && length > 0; levels++)
        while (length > 0 && path[--length] != '/') {}
    snprintf(program, sizeof program, "%.*s/" PROGRAM, length, path);
    add_file(list, program);
}

/* Lists what the driver has loaded into this process from its cache. */
static void list_files(FILE *list, const char *driver)
{
    char line[PATH_SIZE + 128], last[PATH_SIZE + 128] = "";
    FILE *maps = fopen("/proc/self/maps", "r");
    while (maps && fgets(line, sizeof line, maps)) {
        char *path = strchr(line, '/');
        if (!path || strncmp(path, driver, strlen(driver))) continue;
        path[strcspn(path, "\n")] = 0;
        if (strcmp(path, last)) add_kernel(list, path); /* a file is mapped in several consecutive pieces */
        snprintf(last, sizeof last, "%s", path);
    }
    if (maps) fclose(maps);
}

void ec_compile_job_done(const ec_cl *cl, const ec_compile_job *job)
{
    char folder[PATH_SIZE], driver[PATH_SIZE], *text = NULL;
    ec_cache_key key;
    size_t size = 0;
    if (!key_of(cl, job, folder, &key) || !driver_folder(driver)) return;
    FILE *list = open_memstream(&text, &size);
    if (!list) return;
    list_files(list, driver);
    if (fclose(list) == 0 && size) {
        const ec_cache_key prepared = prepared_key(cl, job);
        ec_cache_store(folder, &key, (const unsigned char *)text, size);
        if (ec_prepared_target() && !ec_prepared_put(&prepared, driver, text)) ec_warn(cl->log, "kernels could not be kept in '%s'", ec_prepared_target());
    }
    free(text);
}

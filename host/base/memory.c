#include "base/memory.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#define HUGE_PAGE (UINT64_C(2) << 20)

static uint64_t least(uint64_t a, uint64_t b) { return a < b ? a : b; }

/* Reads /proc/self/statm: the address space, and the resident part of it. */
static void look_at_self(uint64_t *space, uint64_t *resident)
{
    const uint64_t page = (uint64_t)sysconf(_SC_PAGESIZE);
    FILE *file = fopen("/proc/self/statm", "re");
    *space = *resident = 0;
    if (!file) return;
    if (fscanf(file, "%" SCNu64 " %" SCNu64, space, resident) != 2) *space = *resident = 0;
    *space *= page;
    *resident *= page;
    fclose(file);
}

uint64_t ec_memory_of_machine(void) { return (uint64_t)sysconf(_SC_PHYS_PAGES) * (uint64_t)sysconf(_SC_PAGESIZE); }

uint64_t ec_memory_resident(void)
{
    uint64_t space, resident;
    look_at_self(&space, &resident);
    return resident;
}

static uint64_t available(void)
{
    uint64_t kib = 0;
    char line[128];
    FILE *file = fopen("/proc/meminfo", "re");
    if (!file) return UINT64_MAX;
    while (fgets(line, sizeof line, file) && sscanf(line, "MemAvailable: %" SCNu64, &kib) != 1) kib = 0;
    fclose(file);
    return kib ? kib * 1024 : UINT64_MAX;
}

/* Reads a number from a file; UINT64_MAX if there is none, or it is "max". */
static uint64_t number_in(const char *folder, const char *name)
{
    char path[4400];
    uint64_t value = UINT64_MAX;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "re");
    if (!file) return UINT64_MAX;
    if (fscanf(file, "%" SCNu64, &value) != 1) value = UINT64_MAX;
    fclose(file);
    return value;
}

/* Files of the two versions of control groups. */
typedef struct group_files {
    const char *root, *limit, *used, *cached[2];
} group_files;
static const group_files versions[] = {
    {"/sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes", {"total_inactive_file ", "total_active_file "}},
    {"/sys/fs/cgroup", "memory.max", "memory.current", {"inactive_file ", "active_file "}}};

/* Returns the page cache's share of a group's memory, which the kernel reclaims before it kills a process. */
static uint64_t cached_in(const char *folder, const group_files *files)
{
    char path[4400], line[128];
    uint64_t sum = 0, value;
    snprintf(path, sizeof path, "%s/memory.stat", folder);
    FILE *file = fopen(path, "re");
    if (!file) return 0;
    while (fgets(line, sizeof line, file))
        for (int i = 0; i < 2; i++) {
            const size_t size = strlen(files->cached[i]);
            if (!strncmp(line, files->cached[i], size) && sscanf(line + size, "%" SCNu64, &value) == 1) sum += value;
        }
    fclose(file);
    return sum;
}

/* Returns the bytes left under the limits of a group and all groups above it. */
static uint64_t left_in_group(const char *path, const group_files *files)
{
    char folder[4200];
    uint64_t left = UINT64_MAX;
    snprintf(folder, sizeof folder, "%s%s", files->root, path);
    for (size_t root = strlen(files->root), size = strlen(folder); size >= root; size = strlen(folder)) {
        const uint64_t most = number_in(folder, files->limit), now = number_in(folder, files->used),
                       cached = cached_in(folder, files);
        const uint64_t held = cached < now ? now - cached : 0;
        if (most != UINT64_MAX && now != UINT64_MAX) left = least(left, most > held ? most - held : 0);
        char *slash = strrchr(folder, '/');
        if (!slash || size == root) break;
        *slash = 0;
    }
    return left;
}

/* Reads /proc/self/cgroup, whose lines are "0::/path", or "4:memory:/path" in version 1. In a container the path may be that of outside: a group that
 * does not exist has no limit, and the root stands for it. */
static uint64_t left_in_groups(void)
{
    char line[4096];
    uint64_t left = UINT64_MAX;
    FILE *file = fopen("/proc/self/cgroup", "re");
    if (!file) return left;
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = 0;
        const char *first = strchr(line, ':'), *path = first ? strchr(first + 1, ':') : NULL;
        if (path && (path == first + 1 || !strncmp(first, ":memory:", 8)))
            left = least(left, left_in_group(path + 1, &versions[path == first + 1]));
    }
    fclose(file);
    return left;
}

uint64_t ec_memory_free(void)
{
    struct rlimit limit;
    uint64_t space, resident, left = least(available(), left_in_groups());
    look_at_self(&space, &resident);
    if (!getrlimit(RLIMIT_AS, &limit) && limit.rlim_cur != RLIM_INFINITY)
        left = least(left, limit.rlim_cur > space ? limit.rlim_cur - space : 0);
    return left;
}

void *ec_shared_alloc(uint64_t bytes)
{
    const uint64_t alignment = bytes < 2 * HUGE_PAGE ? EC_SHARED_ALIGNMENT : HUGE_PAGE, size = (bytes / alignment + 1) * alignment;
    void *memory = aligned_alloc(alignment, size);
#ifdef MADV_HUGEPAGE
    if (memory && alignment == HUGE_PAGE) (void)madvise(memory, size, MADV_HUGEPAGE); /* advice: rays go all over it, and a TLB holds few small pages */
#endif
    return memory;
}

/* tier: quick */
/* Memory figures: pages that the process has touched, and limits that it is under. */
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/memory.h"
#include "support/test.h"

int main(void)
{
    const uint64_t size = 64u << 20, before = ec_memory_resident(), all = (uint64_t)sysconf(_SC_PHYS_PAGES) * (uint64_t)sysconf(_SC_PAGESIZE);
    char *touched = malloc(size);
    memset(touched, 1, size);
    CHECK(before > 1 << 20 && ec_memory_resident() > before + size * 9 / 10 && ec_memory_resident() < before + size * 3 / 2);
    CHECK(touched[size / 2] == 1);
    free(touched);
    CHECK(ec_memory_free() > 1 << 20 && ec_memory_free() < all);

    unsigned long long pages;
    FILE *file = fopen("/proc/self/statm", "r");
    CHECK(file && fscanf(file, "%llu", &pages) == 1);
    fclose(file);
    const uint64_t room = 100u << 20;
    const rlim_t space = pages * (uint64_t)sysconf(_SC_PAGESIZE) + room;
    CHECK(setrlimit(RLIMIT_AS, &(struct rlimit){space, RLIM_INFINITY}) == 0);
    struct rlimit kept; /* QEMU reports success, and keeps the old limit */
    if (getrlimit(RLIMIT_AS, &kept) == 0 && kept.rlim_cur == space) CHECK(ec_memory_free() <= room && ec_memory_free() > room / 2);
    TEST_END();
}

/* tier: quick */
/* host/cl/cache: what an entry's key depends on, damaged entries, the folder of entries, and programs from the cache. */
#include <dirent.h>

#include "cl/cache.h"
#include "support/cl_case.h"

static char folder[4096]; /* everything this test writes */

static bool same_key(const ec_cache_key *a, const ec_cache_key *b) { return memcmp(a->bytes, b->bytes, 32) == 0; }

static void key_covers_everything(void)
{
    ec_device_info base[4], other;
    fake_devices(base);
    ec_cache_key key = ec_cache_key_of(base, "source", "-DA=1"), changed = ec_cache_key_of(base, "source", "-DA=1");
    CHECK(same_key(&key, &changed) && strlen(key.hex) == 64);
    changed = ec_cache_key_of(base, "source", "-DA=2");
    CHECK(!same_key(&key, &changed));
    changed = ec_cache_key_of(base, "source2", "-DA=1");
    CHECK(!same_key(&key, &changed));
    changed = ec_cache_key_of(base, "source-", "DA=1"); /* equal letters in a row */
    CHECK(!same_key(&key, &changed));
    const size_t texts[] = {offsetof(ec_device_info, name),          offsetof(ec_device_info, vendor),
                            offsetof(ec_device_info, version),       offsetof(ec_device_info, driver),
                            offsetof(ec_device_info, platform_name), offsetof(ec_device_info, platform_version)};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        other = base[0];
        ((char *)&other)[texts[i]] ^= 1;
        changed = ec_cache_key_of(&other, "source", "-DA=1");
        CHECK_MSG(!same_key(&key, &changed), "text %zu", i);
    }
}

static int files_in(const char *path)
{
    int count = 0;
    DIR *dir = opendir(path);
    for (struct dirent *entry; dir && (entry = readdir(dir));)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    if (dir) closedir(dir);
    return count;
}

/* 1 hit with the right bytes, 0 miss, -1 wrong bytes. */
static int loads(const char *cache, const ec_cache_key *key, const char *expected, size_t bytes)
{
    unsigned char *data = NULL;
    size_t got = 0;
    if (!ec_cache_load(cache, key, &data, &got)) return 0;
    int verdict = got == bytes && memcmp(data, expected, bytes) == 0 ? 1 : -1;
    free(data);
    return verdict;
}

/* Changes a byte; beyond the end, adds one. */
static void flip_byte(const char *path, long at)
{
    FILE *file = fopen(path, "r+b");
    if (!file) return;
    fseek(file, at, SEEK_SET);
    int byte = fgetc(file);
    fseek(file, at, SEEK_SET);
    fputc((byte ^ 0x55) & 0xff, file);
    fclose(file);
}

static void entries_are_checked(void)
{
    static const char binary[] = "not really a binary, but bytes";
    char cache[4200], path[4400], path2[4400];
    snprintf(cache, sizeof cache, "%s/a/b/entries", folder);
    ec_device_info devices[4];
    fake_devices(devices);
    ec_cache_key key = ec_cache_key_of(devices, "source", ""), key2 = ec_cache_key_of(devices, "source", "x");
    snprintf(path, sizeof path, "%s/%s.bin", cache, key.hex);
    snprintf(path2, sizeof path2, "%s/%s.bin", cache, key2.hex);
#define STORE() ec_cache_store(cache, &key, (const unsigned char *)binary, sizeof binary)
#define LOADS(k) loads(cache, k, binary, sizeof binary)
    CHECK(LOADS(&key) == 0);
    CHECK(STORE());
    CHECK(LOADS(&key) == 1);
    CHECK(files_in(cache) == 1); /* no temporary file is left */
    struct stat status;
    CHECK(stat(path, &status) == 0 && status.st_size == 80 + (off_t)sizeof binary && (status.st_mode & 0077) == 0);
    for (off_t size = 0; size < status.st_size; size += 7) { /* truncated anywhere */
        CHECK(STORE() && truncate(path, size) == 0);
        CHECK_MSG(LOADS(&key) == 0, "truncated to %ld bytes", (long)size);
    }
    for (long at = 0; at < (long)status.st_size; at++) { /* one byte changed anywhere */
        CHECK(STORE());
        flip_byte(path, at);
        CHECK_MSG(LOADS(&key) == 0, "byte %ld changed", at);
    }
    CHECK(STORE());
    flip_byte(path, (long)status.st_size); /* something after the end */
    CHECK(LOADS(&key) == 0);
    CHECK(STORE() && rename(path, path2) == 0); /* another key's entry */
    CHECK(LOADS(&key2) == 0);
    CHECK(mkdir(path, 0700) == 0); /* a folder in the place of the entry */
    CHECK(LOADS(&key) == 0);
    CHECK(!STORE() && files_in(cache) == 2);
    snprintf(cache, sizeof cache, "/dev/null/cache"); /* not writable, not even for root */
    CHECK(!STORE());
    CHECK(LOADS(&key) == 0);
}

static void folder_follows_xdg(void)
{
    char path[256];
    char *xdg = strdup(getenv("XDG_CACHE_HOME")), *home = getenv("HOME") ? strdup(getenv("HOME")) : NULL;
    setenv("XDG_CACHE_HOME", "/xdg", 1);
    setenv("HOME", "/home/me", 1);
    CHECK(ec_cache_folder("/chosen", path, sizeof path) && strcmp(path, "/chosen") == 0);
    CHECK(ec_cache_folder(NULL, path, sizeof path) && strcmp(path, "/xdg/eclat/kernels") == 0);
    setenv("XDG_CACHE_HOME", "relative", 1);
    CHECK(ec_cache_folder(NULL, path, sizeof path) && strcmp(path, "/home/me/.cache/eclat/kernels") == 0);
    unsetenv("XDG_CACHE_HOME");
    unsetenv("HOME");
    CHECK(!ec_cache_folder(NULL, path, sizeof path));
    CHECK(!ec_cache_folder("/much/longer/than/that", path, 8));
    setenv("XDG_CACHE_HOME", xdg, 1);
    if (home) setenv("HOME", home, 1);
    free(xdg);
    free(home);
}

static void programs_are_cached(ec_cl *cl)
{
    char cache[4200], path[4400], all[256];
    snprintf(cache, sizeof cache, "%s/eclat/kernels", folder); /* folder is XDG_CACHE_HOME */
    cl->cache = EC_CACHE_ON;
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 0 && cl->cache_misses == 1 && files_in(cache) == 1);
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 1 && cl->cache_misses == 0);
    build_doubler(cl, "-DA=2");
    CHECK(cl->cache_hits == 0 && cl->cache_misses == 1 && files_in(cache) == 2);
    /* A valid entry that the driver rejects: the source is compiled, and the entry is replaced. */
    snprintf(all, sizeof all, "-cl-std=CL1.2%s -DA=1",
             cl->info.correctly_rounded_divide_sqrt ? " -cl-fp32-correctly-rounded-divide-sqrt" : "");
    ec_cache_key key = ec_cache_key_of(&cl->info, doubler, all);
    CHECK(ec_cache_store(cache, &key, (const unsigned char *)"garbage", 8) && files_in(cache) == 2);
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 0 && cl->cache_misses == 1);
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 1 && cl->cache_misses == 0);
    snprintf(path, sizeof path, "%s/%s.bin", cache, key.hex);
    CHECK(truncate(path, 100) == 0);
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 0 && cl->cache_misses == 1);
    cl->cache_dir = "/dev/null/cache";
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 0 && cl->cache_misses == 1);
    cl->cache_dir = NULL;
    cl->cache = EC_CACHE_OFF;
    build_doubler(cl, "-DA=1");
    CHECK(cl->cache_hits == 0 && cl->cache_misses == 0);
    CHECK(cl->build_seconds > 0.0);
}

int main(void)
{
    ec_cl cl = {0};
    if (!cl_folder(folder)) TEST_SKIP("no folder %s", folder);
    key_covers_everything();
    entries_are_checked();
    folder_follows_xdg();
    if (cl_open(getenv("ECLAT_DEVICE"), &cl)) programs_are_cached(&cl);
    ec_cl_close(&cl);
    cl_folder_remove(folder);
    TEST_END();
}

#include "cl/prepared.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/module.h"
#include "cl/compile_job.h"
#include "cl/file_mark.h"

/* $ECLAT_KERNELS, where it is set; empty: none. */
static bool find_folder(char folder[PATH_MAX])
{
    const char *chosen = getenv("ECLAT_KERNELS");
    if (!chosen) return ec_module_find("eclat-kernels", folder, NULL) == EC_OK;
    return *chosen && snprintf(folder, PATH_MAX, "%s", chosen) < PATH_MAX;
}

const char *ec_prepared_target(void)
{
    const char *folder = getenv("ECLAT_PREPARE");
    return folder && *folder ? folder : NULL;
}

bool ec_prepares_kernels(void)
{
    return ec_prepared_target() != NULL;
}

static bool make_parent(const char *path)
{
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/');
    return slash && snprintf(folder, sizeof folder, "%.*s", (int)(slash - path), path) < PATH_MAX && ec_cache_make_folder(folder);
}

/* A file that is there stays. False where the bytes do not have the mark. */
static bool copy(const char *from, const char *to, const char *mark)
{
    char found[EC_FILE_MARK];
    size_t size = 0;
    if (access(to, F_OK) == 0) return ec_file_mark(to, found) && !strcmp(found, mark);
    char *bytes = ec_file_bytes(from, &size);
    if (bytes) ec_bytes_mark(bytes, size, found);
    const bool is_good = bytes && !strcmp(found, mark) && make_parent(to) && ec_atomic_write(to, bytes, size, NULL) == EC_OK;
    free(bytes);
    return is_good;
}

/* Each line of `list`, "mark path" with paths below `from`, once copied to `to`, as a line of `out` with paths below `out_root`. */
static bool copy_all(char *list, const char *from, const char *to, const char *out_root, FILE *out)
{
    char source[2 * PATH_MAX], target[2 * PATH_MAX], *rest = NULL;
    for (char *line = strtok_r(list, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        char *path = strchr(line, ' ');
        if (!path) return false;
        *path++ = 0;
        snprintf(source, sizeof source, "%s/%s", from, path);
        snprintf(target, sizeof target, "%s/%s", to, path);
        if (strstr(path, "..") || !copy(source, target, line)) return false;
        fprintf(out, "%s %s%s\n", line, out_root, path);
    }
    return true;
}

bool ec_prepared_take(const ec_cache_key *key, const char *driver, FILE *list)
{
    char folder[PATH_MAX], files[PATH_MAX + 8], root[PATH_MAX + 8];
    unsigned char *found = NULL;
    size_t bytes = 0;
    if (!find_folder(folder) || !ec_cache_load(folder, key, &found, &bytes)) return false;
    snprintf(files, sizeof files, "%s/files", folder);
    snprintf(root, sizeof root, "%s/", driver);
    char *lines = strndup((char *)found, bytes);
    const bool is_good = lines && copy_all(lines, files, driver, root, list);
    free(lines);
    free(found);
    return is_good;
}

bool ec_prepared_put(const ec_cache_key *key, const char *driver, const char *list)
{
    char files[PATH_MAX + 8], *below = NULL, *lines = NULL, *line, *rest = NULL, *absolute = strdup(list);
    size_t size = 0, skip = strlen(driver) + 1;
    const char *folder = ec_prepared_target();
    FILE *to = open_memstream(&below, &size);
    for (line = absolute && to ? strtok_r(absolute, "\n", &rest) : NULL; line; line = strtok_r(NULL, "\n", &rest)) {
        const char *path = strchr(line, ' ') + 1;
        fprintf(to, "%.*s%s\n", (int)(path - line), line, path + skip);
    }
    bool is_good = to && fclose(to) == 0 && absolute;
    snprintf(files, sizeof files, "%s/files", folder);
    FILE *nowhere = fopen("/dev/null", "we");
    lines = is_good ? strdup(below) : NULL;
    is_good = lines && nowhere && copy_all(lines, driver, files, "", nowhere) && ec_cache_store(folder, key, (const unsigned char *)below, size);
    if (nowhere) fclose(nowhere);
    free(lines);
    free(below);
    free(absolute);
    return is_good;
}

#include "cl/prepared.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/module.h"
#include "base/read_file.h"
#include "cl/compile_job.h"
#include "cl/file_mark.h"

/* Finds the folder of prepared kernels: $ECLAT_KERNELS, if that is set; empty: none. */
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

/* Copies a file, unless it is there already. Returns false if the bytes do not have the mark. */
static bool copy(const char *from, const char *to, const char *mark)
{
    char found[EC_FILE_MARK];
    uint8_t *bytes;
    size_t size;
    if (access(to, F_OK) == 0) return ec_file_mark(to, found) && !strcmp(found, mark);
    bool is_good = ec_read_file(from, &bytes, &size, NULL) == EC_OK;
    if (is_good) ec_bytes_mark(bytes, size, found);
    is_good = is_good && !strcmp(found, mark) && make_parent(to) && ec_atomic_write(to, bytes, size, NULL) == EC_OK;
    free(bytes);
    return is_good;
}

/* Copies the files of a list, each a line "mark path", from a folder to another. Paths below the first folder begin after `skip` characters; `out`
 * gets the lines with `root` in place of these. */
static bool copy_all(const char *list, size_t bytes, size_t skip, const char *from, const char *to, const char *root, FILE *out)
{
    char source[2 * PATH_MAX], target[2 * PATH_MAX], *rest = NULL, *lines = strndup(list, bytes);
    bool is_good = lines != NULL;
    for (char *line = is_good ? strtok_r(lines, "\n", &rest) : NULL; line && is_good; line = strtok_r(NULL, "\n", &rest)) {
        char *path = strchr(line, ' ');
        is_good = path && strlen(path) > 1 + skip && !strstr(path, "..");
        if (!is_good) break;
        *path = 0;
        path += 1 + skip;
        snprintf(source, sizeof source, "%s/%s", from, path);
        snprintf(target, sizeof target, "%s/%s", to, path);
        is_good = copy(source, target, line) && fprintf(out, "%s %s%s\n", line, root, path) > 0;
    }
    free(lines);
    return is_good;
}

bool ec_prepared_take(const ec_cache_key *key, const char *driver, FILE *list)
{
    char folder[PATH_MAX], files[PATH_MAX + 8], root[PATH_MAX + 8];
    unsigned char *found = NULL;
    size_t bytes = 0;
    if (!find_folder(folder) || !ec_cache_load(folder, key, &found, &bytes)) return false;
    snprintf(files, sizeof files, "%s/files", folder);
    snprintf(root, sizeof root, "%s/", driver);
    const bool is_good = copy_all((char *)found, bytes, 0, files, driver, root, list);
    free(found);
    return is_good;
}

bool ec_prepared_put(const ec_cache_key *key, const char *driver, const char *list)
{
    char files[PATH_MAX + 8], *text = NULL;
    size_t size = 0;
    FILE *below = open_memstream(&text, &size);
    snprintf(files, sizeof files, "%s/files", ec_prepared_target());
    bool is_good = below && copy_all(list, strlen(list), strlen(driver) + 1, driver, files, "", below);
    is_good = below && fclose(below) == 0 && is_good && ec_cache_store(ec_prepared_target(), key, (const unsigned char *)text, size);
    free(text);
    return is_good;
}

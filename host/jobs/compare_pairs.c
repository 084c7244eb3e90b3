#include "jobs/compare_pairs.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* If a folder has several files of one name, the ending listed first is preferred. */
static const char *const endings[] = {".exr", ".hdr", ".png", ".webp", ".avif", ".jpg", ".jpeg", NULL};

static bool is_folder(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

/* Returns the index of the name's ending; -1: not that of a picture. */
static int ending_of(const char *name)
{
    const char *dot = strrchr(name, '.');
    for (int i = 0; dot && dot != name && endings[i]; i++)
        if (!strcasecmp(dot, endings[i])) return i;
    return -1;
}

static bool is_called_alike(const char *a, const char *b)
{
    const size_t length = (size_t)(strrchr(a, '.') - a);
    return (size_t)(strrchr(b, '.') - b) == length && !memcmp(a, b, length);
}

static char *join(const char *folder, const char *name)
{
    const size_t size = strlen(folder) + strlen(name) + 2;
    char *path = malloc(size);
    if (path) snprintf(path, size, "%s%s%s", folder, folder[strlen(folder) - 1] == '/' ? "" : "/", name);
    return path;
}

static ec_result add(ec_compare_pairs *pairs, char *a, char *b, ec_error *err)
{
    ec_compare_pair *more = realloc(pairs->pair, (pairs->count + 1) * sizeof *more);
    if (more) pairs->pair = more;
    if (more && a && b) {
        more[pairs->count++] = (ec_compare_pair){a, b};
        return EC_OK;
    }
    free(a);
    free(b);
    return ec_fail(err, "out of memory for the names of pictures");
}

static int is_picture(const struct dirent *entry) { return entry->d_name[0] != '.' && ending_of(entry->d_name) >= 0; }

static void free_list(struct dirent **list, int count)
{
    for (int i = 0; i < count; i++) free(list[i]);
    free(list);
}

/* Finds the entry that is called like `name`; of several, the one whose ending is listed first. */
static const struct dirent *find(struct dirent *const *list, int count, const char *name)
{
    const struct dirent *found = NULL;
    for (int i = 0; i < count; i++)
        if (is_called_alike(list[i]->d_name, name) && (!found || ending_of(list[i]->d_name) < ending_of(found->d_name))) found = list[i];
    return found;
}

static ec_result match(const char *a, const char *b, ec_compare_pairs *pairs, ec_error *err)
{
    struct dirent **of_a = NULL, **of_b = NULL;
    const int count_a = scandir(a, &of_a, is_picture, alphasort), count_b = scandir(b, &of_b, is_picture, alphasort);
    ec_result result = count_a < 0 || count_b < 0 ? ec_fail(err, "cannot read the folder '%s'", count_a < 0 ? a : b) : EC_OK;
    for (int i = 0; i < count_a && result == EC_OK; i++) {
        const char *name = of_a[i]->d_name;
        if (find(of_a, count_a, name) != of_a[i]) continue; /* the same picture in another format */
        const struct dirent *partner = find(of_b, count_b, name);
        if (partner) result = add(pairs, join(a, name), join(b, partner->d_name), err);
        else pairs->alone++;
    }
    if (result == EC_OK && pairs->count == 0)
        result = ec_fail(err, "nothing to compare: no picture in '%s' has the name of one in '%s', apart from the extension", a, b);
    free_list(of_a, count_a);
    free_list(of_b, count_b);
    return result;
}

ec_result ec_compare_pairs_of(char *const *inputs, int count, ec_compare_pairs *pairs, ec_error *err)
{
    *pairs = (ec_compare_pairs){0};
    if (count == 2 && is_folder(inputs[0]) && is_folder(inputs[1])) return match(inputs[0], inputs[1], pairs, err);
    for (int i = 0; i < count - 1; i++) EC_TRY(add(pairs, strdup(inputs[i]), strdup(inputs[count - 1]), err));
    return EC_OK;
}

void ec_compare_pairs_free(ec_compare_pairs *pairs)
{
    for (uint32_t i = 0; i < pairs->count; i++) {
        free(pairs->pair[i].a);
        free(pairs->pair[i].b);
    }
    free(pairs->pair);
    *pairs = (ec_compare_pairs){0};
}

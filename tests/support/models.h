/* Lists every .gltf and .glb below a folder, by name. Define _XOPEN_SOURCE 700 before the first include. */
#ifndef EC_TESTS_SUPPORT_MODELS_H
#define EC_TESTS_SUPPORT_MODELS_H

#include <ftw.h>
#include <stdlib.h>
#include <string.h>

enum { MODELS_MAX = 512 };

static char *models[MODELS_MAX];
static int model_count;

static int models_take(const char *path, const struct stat *status, int type, struct FTW *walk)
{
    (void)status, (void)walk;
    const char *dot = strrchr(path, '.');
    if (type == FTW_F && dot && (!strcmp(dot, ".gltf") || !strcmp(dot, ".glb")) && model_count < MODELS_MAX)
        models[model_count++] = strdup(path);
    return 0;
}

static int models_by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* 0: no such file, or no folder */
static inline int models_collect(const char *folder)
{
    if (nftw(folder, models_take, 16, FTW_PHYS) != 0) return 0;
    qsort(models, (size_t)model_count, sizeof *models, models_by_name);
    return model_count;
}

#endif

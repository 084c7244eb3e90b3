#include "denoise/oidn_find.h"

#include <dlfcn.h>
#include <glob.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#define FILE_NAME "libOpenImageDenoise.so.2"
#define IN_PACKAGE "pyoidn/oidn/lib/" FILE_NAME

/* RTLD_LOCAL: it brings libraries of its own, which nothing else should find. */
static void *open_file(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }

/* Loads from a file, or from a folder that has it directly, or as PyPI's package has it. */
static ec_result load_named(const char *named, void **library, ec_error *err)
{
    static const char *const inside[] = {FILE_NAME, "oidn/lib/" FILE_NAME, IN_PACKAGE};
    char path[PATH_MAX];
    struct stat about;
    if (stat(named, &about) != 0) return ec_fail(err, "ECLAT_OIDN: there is no '%s'; name " FILE_NAME " or its folder, or unset it", named);
    if (!S_ISDIR(about.st_mode)) *library = open_file(named);
    for (size_t i = 0; S_ISDIR(about.st_mode) && !*library && i < sizeof inside / sizeof *inside; i++)
        if (snprintf(path, sizeof path, "%s/%s", named, inside[i]) < (int)sizeof path && stat(path, &(struct stat){0}) == 0) *library = open_file(path);
    if (*library) return EC_OK;
    const char *why = dlerror();
    return ec_fail(err, "ECLAT_OIDN: cannot load " FILE_NAME " from '%s'%s%s", named, why ? ": " : ", which does not have it", why ? why : "");
}

static void *open_matching(const char *prefix, const char *pattern)
{
    char whole[PATH_MAX];
    glob_t found;
    void *library = NULL;
    if (!prefix || snprintf(whole, sizeof whole, "%s%s", prefix, pattern) >= (int)sizeof whole) return NULL;
    if (glob(whole, 0, NULL, &found) != 0) return NULL;
    for (size_t i = found.gl_pathc; !library && i > 0; i--) library = open_file(found.gl_pathv[i - 1]); /* the newest Python's first */
    globfree(&found);
    return library;
}

/* Loads from where pip installs it: the active environment, the user's own packages, the system's. */
static void *open_of_python(void)
{
    void *library = open_matching(getenv("VIRTUAL_ENV"), "/lib/python3*/site-packages/" IN_PACKAGE);
    if (!library) library = open_matching(getenv("HOME"), "/.local/lib/python3*/site-packages/" IN_PACKAGE);
    if (!library) library = open_matching("/usr", "/local/lib/python3*/*-packages/" IN_PACKAGE);
    return library;
}

bool ec_oidn_is_named(void)
{
    const char *named = getenv("ECLAT_OIDN");
    return named && *named;
}

ec_result ec_oidn_load(void **library, ec_error *err)
{
    *library = NULL;
    if (ec_oidn_is_named()) return load_named(getenv("ECLAT_OIDN"), library, err);
    *library = open_file(FILE_NAME);
    if (!*library) *library = open_of_python();
    if (*library) return EC_OK;
    return ec_fail(err, "--denoise oidn: Intel's Open Image Denoise (" FILE_NAME ") is not installed; install version 2 from the system's packages or "
                        "by 'pip install pyoidn' (from Python: 'pip install eclat[denoise]'); ECLAT_OIDN names it if it is elsewhere; --denoise atrous does without it");
}

#define _GNU_SOURCE /* for dladdr */
#include "base/module.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)

/* Finds the folder of the library, or of the program that it is linked into, with a trailing slash. */
static ec_result find_folder(char folder[PATH_MAX], ec_error *err)
{
    Dl_info info;
    const bool is_found = dladdr((const void *)(uintptr_t)ec_module_load, &info) && strchr(info.dli_fname, '/') && realpath(info.dli_fname, folder);
    if (!is_found && !realpath("/proc/self/exe", folder)) return ec_fail(err, "cannot find the folder of eclat: /proc/self/exe cannot be read");
    strrchr(folder, '/')[1] = 0;
    return EC_OK;
}

ec_result ec_module_find(const char *file, char *path, ec_error *err)
{
    static const char *const places[] = {"", "eclat/"}; /* when built; when installed */
    char folder[PATH_MAX];
    EC_TRY(find_folder(folder, err));
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++)
        if (snprintf(path, PATH_MAX, "%s%s%s", folder, places[i], file) < PATH_MAX && access(path, F_OK) == 0) return EC_OK;
    return ec_fail(err, "%s is missing from where it was installed; install eclat again", file);
}

ec_result ec_module_load(const char *name, const char *remedy, const void **symbol, ec_error *err)
{
    char file[64], path[PATH_MAX];
    void *module = NULL;
    snprintf(file, sizeof file, "eclat-%s.so", name);
    if (ec_module_find(file, path, NULL) != EC_OK) return ec_fail(err, "%s", remedy);
    module = dlopen(path, RTLD_NOW | RTLD_GLOBAL); /* Open MPI loads plugins, which look for symbols there */
    *symbol = module ? dlsym(module, TEXT(EC_MODULE_SYMBOL)) : NULL;
    return *symbol ? EC_OK : ec_fail(err, "cannot load '%s': %s", path, dlerror());
}

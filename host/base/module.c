#include "base/module.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#ifndef EC_MODULE_FOLDER /* CMakeLists.txt says it: from the program to where modules are installed */
#define EC_MODULE_FOLDER "../lib/eclat"
#endif

#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)

/* The folder of the running program, with a slash at its end. */
static bool find_program(char folder[PATH_MAX])
{
    const ssize_t size = readlink("/proc/self/exe", folder, PATH_MAX - 1);
    if (size <= 0) return false;
    folder[size] = 0;
    char *slash = strrchr(folder, '/');
    if (slash) slash[1] = 0;
    return slash != NULL;
}

ec_result ec_module_find(const char *file, char *path, ec_error *err)
{
    static const char *const places[] = {"", EC_MODULE_FOLDER "/"}; /* built; installed */
    char folder[PATH_MAX];
    if (!find_program(folder)) return ec_fail(err, "cannot tell where eclat lies: /proc/self/exe cannot be read");
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++)
        if (snprintf(path, PATH_MAX, "%s%s%s", folder, places[i], file) < PATH_MAX && access(path, F_OK) == 0) return EC_OK;
    return ec_fail(err, "%s is not where it was installed", file);
}

ec_result ec_module_load(const char *name, const char *remedy, const void **symbol, ec_error *err)
{
    char file[64], path[PATH_MAX];
    void *module = NULL;
    snprintf(file, sizeof file, "eclat-%s.so", name);
    if (ec_module_find(file, path, NULL) != EC_OK) return ec_fail(err, "%s", remedy);
    module = dlopen(path, RTLD_NOW | RTLD_GLOBAL); /* Open MPI loads parts of its own, which look for it there */
    *symbol = module ? dlsym(module, TEXT(EC_MODULE_SYMBOL)) : NULL;
    return *symbol ? EC_OK : ec_fail(err, "cannot load '%s': %s", path, dlerror());
}

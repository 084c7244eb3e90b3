/* Finds drivers that are missing: an ICD loader says nothing about drivers that it cannot load, nor about those that no file names to it. */
#include "cl/drivers.h"

#include <dirent.h>
#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cl/cl.h"

#define VENDORS "/etc/OpenCL/vendors"

static bool ends_with(const char *name, const char *ending)
{
    const size_t size = strlen(name), tail = strlen(ending);
    return size >= tail && !strcmp(name + size - tail, ending);
}

/* Explains why a driver's library cannot be used. It is a line of the file `icd`, or icd is NULL. */
static bool explain_library(const char *icd, const char *library, ec_error *err)
{
    void *driver = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    const char *why = driver ? "it loads, but offers no platform" : dlerror();
    if (icd) ec_fail(err, "the OpenCL driver of '%s' cannot be used: %.800s", icd, why ? why : "no reason given");
    else ec_fail(err, "the OpenCL driver '%s' cannot be used: %.800s", library, why ? why : "no reason given");
    if (driver) dlclose(driver);
    else ec_fail_more(err, "; install the driver again, or raise the limits of this process (ulimit -a)");
    return true;
}

static bool explain_file(const char *icd, ec_error *err)
{
    char library[PATH_MAX] = "";
    FILE *file = fopen(icd, "r");
    if (!file) return false;
    if (!fgets(library, sizeof library, file)) library[0] = 0;
    fclose(file);
    library[strcspn(library, "\r\n")] = 0;
    return library[0] && explain_library(icd, library, err);
}

/* Explains the first driver that a folder names. */
static bool explain_folder(const char *path, ec_error *err)
{
    DIR *folder = opendir(path);
    bool found = false;
    for (struct dirent *entry; folder && !found && (entry = readdir(folder));) {
        char icd[PATH_MAX];
        if (ends_with(entry->d_name, ".icd") && snprintf(icd, sizeof icd, "%s/%s", path, entry->d_name) < (int)sizeof icd) found = explain_file(icd, err);
    }
    if (folder) closedir(folder);
    return found;
}

bool ec_drivers_explain(ec_error *err)
{
    struct stat info;
    const char *wanted = getenv("OCL_ICD_VENDORS");
    if (!wanted || !*wanted) return explain_folder(VENDORS, err);
    if (stat(wanted, &info) == 0 && S_ISDIR(info.st_mode)) return explain_folder(wanted, err);
    if (!ends_with(wanted, ".icd")) return (!strchr(wanted, '/') || access(wanted, F_OK) == 0) && explain_library(NULL, wanted, err);
    char icd[PATH_MAX];
    return explain_file(wanted, err) || (snprintf(icd, sizeof icd, VENDORS "/%s", wanted) < (int)sizeof icd && explain_file(icd, err));
}

/* Drivers that containers get from outside, while the files that name them to the loader are the image's. */
static const struct {
    const char *platform, *library, *icd;
} brought_in[] = {{"NVIDIA", "libnvidia-opencl.so.1", "nvidia.icd"}};

/* Returns whether the loader offers a platform. Whoever sets OCL_ICD_VENDORS, and has a platform, has chosen. */
static bool is_offered(const char *platform)
{
    cl_platform_id platforms[64];
    cl_uint count = 0;
    const char *wanted = getenv("OCL_ICD_VENDORS");
    if (clGetPlatformIDs(64, platforms, &count) != CL_SUCCESS) return false;
    for (cl_uint i = 0; i < count && i < 64; i++) {
        char own[256] = "";
        clGetPlatformInfo(platforms[i], CL_PLATFORM_NAME, sizeof own, own, NULL);
        if (strstr(own, platform)) return true;
    }
    return count > 0 && wanted && *wanted;
}

/* Returns whether the machine has the library, but the loader no file that names it. If it has the file and finds no platform, there is no such device. */
static bool is_untold(const char *library, const char *icd)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, VENDORS "/%s", icd);
    if (access(path, F_OK) == 0) return false;
    void *driver = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
    if (driver) dlclose(driver);
    return driver != NULL;
}

bool ec_drivers_unnamed(char *text, size_t size)
{
    for (size_t i = 0; i < sizeof brought_in / sizeof *brought_in; i++) {
        if (!is_untold(brought_in[i].library, brought_in[i].icd) || is_offered(brought_in[i].platform)) continue;
        snprintf(text, size, "%s's driver is installed, but the OpenCL loader does not know of it; to use its devices: echo %s >" VENDORS "/%s",
                 brought_in[i].platform, brought_in[i].library, brought_in[i].icd);
        return true;
    }
    return false;
}

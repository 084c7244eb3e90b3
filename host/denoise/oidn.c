#include "denoise/oidn.h"

#include <dlfcn.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "denoise/oidn_find.h"

enum { CPU = 1, FLOAT3 = 3, MEMORY_MB = 1024 }; /* OIDNDeviceType, OIDNFormat; and what one filter may take */

/* result, name, arguments */
#define FUNCTIONS(DO)                                                                                                                               \
    DO(void *, NewDevice, (int type))                                                                                                                \
    DO(void, SetDeviceBool, (void *device, const char *name, bool value))                                                                            \
    DO(int, GetDeviceInt, (void *device, const char *name))                                                                                          \
    DO(int, GetDeviceError, (void *device, const char **text))                                                                                       \
    DO(void, CommitDevice, (void *device))                                                                                                           \
    DO(void, ReleaseDevice, (void *device))                                                                                                          \
    DO(void *, NewFilter, (void *device, const char *type))                                                                                          \
    DO(void, SetSharedFilterImage, (void *filter, const char *name, void *data, int format, size_t width, size_t height, size_t offset,              \
                                    size_t pixel_stride, size_t row_stride))                                                                         \
    DO(void, SetFilterBool, (void *filter, const char *name, bool value))                                                                            \
    DO(void, SetFilterInt, (void *filter, const char *name, int value))                                                                              \
    DO(void, CommitFilter, (void *filter))                                                                                                           \
    DO(void, ExecuteFilter, (void *filter))                                                                                                          \
    DO(void, ReleaseFilter, (void *filter))

#define FIELD(result, name, arguments) result(*name) arguments;
struct ec_oidn {
    FUNCTIONS(FIELD)
    void *device;
    char version[24];
};

static ec_result find_functions(ec_oidn *oidn, void *library, ec_error *err)
{
#define FIND(result, name, arguments)                                                                                                                \
    *(void **)&oidn->name = dlsym(library, "oidn" #name);                                                                                            \
    if (!oidn->name) return ec_fail(err, "--denoise: the installed Open Image Denoise has no oidn" #name "; install version 2");
    FUNCTIONS(FIND)
    return EC_OK;
}

static ec_result check(const ec_oidn *oidn, const char *what, ec_error *err)
{
    const char *text = NULL;
    if (oidn->GetDeviceError(oidn->device, &text) == 0) return EC_OK;
    return ec_fail(err, "--denoise: Open Image Denoise %s: %s; leave --denoise out", what, text ? text : "no reason given");
}

/* Opens the processor as a device. Threads are not pinned, since others render beside. */
static ec_result open_device(ec_oidn *oidn, ec_error *err)
{
    oidn->device = oidn->NewDevice(CPU);
    if (!oidn->device) return check(oidn, "does not run on this processor", err);
    oidn->SetDeviceBool(oidn->device, "setAffinity", false);
    oidn->CommitDevice(oidn->device);
    EC_TRY(check(oidn, "does not start", err));
    const int version = oidn->GetDeviceInt(oidn->device, "version");
    snprintf(oidn->version, sizeof oidn->version, "%d.%d.%d", version / 10000, version / 100 % 100, version % 100);
    return EC_OK;
}

ec_result ec_oidn_open(ec_oidn **made, ec_error *err)
{
    void *library;
    *made = NULL;
    EC_TRY(ec_oidn_load(&library, err));
    ec_oidn *oidn = calloc(1, sizeof *oidn);
    if (!oidn) return ec_fail(err, "out of memory for a denoiser");
    ec_result result = find_functions(oidn, library, err);
    if (result == EC_OK) result = open_device(oidn, err);
    if (result == EC_OK) *made = oidn;
    else ec_oidn_close(oidn);
    return result;
}

void ec_oidn_close(ec_oidn *oidn)
{
    if (oidn && oidn->device) oidn->ReleaseDevice(oidn->device);
    free(oidn);
}

const char *ec_oidn_version(const ec_oidn *oidn) { return oidn->version; }

static void set_image(ec_oidn *oidn, void *filter, const ec_oidn_image *image, const char *name, float *data)
{
    if (data) oidn->SetSharedFilterImage(filter, name, data, FLOAT3, image->width, image->height, 0, 0, 0);
}

ec_result ec_oidn_filter_create(ec_oidn *oidn, const ec_oidn_image *image, ec_oidn_filter **made, ec_error *err)
{
    void *filter = oidn->NewFilter(oidn->device, "RT");
    *made = filter;
    if (!filter) return check(oidn, "has no filter", err);
    float *output = image->color ? image->color : image->albedo ? image->albedo : image->normal;
    set_image(oidn, filter, image, "color", image->color);
    set_image(oidn, filter, image, "albedo", image->albedo);
    set_image(oidn, filter, image, "normal", image->normal);
    set_image(oidn, filter, image, "output", output);
    if (image->color) oidn->SetFilterBool(filter, "hdr", true);
    if (image->color && image->has_clean_guides) oidn->SetFilterBool(filter, "cleanAux", true);
    oidn->SetFilterInt(filter, "quality", (int)image->quality);
    oidn->SetFilterInt(filter, "maxMemoryMB", MEMORY_MB);
    oidn->CommitFilter(filter);
    const ec_result result = check(oidn, "failed", err);
    if (result != EC_OK) ec_oidn_filter_free(oidn, filter), *made = NULL;
    return result;
}

ec_result ec_oidn_filter_run(ec_oidn *oidn, ec_oidn_filter *filter, ec_error *err)
{
    oidn->ExecuteFilter(filter);
    return check(oidn, "failed", err);
}

void ec_oidn_filter_free(ec_oidn *oidn, ec_oidn_filter *filter)
{
    if (filter) oidn->ReleaseFilter(filter);
}

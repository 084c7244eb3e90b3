/* A stand-in for Open Image Denoise, for test_denoise.py. It makes colours 0.9 as bright, so that the test can predict the report. With
 * DIM_SHOWS_ALBEDO in the environment it returns the albedo instead. It does not change a guide that is filtered alone. It declares only
 * the functions that host/denoise/oidn.c calls. */
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { FILTERS = 4 };

typedef struct filter {
    float *color, *albedo;
    size_t values;
} filter;

static filter filters[FILTERS];

void *oidnNewDevice(int type) { return type == 1 ? filters : NULL; }
void oidnSetDeviceBool(void *device, const char *name, bool value) { (void)device, (void)name, (void)value; }
int oidnGetDeviceInt(void *device, const char *name) { return (void)device, strcmp(name, "version") == 0 ? 20000 : 0; }
int oidnGetDeviceError(void *device, const char **text) { return (void)device, (void)text, 0; }
void oidnCommitDevice(void *device) { (void)device; }
void oidnReleaseDevice(void *device) { (void)device; }

void *oidnNewFilter(void *device, const char *type)
{
    (void)device, (void)type;
    for (int i = 0; i < FILTERS; i++)
        if (!filters[i].values) return filters[i].values = 1, &filters[i];
    return NULL;
}

void oidnSetSharedFilterImage(filter *f, const char *name, void *data, int format, size_t width, size_t height, size_t offset, size_t pixel_stride,
                              size_t row_stride)
{
    (void)format, (void)offset, (void)pixel_stride, (void)row_stride;
    if (strcmp(name, "color") == 0) f->color = data, f->values = 3 * width * height;
    if (strcmp(name, "albedo") == 0) f->albedo = data;
}

void oidnSetFilterBool(filter *f, const char *name, bool value) { (void)f, (void)name, (void)value; }
void oidnSetFilterInt(filter *f, const char *name, int value) { (void)f, (void)name, (void)value; }
void oidnCommitFilter(filter *f) { (void)f; }

void oidnExecuteFilter(filter *f)
{
    const bool shows_albedo = getenv("DIM_SHOWS_ALBEDO") != NULL;
    for (size_t i = 0; f->color && i < f->values; i++) f->color[i] = shows_albedo ? f->albedo[i] : 0.9f * f->color[i];
}

void oidnReleaseFilter(filter *f) { *f = (filter){0}; }

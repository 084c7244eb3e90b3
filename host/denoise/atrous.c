#include "denoise/atrous.h"

#include <stdlib.h>

#include "denoise/judge.h"
#include "shared/path_state.h"

enum { PASSES = 5, LOCAL = 64 };

_Static_assert(EC_AOV_FIELDS == EC_FILM_FEATURES, "the kernel reads the film's features");

typedef struct work {
    ec_cl cl;
    cl_program program;
    cl_kernel kernel;
    cl_mem colours[2], features;
    uint64_t pixels;
    cl_int width, height;
} work;

static ec_result set_up(work *w, const ec_device_info *device, ec_error *err)
{
    EC_TRY(ec_cl_open(device, &w->cl, err));
    EC_TRY(ec_program_build(&w->cl, "atrous", ec_kernel_source("atrous"), "-DLANES=1 -DFEATURES=0", &w->program, err));
    EC_TRY(ec_kernel_create(w->program, "ec_atrous", &w->kernel, err));
    EC_TRY(ec_buffer_create(&w->cl, "features", w->pixels * EC_AOV_FIELDS * sizeof(float), NULL, &w->features, err));
    for (int i = 0; i < 2; i++) EC_TRY(ec_buffer_create(&w->cl, "colours", w->pixels * 4 * sizeof(float), NULL, &w->colours[i], err));
    return EC_OK;
}

static void take_down(work *w)
{
    for (int i = 0; i < 2; i++) ec_buffer_release(&w->cl, &w->colours[i]);
    ec_buffer_release(&w->cl, &w->features);
    if (w->kernel) clReleaseKernel(w->kernel);
    if (w->program) clReleaseProgram(w->program);
    ec_cl_close(&w->cl);
}

/* Runs the passes from one buffer to the other and back, with taps further apart each time; the last one holds the picture. */
static ec_result run_passes(work *w, ec_error *err)
{
    for (cl_int pass = 0; pass < PASSES; pass++) {
        const cl_int apart = 1 << pass;
        const ec_argument arguments[] = {EC_ARGUMENT(w->colours[pass % 2]), EC_ARGUMENT(w->features), EC_ARGUMENT(w->colours[(pass + 1) % 2]),
                                         EC_ARGUMENT(w->width), EC_ARGUMENT(w->height), EC_ARGUMENT(apart)};
        EC_TRY(ec_kernel_arguments(w->kernel, arguments, sizeof arguments / sizeof *arguments, err));
        ec_cl_busy(&w->cl, "atrous", w->pixels);
        EC_TRY(ec_kernel_run(&w->cl, "atrous", w->kernel, w->pixels, LOCAL, err));
    }
    return EC_OK;
}

/* room: EC_FILM_FEATURES floats a pixel. */
static ec_result filter_half(work *w, const ec_film *film, uint32_t half, float scale, float *room, float *rgb, ec_error *err)
{
    const uint64_t bytes = w->pixels * 4 * sizeof(float);
    ec_film_features_of(film, half, 0, w->pixels, room);
    EC_TRY(ec_buffer_write(&w->cl, w->features, 0, w->pixels * EC_FILM_FEATURES * sizeof(float), room, err));
    ec_half(film, half, scale, 4, room);
    EC_TRY(ec_buffer_write(&w->cl, w->colours[0], 0, bytes, room, err));
    EC_TRY(run_passes(w, err));
    EC_TRY(ec_buffer_read(&w->cl, w->colours[PASSES % 2], 0, bytes, room, err));
    for (uint64_t i = 0; i < w->pixels; i++)
        for (uint64_t c = 0; c < 3; c++) rgb[3 * i + c] = room[4 * i + c];
    return EC_OK;
}

ec_result ec_atrous(const ec_device_info *device, const ec_film *film, float scale, float *const half[2], ec_error *err)
{
    work w = {.pixels = (uint64_t)film->width * film->height, .width = (cl_int)film->width, .height = (cl_int)film->height};
    float *room = malloc(w.pixels * EC_FILM_FEATURES * sizeof *room);
    ec_result result = room ? set_up(&w, device, err) : ec_fail(err, "out of memory for denoising %u x %u pixels", film->width, film->height);
    for (uint32_t h = 0; result == EC_OK && h < 2; h++) result = filter_half(&w, film, h, scale, room, half[h], err);
    take_down(&w);
    free(room);
    return result;
}

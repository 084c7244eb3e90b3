/* Traces light paths before the picture, for the guide's table. */
#include <stdlib.h>

#include "base/clock.h"
#include "base/freed.h"
#include "device/guide.h"
#include "device/pipeline.h"
#include "shared/guide.h"

#define PATHS (1u << 19)        /* whatever the picture's size */
#define PHOTONS_MOST (1u << 20) /* 32 MiB */
#define SEED 0x9e3779b9u        /* the same for all pictures: slices and frames of one job are guided alike */

_Static_assert(sizeof(ec_photon) == 4 * EC_PHOTON_WORDS, "photons are read as kernels write them");

typedef struct photons {
    ec_photon *list;
    size_t count, room;
} photons;

static ec_result add(photons *all, const ec_photon *one, ec_error *err)
{
    if (all->count == all->room) {
        const size_t room = all->room ? 2 * all->room : 4096;
        ec_photon *list = realloc(all->list, room * sizeof *list);
        if (!list) return ec_fail(err, "out of memory for the photons of --guiding");
        all->list = list;
        all->room = room;
    }
    all->list[all->count++] = *one;
    return EC_OK;
}

/* Adds what paths first … first + count - 1 meet, path by path, so that waves of any size give one list. met: room for all that they meet. */
static ec_result trace(ec_pipeline *p, uint32_t first, uint32_t count, ec_photon *met, photons *all, ec_error *err)
{
    const uint64_t bytes = (uint64_t)count * EC_PHOTON_VERTICES * sizeof *met;
    EC_TRY(ec_buffer_zero(p->cl, p->buffers[EC_ARG_PHOTONS], 0, bytes, err));
    EC_TRY(ec_pipeline_run_light_wave(p, SEED, first, count, err));
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_PHOTONS], 0, bytes, met, err));
    for (uint32_t path = 0; path < count; path++)
        for (uint32_t vertex = 0; vertex < EC_PHOTON_VERTICES && all->count < PHOTONS_MOST; vertex++) {
            const ec_photon *one = &met[(size_t)vertex * count + path];
            if (one->flux > 0) EC_TRY(add(all, one, err));
        }
    return EC_OK;
}

static ec_result collect(ec_pipeline *p, photons *all, ec_error *err)
{
    const uint64_t bytes = (uint64_t)p->wave * EC_PHOTON_VERTICES * sizeof(ec_photon);
    const uint32_t batch = p->params.batch;
    EC_FREED ec_photon *met = malloc(bytes);
    if (!met) return ec_fail(err, "out of memory for the photons of --guiding");
    EC_TRY(ec_buffer_create(p->cl, "photons", bytes, NULL, &p->buffers[EC_ARG_PHOTONS], err));
    p->params.batch = 1;
    EC_TRY(ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof p->params, &p->params, err));
    for (uint32_t first = 0, count; first < PATHS && all->count < PHOTONS_MOST; first += count) {
        count = p->wave < PATHS - first ? p->wave : PATHS - first;
        EC_TRY(trace(p, first, count, met, all, err));
    }
    ec_buffer_release(p->cl, &p->buffers[EC_ARG_PHOTONS]);
    p->params.batch = batch;
    p->rays = 0; /* rays count for the picture alone */
    return ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof p->params, &p->params, err);
}

ec_result ec_pipeline_train(ec_pipeline *p, double *seconds, ec_error *err)
{
    photons all = {0};
    float *table = NULL;
    size_t words;
    const double start = ec_now();
    if (!(p->effects.called.bits & EC_FEATURE_GUIDING)) return EC_OK;
    ec_result result = collect(p, &all, err);
    if (result == EC_OK) result = ec_guide_build(all.list, all.count, &table, &words, err);
    if (result == EC_OK && table) result = ec_buffer_create(p->cl, "path guiding", words * sizeof *table, table, &p->buffers[EC_ARG_GUIDE], err);
    p->guide = table;
    free(all.list);
    *seconds = ec_now() - start;
    return result;
}

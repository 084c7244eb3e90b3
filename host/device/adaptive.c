#include "device/adaptive.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "film/neighbourhood.h"
#include "film/pixel.h"
#include "film/threads.h"
#include "device/batch_source.h"

#define RADIUS 3        /* 48 pixels around: with the pilot's replicates they give a variance to a tenth or so */
#define LEAST 0.15      /* least weight of a pixel: what the pilot did not see is still looked for */
#define MOST 24.0       /* greatest weight, in means */
#define WORTH_IT 0.95

/* Numbers go tile by tile, as in pixel_to_xy of kernels/lib/film.h: rows of tiles first, the last of them lower, its last tile narrower. */
uint32_t ec_pixel_place(const ec_params *params, uint32_t number)
{
    const uint32_t tile = EC_TILE_ROWS, width = params->width, height = params->height;
    const uint32_t y0 = number / (width * tile) * tile, rows = height - y0 < tile ? height - y0 : tile;
    const uint32_t in_row = number % (width * tile), x0 = in_row / (rows * tile) * tile, columns = width - x0 < tile ? width - x0 : tile;
    const uint32_t in_tile = in_row - x0 * rows;
    return (y0 + in_tile / columns) * width + x0 + in_tile % columns;
}

/* Sets the variance of luminance, of a sample, for all pixels in row order. */
static void look_at_variances(const ec_film *film, float *variance)
{
    const uint64_t pixels = (uint64_t)film->width * film->height;
#pragma omp parallel for if (ec_film_is_many(pixels))
    for (uint64_t first = 0; first < pixels; first += EC_PIXELS) {
        const uint64_t count = pixels - first < EC_PIXELS ? pixels - first : EC_PIXELS;
        ec_pixel piece[EC_PIXELS];
        ec_film_look(film, first, count, piece);
        for (uint64_t i = 0; i < count; i++) variance[first + i] = (float)(ec_pixel_se2(&piece[i], 3) * piece[i].samples);
    }
}

static double variance_around(const ec_film *film, const float *variance, uint32_t place)
{
    uint32_t x = place % film->width, y = place / film->width;
    ec_neighbourhood around = ec_neighbourhood_of(x, y, RADIUS, film->width, film->height);
    double sum = 0, count = 0;
    for (uint32_t j = around.y0; j < around.y1; j++)
        for (uint32_t i = around.x0; i < around.x1; i++) {
            uint64_t q = (uint64_t)j * film->width + i;
            if (q == place) continue;
            sum += variance[q];
            count++;
        }
    return count > 0 ? sum / count : 0;
}

/* Scales weights to a mean of 1, after lifting them to LEAST and cutting them to MOST. */
static void normalise(ec_allotment *a, double mean)
{
    double sum = 0;
    for (uint32_t i = 0; i < a->pixels; i++) {
        double w = mean > 0 ? LEAST + (1 - LEAST) * a->weight[i] / mean : 1;
        a->weight[i] = (float)fmin(w, MOST);
        sum += a->weight[i];
    }
    for (uint32_t i = 0; i < a->pixels; i++) a->weight[i] = (float)(a->weight[i] * a->pixels / sum);
}

/* Returns error^2 by these weights over that of uniform sampling. A pixel's own variance is independent of its weight, so that this is no flattery. */
static double predicted_gain(const ec_allotment *a)
{
    double uniform = 0, weighted = 0;
    for (uint32_t i = 0; i < a->pixels; i++) {
        const double v = a->variance[a->place[i]];
        uniform += v;
        weighted += v / a->weight[i];
    }
    return uniform > 0 ? weighted / uniform : 1;
}

static ec_result allocate(ec_allotment *a, const ec_params *params, ec_error *err)
{
    a->pixels = params->width * params->height;
    a->room = (uint32_t)ec_order_positions(a->pixels, a->replicates);
    a->weight = malloc(a->pixels * sizeof *a->weight);
    a->place = malloc(a->pixels * sizeof *a->place);
    a->list = malloc((uint64_t)a->room * EC_LIST_WORDS * sizeof *a->list);
    a->places = malloc(a->room * sizeof *a->places);
    a->variance = malloc(a->pixels * sizeof *a->variance);
    if (!a->weight || !a->place || !a->list || !a->places || !a->variance) {
        ec_allotment_free(a);
        return ec_fail(err, "out of memory for the allotment of samples to %u pixels; give --adaptive off",
                       params->width * params->height);
    }
    for (uint32_t i = 0; i < a->pixels; i++) a->place[i] = ec_pixel_place(params, i);
    return EC_OK;
}

ec_result ec_allotment_again(const ec_allotment *made, const ec_params *params, uint32_t replicates, ec_allotment *a, ec_error *err)
{
    *a = (ec_allotment){.level = made->level, .gain = made->gain, .replicates = replicates};
    EC_TRY(allocate(a, params, err));
    memcpy(a->weight, made->weight, (size_t)a->pixels * sizeof *a->weight);
    return EC_OK;
}

static void weigh(ec_allotment *a, const ec_film *film)
{
    double mean = 0;
    look_at_variances(film, a->variance);
#pragma omp parallel for if (ec_film_is_many(a->pixels))
    for (uint32_t i = 0; i < a->pixels; i++) a->weight[i] = (float)sqrt(variance_around(film, a->variance, a->place[i]));
    for (uint32_t i = 0; i < a->pixels; i++) mean += a->weight[i] / a->pixels;
    normalise(a, mean);
}

ec_result ec_allot(const ec_film *film, const ec_params *params, ec_allotment *a, ec_error *err)
{
    *a = (ec_allotment){.level = film->samples[0], .gain = 1, .replicates = film->replicates};
    if ((uint64_t)film->width * film->height < EC_ALLOT_PIXELS) return EC_OK;
    EC_TRY(allocate(a, params, err));
    weigh(a, film);
    const double gain = predicted_gain(a);
    if (gain > WORTH_IT) ec_allotment_free(a);
    else a->gain = gain;
    return EC_OK;
}

/* Returns a pixel's phase in [0, 1), by the golden ratio, so that pixels of one weight do not all fall due in the same pass. */
static double phase(uint32_t number)
{
    return (double)(uint32_t)(number * 2654435769u) * 0x1p-32;
}

/* Returns how many samples each replicate of pixel number i has. */
static uint32_t samples_of(const ec_allotment *a, const ec_film *film, uint32_t i)
{
    return film->counts ? film->counts[a->place[i]] : (uint32_t)film->samples[0];
}

/* Returns the length of the next stride of pixel number i, with `has` samples, if it is due that; else 0. */
static uint32_t due(const ec_allotment *a, uint32_t i, double has)
{
    const uint32_t step = ec_schedule_step((uint64_t)has);
    return has + step * phase(i) < a->level * a->weight[i] && has + step < UINT32_MAX ? step : 0;
}

bool ec_allotment_is_even(const ec_allotment *a, const ec_film *film)
{
    for (uint32_t i = 0; i < a->pixels; i++)
        if (due(a, i, samples_of(a, film, i))) return false;
    return true;
}

/* Pixels that one thread looks at: the shortest stride that any of them is due, and how many strides of that length they are due. */
typedef struct share {
    uint32_t first, end, step, strides;
} share;
enum { SHARES = 64 };

/* Returns how many strides pixel number i is due that are as long as its next one, *step. In which strides a pixel goes on depends on nothing but its
 * samples, and so do its bits. */
static uint32_t strides_due(const ec_allotment *a, const ec_film *film, uint32_t i, uint32_t *step)
{
    uint32_t has = samples_of(a, film, i), count = 0;
    *step = due(a, i, has);
    for (uint32_t next = *step; next && next == *step; count++) next = due(a, i, has += next);
    return count;
}

static void look(const ec_allotment *a, const ec_film *film, share *s)
{
    s->step = UINT32_MAX;
    s->strides = 0;
    for (uint32_t i = s->first; i < s->end; i++) {
        uint32_t step, count = strides_due(a, film, i, &step);
        if (!step || step > s->step) continue;
        s->strides = count + (step == s->step ? s->strides : 0);
        s->step = step;
    }
}

/* Returns the shortest stride that any pixel is due. */
static uint32_t look_at_all(const ec_allotment *a, const ec_film *film, share shares[SHARES])
{
    uint32_t least = UINT32_MAX;
#pragma omp parallel for if (ec_film_is_many(a->pixels))
    for (uint32_t k = 0; k < SHARES; k++) {
        shares[k].first = (uint32_t)((uint64_t)a->pixels * k / SHARES);
        shares[k].end = (uint32_t)((uint64_t)a->pixels * (k + 1) / SHARES);
        look(a, film, &shares[k]);
    }
    for (uint32_t k = 0; k < SHARES; k++) least = shares[k].step < least ? shares[k].step : least;
    return least;
}

/* Enters strides of the pass in the list, from its stride `at` on, up to `most`. */
static void enter(ec_allotment *a, const ec_film *film, const share *s, uint32_t samples, uint64_t at, uint64_t most)
{
    for (uint32_t i = s->first; i < s->end && at < most; i++) {
        uint32_t step, count = strides_due(a, film, i, &step), has = samples_of(a, film, i);
        if (step != samples) continue;
        for (; count > 0 && at < most; count--, at++, has += samples)
            for (uint32_t r = 0; r < a->replicates; r++) {
                uint32_t *entry = a->list + EC_LIST_WORDS * (at * a->replicates + r);
                entry[0] = i + r * a->pixels;
                entry[1] = has;
                a->places[at * a->replicates + r] = a->place[i];
            }
    }
}

/* Raises the level. Once all pixels have what they are due at a power of 2, beyond the pilot, whose weights these are, variances are known better,
 * and weights are made anew. */
static void rise(ec_allotment *a, const ec_film *film)
{
    const uint64_t level = (uint64_t)a->level;
    if (level > ec_schedule_pilot(a->replicates) && (level & (level - 1)) == 0) weigh(a, film);
    a->level += ec_schedule_step(level);
}

ec_pass ec_allotment_pass(ec_allotment *a, const ec_film *film, double most)
{
    share shares[SHARES];
    uint64_t starts[SHARES + 1] = {0};
    uint32_t step;
    while ((step = look_at_all(a, film, shares)) == UINT32_MAX) rise(a, film);
    const double allowed = floor(most / ((double)step * a->replicates)), room = floor((double)a->room / a->replicates);
    const uint64_t strides_most = (uint64_t)fmax(fmin(allowed, room), 1);
    for (uint32_t k = 0; k < SHARES; k++) starts[k + 1] = starts[k] + (shares[k].step == step ? shares[k].strides : 0);
#pragma omp parallel for if (ec_film_is_many(a->pixels))
    for (uint32_t k = 0; k < SHARES; k++)
        if (shares[k].step == step) enter(a, film, &shares[k], step, starts[k], strides_most);
    const uint64_t strides = starts[SHARES] < strides_most ? starts[SHARES] : strides_most;
    return (ec_pass){.count = (uint32_t)(strides * a->replicates), .samples = step};
}

void ec_allotment_free(ec_allotment *a)
{
    free(a->weight);
    free(a->place);
    free(a->list);
    free(a->places);
    free(a->variance);
    *a = (ec_allotment){.gain = 1};
}

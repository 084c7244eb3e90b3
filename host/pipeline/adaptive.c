#include "pipeline/adaptive.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "film/neighbourhood.h"

#define RADIUS 3        /* 48 pixels around: with a pilot of four batches they know a variance to a tenth or so */
#define LEAST 0.15      /* weight that every pixel has: what the pilot did not see is still looked for */
#define MOST 24.0       /* of the mean */
#define WORTH_IT 0.95

/* As kernels/lib/film.h numbers pixels: tile by tile. */
static void number_pixels(const ec_params *params, uint32_t *place)
{
    const uint32_t tile = 8, width = params->width, height = params->height;
    uint32_t number = 0;
    for (uint32_t y0 = 0; y0 < height; y0 += tile)
        for (uint32_t x0 = 0; x0 < width; x0 += tile)
            for (uint32_t y = y0; y < y0 + tile && y < height; y++)
                for (uint32_t x = x0; x < x0 + tile && x < width; x++) place[number++] = y * width + x;
}

static double deviation_around(const ec_film *film, uint32_t place)
{
    uint32_t x = place % film->width, y = place / film->width;
    ec_neighbourhood around = ec_neighbourhood_of(x, y, RADIUS, film->width, film->height);
    double sum = 0, count = 0;
    for (uint32_t j = around.y0; j < around.y1; j++)
        for (uint32_t i = around.x0; i < around.x1; i++) {
            uint64_t q = (uint64_t)j * film->width + i;
            if (q == place) continue;
            sum += film->m2[4 * q + 3];
            count++;
        }
    return count > 0 ? sqrt(sum / count / (film->batch_count - 1.0)) : 0;
}

/* Mean 1, none under LEAST and none over MOST. */
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

/* A pixel's own variance is independent of its weight, so that this is no flattery. */
static double foretold_gain(const ec_allotment *a, const ec_film *film)
{
    double uniform = 0, weighted = 0;
    for (uint32_t i = 0; i < a->pixels; i++) {
        double v = film->m2[4 * (uint64_t)a->place[i] + 3];
        uniform += v;
        weighted += v / a->weight[i];
    }
    return uniform > 0 ? weighted / uniform : 1;
}

static ec_result allocate(ec_allotment *a, const ec_params *params, ec_error *err)
{
    a->pixels = params->width * params->height;
    size_t bytes = (size_t)a->pixels * sizeof(uint32_t);
    a->weight = malloc(bytes);
    a->place = malloc(bytes);
    a->list = malloc(bytes);
    a->places = malloc(bytes);
    if (!a->weight || !a->place || !a->list || !a->places) {
        ec_allotment_free(a);
        return ec_fail(err, "out of memory for the allotment of samples to %u pixels; leave out --adaptive",
                       params->width * params->height);
    }
    number_pixels(params, a->place);
    return EC_OK;
}

ec_result ec_allotment_again(const ec_allotment *made, const ec_params *params, ec_allotment *a, ec_error *err)
{
    *a = (ec_allotment){.level = made->level, .gain = made->gain};
    EC_TRY(allocate(a, params, err));
    memcpy(a->weight, made->weight, (size_t)a->pixels * sizeof *a->weight);
    return EC_OK;
}

ec_result ec_allot(const ec_film *film, const ec_params *params, ec_allotment *a, ec_error *err)
{
    *a = (ec_allotment){.level = film->batch_count, .gain = 1};
    EC_TRY(allocate(a, params, err));
    double mean = 0;
    for (uint32_t i = 0; i < a->pixels; i++) {
        a->weight[i] = (float)deviation_around(film, a->place[i]);
        mean += a->weight[i] / a->pixels;
    }
    normalise(a, mean);
    double gain = foretold_gain(a, film);
    if (gain > WORTH_IT) ec_allotment_free(a);
    else a->gain = gain;
    return EC_OK;
}

/* So that pixels of one weight do not all fall due in the same pass: golden ratio. */
static double phase(uint32_t number)
{
    return (double)(uint32_t)(number * 2654435769u) * 0x1p-32;
}

/* Batches that pixel number i is due, as far as numbers go. */
static uint32_t due(const ec_allotment *a, const ec_film *film, uint32_t i)
{
    double wanted = floor(a->level * a->weight[i] + phase(i)), has = ec_film_batches(film, a->place[i]);
    return (uint32_t)fmin(fmax(wanted - has, 0), UINT32_MAX / a->pixels);
}

uint32_t ec_allotment_pass(ec_allotment *a, const ec_film *film)
{
    uint32_t count = 0;
    for (bool raised = false; count == 0; raised = true) {
        if (raised) a->level += 0.5;
        for (uint32_t i = 0; i < a->pixels; i++)
            for (uint32_t k = 0, n = due(a, film, i); k < n && count < a->pixels; k++) {
                a->list[count] = i + k * a->pixels;
                a->places[count++] = a->place[i];
            }
    }
    return count;
}

void ec_allotment_free(ec_allotment *a)
{
    free(a->weight);
    free(a->place);
    free(a->list);
    free(a->places);
    *a = (ec_allotment){.gain = 1};
}

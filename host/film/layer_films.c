#include "film/layer_films.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "film/pixel.h"
#include "film/threads.h"

ec_result ec_film_set_layers(ec_film *film, const ec_layers *layers, ec_error *err)
{
    film->layers = *layers;
    if (layers->mattes) EC_TRY(ec_matte_create(&film->matte, (uint64_t)film->width * film->height, err));
    if (!layers->count) return EC_OK;
    film->layer_films = calloc(layers->count, sizeof *film->layer_films);
    if (!film->layer_films) return ec_fail(err, "out of memory for %u layers", layers->count);
    for (uint32_t k = 0; k < layers->count; k++) EC_TRY(ec_film_create(&film->layer_films[k], film->width, film->height, film->replicates, err));
    return EC_OK;
}

void ec_film_layer_batch(const ec_film *film, uint32_t layer, const float *layers, uint64_t positions, float *batch)
{
    const uint64_t stride = 3ull * film->layers.count;
#pragma omp parallel for if (ec_film_is_many(positions))
    for (uint64_t i = 0; i < positions; i++) {
        float *to = batch + EC_BATCH_FIELDS * i;
        memset(to, 0, EC_BATCH_FIELDS * sizeof *to);
        memcpy(to, layers + stride * i + 3ull * layer, 3 * sizeof *to);
    }
}

static float sum_of(const float *numbers, uint32_t count, uint32_t stride)
{
    float sum = numbers[0];
    for (uint32_t k = 1; k < count; k++) sum += numbers[k * stride];
    return sum;
}

/* Adjusts one number alone, which starts nearly right, since the sum of the others loses no more than roundings. */
static bool step_to(float *number, const float *numbers, uint32_t count, uint32_t stride, float sum)
{
    enum { STEPS = 16 };
    *number += sum - sum_of(numbers, count, stride);
    for (int i = 0; i < STEPS; i++) {
        const float now = sum_of(numbers, count, stride);
        if (now == sum) return true;
        *number = nextafterf(*number, now < sum ? INFINITY : -INFINITY);
    }
    return false;
}

/* Adjusts another one too, in steps from an eighth of the sum's last place on. */
static bool nudge_to(float *number, const float *numbers, uint32_t count, uint32_t stride, float sum)
{
    const float before = *number, place = nextafterf(fabsf(sum), INFINITY) - fabsf(sum);
    for (int i = 2; i < 50; i++) {
        *number = before + (i & 1 ? -place : place) * (float)(i / 2) / 8;
        if (sum_of(numbers, count, stride) == sum) return true;
    }
    *number = before;
    return false;
}

/* A step of the largest number moves the sum by one in its last place, or by two where both halves round to even: then another number makes up for
 * that. If none does, which no test has seen, the largest takes all. */
void ec_sum_to(float *numbers, uint32_t count, uint32_t stride, float sum)
{
    uint32_t largest = 0;
    if (!isfinite(sum) || sum_of(numbers, count, stride) == sum) return;
    for (uint32_t k = 1; k < count; k++)
        if (fabsf(numbers[k * stride]) > fabsf(numbers[largest * stride])) largest = k;
    if (step_to(&numbers[largest * stride], numbers, count, stride, sum)) return;
    for (uint32_t k = 0; k < count; k++)
        if (k != largest && nudge_to(&numbers[k * stride], numbers, count, stride, sum)) return;
    for (uint32_t k = 0; k < count; k++) numbers[k * stride] = k == largest ? sum : 0.0f;
}

static void write_pixel(const ec_pixel *pixel, float *out)
{
    for (int c = 0; c < 3; c++) out[c] = (float)pixel->mean[c];
    for (int c = 0; c < 4; c++) out[3 + c] = (float)sqrt(ec_pixel_se2(pixel, c));
}

/* Makes layers [first, first + count) of a pixel add up to rgb. */
static void add_up(float *out, uint32_t first, uint32_t count, const float *rgb)
{
    for (uint32_t c = 0; c < 3 && count; c++) ec_sum_to(out + EC_LAYER_PLANES * first + c, count, EC_LAYER_PLANES, rgb[c]);
}

void ec_film_resolve_layers(const ec_film *film, uint32_t first, uint32_t rows, const float *rgb, float *out)
{
    const ec_layers *layers = &film->layers;
    const uint64_t pixels = (uint64_t)rows * film->width, before = (uint64_t)first * film->width;
    const uint32_t direct = ec_layers_find(layers, EC_LAYER_DIRECT), indirect = ec_layers_find(layers, EC_LAYER_INDIRECT);
    ec_pixel piece[EC_PIXELS];
    for (uint64_t at = 0; at < pixels; at += EC_PIXELS) {
        const uint64_t count = pixels - at < EC_PIXELS ? pixels - at : EC_PIXELS;
        for (uint32_t k = 0; k < layers->count; k++) {
            ec_film_look(&film->layer_films[k], before + at, count, piece);
            for (uint64_t i = 0; i < count; i++) write_pixel(&piece[i], out + EC_LAYER_PLANES * ((at + i) * layers->count + k));
        }
    }
    for (uint64_t i = 0; i < pixels; i++) {
        float *own = out + EC_LAYER_PLANES * i * layers->count;
        if (direct && indirect) add_up(own, direct - 1, 2, rgb + 3 * i);
        if (layers->group_count) add_up(own, layers->count - layers->group_count, layers->group_count, rgb + 3 * i);
    }
}

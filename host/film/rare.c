#include "film/rare.h"

#include <math.h>
#include <stdio.h>

ec_rare_kind *ec_rare_make_room(ec_rare *rare, double matters)
{
    uint32_t least = 0;
    if (rare->count < EC_RARE_KINDS) return &rare->kinds[rare->count++];
    for (uint32_t i = 1; i < EC_RARE_KINDS; i++)
        if (rare->kinds[i].luminance * rare->kinds[i].gathered < rare->kinds[least].luminance * rare->kinds[least].gathered) least = i;
    return rare->kinds[least].luminance * rare->kinds[least].gathered < matters ? &rare->kinds[least] : NULL;
}

void ec_rare_way(const char *through, const char *light, char *text, size_t size)
{
    if (*through) snprintf(text, size, "through \"%s\" to %s", through, light);
    else snprintf(text, size, "straight to %s", light);
}

static int is_missing(const ec_rare_kind *kind, double samples) { return samples * kind->chance < EC_RARE_MET; }

/* Returns the luminance that a kind brings to a picture of that mean and limit. */
static double luminance_of(const ec_rare_kind *kind, double mean, double limit)
{
    const double all = kind->luminance * (kind->is_relative ? mean : 1), clamped = kind->clamped * all;
    return limit > 0 ? all - clamped + fmin(clamped, kind->chance * limit) : all;
}

double ec_rare_missing(const ec_rare *rare, double samples, double mean, double limit, const ec_rare_kind **most)
{
    double sum = 0, squares = 0, largest = 0;
    *most = NULL;
    for (uint32_t i = 0; rare && i < rare->count; i++) {
        const ec_rare_kind *kind = &rare->kinds[i];
        if (!is_missing(kind, samples)) continue;
        const double luminance = luminance_of(kind, mean, limit), rms = luminance * kind->gathered;
        sum += luminance;
        squares += rms * rms - luminance * luminance;
        if (!*most || rms > largest) *most = kind, largest = rms;
    }
    return sum * sum + squares;
}

double ec_rare_caustics(const ec_rare *rare, double mean, const ec_rare_kind **most)
{
    double sum = 0, largest = 0;
    *most = NULL;
    for (uint32_t i = 0; i < rare->count; i++) {
        const ec_rare_kind *kind = &rare->kinds[i];
        const double luminance = luminance_of(kind, mean, 0) / mean, variance = kind->caustic * luminance * luminance / kind->chance;
        sum += variance;
        if (variance > largest) *most = kind, largest = variance;
    }
    return sum;
}

uint32_t ec_rare_tile(const ec_rare *rare, uint32_t x, uint32_t y)
{
    return (uint32_t)((uint64_t)y * EC_RARE_TILES / rare->height) * EC_RARE_TILES + (uint32_t)((uint64_t)x * EC_RARE_TILES / rare->width);
}

double ec_rare_missing_at(const ec_rare *rare, double samples_a_pixel, double mean, double limit, uint32_t x, uint32_t y)
{
    const double samples = samples_a_pixel * rare->width * rare->height;
    const uint32_t tile = ec_rare_tile(rare, x, rare->row + y);
    double sum = 0;
    for (uint32_t i = 0; i < rare->count; i++)
        if (is_missing(&rare->kinds[i], samples)) sum += luminance_of(&rare->kinds[i], mean, limit) * rare->kinds[i].peak * rare->kinds[i].share[tile] / 255;
    return sum;
}

#include "film/rare.h"

#include <math.h>
#include <stddef.h>

static int is_unmet(const ec_rare_kind *kind, double samples) { return samples * kind->chance < EC_RARE_MET; }

/* What it brings to a picture with such a limit. */
static double luminance_of(const ec_rare_kind *kind, double mean, double limit)
{
    const double all = kind->luminance * (kind->is_relative ? mean : 1), clamped = kind->clamped * all;
    return limit > 0 ? all - clamped + fmin(clamped, kind->chance * limit) : all;
}

double ec_rare_unmet(const ec_rare *rare, double samples, double mean, double limit, const ec_rare_kind **most)
{
    double sum = 0, largest = 0;
    *most = NULL;
    for (uint32_t i = 0; rare && i < rare->count; i++) {
        const ec_rare_kind *kind = &rare->kinds[i];
        if (!is_unmet(kind, samples)) continue;
        const double rms = luminance_of(kind, mean, limit) * kind->gathered;
        sum += rms * rms;
        if (!*most || rms > largest) *most = kind, largest = rms;
    }
    return sum;
}

/* A tile's part of a kind's light, over the mean tile's. */
static double share_of(const ec_rare_kind *kind, uint32_t tile)
{
    uint32_t sum = 0;
    for (int i = 0; i < EC_RARE_SHARES; i++) sum += kind->share[i];
    return sum ? (double)kind->share[tile] * EC_RARE_SHARES / sum : 1;
}

uint32_t ec_rare_tile(const ec_rare *rare, uint32_t x, uint32_t y)
{
    return (uint32_t)((uint64_t)y * EC_RARE_TILES / rare->height) * EC_RARE_TILES + (uint32_t)((uint64_t)x * EC_RARE_TILES / rare->width);
}

double ec_rare_unmet_at(const ec_rare *rare, double samples_a_pixel, double mean, double limit, uint32_t x, uint32_t y)
{
    const double samples = samples_a_pixel * rare->width * rare->height;
    const uint32_t tile = ec_rare_tile(rare, x, rare->row + y);
    double sum = 0;
    for (uint32_t i = 0; i < rare->count; i++)
        if (is_unmet(&rare->kinds[i], samples)) sum += luminance_of(&rare->kinds[i], mean, limit) * share_of(&rare->kinds[i], tile);
    return sum;
}

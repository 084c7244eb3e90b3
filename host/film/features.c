/* First-hit features of a film: the mean over its parts. */
#include <math.h>
#include <string.h>

#include "film/film.h"

static double samples_of(const ec_film_part *part) { return part->set_samples[0] + part->set_samples[1]; }

double ec_film_feature_samples(const ec_film *film)
{
    double samples = 0;
    for (uint32_t i = 0; i < film->part_count; i++) samples += samples_of(&film->parts[i]);
    return samples;
}

/* Returns a part's set from pixel `first` on; NULL: it has none. */
static const float *values_of(const ec_film_part *part, uint32_t set, uint64_t first)
{
    if (!(part->set_samples[set] > 0)) return NULL;
    return part->batch ? part->features + EC_FILM_FEATURES * first : ec_sums_features(&part->sums, set, first);
}

/* Averages parts from left to right, and even replicates first. An average that moves by differences keeps values that are all alike. */
void ec_film_features_of(const ec_film *film, uint32_t half, uint64_t first, uint64_t count, float *out)
{
    const uint64_t values = count * EC_FILM_FEATURES;
    double samples = 0;
    memset(out, 0, values * sizeof *out);
    for (uint32_t i = 0; i < film->part_count; i++)
        for (uint32_t set = 0; set < film->feature_sets; set++) {
            const float *own = values_of(&film->parts[i], set, first);
            if (!own || (film->feature_sets == 2 && half != EC_BOTH_HALVES && half != set)) continue;
            samples += film->parts[i].set_samples[set];
            const double share = film->parts[i].set_samples[set] / samples;
            for (uint64_t v = 0; v < values; v++) out[v] = share < 1 ? (float)(out[v] + ((double)own[v] - out[v]) * share) : own[v];
        }
    for (uint64_t p = 0; film->shadow && half == EC_BOTH_HALVES && p < count; p++) {
        float *alpha = out + EC_FILM_FEATURES * p + EC_FILM_ALPHA;
        *alpha = fmaxf(*alpha, film->shadow[first + p]);
    }
}

const float *ec_film_features_at(const ec_film *film, uint64_t first)
{
    const ec_film_part *only = NULL;
    if (film->shadow || film->feature_sets != 1) return NULL;
    for (uint32_t i = 0; i < film->part_count; i++) {
        if (!(samples_of(&film->parts[i]) > 0)) continue;
        if (only) return NULL;
        only = &film->parts[i];
    }
    return only ? values_of(only, 0, first) : NULL;
}

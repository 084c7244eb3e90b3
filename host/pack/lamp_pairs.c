/* Half of a bulb's triangles face away from any point outside of it: chosen by power alone, half of all light samples are lost, and those that are
 * not vary as the cosine. For a ball far away a sample's relative variance is 5/3; where the one of two opposite triangles is taken that faces the
 * point it is 1/3. */
#include "pack/lamp_pairs.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/freed.h"
#include "base/vec3.h"

#define MOST 8192      /* lamps: each is compared with each */
#define OPPOSITE -0.7  /* cosine of the normals of a pair */
#define NONE UINT32_MAX

typedef struct facing {
    double n[3], middle[3];
    bool may; /* be one of a pair */
} facing;

static facing facing_of(const ec_light_data *l)
{
    facing f = {.may = (l->kind & EC_LIGHT_KIND_MASK) == EC_KIND_TRIANGLE && !(l->kind & EC_LIGHT_TWO_SIDED) && !(l->kind >> EC_LIGHT_PARTS)};
    if (!f.may) return f;
    ec_triangle_normal(l->a, l->b, l->c, f.n);
    const double length = sqrt(ec_dot(f.n, f.n));
    for (int k = 0; k < 3; k++) {
        f.n[k] /= length;
        f.middle[k] = ((double)l->a[k] + l->b[k] + l->c[k]) / 3;
    }
    return f;
}

/* The nearest that faces the opposite way, of those that are not taken; of equally near ones the most opposite. */
static uint32_t find_partner(const ec_light_data *lights, const facing *all, const uint32_t *partner, uint32_t i, uint32_t count)
{
    uint32_t best = NONE;
    double least = INFINITY;
    for (uint32_t j = i + 1; j < count; j++) {
        if (!all[j].may || partner[j] != NONE || memcmp(lights[i].emission, lights[j].emission, sizeof lights[i].emission)) continue;
        const double cosine = ec_dot(all[i].n, all[j].n);
        if (cosine > OPPOSITE) continue;
        double way2 = 0;
        for (int k = 0; k < 3; k++) way2 += (all[j].middle[k] - all[i].middle[k]) * (all[j].middle[k] - all[i].middle[k]);
        const double cost = way2 * (2 + cosine); /* 1 to 1.3 times that */
        if (cost < least) least = cost, best = j;
    }
    return best;
}

static void put(ec_light_data *lights, double *power, uint32_t *source, uint32_t at, const ec_light_data *light, double its_power, uint32_t its_source)
{
    lights[at] = *light;
    power[at] = its_power;
    source[at] = its_source;
}

/* Each pair to where its first one stands. */
static void move(const ec_light_data *old, const double *old_power, const uint32_t *old_source, const uint32_t *partner, uint32_t count,
                 ec_light_data *lights, double *power, uint32_t *source)
{
    uint32_t at = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t other = partner[i];
        if (other != NONE && other < i) continue;
        put(lights, power, source, at, &old[i], old_power[i], old_source[i]);
        if (other != NONE) {
            lights[at].kind |= EC_LIGHT_PAIR_FIRST;
            put(lights, power, source, ++at, &old[other], old_power[other], old_source[other]);
            lights[at].kind |= EC_LIGHT_PAIR_SECOND;
        }
        at++;
    }
}

ec_result ec_lamp_pairs_find(ec_light_data *lights, double *power, uint32_t *source, uint32_t count, uint32_t *pairs, ec_error *err)
{
    *pairs = 0;
    if (count < 2 || count > MOST) return EC_OK;
    EC_FREED facing *all = malloc(count * sizeof *all);
    EC_FREED uint32_t *partner = malloc(count * sizeof *partner);
    EC_FREED ec_light_data *old = malloc(count * sizeof *old);
    EC_FREED double *old_power = malloc(count * sizeof *old_power);
    EC_FREED uint32_t *old_source = malloc(count * sizeof *old_source);
    if (!all || !partner || !old || !old_power || !old_source) return ec_fail(err, "out of memory for %u lights", count);
    for (uint32_t i = 0; i < count; i++) all[i] = facing_of(&lights[i]), partner[i] = NONE;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t j = all[i].may && partner[i] == NONE ? find_partner(lights, all, partner, i, count) : NONE;
        if (j == NONE) continue;
        partner[i] = j;
        partner[j] = i;
        ++*pairs;
    }
    if (!*pairs) return EC_OK;
    memcpy(old, lights, count * sizeof *old);
    memcpy(old_power, power, count * sizeof *old_power);
    memcpy(old_source, source, count * sizeof *old_source);
    move(old, old_power, old_source, partner, count, lights, power, source);
    return EC_OK;
}

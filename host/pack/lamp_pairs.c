/* Half of a bulb's triangles face away from any point outside: chosen by power alone, half of all light samples are lost, and the others vary with
 * the cosine. For a ball far away the relative variance of a sample is 5/3; if of two opposite triangles the one that faces the point is taken, it is
 * 1/3. */
#include "pack/lamp_pairs.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/freed.h"
#include "base/vec3.h"
#include "pack/distribution.h"
#include "pack/light_order.h"

#define OPPOSITE -0.7  /* largest cosine between the normals of a pair */
#define NONE EC_NO_ID

typedef struct facing {
    double n[3], middle[3];
    bool may; /* be part of a pair */
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

/* Finds the nearest free light that faces the opposite way; of equally near ones the most opposite. */
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
        const double cost = way2 * (2 + cosine); /* 1 to 1.3 times the squared distance */
        if (cost < least) least = cost, best = j;
    }
    return best;
}

ec_result ec_lamp_pairs_match(const ec_light_data *lights, uint32_t count, uint32_t *partner, uint32_t *pairs, ec_error *err)
{
    EC_FREED facing *all = malloc(count * sizeof *all);
    if (!all) return ec_fail(err, "out of memory for %u lights", count);
    for (uint32_t i = 0; i < count; i++) all[i] = facing_of(&lights[i]), partner[i] = NONE;
    *pairs = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t j = all[i].may && partner[i] == NONE ? find_partner(lights, all, partner, i, count) : NONE;
        if (j == NONE) continue;
        partner[i] = j;
        partner[j] = i;
        ++*pairs;
    }
    return EC_OK;
}

void ec_lamp_pairs_order(ec_light_data *lights, uint32_t count, const uint32_t *partner, uint32_t *order)
{
    uint32_t at = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t other = partner[i];
        if (other != NONE && other < i) continue;
        order[at++] = i;
        if (other == NONE) continue;
        order[at++] = other;
        lights[i].kind |= EC_LIGHT_PAIR_FIRST;
        lights[other].kind |= EC_LIGHT_PAIR_SECOND;
    }
}

/* Moves the shares, so that each light keeps as many numbers as it had. */
static ec_result move_shares(ec_pack *pack, const uint32_t *order, ec_error *err)
{
    const uint32_t count = pack->light_count;
    EC_FREED uint32_t *numbers = malloc(count * sizeof *numbers);
    if (!numbers) return ec_fail(err, "out of memory for %u lights", count);
    for (uint32_t i = 0; i < count; i++) /* the last one ends at 2^32 */
        numbers[i] = (i + 1 < count ? pack->light_shares[i + 1].first : 0) - pack->light_shares[i].first;
    for (uint32_t i = 0, first = 0; i < count; first += numbers[order[i++]]) pack->light_shares[i].first = first;
    ec_distribution_guide(count, pack->light_shares);
    return EC_OK;
}

ec_result ec_lights_move(ec_pack *pack, const uint32_t *order, ec_error *err)
{
    const uint32_t count = pack->light_count;
    EC_FREED uint32_t *place = malloc(count * sizeof *place);
    if (!place) return ec_fail(err, "out of memory for %u lights", count);
    for (uint32_t i = 0; i < count; i++) place[order[i]] = i;
    for (uint32_t p = 0; p < pack->prim_count; p++)
        if (pack->light_of_prim[p] != EC_NO_ID) pack->light_of_prim[p] = place[pack->light_of_prim[p]];
    EC_TRY(ec_light_rearrange(pack->lights, sizeof *pack->lights, order, count, err));
    EC_TRY(ec_light_rearrange(pack->light_source, sizeof *pack->light_source, order, count, err));
    return move_shares(pack, order, err);
}

static ec_result note_partners(ec_pack *pack, ec_error *err)
{
    pack->pair_of_prim = malloc((pack->prim_count + (size_t)1) * sizeof *pack->pair_of_prim);
    if (!pack->pair_of_prim) return ec_fail(err, "out of memory for %u triangles", pack->prim_count);
    for (uint32_t p = 0; p < pack->prim_count; p++) {
        const uint32_t light = pack->light_of_prim[p];
        const bool is = light != EC_NO_ID && (pack->lights[light].kind & (EC_LIGHT_PAIR_FIRST | EC_LIGHT_PAIR_SECOND));
        pack->pair_of_prim[p] = is ? ec_lamp_partner(pack->lights, light) : EC_NO_ID;
    }
    return EC_OK;
}

ec_result ec_pack_lamp_pairs(ec_pack *pack, ec_error *err)
{
    const uint32_t count = pack->light_count;
    if (count < 2 || count > EC_LAMP_PAIRS_MOST) return EC_OK;
    EC_FREED uint32_t *partner = malloc(count * sizeof *partner);
    EC_FREED uint32_t *order = malloc(count * sizeof *order);
    if (!partner || !order) return ec_fail(err, "out of memory for %u lights", count);
    EC_TRY(ec_lamp_pairs_match(pack->lights, count, partner, &pack->lamp_pair_count, err));
    if (!pack->lamp_pair_count) return EC_OK;
    ec_lamp_pairs_order(pack->lights, count, partner, order);
    EC_TRY(ec_lights_move(pack, order, err));
    return note_partners(pack, err);
}

/* Sorts lamps by the Morton codes of their centres (Morton 1966), a curve that mostly goes on to a neighbour. */
#include "pack/light_order.h"

#include <math.h>
#include <string.h>

#include "base/freed.h"
#include "base/morton.h"

#define MORTON_BITS 20 /* per axis */

typedef struct place {
    uint64_t key;
    uint32_t light;
} place;

bool ec_light_is_far(const ec_light_data *light)
{
    uint32_t kind = light->kind & EC_LIGHT_KIND_MASK;
    return kind == EC_KIND_ENVIRONMENT || kind == EC_KIND_DIRECTIONAL;
}

static double middle(const ec_light_data *l, int axis)
{
    bool triangle = (l->kind & EC_LIGHT_KIND_MASK) == EC_KIND_TRIANGLE;
    return triangle ? ((double)l->a[axis] + l->b[axis] + l->c[axis]) / 3 : (double)l->a[axis];
}

static uint64_t code_of(const ec_light_data *l, const double low[3], double size)
{
    uint32_t at[3];
    for (int k = 0; k < 3; k++) at[k] = size > 0 ? (uint32_t)((middle(l, k) - low[k]) / size * ((1 << MORTON_BITS) - 1)) : 0;
    return ec_morton(at);
}

static int compare(const void *x, const void *y)
{
    const place *a = x, *b = y;
    if (a->key != b->key) return a->key < b->key ? -1 : 1;
    return a->light < b->light ? -1 : 1; /* distinct lights, so never equal */
}

static void find_keys(const ec_light_data *lights, uint32_t count, place *places)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, size = 0;
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3 && !ec_light_is_far(&lights[i]); k++)
            low[k] = fmin(low[k], middle(&lights[i], k)), high[k] = fmax(high[k], middle(&lights[i], k));
    for (int k = 0; k < 3; k++) size = fmax(size, high[k] - low[k]);
    for (uint32_t i = 0; i < count; i++) {
        uint64_t lamps = UINT64_C(2) << (3 * MORTON_BITS);
        bool far = ec_light_is_far(&lights[i]);
        places[i].light = i;
        places[i].key = far ? lights[i].kind == EC_KIND_DIRECTIONAL : lamps | code_of(&lights[i], low, size);
    }
}

ec_result ec_light_rearrange(void *items, size_t size, const uint32_t *order, uint32_t count, ec_error *err)
{
    EC_FREED char *old = malloc((count + (size_t)1) * size);
    if (!old) return ec_fail(err, "out of memory for %u lights", count);
    memcpy(old, items, count * size);
    for (uint32_t i = 0; i < count; i++) memcpy((char *)items + i * size, old + order[i] * size, size);
    return EC_OK;
}

ec_result ec_light_order(ec_light_data *lights, double *power, uint32_t *source, uint32_t count, ec_error *err)
{
    EC_FREED place *places = malloc((count + (size_t)1) * sizeof *places);
    EC_FREED uint32_t *order = malloc((count + (size_t)1) * sizeof *order);
    if (!places || !order) return ec_fail(err, "out of memory for %u lights", count);
    find_keys(lights, count, places);
    qsort(places, count, sizeof *places, compare);
    for (uint32_t i = 0; i < count; i++) order[i] = places[i].light;
    EC_TRY(ec_light_rearrange(lights, sizeof *lights, order, count, err));
    EC_TRY(ec_light_rearrange(power, sizeof *power, order, count, err));
    return ec_light_rearrange(source, sizeof *source, order, count, err);
}

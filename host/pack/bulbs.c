#include "pack/bulbs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/freed.h"
#include "base/vec3.h"
#include "pack/lamp_pairs.h"
#include "pack/light_bounds.h"

#define LEAST 8               /* lamps: the tree soon separates fewer */
#define LAMPS_MOST (1u << 18) /* limit for all lamps, as their corners are sorted */
#define PAIRED 0.9            /* share of a body's power that pairs must have … */
#define FLAT 0.9              /* … or else the least cosine between its normals and the first one */
#define FAINTEST 0x1p-26      /* least share of a body's power, so that each lamp gets several of the body's 2^30 numbers */

typedef struct corner {
    float at[3];
    uint32_t lamp;
} corner;

/* The search for bodies; arrays are by lamp. */
typedef struct finder {
    uint32_t *root;          /* the first lamp of the same body; EC_NO_ID: already placed */
    uint32_t *next, *count;  /* next lamp of the body; number of its lamps, by the first one */
    uint32_t *order, placed; /* the light that comes to each place */
} finder;

static bool may_be(const ec_light_data *l)
{
    return (l->kind & EC_LIGHT_KIND_MASK) == EC_KIND_TRIANGLE && !(l->kind & (EC_LIGHT_TWO_SIDED | EC_LIGHT_TEXTURED | EC_LIGHT_OPEN)) &&
           !(l->kind >> EC_LIGHT_PARTS);
}

static int compare(const void *a, const void *b)
{
    const corner *p = a, *q = b;
    const int by_place = memcmp(p->at, q->at, sizeof p->at);
    return by_place ? by_place : (p->lamp > q->lamp) - (p->lamp < q->lamp);
}

static uint32_t root_of(uint32_t *root, uint32_t i)
{
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
}

static ec_result join_corners(const ec_pack *pack, uint32_t *root, ec_error *err)
{
    const ec_light_data *lights = pack->lights;
    uint32_t n = 0;
    EC_FREED corner *corners = malloc(3 * (size_t)pack->light_count * sizeof *corners);
    if (!corners) return ec_fail(err, "out of memory for %u lights", pack->light_count);
    for (uint32_t i = 0; i < pack->light_count; i++) {
        const float *at[3] = {lights[i].a, lights[i].b, lights[i].c};
        for (int k = 0; k < 3 && may_be(&lights[i]); k++) {
            corners[n] = (corner){.lamp = i};
            for (int axis = 0; axis < 3; axis++) corners[n].at[axis] = at[k][axis] + 0.0f; /* -0 becomes 0 */
            n++;
        }
    }
    qsort(corners, n, sizeof *corners, compare);
    for (uint32_t c = 1; c < n; c++) {
        if (memcmp(corners[c].at, corners[c - 1].at, sizeof corners[c].at)) continue;
        const uint32_t a = root_of(root, corners[c - 1].lamp), b = root_of(root, corners[c].lamp);
        if (memcmp(lights[a].emission, lights[b].emission, sizeof lights[a].emission)) continue;
        root[a > b ? a : b] = a > b ? b : a;
    }
    return EC_OK;
}

ec_result ec_lamp_bodies(const ec_pack *pack, uint32_t *root, ec_error *err)
{
    const uint32_t lights = pack->light_count;
    for (uint32_t i = 0; i < lights; i++) root[i] = i;
    if (lights > 1 && lights <= LAMPS_MOST) EC_TRY(join_corners(pack, root, err));
    for (uint32_t i = 0; i < lights; i++) root[i] = root_of(root, i);
    return EC_OK;
}

/* Tells whether a body is small for the scene: little is far away from a large one. */
static bool is_small(const ec_light_data *members, uint32_t count, float scene_radius)
{
    const double most = EC_LIGHT_TREE_BODY * (double)scene_radius;
    ec_light_bounds all = {.power = 0};
    for (uint32_t i = 0; i < count; i++) {
        const ec_light_bounds one = ec_light_bounds_of(&members[i], members[i].pmf);
        ec_light_bounds_add(&all, &one);
    }
    return ec_light_bounds_size2(&all) <= most * most;
}

/* Tells whether power chooses well the lamp that shines on a far point. */
static bool is_even(const ec_light_data *members, uint32_t count, const uint32_t *partner)
{
    double all = 0, paired = 0, least = INFINITY, flattest = 1, first[3], n[3];
    ec_triangle_normal(members[0].a, members[0].b, members[0].c, first);
    for (uint32_t i = 0; i < count; i++) {
        all += (double)members[i].pmf;
        paired += partner[i] == EC_NO_ID ? 0 : (double)members[i].pmf;
        least = fmin(least, (double)members[i].pmf);
        ec_triangle_normal(members[i].a, members[i].b, members[i].c, n);
        flattest = fmin(flattest, ec_dot(first, n) / sqrt(ec_dot(first, first) * ec_dot(n, n)));
    }
    return least > FAINTEST * all && (paired > PAIRED * all || flattest > FLAT);
}

/* Places the body that begins with lamp i if it is a bulb, otherwise only lamp i. */
static ec_result place_body(finder *f, ec_pack *pack, uint32_t i, ec_error *err)
{
    const uint32_t count = f->count[i], place = f->placed;
    uint32_t n = 0, pairs;
    f->order[f->placed++] = i;
    if (count < LEAST || count > EC_LAMP_PAIRS_MOST) return EC_OK;
    EC_FREED ec_light_data *members = malloc(count * sizeof *members);
    EC_FREED uint32_t *ids = malloc(3 * (size_t)count * sizeof *ids);
    if (!members || !ids) return ec_fail(err, "out of memory for a lamp of %u triangles", count);
    uint32_t *partner = ids + count, *order = partner + count;
    for (uint32_t k = i; k != EC_NO_ID; k = f->next[k]) {
        members[n] = pack->lights[k];
        ids[n++] = k;
    }
    if (!is_small(members, count, pack->scene_radius)) return EC_OK;
    EC_TRY(ec_lamp_pairs_match(members, count, partner, &pairs, err));
    if (!is_even(members, count, partner)) return EC_OK;
    ec_lamp_pairs_order(members, count, partner, order);
    for (uint32_t k = 0; k < count; k++) {
        pack->lights[ids[k]].kind = members[k].kind;
        f->order[place + k] = ids[order[k]];
        if (k) f->root[ids[k]] = EC_NO_ID; /* placed */
    }
    f->placed = place + count;
    pack->bulbs[pack->bulb_count++] = (ec_bulb){place, count};
    pack->lamp_pair_count += pairs;
    return EC_OK;
}

ec_result ec_pack_bulbs(ec_pack *pack, const uint32_t *root, ec_error *err)
{
    const uint32_t lamps = pack->light_count;
    if (lamps < LEAST || lamps > LAMPS_MOST) return EC_OK;
    EC_FREED uint32_t *words = malloc(4 * (size_t)lamps * sizeof *words);
    pack->bulbs = malloc(lamps / LEAST * sizeof *pack->bulbs);
    if (!words || !pack->bulbs) return ec_fail(err, "out of memory for %u lights", lamps);
    finder f = {.root = words, .next = words + lamps, .count = words + 2 * (size_t)lamps, .order = words + 3 * (size_t)lamps};
    for (uint32_t i = 0; i < lamps; i++) f.root[i] = root[i], f.next[i] = EC_NO_ID, f.count[i] = 1;
    for (uint32_t i = lamps; i-- > 0;) { /* from the end, so that lists begin with their roots */
        const uint32_t first = root[i];
        if (first == i) continue;
        f.next[i] = f.next[first];
        f.next[first] = i;
        f.count[first]++;
    }
    for (uint32_t i = 0; i < lamps; i++)
        if (f.root[i] != EC_NO_ID) EC_TRY(place_body(&f, pack, i, err));
    return pack->bulb_count ? ec_lights_move(pack, f.order, err) : EC_OK;
}

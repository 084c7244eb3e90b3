/* tier: full */
/* Rays with exactly known answers: along planes and edges at whole numbers, and where several triangles are equally near. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "robust/cases.h"
#include "robust/soups.h"
#include "selftest/tracer.h"

enum { BOXES = 16, QUADS = 30 }; /* few enough triangles for the accelerator that tests all of them */

typedef struct quad {
    int axis, low[3], high[3]; /* low[axis] = high[axis] */
} quad;

static quad make_quad(uint64_t *random)
{
    quad q = {.axis = (int)(ec_random_bits(random) % 3)};
    for (int k = 0; k < 3; k++) {
        q.low[k] = (int)(ec_random_bits(random) % BOXES) - BOXES / 2;
        q.high[k] = q.low[k] + (k == q.axis ? 0 : 1 + (int)(ec_random_bits(random) % 6));
    }
    return q;
}

static void put_quad(const quad *q, float *v)
{
    int a = (q->axis + 1) % 3, b = (q->axis + 2) % 3;
    static const int corners[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    for (int i = 0; i < 6; i++) {
        v[3 * i + q->axis] = (float)q->low[q->axis];
        v[3 * i + a] = (float)(corners[i][0] ? q->high[a] : q->low[a]);
        v[3 * i + b] = (float)(corners[i][1] ? q->high[b] : q->low[b]);
    }
}

/* The smallest whole t >= 1 at which o + t d, with d of -1, 0 and 1, is on a quad or its border; 0: none. */
static int first_meeting(const quad *quads, const int o[3], const int d[3])
{
    int best = 0;
    for (int i = 0; i < QUADS; i++) {
        const quad *q = &quads[i];
        if (!d[q->axis]) continue;
        int t = (q->low[q->axis] - o[q->axis]) * d[q->axis];
        bool on = t >= 1;
        for (int k = 0; k < 3; k++) on = on && o[k] + t * d[k] >= q->low[k] && o[k] + t * d[k] <= q->high[k];
        if (on && (!best || t < best)) best = t;
    }
    return best;
}

/* Most rays begin 1 to 16 steps before a corner, a border point or an inner point of a quad. */
static int put_whole_ray(ec_tracer *r, uint64_t *random, const quad *quads, uint32_t i)
{
    const quad *q = &quads[ec_random_bits(random) % QUADS];
    int o[3], d[3] = {0, 0, 0}, steps = 1 + (int)(ec_random_bits(random) % 16);
    float from[3], way[3];
    while (i % 8 ? !d[q->axis] : !d[0] && !d[1] && !d[2])
        for (int k = 0; k < 3; k++) d[k] = ec_random_bits(random) % 3 ? 0 : 1 - 2 * (int)(ec_random_bits(random) & 1);
    for (int k = 0; k < 3; k++) {
        o[k] = q->low[k] + (int)(ec_random_bits(random) % (uint32_t)(q->high[k] - q->low[k] + 1)) - steps * d[k];
        if (i % 8 == 0) o[k] = (int)(ec_random_bits(random) % (2 * BOXES)) - BOXES;
        from[k] = (float)o[k];
        way[k] = d[k] ? (float)d[k] : ec_random_bits(random) & 1 ? 0.0f : -0.0f;
    }
    ec_tracer_ray(r, i, from, way, EC_NO_ID);
    return first_meeting(quads, o, d);
}

/* Every ray lies in planes of boxes; most have components of 0 or -0. In whole numbers everything but 1 / det is exact. So a wrong answer
 * comes from 0 * infinity in a slab, or from a border that counts as outside. */
static ec_result box_planes_case(ec_selftest *t, ec_error *err)
{
    uint64_t random = 4;
    uint64_t rays = 0, missed = 0, wrong = 0, met = 0, tried = 0;
    ec_tracer *r;
    EC_TRY(ec_tracer_of(t, &r, err));
    int *expected = malloc(EC_TRACER_RAYS * sizeof *expected);
    ec_result result = expected ? EC_OK : ec_fail(err, "out of memory for %u rays", EC_TRACER_RAYS);
    for (int round = 0; round < 64 && result == EC_OK; round++) {
        quad quads[QUADS];
        ec_soup soup;
        if ((result = ec_soup_make(2 * QUADS, &soup, err)) != EC_OK) break;
        for (int i = 0; i < QUADS; i++) {
            quads[i] = make_quad(&random);
            put_quad(&quads[i], soup.vertices + 18 * i);
        }
        for (uint32_t i = 0; i < EC_TRACER_RAYS; i++) {
            expected[i] = put_whole_ray(r, &random, quads, i);
            met += expected[i] > 0;
        }
        tried += EC_TRACER_RAYS;
        result = ec_tracer_build(r, &soup, err);
        for (uint32_t a = 0; ec_tracer_next(r, &a, EC_TRACER_RAYS, &result, err); a++) {
            for (uint32_t i = 0; i < EC_TRACER_RAYS; i++) {
                ec_traced h = ec_tracer_hit(r, i);
                missed += expected[i] > 0 && h.prim == EC_NO_ID;
                /* 1 / det with 2.5 ulp, a product, and exit distances padded by 8 u */
                wrong += h.prim != EC_NO_ID && !(fabs((double)h.t - expected[i]) <= expected[i] * 16 * 0x1p-24);
            }
            rays += EC_TRACER_RAYS;
        }
        ec_soup_free(&soup);
    }
    free(expected);
    EC_TRY(result);
    char note[64];
    snprintf(note, sizeof note, "%.0f %% of them touch something", 100.0 * (double)met / (double)tried);
    EC_TRY(ec_selftest_none(t, "misses", missed, rays, note, err));
    return ec_selftest_none(t, "hits at a wrong distance", wrong, rays, NULL, err);
}

enum { DISTINCT = 12, COPIES = 5 }; /* as above */

/* Copies of triangles, half of them in one plane. reversed: the last of the list comes first. */
static ec_result copies(const ec_soup *once, bool reversed, ec_soup *soup, ec_error *err)
{
    EC_TRY(ec_soup_make(DISTINCT * COPIES, soup, err));
    for (uint32_t i = 0; i < soup->count; i++) {
        uint32_t at = reversed ? soup->count - 1 - i : i;
        memcpy(soup->vertices + 9 * (size_t)at, once->vertices + 9 * (size_t)(i % DISTINCT), 9 * sizeof(float));
    }
    return EC_OK;
}

static void put_crossing_rays(ec_tracer *r, uint64_t *random)
{
    for (uint32_t i = 0; i < EC_TRACER_RAYS; i++) {
        double from[3], to[3];
        float o[3], d[3];
        for (int k = 0; k < 3; k++) {
            o[k] = (float)ec_random_between(random, -3, 3);
            from[k] = o[k];
            to[k] = ec_random_between(random, -1, 1);
        }
        ec_float_direction(from, to, d);
        if (i % 4 == 0) d[0] = d[1] = 0, d[2] = o[2] < 0.25f ? 1.0f : -1.0f;
        ec_tracer_ray(r, i, o, d, EC_NO_ID);
    }
}

/* The smallest id of equally near triangles must win, in every accelerator. Then reversing the list cannot move the hit; among equal
 * triangles the first wins in one order, and the last in the other. */
static ec_result ties_case(ec_selftest *t, ec_error *err)
{
    const double nowhere[3] = {0, 0, 0};
    uint64_t random = 5;
    uint64_t rays = 0, moved = 0, wrong = 0;
    ec_tracer *r;
    ec_soup once;
    EC_TRY(ec_tracer_of(t, &r, err));
    EC_TRY(ec_soup_random(&random, DISTINCT, 1.5, 0.5, nowhere, &once, err));
    ec_traced *first = malloc(EC_TRACER_RAYS * sizeof *first);
    for (int i = 0; i < DISTINCT / 2; i++)
        for (int k = 2; k < 9; k += 3) once.vertices[9 * i + k] = 0.25f;
    put_crossing_rays(r, &random);
    ec_result result = first ? EC_OK : ec_fail(err, "out of memory for %u hits", EC_TRACER_RAYS);
    for (int reversed = 0; reversed < 2 && result == EC_OK; reversed++) {
        ec_soup soup;
        if ((result = copies(&once, reversed, &soup, err)) != EC_OK) break;
        result = ec_tracer_build(r, &soup, err);
        for (uint32_t a = 0; ec_tracer_next(r, &a, EC_TRACER_RAYS, &result, err); a++) {
            for (uint32_t i = 0; i < EC_TRACER_RAYS; i++) {
                ec_traced h = ec_tracer_hit(r, i);
                if (!reversed && a == 0) first[i] = h;
                moved += (h.prim == EC_NO_ID) != (first[i].prim == EC_NO_ID) || h.t != first[i].t;
                if (h.prim == EC_NO_ID) continue;
                uint32_t listed = reversed ? soup.count - 1 - h.prim : h.prim; /* its place in the original list */
                if (reversed) wrong += listed < soup.count - DISTINCT || listed % DISTINCT < first[i].prim;
                else wrong += listed >= DISTINCT || h.prim != first[i].prim || h.b1 != first[i].b1 || h.b2 != first[i].b2;
            }
            rays += EC_TRACER_RAYS;
        }
        ec_soup_free(&soup);
    }
    ec_soup_free(&once);
    free(first);
    EC_TRY(result);
    EC_TRY(ec_selftest_none(t, "distance", moved, rays, NULL, err));
    return ec_selftest_none(t, "triangle", wrong, rays, NULL, err);
}

/* Many copies of one triangle: no plane divides them, and every box is the same. Nodes and references may only grow linearly. The grid has
 * most, since it allows 64 references a triangle. */
static ec_result coincident_case(ec_selftest *t, ec_error *err)
{
    enum { RAYS = 256, ENTRIES_MOST = 65 };
    static const float corners[9] = {-1, -0.7f, 0.2f, 1, -0.9f, -0.1f, 0.1f, 1, 0.3f};
    const uint32_t count = 100000;
    uint64_t random = 6;
    uint64_t rays = 0, wrong = 0;
    uint64_t most = 0, allowed = (uint64_t)ENTRIES_MOST * count;
    char note[64] = "";
    ec_tracer *r;
    ec_soup soup;
    EC_TRY(ec_tracer_of(t, &r, err));
    EC_TRY(ec_soup_make(count, &soup, err));
    for (uint32_t i = 0; i < count; i++) memcpy(soup.vertices + 9 * (size_t)i, corners, sizeof corners);
    for (uint32_t i = 0; i < RAYS; i++) {
        double b1 = ec_random_unit(&random), b2 = ec_random_unit(&random) * (1 - b1), from[3] = {0.1, 0.2, i % 2 ? 3 : -3}, to[3];
        float o[3] = {0.1f, 0.2f, i % 2 ? 3 : -3}, d[3];
        for (int k = 0; k < 3; k++)
            to[k] =
                corners[k] + b1 * ((double)corners[3 + k] - corners[k]) + b2 * ((double)corners[6 + k] - corners[k]);
        ec_float_direction(from, to, d);
        ec_tracer_ray(r, i, o, d, EC_NO_ID);
    }
    ec_result result = ec_tracer_build(r, &soup, err);
    for (uint32_t a = 0; ec_tracer_next(r, &a, RAYS, &result, err); a++) {
        uint64_t entries = r->accels[a].stats.references + r->accels[a].stats.nodes;
        if (entries > most)
            snprintf(note, sizeof note, "%.1f a triangle in %s", (double)entries / count, ec_accels[a].name),
                most = entries;
        for (uint32_t i = 0; i < RAYS; i++) wrong += ec_tracer_hit(r, i).prim != 0;
        rays += RAYS;
    }
    ec_soup_free(&soup);
    EC_TRY(result);
    EC_TRY(ec_selftest_none(t, "entries too many", most > allowed ? most - allowed : 0, allowed, note, err));
    return ec_selftest_none(t, "not the first of them", wrong, rays, NULL, err);
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"rays/box planes", false, box_planes_case, "0 times infinity in slabs loses touched boxes (Williams et al. 2005)"},
        {"rays/ties", false, ties_case, "coplanar faces flicker with the order of triangles"},
        {"rays/coincident triangles", false, coincident_case, "builders that never end where triangles cannot be parted"},
    };
    return RUN_CASES(cases);
}

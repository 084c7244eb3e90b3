#include "rare/patches.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PI 3.14159265358979323846
#define BACK 1e-4     /* of the scene's radius: how far vertices may lie from a patch's plane in any case */
#define NEAREST 12    /* vertices by which their density is told … */
#define FLAT 0.05     /* … that lie no further from its plane, over their distance */
#define ALIKE 0.9     /* cosine between its normal and theirs */

static double dot(const float *a, const float *b) { return (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2]; }

/* A vertex that a path left, and the square of its distance from the patch. */
typedef struct near_vertex {
    double square;
    const ec_chain *from; /* NULL: on another surface after all */
} near_vertex;

/* The nearest vertices to a patch, nearest first, apart: [1] those that the camera sees, [0] those that are only on the way. */
typedef struct near_patch {
    near_vertex vertices[2][NEAREST];
    uint32_t count[2], within[2]; /* within: vertices in the patch's area, if it is a disk */
} near_patch;

/* Finds the nearest vertices in the patch's plane and on its side. */
static void find_near(double radius, const ec_chains *paths, const ec_rare_patch *at, near_patch *found)
{
    *found = (near_patch){0};
    for (uint32_t i = 0; i < paths->vertex_count; i++) {
        const ec_chain *c = &paths->vertices[i];
        const float way[3] = {c->origin[0] - at->point[0], c->origin[1] - at->point[1], c->origin[2] - at->point[2]};
        const double square = dot(way, way), height = dot(way, at->normal);
        const bool seen = c->segment == 1;
        near_vertex *near = found->vertices[seen];
        uint32_t *count = &found->count[seen];
        const bool is_within = PI * square < at->area;
        if (*count == NEAREST && square >= near[NEAREST - 1].square && !is_within) continue;
        if (c->prim == EC_NO_ID) continue; /* it was scattered within a body */
        if (!(dot(c->direction, at->normal) > 0 && fabs(height) <= FLAT * sqrt(square) + BACK * radius)) continue;
        found->within[seen] += is_within;
        if (*count == NEAREST && square >= near[NEAREST - 1].square) continue;
        uint32_t k = *count < NEAREST ? (*count)++ : NEAREST - 1;
        for (; k > 0 && near[k - 1].square > square; k--) near[k] = near[k - 1];
        near[k] = (near_vertex){square, c};
    }
}

/* Drops vertices whose surface lies at an angle to the patch: that of a wall beside it. */
static ec_result drop_others(ec_rare_follower *f, const ec_rare_patch *at, near_patch *found, ec_error *err)
{
    for (int seen = 0; seen < 2; seen++)
        for (uint32_t i = 0; i < found->count[seen]; i++) {
            const ec_chain **from = &found->vertices[seen][i].from;
            double n[3];
            EC_TRY(ec_rare_normal_of(f, (*from)->prim, n, err));
            if (fabs(n[0] * at->normal[0] + n[1] * at->normal[1] + n[2] * at->normal[2]) < ALIKE) *from = NULL;
        }
    return EC_OK;
}

/* Returns the root mean square over the mean, from pairs in one tile, as it would be with many vertices. */
static double gathered(const uint32_t *tiles, uint32_t count)
{
    uint32_t pairs = 0;
    for (uint32_t i = 0; i < EC_RARE_SHARES; i++) pairs += tiles[i] * (tiles[i] - (tiles[i] > 0));
    return sqrt(fmax(1, count > 1 ? (double)EC_RARE_SHARES * pairs / count / (count - 1) : EC_RARE_SHARES));
}

/* Sums over the patches of a kind, by vertices of one sort. */
typedef struct sums {
    double chance, luminance;
    uint32_t count, tiles[EC_RARE_SHARES]; /* of the nearest vertices, in all and in each tile */
} sums;

static void add_patch(const near_patch *found, bool seen, const ec_chains *paths, const ec_rare_patch *at, const ec_rare *rare, sums *s)
{
    const near_vertex *near = found->vertices[seen];
    double beta = 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < found->count[seen]; i++) {
        if (!near[i].from) continue;
        count++;
        beta += (double)near[i].from->beta;
        s->tiles[ec_rare_tile(rare, near[i].from->place % rare->width, near[i].from->place / rare->width)]++;
    }
    if (!count) return;
    const double few = fmin(at->area / (PI * near[found->count[seen] - 1].square), 1); /* share of them in the patch, where it has fewer in it */
    const double there = at->weight * count * fmax(few, (double)found->within[seen] / found->count[seen]) / paths->paths;
    s->count += count;
    s->chance += there * at->chance;
    s->luminance += there * beta / count * at->irradiance / PI;
}

/* A patch that is seen is an image of its light; a sky's light is spread over all that it falls on. */
static void add_kind(const sums *s, bool seen, const ec_rare_patch *first, ec_rare *rare)
{
    const double pixels = (double)rare->width * rare->height;
    const double spread = !seen ? gathered(s->tiles, s->count) : first->is_sky ? 1 : sqrt(fmin(1 / s->chance, pixels));
    ec_rare_kind *kind = s->luminance > 0 && s->chance < EC_RARE_COMMON ? ec_rare_make_room(rare, s->luminance * spread) : NULL;
    if (!kind) return;
    *kind = (ec_rare_kind){.chance = s->chance, .luminance = s->luminance, .clamped = seen ? 0 : 1, .gathered = spread};
    uint32_t lit = 0;
    for (int i = 0; i < EC_RARE_SHARES; i++)
        if (!seen || first->is_sky || s->tiles[i]) kind->share[i] = 255, lit++;
    kind->peak = (double)EC_RARE_SHARES / lit;
    snprintf(kind->light, sizeof kind->light, "%s%.*s", first->is_sky ? "a small opening towards " : "a small patch lit by ", EC_RARE_NAME - 25, first->light);
}

ec_result ec_rare_patches_judge(const ec_rare_patches *patches, ec_rare_follower *f, const ec_chains *paths, ec_rare *rare, ec_error *err)
{
    near_patch found[EC_RARE_PATCHES];
#pragma omp parallel for if (patches->count > 1)
    for (uint32_t i = 0; i < patches->count; i++) find_near((double)f->lights->radius, paths, &patches->list[i], &found[i]);
    for (uint32_t i = 0; i < patches->count; i++) EC_TRY(drop_others(f, &patches->list[i], &found[i], err));
    for (uint32_t first = 0, end; first < patches->count; first = end)
        for (int seen = 0; seen < 2; seen++) {
            sums s = {0};
            for (end = first; end == first || (end < patches->count && patches->list[end].joins); end++)
                add_patch(&found[end], seen, paths, &patches->list[end], rare, &s);
            add_kind(&s, seen, &patches->list[first], rare);
        }
    return EC_OK;
}

void ec_rare_patches_free(ec_rare_patches *patches)
{
    free(patches->list);
    *patches = (ec_rare_patches){0};
}

#include "rare/openings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "rare/follow.h"
#include "rare/leave.h"

#define PI 3.14159265358979323846
#define BACK 1e-4     /* of the scene's radius: rays start this far before an edge */
#define ABOVE 1e-5    /* likewise, above what is lit */
#define GRAZING 0.05  /* cosine under which light only grazes what it falls on */
enum { PASSED = 1 << 11 };                       /* rays past edges that are followed to where they land */
enum { LANDED = 128, FELT = 16, PATCHES = 16 }; /* rays of a source that are looked at where they land; places around which rays feel what is lit;
                                                 * patches in all */
enum { RINGS = 20, AROUND = 8 }; /* the largest first, each half of the one before: down to 6e-7 of the radius */
/* A patch is small if fewer than SMALL_LIT rays are lit in one of SMALL_RINGS rings: every SMALL_STEP-th one, from number SMALL_STEP on. In the first of
 * these, SMALL_LIT lit rays mean an area of more than SMALL; the others lie within a room that stands in a wide landscape. */
enum { SMALL_RINGS = 3, SMALL_STEP = 3, SMALL_LIT = 3 };
#define LARGEST 0.3   /* of the scene's radius: the first one */
#define SMALL 3e-4    /* of the disk around the scene: what is lit more is met soon */

typedef ec_rare_patch patch;

typedef struct finder {
    const ec_rare_lights *all;
    ec_rare_follower *follower;
    ec_chain *rays;
    uint32_t *edges;           /* that rays are aimed past, by ray */
    patch *patches;            /* those that are small */
    uint32_t count, most;
} finder;

static double square_between(const float *a, const float *b)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += ((double)a[k] - b[k]) * ((double)a[k] - b[k]);
    return sum;
}

static void aim(const finder *f, const ec_rare_source *source, const float point[3], float towards[3])
{
    ec_rare_source_aim(source, &f->follower->p->params, point, towards);
}

static ec_result follow(finder *f, const ec_rare_source *source, uint32_t count, ec_error *err)
{
    return ec_rare_follow(f->follower, f->rays, count, source->type == EC_RARE_POINT, err);
}

/* Returns whether a ray towards the source has met it. */
static bool meets(const finder *f, const ec_rare_source *source, const ec_chain *ray)
{
    if (source->type == EC_RARE_LAMP) return ray->hit != EC_NO_ID && ec_rare_material_of(f->all, ray->hit) == source->material;
    if (source->type == EC_RARE_FAR || ray->hit == EC_NO_ID) return ray->hit == EC_NO_ID;
    return (double)ray->reach * ray->reach > square_between(ray->origin, source->middle);
}

/* Finds where a ray of the source ends; *is_there: it does not only graze. */
static ec_result land(finder *f, const ec_chain *ray, const ec_rare_source *source, patch *at, bool *is_there, ec_error *err)
{
    ec_rare_landing end;
    EC_TRY(ec_rare_land(f->follower, ray, &end, err));
    *at = (patch){.light = source->name, .irradiance = end.cosine * ray->beta * ec_rare_source_irradiance(source, end.point, ray->direction)};
    memcpy(at->point, end.point, sizeof at->point);
    memcpy(at->normal, end.normal, sizeof at->normal);
    *is_there = end.cosine > GRAZING && at->irradiance > 0;
    return EC_OK;
}

/* Traces rays past edges to where the light of a source that gets by lands, and moves those that land to the front. Near sources are many, and their
 * rays pass only some of the edges. */
static ec_result pass_edges(finder *f, const ec_rare_source *source, uint32_t *landed, ec_error *err)
{
    const uint32_t most = source->type == EC_RARE_FAR ? EC_RARE_EDGES : EC_RARE_NEAR_EDGES;
    const double back = BACK * f->all->radius;
    uint32_t count = 0, passed = 0;
    for (uint32_t i = 0; i < f->all->edge_count && count < most; i++) {
        float towards[3];
        aim(f, source, f->all->edges[i], towards);
        const float along[3] = {-towards[0], -towards[1], -towards[2]};
        if (source->type == EC_RARE_POINT && !(ec_rare_source_irradiance(source, f->all->edges[i], along) > 0)) continue; /* beside a spot's cone */
        f->edges[count] = i;
        ec_rare_ray(f->all->edges[i], towards, 1, back, &f->rays[count++]);
    }
    EC_TRY(follow(f, source, count, err));
    for (uint32_t i = 0; i < count && passed < PASSED; i++) { /* any of them will do: edges are in no order */
        float towards[3];
        if (!meets(f, source, &f->rays[i])) continue;
        const float beta = f->rays[i].beta, *edge = f->all->edges[f->edges[i]];
        aim(f, source, edge, towards);
        ec_rare_ray(edge, towards, -1, back, &f->rays[passed]);
        f->rays[passed++].beta = beta;
    }
    EC_TRY(follow(f, source, passed, err));
    *landed = 0;
    for (uint32_t i = 0; i < passed; i++)
        if (f->rays[i].hit != EC_NO_ID) f->rays[(*landed)++] = f->rays[i];
    return EC_OK;
}

static int count_lit(const finder *f, const ec_rare_source *source, const ec_chain *ring)
{
    int lit = 0;
    for (int k = 0; k < AROUND; k++) lit += meets(f, source, &ring[k]);
    return lit;
}

/* Adds up rings around a patch's point, from the smallest on, up to where nothing is lit. */
static double lit_area(const finder *f, const ec_rare_source *source, const ec_chain *rays)
{
    double area = 0, outer = LARGEST * f->all->radius * ldexp(1, 1 - RINGS), inner = 0;
    for (int ring = RINGS - 1; ring >= 0; ring--, inner = outer, outer *= 2) {
        const int lit = count_lit(f, source, rays + ring * AROUND);
        if (!lit && ring < RINGS - 1) break;
        area += PI * (outer * outer - inner * inner) * lit / AROUND;
    }
    return area;
}

/* Makes rays towards the source from a ring around a patch, evenly spaced. */
static void feel_ring(const finder *f, const ec_rare_source *source, const patch *at, int ring, uint64_t *random,
                      ec_chain *rays)
{
    const float *n = at->normal;
    double u[3], v[3];
    ec_rare_frame(n, u, v);
    const double outer = LARGEST * f->all->radius * ldexp(1, -ring), inner = ring < RINGS - 1 ? outer / 2 : 0, above = ABOVE * f->all->radius;
    for (int i = 0; i < AROUND; i++) {
        const double r = sqrt(ec_random_between(random, inner * inner, outer * outer)), angle = 2 * PI * (i + ec_random_unit(random)) / AROUND;
        float point[3], towards[3];
        for (int k = 0; k < 3; k++) point[k] = (float)(at->point[k] + r * (cos(angle) * u[k] + sin(angle) * v[k]) + above * n[k]);
        aim(f, source, point, towards);
        ec_rare_ray(point, towards, 1, 0, &rays[i]);
    }
}

static bool is_known(const finder *f, const patch *at)
{
    for (uint32_t i = 0; i < f->count; i++)
        if (f->patches[i].light == at->light && square_between(f->patches[i].point, at->point) < 4 * f->patches[i].area) return true;
    return false;
}

/* Keeps the patches, up to FELT, that have a ring in which so little is lit that they are small. */
static ec_result drop_large(finder *f, const ec_rare_source *source, patch *found, uint32_t *count, uint64_t *random, ec_error *err)
{
    uint32_t kept = 0;
    for (uint32_t k = 0; k < *count * SMALL_RINGS; k++)
        feel_ring(f, source, &found[k / SMALL_RINGS], SMALL_STEP * (int)(1 + k % SMALL_RINGS), random, f->rays + (size_t)k * AROUND);
    EC_TRY(follow(f, source, *count * SMALL_RINGS * AROUND, err));
    for (uint32_t k = 0; k < *count; k++) {
        int least = AROUND;
        for (uint32_t ring = 0; ring < SMALL_RINGS; ring++) {
            const int lit = count_lit(f, source, f->rays + ((size_t)k * SMALL_RINGS + ring) * AROUND);
            least = lit < least ? lit : least;
        }
        if (least < SMALL_LIT) found[kept++] = found[k];
    }
    *count = kept < FELT ? kept : FELT;
    for (uint32_t k = 0; k < *count; k++) found[k] = found[(uint64_t)k * kept / *count];
    return EC_OK;
}

static ec_result find_patches(finder *f, const ec_rare_source *source, ec_error *err)
{
    uint32_t landed = 0, count = 0;
    uint64_t random = 11;
    patch found[LANDED];
    EC_TRY(pass_edges(f, source, &landed, err));
    for (uint32_t k = 0; k < landed && k < LANDED; k++) { /* some of them, evenly */
        bool is_there;
        EC_TRY(land(f, &f->rays[landed > LANDED ? (uint64_t)k * landed / LANDED : k], source, &found[count], &is_there, err));
        count += is_there;
    }
    EC_TRY(drop_large(f, source, found, &count, &random, err));
    for (uint32_t k = 0; k < count * RINGS; k++) feel_ring(f, source, &found[k / RINGS], (int)(k % RINGS), &random, f->rays + (size_t)k * AROUND);
    EC_TRY(follow(f, source, count * RINGS * AROUND, err));
    const double most = SMALL * PI * f->all->radius * f->all->radius;
    for (uint32_t k = 0; k < count && f->count < f->most; k++) {
        found[k].area = lit_area(f, source, f->rays + (size_t)k * RINGS * AROUND);
        if (found[k].area > 0 && found[k].area < most && !is_known(f, &found[k])) f->patches[f->count++] = found[k];
    }
    return EC_OK;
}

ec_result ec_rare_openings_find(ec_rare_follower *follower, ec_rare_patches *patches, ec_error *err)
{
    const ec_rare_lights *all = follower->lights;
    const uint32_t felt = AROUND * (FELT * RINGS > LANDED * SMALL_RINGS ? FELT * RINGS : LANDED * SMALL_RINGS);
    const uint32_t most = all->edge_count > felt ? all->edge_count : felt, room = patches->count + PATCHES;
    if (!all->source_count || !all->edge_count) return EC_OK;
    finder f = {.all = all, .follower = follower, .rays = calloc(most, sizeof *f.rays), .edges = malloc(all->edge_count * sizeof *f.edges),
                .patches = patches->list, .count = patches->count, .most = room < EC_RARE_PATCHES ? room : EC_RARE_PATCHES};
    ec_result result = f.rays && f.edges ? EC_OK : ec_fail(err, "out of memory for rays past %u edges", all->edge_count);
    for (uint32_t i = 0; result == EC_OK && i < all->source_count; i++) result = find_patches(&f, &all->sources[i], err);
    free(f.edges);
    free(f.rays);
    patches->count = f.count;
    return result;
}

#include "rare/openings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/freed.h"
#include "base/random.h"
#include "base/vec3.h"
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

/* The search by the light of one source. Its rays of a step are some of the finder's. */
typedef struct search {
    const ec_rare_source *source;
    ec_chain *rays;
    uint32_t ray_count;
    patch found[LANDED];
    uint32_t count;            /* found */
    uint64_t random;
} search;

/* All searches take each step together, since a launch takes longer than the rays of one of them. */
typedef struct finder {
    const ec_rare_lights *all;
    ec_rare_follower *follower;
    search searches[EC_RARE_SOURCES];
    uint32_t count;            /* searches */
    ec_chain *rays;            /* one search after the other */
    uint32_t ray_count;
    uint32_t *edges;           /* that rays are aimed past, by ray */
} finder;

static void aim(const finder *f, const ec_rare_source *source, const float point[3], float towards[3])
{
    ec_rare_source_aim(source, &f->follower->p->params, point, towards);
}

static ec_chain *add_ray(finder *f, search *s)
{
    s->ray_count++;
    return &f->rays[f->ray_count++];
}

/* Begins a search's rays of a step, behind those of the searches before it. */
static void begin_rays(finder *f, search *s)
{
    s->rays = f->rays + f->ray_count;
    s->ray_count = 0;
}

static ec_result follow_all(finder *f, ec_error *err)
{
    EC_TRY(ec_rare_follow(f->follower, f->rays, f->ray_count, err));
    for (search *s = f->searches; s < f->searches + f->count; s++)
        if (s->source->type == EC_RARE_POINT) EC_TRY(ec_rare_reach(f->follower, s->rays, s->ray_count, err));
    return EC_OK;
}

/* Returns whether a ray towards the source has met it. */
static bool meets(const finder *f, const ec_rare_source *source, const ec_chain *ray)
{
    if (source->type == EC_RARE_LAMP) return ray->hit != EC_NO_ID && ec_rare_material_of(f->all, ray->hit) == source->material;
    if (source->type == EC_RARE_FAR || ray->hit == EC_NO_ID) return ray->hit == EC_NO_ID;
    return (double)ray->reach * ray->reach > ec_square_between(ray->origin, source->middle);
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

/* Aims rays past edges at a source. Near sources are many, and their rays pass only some of the edges. */
static void aim_past_edges(finder *f, search *s)
{
    const ec_rare_source *source = s->source;
    const uint32_t most = source->type == EC_RARE_FAR ? EC_RARE_EDGES : EC_RARE_NEAR_EDGES;
    begin_rays(f, s);
    for (uint32_t i = 0; i < f->all->edge_count && s->ray_count < most; i++) {
        float towards[3];
        aim(f, source, f->all->edges[i], towards);
        const float along[3] = {-towards[0], -towards[1], -towards[2]};
        if (source->type == EC_RARE_POINT && !(ec_rare_source_irradiance(source, f->all->edges[i], along) > 0)) continue; /* beside a spot's cone */
        f->edges[f->ray_count] = i;
        ec_rare_ray(f->all->edges[i], towards, 1, BACK * f->all->radius, add_ray(f, s));
    }
}

/* Turns round those rays that have met the source, to where its light lands. They take the places of others that are not needed any more. */
static void turn_back(finder *f, search *s)
{
    const ec_chain *met = s->rays;
    const uint32_t count = s->ray_count, *edges = f->edges + (met - f->rays);
    begin_rays(f, s);
    for (uint32_t i = 0; i < count && s->ray_count < PASSED; i++) { /* any of them will do: edges are in no order */
        float towards[3];
        if (!meets(f, s->source, &met[i])) continue;
        const float beta = met[i].beta, *edge = f->all->edges[edges[i]];
        aim(f, s->source, edge, towards);
        ec_chain *ray = add_ray(f, s);
        ec_rare_ray(edge, towards, -1, BACK * f->all->radius, ray);
        ray->beta = beta;
    }
}

/* Finds where some of the light lands, evenly among the rays. */
static ec_result find_landings(finder *f, search *s, ec_error *err)
{
    uint32_t landed = 0;
    for (uint32_t i = 0; i < s->ray_count; i++)
        if (s->rays[i].hit != EC_NO_ID) s->rays[landed++] = s->rays[i];
    for (uint32_t k = 0; k < landed && k < LANDED; k++) {
        bool is_there;
        EC_TRY(land(f, &s->rays[landed > LANDED ? (uint64_t)k * landed / LANDED : k], s->source, &s->found[s->count], &is_there, err));
        s->count += is_there;
    }
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
static void feel_ring(finder *f, search *s, const patch *at, int ring)
{
    const float *n = at->normal;
    double u[3], v[3];
    ec_rare_frame(n, u, v);
    const double outer = LARGEST * f->all->radius * ldexp(1, -ring), inner = ring < RINGS - 1 ? outer / 2 : 0, above = ABOVE * f->all->radius;
    for (int i = 0; i < AROUND; i++) {
        const double r = sqrt(ec_random_between(&s->random, inner * inner, outer * outer)), angle = 2 * PI * (i + ec_random_unit(&s->random)) / AROUND;
        float point[3], towards[3];
        for (int k = 0; k < 3; k++) point[k] = (float)(at->point[k] + r * (cos(angle) * u[k] + sin(angle) * v[k]) + above * n[k]);
        aim(f, s->source, point, towards);
        ec_rare_ray(point, towards, 1, 0, add_ray(f, s));
    }
}

static void feel_few_rings(finder *f, search *s)
{
    begin_rays(f, s);
    for (uint32_t k = 0; k < s->count * SMALL_RINGS; k++) feel_ring(f, s, &s->found[k / SMALL_RINGS], SMALL_STEP * (int)(1 + k % SMALL_RINGS));
}

/* Keeps the patches, up to FELT, that have a ring in which so little is lit that they are small. */
static void drop_large(const finder *f, search *s)
{
    uint32_t kept = 0;
    for (uint32_t k = 0; k < s->count; k++) {
        int least = AROUND;
        for (uint32_t ring = 0; ring < SMALL_RINGS; ring++) {
            const int lit = count_lit(f, s->source, s->rays + ((size_t)k * SMALL_RINGS + ring) * AROUND);
            least = lit < least ? lit : least;
        }
        if (least < SMALL_LIT) s->found[kept++] = s->found[k];
    }
    s->count = kept < FELT ? kept : FELT;
    for (uint32_t k = 0; k < s->count; k++) s->found[k] = s->found[(uint64_t)k * kept / s->count];
}

static void feel_all_rings(finder *f, search *s)
{
    begin_rays(f, s);
    for (uint32_t k = 0; k < s->count * RINGS; k++) feel_ring(f, s, &s->found[k / RINGS], (int)(k % RINGS));
}

static bool is_known(const ec_rare_patches *patches, const patch *at)
{
    for (uint32_t i = 0; i < patches->count; i++)
        if (patches->list[i].light == at->light && ec_square_between(patches->list[i].point, at->point) < 4 * patches->list[i].area) return true;
    return false;
}

static void keep_small(const finder *f, search *s, uint32_t most_patches, ec_rare_patches *patches)
{
    const double most = SMALL * PI * f->all->radius * f->all->radius;
    for (uint32_t k = 0; k < s->count && patches->count < most_patches; k++) {
        s->found[k].area = lit_area(f, s->source, s->rays + (size_t)k * RINGS * AROUND);
        if (s->found[k].area > 0 && s->found[k].area < most && !is_known(patches, &s->found[k])) patches->list[patches->count++] = s->found[k];
    }
}

/* Takes a step of all searches: makes their rays, and traces them. */
static ec_result step(finder *f, void (*make)(finder *, search *), ec_error *err)
{
    f->ray_count = 0;
    for (uint32_t i = 0; i < f->count; i++) make(f, &f->searches[i]);
    return follow_all(f, err);
}

static ec_result find_all(finder *f, ec_rare_patches *patches, ec_error *err)
{
    const uint32_t room = patches->count + PATCHES, most = room < EC_RARE_PATCHES ? room : EC_RARE_PATCHES;
    EC_TRY(step(f, aim_past_edges, err));
    EC_TRY(step(f, turn_back, err));
    for (uint32_t i = 0; i < f->count; i++) EC_TRY(find_landings(f, &f->searches[i], err));
    EC_TRY(step(f, feel_few_rings, err));
    for (uint32_t i = 0; i < f->count; i++) drop_large(f, &f->searches[i]);
    EC_TRY(step(f, feel_all_rings, err));
    for (uint32_t i = 0; i < f->count; i++) keep_small(f, &f->searches[i], most, patches);
    return EC_OK;
}

/* Returns how many rays a step of all searches takes at most. */
static size_t most_rays(const ec_rare_lights *all)
{
    const size_t felt = AROUND * (FELT * RINGS > LANDED * SMALL_RINGS ? FELT * RINGS : LANDED * SMALL_RINGS);
    const size_t edges = all->edge_count > felt ? all->edge_count : felt;
    return all->source_count * edges;
}

ec_result ec_rare_openings_find(ec_rare_follower *follower, ec_rare_patches *patches, ec_error *err)
{
    const ec_rare_lights *all = follower->lights;
    if (!all->source_count || !all->edge_count) return EC_OK;
    EC_FREED finder *f = calloc(1, sizeof *f);
    EC_FREED ec_chain *rays = malloc(most_rays(all) * sizeof *rays);
    EC_FREED uint32_t *edges = malloc(most_rays(all) * sizeof *edges);
    if (!f || !rays || !edges) return ec_fail(err, "out of memory for rays past %u edges", all->edge_count);
    f->all = all;
    f->follower = follower;
    f->rays = rays;
    f->edges = edges;
    for (; f->count < all->source_count; f->count++) f->searches[f->count] = (search){.source = &all->sources[f->count], .random = 11};
    return find_all(f, patches, err);
}

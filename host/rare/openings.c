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
enum { PATCHES = 16, SKY_PATCHES = 128 };       /* in all */
/* Rays of a source that are looked at where they land; places around which rays feel what is lit. If sources are more than MANY, these are as many in
 * all as of MANY. */
enum { LANDED = 128, FELT = 16, SKY_FELT = 4, MANY = 20 };
enum { SKY_OPENINGS = 3 }; /* that are looked at from all directions */
#define APART 4       /* openings, in sides of what one of them lights */
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
    uint32_t first_edge, edge_count, most_landed, most_felt;
    ec_chain *rays; /* place: number of the edge that they pass */
    uint32_t ray_count;
    patch found[LANDED];
    uint32_t count;            /* found */
    uint64_t random;
} search;

_Static_assert(EC_RARE_SKY <= EC_RARE_SOURCES, "a finder has room for searches by all sources");

/* All searches take each step together, since a launch takes longer than the rays of one of them. */
typedef struct finder {
    const ec_rare_lights *all;
    ec_rare_follower *follower;
    search searches[EC_RARE_SOURCES];
    uint32_t count;            /* searches */
    ec_chain *rays;            /* one search after the other */
    uint32_t ray_count;
    const uint32_t *chosen;    /* edges in place of all, which the searches' first ones count; NULL: all */
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

/* Finds where a ray of the source ends; *is_there: it does not only graze. */
static ec_result land(finder *f, const ec_chain *ray, const ec_rare_source *source, patch *at, bool *is_there, ec_error *err)
{
    ec_rare_landing end;
    EC_TRY(ec_rare_land(f->follower, ray, &end, err));
    *at = (patch){.light = source->name, .irradiance = end.cosine * ray->beta * ec_rare_source_irradiance(source, end.point, ray->direction),
                  .chance = 1, .weight = 1, .edge = ray->place, .is_sky = source->solid_angle > 0};
    if (at->is_sky) at->chance = end.cosine * source->solid_angle / PI; /* as a matt surface scatters; light sampling changes little */
    memcpy(at->point, end.point, sizeof at->point);
    memcpy(at->normal, end.normal, sizeof at->normal);
    *is_there = end.cosine > GRAZING && at->irradiance > 0;
    return EC_OK;
}

/* Aims rays past edges at a source. */
static void aim_past_edges(finder *f, search *s)
{
    const ec_rare_source *source = s->source;
    begin_rays(f, s);
    for (uint32_t n = 0; n < f->all->edge_count && s->ray_count < s->edge_count; n++) {
        const uint32_t i = f->chosen ? f->chosen[n] : (s->first_edge + n) % f->all->edge_count;
        float towards[3];
        aim(f, source, f->all->edges[i], towards);
        const float along[3] = {-towards[0], -towards[1], -towards[2]};
        if (source->type == EC_RARE_POINT && !(ec_rare_source_irradiance(source, f->all->edges[i], along) > 0)) continue; /* beside a spot's cone */
        ec_chain *ray = add_ray(f, s);
        ec_rare_ray(f->all->edges[i], towards, 1, BACK * f->all->radius, ray);
        ray->place = i;
    }
}

/* Turns round those rays that have met the source, to where its light lands. They take the places of others that are not needed any more. */
static void turn_back(finder *f, search *s)
{
    const ec_chain *met = s->rays;
    const uint32_t count = s->ray_count;
    begin_rays(f, s);
    for (uint32_t i = 0; i < count && s->ray_count < PASSED; i++) { /* any of them will do: edges are in no order */
        float towards[3];
        if (!ec_rare_meets(f->follower, s->source, &met[i])) continue;
        const uint32_t place = met[i].place;
        const float beta = met[i].beta, *edge = f->all->edges[place];
        aim(f, s->source, edge, towards);
        ec_chain *ray = add_ray(f, s);
        ec_rare_ray(edge, towards, -1, BACK * f->all->radius, ray);
        ray->beta = beta;
        ray->place = place;
    }
}

/* Finds where some of the light lands, evenly among the rays. */
static ec_result find_landings(finder *f, search *s, ec_error *err)
{
    uint32_t landed = 0;
    for (uint32_t i = 0; i < s->ray_count; i++)
        if (s->rays[i].hit != EC_NO_ID) s->rays[landed++] = s->rays[i];
    for (uint32_t k = 0; k < landed && k < s->most_landed; k++) {
        bool is_there;
        EC_TRY(land(f, &s->rays[landed > s->most_landed ? (uint64_t)k * landed / s->most_landed : k], s->source, &s->found[s->count], &is_there, err));
        s->count += is_there;
    }
    return EC_OK;
}

static int count_lit(const finder *f, const ec_rare_source *source, const ec_chain *ring)
{
    int lit = 0;
    for (int k = 0; k < AROUND; k++) lit += ec_rare_meets(f->follower, source, &ring[k]);
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

/* Keeps the patches, up to most_felt, that have a ring in which so little is lit that they are small. */
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
    s->count = kept < s->most_felt ? kept : s->most_felt;
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

/* Adds patches, up to so many in all. */
static ec_result find_all(finder *f, uint32_t most, ec_rare_patches *patches, ec_error *err)
{
    for (uint32_t i = 0; i < f->count; i++) f->searches[i].count = 0;
    EC_TRY(step(f, aim_past_edges, err));
    EC_TRY(step(f, turn_back, err));
    for (uint32_t i = 0; i < f->count; i++) EC_TRY(find_landings(f, &f->searches[i], err));
    EC_TRY(step(f, feel_few_rings, err));
    for (uint32_t i = 0; i < f->count; i++) drop_large(f, &f->searches[i]);
    EC_TRY(step(f, feel_all_rings, err));
    for (uint32_t i = 0; i < f->count; i++) keep_small(f, &f->searches[i], most, patches);
    return EC_OK;
}

/* Adds a search for each source. Near sources and a sky's are many, and their rays pass only some of the edges. */
static void add_searches(finder *f, const ec_rare_source *sources, uint32_t count)
{
    const uint32_t many = count > MANY ? count : MANY;
    for (uint32_t i = 0; i < count; i++) {
        const bool is_sky = sources[i].solid_angle > 0;
        f->searches[f->count++] = (search){.source = &sources[i], .random = 11, .first_edge = is_sky ? i * EC_RARE_NEAR_EDGES : 0,
                                           .edge_count = !is_sky && sources[i].type == EC_RARE_FAR ? EC_RARE_EDGES : EC_RARE_NEAR_EDGES,
                                           .most_landed = LANDED * MANY / many, .most_felt = is_sky ? SKY_FELT : FELT * MANY / many};
    }
}

/* Returns how many rays a step of all searches takes at most. */
static size_t most_rays(const finder *f)
{
    size_t sum = 0;
    for (const search *s = f->searches; s < f->searches + f->count; s++) {
        const size_t edges = s->edge_count < f->all->edge_count ? s->edge_count : f->all->edge_count;
        const size_t few = (size_t)AROUND * s->most_landed * SMALL_RINGS, all = (size_t)AROUND * s->most_felt * RINGS, felt = few > all ? few : all;
        sum += edges > felt ? edges : felt;
    }
    return sum;
}

/* Finds edges beside different openings, and returns how many. */
static uint32_t find_different(const ec_rare_lights *all, const ec_rare_patches *patches, uint32_t edges[SKY_PATCHES])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < patches->count; i++) {
        const patch *at = &patches->list[i];
        uint32_t k = 0;
        while (k < count && ec_square_between(all->edges[edges[k]], all->edges[at->edge]) > APART * APART * at->area) k++;
        if (k == count) edges[count++] = at->edge;
    }
    return count;
}

/* Finds openings by directions that each pass some of the edges, and then what comes through some of them from all directions. */
static ec_result find_sky(finder *f, ec_rare_patches *patches, ec_error *err)
{
    EC_FREED patch *list = calloc(SKY_PATCHES, sizeof *list);
    ec_rare_patches found = {.list = list};
    uint32_t chosen[SKY_PATCHES];
    const uint32_t first = patches->count;
    if (!list) return ec_fail(err, "out of memory for %d patches", SKY_PATCHES);
    EC_TRY(find_all(f, SKY_PATCHES, &found, err));
    const uint32_t different = find_different(f->all, &found, chosen), count = different < SKY_OPENINGS ? different : SKY_OPENINGS;
    if (!count) return EC_OK;
    for (uint32_t k = 0; k < count; k++) chosen[k] = chosen[k * different / count];
    f->chosen = chosen;
    for (uint32_t i = 0; i < f->count; i++) f->searches[i].edge_count = count;
    EC_TRY(find_all(f, EC_RARE_PATCHES, patches, err));
    for (uint32_t i = first; i < patches->count; i++) {
        patches->list[i].joins = i > first;
        patches->list[i].weight = (double)different / count;
    }
    return EC_OK;
}

static ec_result find(ec_rare_follower *follower, const ec_rare_source *sources, uint32_t count, ec_rare_patches *patches, ec_error *err)
{
    const ec_rare_lights *all = follower->lights;
    if (!count || !all->edge_count) return EC_OK;
    EC_FREED finder *f = calloc(1, sizeof *f);
    if (!f) return ec_fail(err, "out of memory for %u lights", count);
    f->all = all;
    f->follower = follower;
    add_searches(f, sources, count);
    EC_FREED ec_chain *rays = malloc(most_rays(f) * sizeof *rays);
    if (!rays) return ec_fail(err, "out of memory for rays past %u edges", all->edge_count);
    f->rays = rays;
    if (sources == all->sky) return find_sky(f, patches, err);
    const uint32_t room = patches->count + PATCHES;
    return find_all(f, room < EC_RARE_PATCHES ? room : EC_RARE_PATCHES, patches, err);
}

ec_result ec_rare_openings_find(ec_rare_follower *follower, ec_rare_patches *patches, ec_error *err)
{
    return find(follower, follower->lights->sources, follower->lights->source_count, patches, err);
}

ec_result ec_rare_sky_openings_find(ec_rare_follower *follower, ec_rare_patches *patches, ec_error *err)
{
    return find(follower, follower->lights->sky, follower->lights->sky_count, patches, err);
}

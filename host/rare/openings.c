#include "rare/openings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"

#define PI 3.14159265358979323846
#define BACK 1e-4     /* of the scene's radius: rays start this far before an edge */
#define ABOVE 1e-5    /* likewise, above what is lit */
#define GRAZING 0.05  /* cosine under which light only grazes what it falls on */
enum { PAGE = 256 }; /* triangles that are read at once */
enum { PASSED = 1 << 11 };                       /* rays past edges that are followed to where they land */
enum { LANDED = 128, FELT = 16, PATCHES = 16 }; /* rays of a sun that are looked at where they land; places around which rays feel what is lit;
                                                 * patches in all */
enum { RINGS = 20, AROUND = 8 }; /* the largest first, each half of the one before: down to 6e-7 of the radius */
/* A patch is small if fewer than SMALL_LIT rays are lit in one of SMALL_RINGS rings: every SMALL_STEP-th one, from number SMALL_STEP on. In the first of
 * these, SMALL_LIT lit rays mean an area of more than SMALL; the others lie within a room that stands in a wide landscape. */
enum { SMALL_RINGS = 3, SMALL_STEP = 3, SMALL_LIT = 3 };
#define LARGEST 0.3   /* of the scene's radius: the first one */
#define SMALL 3e-4    /* of the disk around the scene: what is lit more is met soon */
#define NEAREST 12    /* vertices by which their density is told … */
#define FLAT 0.05     /* … that lie no further from its plane, over their distance */
#define COMMON 0.02   /* chance beyond which every picture meets its light, as in paths.c */

typedef ec_rare_patch patch;

typedef struct finder {
    const ec_rare_lights *all;
    ec_pipeline *p;
    ec_chain *rays;
    ec_prim **pages;           /* pages of triangles, each read when one of its triangles is asked for */
    patch *patches;            /* those that are small */
    uint32_t count;
} finder;

static double dot(const float *a, const float *b) { return (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2]; }

static double square_between(const float *a, const float *b)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += ((double)a[k] - b[k]) * ((double)a[k] - b[k]);
    return sum;
}

/* Sets the direction from a point towards a sun. */
static void aim(const finder *f, const ec_rare_sun *sun, const float point[3], float towards[3])
{
    double length = 0;
    ec_rare_sun_direction(sun, &f->p->params, towards);
    if (!sun->is_lamp) return;
    for (int k = 0; k < 3; k++) towards[k] = sun->middle[k] - point[k], length += (double)towards[k] * towards[k];
    for (int k = 0; k < 3; k++) towards[k] = (float)(towards[k] / fmax(sqrt(length), 1e-30));
}

/* Returns whether a ray towards the sun has met it. */
static bool meets(const finder *f, const ec_rare_sun *sun, const ec_chain *ray)
{
    if (!sun->is_lamp || ray->hit == EC_NO_ID) return !sun->is_lamp && ray->hit == EC_NO_ID;
    return ec_rare_material_of(f->all, ray->hit) == sun->material;
}

/* Returns the irradiance of a surface that faces the sun, at a point that its light comes to along a direction. */
static double irradiance_at(const ec_rare_sun *sun, const float point[3], const float along[3])
{
    const double cosine = dot(sun->direction, along);
    if (!sun->is_lamp) return sun->irradiance;
    const double far = sun->irradiance * fmax(sun->two_sided ? fabs(cosine) : cosine, 0) / fmax(square_between(sun->middle, point), 1e-30);
    return fmin(far, PI * sun->radiance); /* no more than under a sky of such lamps */
}

/* Sets a ray along a direction, or against it (sign), from a point that is moved back by `back`. */
static void set_ray(ec_chain *ray, const float point[3], const float direction[3], double sign, double back)
{
    ray->prim = EC_NO_ID;
    for (int k = 0; k < 3; k++) {
        ray->direction[k] = (float)(sign * direction[k]);
        ray->origin[k] = (float)(point[k] - back * ray->direction[k]);
    }
}

/* Reads a triangle below flat_count; the pages are freed as a whole. */
static ec_result read_triangle(const finder *f, uint32_t prim, const ec_prim **at, ec_error *err)
{
    ec_prim **page = &f->pages[prim / PAGE];
    const uint32_t first = prim / PAGE * PAGE, count = f->all->flat_count - first < PAGE ? f->all->flat_count - first : PAGE;
    if (!*page) {
        *page = malloc(count * sizeof **page);
        if (!*page) return ec_fail(err, "out of memory for %u triangles", count);
        EC_TRY(ec_buffer_read(f->p->cl, f->p->buffers[EC_ARG_PRIMS], (uint64_t)first * sizeof **page, count * sizeof **page, *page, err));
    }
    *at = *page + prim % PAGE;
    return EC_OK;
}

/* Finds where a ray of the sun ends; *is_there: it does not only graze. */
static ec_result land(const finder *f, const ec_chain *ray, const ec_rare_sun *sun, patch *at, bool *is_there, ec_error *err)
{
    float e[3], g[3], n[3], way[3];
    const ec_prim *v = NULL;
    EC_TRY(read_triangle(f, ray->hit, &v, err));
    for (int k = 0; k < 3; k++) e[k] = v->v1[k] - v->v0[k], g[k] = v->v2[k] - v->v0[k], way[k] = v->v0[k] - ray->origin[k];
    for (int k = 0; k < 3; k++) n[k] = e[(k + 1) % 3] * g[(k + 2) % 3] - e[(k + 2) % 3] * g[(k + 1) % 3];
    const double length = sqrt(dot(n, n)), along = dot(n, ray->direction) / length, t = dot(n, way) / dot(n, ray->direction);
    *is_there = fabs(along) > GRAZING && t > 0 && isfinite(t);
    *at = (patch){.sun = sun};
    for (int k = 0; k < 3; k++) {
        at->point[k] = (float)(ray->origin[k] + t * ray->direction[k]);
        at->normal[k] = (float)(along > 0 ? -n[k] / length : n[k] / length);
    }
    at->irradiance = fabs(along) * irradiance_at(sun, at->point, ray->direction);
    *is_there = *is_there && at->irradiance > 0;
    return EC_OK;
}

/* Traces a sun's rays past edges, and moves those that get by and land to the front. There are many lamps, whose rays pass only some of the edges. */
static ec_result pass_edges(finder *f, const ec_rare_sun *sun, uint32_t *landed, ec_error *err)
{
    const uint32_t most = sun->is_lamp ? EC_RARE_LAMP_EDGES : EC_RARE_EDGES, count = f->all->edge_count < most ? f->all->edge_count : most;
    const double back = BACK * f->all->radius;
    float towards[3];
    uint32_t passed = 0;
    for (uint32_t i = 0; i < count; i++) {
        aim(f, sun, f->all->edges[i], towards);
        set_ray(&f->rays[i], f->all->edges[i], towards, 1, back);
    }
    ec_result result = ec_chains_meet(f->p, f->rays, count, err);
    for (uint32_t i = 0; i < count; i++) {
        if (!meets(f, sun, &f->rays[i])) continue;
        aim(f, sun, f->all->edges[i], towards);
        set_ray(&f->rays[passed++], f->all->edges[i], towards, -1, back);
    }
    passed = passed < PASSED ? passed : PASSED; /* any of them will do: edges are in no order */
    if (result == EC_OK && passed) result = ec_chains_meet(f->p, f->rays, passed, err);
    *landed = 0;
    for (uint32_t i = 0; i < passed; i++)
        if (f->rays[i].hit < f->all->flat_count) f->rays[(*landed)++] = f->rays[i];
    return result;
}

static int count_lit(const finder *f, const ec_rare_sun *sun, const ec_chain *ring)
{
    int lit = 0;
    for (int k = 0; k < AROUND; k++) lit += meets(f, sun, &ring[k]);
    return lit;
}

/* Adds up rings around a patch's point, from the smallest on, up to where nothing is lit. */
static double lit_area(const finder *f, const ec_rare_sun *sun, const ec_chain *rays)
{
    double area = 0, outer = LARGEST * f->all->radius * ldexp(1, 1 - RINGS), inner = 0;
    for (int ring = RINGS - 1; ring >= 0; ring--, inner = outer, outer *= 2) {
        const int lit = count_lit(f, sun, rays + ring * AROUND);
        if (!lit && ring < RINGS - 1) break;
        area += PI * (outer * outer - inner * inner) * lit / AROUND;
    }
    return area;
}

/* Makes rays towards the sun from a ring around a patch, evenly spaced. */
static void feel_ring(const finder *f, const patch *at, int ring, uint64_t *random, ec_chain *rays)
{
    const int axis = fabsf(at->normal[0]) < 0.6f ? 0 : 1;
    const float *n = at->normal;
    double u[3], v[3], length = 0;
    for (int k = 0; k < 3; k++) u[k] = (k == axis) - (double)n[axis] * n[k], length += u[k] * u[k];
    for (int k = 0; k < 3; k++) u[k] /= sqrt(length);
    for (int k = 0; k < 3; k++) v[k] = n[(k + 1) % 3] * u[(k + 2) % 3] - n[(k + 2) % 3] * u[(k + 1) % 3];
    const double outer = LARGEST * f->all->radius * ldexp(1, -ring), inner = ring < RINGS - 1 ? outer / 2 : 0, above = ABOVE * f->all->radius;
    for (int i = 0; i < AROUND; i++) {
        const double r = sqrt(ec_random_between(random, inner * inner, outer * outer)), angle = 2 * PI * (i + ec_random_unit(random)) / AROUND;
        float point[3], towards[3];
        for (int k = 0; k < 3; k++) point[k] = (float)(at->point[k] + r * (cos(angle) * u[k] + sin(angle) * v[k]) + above * n[k]);
        aim(f, at->sun, point, towards);
        set_ray(&rays[i], point, towards, 1, 0);
    }
}

static bool is_known(const finder *f, const patch *at)
{
    for (uint32_t i = 0; i < f->count; i++)
        if (f->patches[i].sun == at->sun && square_between(f->patches[i].point, at->point) < 4 * f->patches[i].area) return true;
    return false;
}

/* Keeps the patches, up to FELT, that have a ring in which so little is lit that they are small. */
static ec_result drop_large(finder *f, const ec_rare_sun *sun, patch *found, uint32_t *count, uint64_t *random, ec_error *err)
{
    uint32_t kept = 0;
    for (uint32_t k = 0; k < *count * SMALL_RINGS; k++)
        feel_ring(f, &found[k / SMALL_RINGS], SMALL_STEP * (int)(1 + k % SMALL_RINGS), random, f->rays + (size_t)k * AROUND);
    if (*count) EC_TRY(ec_chains_meet(f->p, f->rays, *count * SMALL_RINGS * AROUND, err));
    for (uint32_t k = 0; k < *count; k++) {
        int least = AROUND;
        for (uint32_t ring = 0; ring < SMALL_RINGS; ring++) {
            const int lit = count_lit(f, sun, f->rays + ((size_t)k * SMALL_RINGS + ring) * AROUND);
            least = lit < least ? lit : least;
        }
        if (least < SMALL_LIT) found[kept++] = found[k];
    }
    *count = kept < FELT ? kept : FELT;
    for (uint32_t k = 0; k < *count; k++) found[k] = found[(uint64_t)k * kept / *count];
    return EC_OK;
}

static ec_result find_patches(finder *f, const ec_rare_sun *sun, ec_error *err)
{
    uint32_t landed = 0, count = 0;
    uint64_t random = 11;
    patch found[LANDED];
    EC_TRY(pass_edges(f, sun, &landed, err));
    for (uint32_t k = 0; k < landed && k < LANDED; k++) { /* some of them, evenly */
        bool is_there;
        EC_TRY(land(f, &f->rays[landed > LANDED ? (uint64_t)k * landed / LANDED : k], sun, &found[count], &is_there, err));
        count += is_there;
    }
    EC_TRY(drop_large(f, sun, found, &count, &random, err));
    for (uint32_t k = 0; k < count * RINGS; k++) feel_ring(f, &found[k / RINGS], (int)(k % RINGS), &random, f->rays + (size_t)k * AROUND);
    if (count) EC_TRY(ec_chains_meet(f->p, f->rays, count * RINGS * AROUND, err));
    const double most = SMALL * PI * f->all->radius * f->all->radius;
    for (uint32_t k = 0; k < count && f->count < PATCHES; k++) {
        found[k].area = lit_area(f, sun, f->rays + (size_t)k * RINGS * AROUND);
        if (found[k].area > 0 && found[k].area < most && !is_known(f, &found[k])) f->patches[f->count++] = found[k];
    }
    return EC_OK;
}

/* A vertex that a path left, and the square of its distance from the patch. */
typedef struct near_vertex {
    double square;
    const ec_chain *from;
} near_vertex;

/* The nearest vertices to a patch, nearest first, apart: [1] those that the camera sees, [0] those that are only on the way. */
typedef struct near_patch {
    near_vertex vertices[2][NEAREST];
    uint32_t count[2];
} near_patch;

/* Finds the nearest vertices in the patch's plane and on its side. */
static void find_near(double radius, const ec_chains *paths, const patch *at, near_patch *found)
{
    found->count[0] = found->count[1] = 0;
    for (uint32_t i = 0; i < paths->vertex_count; i++) {
        const ec_chain *c = &paths->vertices[i];
        const float way[3] = {c->origin[0] - at->point[0], c->origin[1] - at->point[1], c->origin[2] - at->point[2]};
        const double square = dot(way, way), height = dot(way, at->normal);
        const bool seen = c->segment == 1;
        near_vertex *near = found->vertices[seen];
        uint32_t *count = &found->count[seen];
        if (*count == NEAREST && square >= near[NEAREST - 1].square) continue;
        if (!(dot(c->direction, at->normal) > 0 && fabs(height) <= FLAT * sqrt(square) + BACK * radius)) continue;
        uint32_t k = *count < NEAREST ? (*count)++ : NEAREST - 1;
        for (; k > 0 && near[k - 1].square > square; k--) near[k] = near[k - 1];
        near[k] = (near_vertex){square, c};
    }
}

/* Returns the root mean square over the mean, from pairs in one tile, as it would be with many vertices. */
static double gathered(const uint32_t *tiles, uint32_t count)
{
    uint32_t pairs = 0;
    for (uint32_t i = 0; i < EC_RARE_SHARES; i++) pairs += tiles[i] * (tiles[i] - (tiles[i] > 0));
    return sqrt(fmax(1, count > 1 ? (double)EC_RARE_SHARES * pairs / count / (count - 1) : EC_RARE_SHARES));
}

static void add_kind(const near_patch *found, bool seen, const ec_chains *paths, const patch *at, ec_rare *rare)
{
    const near_vertex *near = found->vertices[seen];
    const uint32_t count = found->count[seen];
    uint32_t tiles[EC_RARE_SHARES] = {0};
    double beta = 0;
    if (!count) return;
    const double chance = count * fmin(at->area / (PI * near[count - 1].square), 1) / paths->paths;
    const double pixels = (double)rare->width * rare->height;
    for (uint32_t i = 0; i < count; i++) {
        beta += (double)near[i].from->beta / count;
        tiles[ec_rare_tile(rare, near[i].from->place % rare->width, near[i].from->place / rare->width)]++;
    }
    const double luminance = chance * beta * at->irradiance / PI;
    const double spread = seen ? sqrt(fmin(1 / chance, pixels)) : gathered(tiles, count);
    ec_rare_kind *kind = luminance > 0 && chance < COMMON ? ec_rare_make_room(rare, luminance * spread) : NULL;
    if (!kind) return;
    *kind = (ec_rare_kind){.chance = chance, .luminance = luminance, .clamped = seen ? 0 : 1, .gathered = spread};
    uint32_t lit = 0;
    for (int i = 0; i < EC_RARE_SHARES; i++)
        if (!seen || tiles[i]) kind->share[i] = 255, lit++;
    kind->peak = (double)EC_RARE_SHARES / lit;
    snprintf(kind->light, sizeof kind->light, "a small patch lit by %.*s", EC_RARE_NAME - 24, at->sun->name);
}

ec_result ec_rare_openings_find(const ec_rare_lights *all, ec_pipeline *p, ec_rare_openings *openings, ec_error *err)
{
    const size_t felt = FELT * RINGS > LANDED * SMALL_RINGS ? FELT * RINGS : LANDED * SMALL_RINGS;
    const size_t most = all->edge_count > felt * AROUND ? all->edge_count : felt * AROUND;
    *openings = (ec_rare_openings){0};
    if (!all->sun_count || !all->edge_count) return EC_OK;
    const uint32_t pages = (all->flat_count + PAGE - 1) / PAGE;
    finder f = {.all = all, .p = p, .rays = calloc(most, sizeof *f.rays), .patches = calloc(PATCHES, sizeof *f.patches),
                .pages = calloc(pages + (size_t)1, sizeof *f.pages)};
    ec_result result = f.rays && f.patches && f.pages ? EC_OK : ec_fail(err, "out of memory for rays past %u edges", all->edge_count);
    for (uint32_t i = 0; result == EC_OK && i < all->sun_count; i++) result = find_patches(&f, &all->suns[i], err);
    for (uint32_t i = 0; f.pages && i < pages; i++) free(f.pages[i]);
    free(f.pages);
    free(f.rays);
    *openings = (ec_rare_openings){f.count, f.patches};
    return result;
}

void ec_rare_openings_judge(const ec_rare_openings *openings, const ec_rare_lights *all, const ec_chains *paths, ec_rare *rare)
{
    near_patch found[PATCHES];
#pragma omp parallel for if (openings->count > 1)
    for (uint32_t i = 0; i < openings->count; i++) find_near((double)all->radius, paths, &openings->patches[i], &found[i]);
    for (uint32_t i = 0; i < openings->count; i++)
        for (int seen = 0; seen < 2; seen++) add_kind(&found[i], seen, paths, &openings->patches[i], rare);
}

void ec_rare_openings_free(ec_rare_openings *openings)
{
    free(openings->patches);
    *openings = (ec_rare_openings){0};
}

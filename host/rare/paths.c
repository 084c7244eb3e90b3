#include "rare/paths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "rare/blind.h"
#include "rare/openings.h"
#include "rare/seldom.h"
#include "rare/sight.h"
#include "rare/spots.h"

#define PI 3.14159265358979323846
#define COMPARED (1 << 18)  /* chains times lamps that are compared, about, of each kind */
#define LEAST 1024          /* chains of a kind that are looked at in any case */
#define NEAREST 12
#define FEW 16              /* fewer chains say nothing of where they go, which may be anywhere */
#define AROUND 0.35         /* length of the nearest ones' mean offset, over its root mean square: beyond, all lie to one side … */
#define AROUND_CHANCE 1.0   /* … but for what chance makes of it, this over the root of their number */
#define OPEN 32             /* paths of which one leaves the scene, or more, meet so much of the sky that small openings do not matter */

/* A chain beside a light. */
typedef struct beside {
    double square;          /* of the distance of the two unit directions */
    float offset[3];        /* from the light's direction to the chain's */
    double solid_angle;     /* of the light, from there; 0: none of it is in sight */
    bool is_open;           /* whether it is in sight is not known: the chain's path ended with it */
    const ec_chain *chain;
} beside;

/* Chains of one sharpness, thinned out; each stands for `weight`. */
typedef struct selection {
    const ec_chain **chains;
    uint32_t count;
    double weight;
    const bool *in_sight;   /* from ec_rare_sight, for the light of this call of add_light; NULL: there are enough chains */
} selection;

/* Sums over the chains of a kind. */
typedef struct sums {
    double chance, luminance, clamped, caustic, share[EC_RARE_SHARES];
    double *through; /* by material; the last one: the camera's */
} sums;

static void place_beside(const ec_chain *chain, const double towards[3], beside *b)
{
    b->chain = chain;
    b->square = 0;
    b->is_open = false;
    for (int k = 0; k < 3; k++) {
        b->offset[k] = (float)(chain->direction[k] - towards[k]);
        b->square += (double)b->offset[k] * b->offset[k];
    }
}

/* Returns the solid angle of a light from where a chain starts. */
static double size_of(const ec_chain *chain, const ec_rare_light *light, const ec_rare_lamp *lamp)
{
    double square = 0, projected = 0;
    if (!lamp) return light->solid_angle;
    for (int k = 0; k < 3; k++) {
        const double way = (double)lamp->middle[k] - chain->origin[k];
        square += way * way;
        projected -= way * lamp->normal[k];
    }
    const double cosine = (lamp->two_sided ? fabs(projected) : projected) / fmax(sqrt(square), 1e-300);
    return cosine <= 0 ? 0 : fmin(lamp->area * cosine / fmax(square, 1e-300), 2 * PI);
}

static void beside_environment(const ec_chain *chain, const ec_rare_light *light, const ec_params *params, beside *b)
{
    float towards[3];
    ec_rare_light_direction(light, params, towards);
    place_beside(chain, (double[3]){towards[0], towards[1], towards[2]}, b);
    b->solid_angle = chain->hit == EC_NO_ID ? light->solid_angle : 0;
}

static void beside_lamp(const ec_rare_lights *all, const ec_chain *chain, const ec_rare_light *light, const ec_rare_lamp *lamp, beside *b)
{
    double way[3], square = 0;
    for (int k = 0; k < 3; k++) way[k] = (double)lamp->middle[k] - chain->origin[k], square += way[k] * way[k];
    const double distance = sqrt(square);
    for (int k = 0; k < 3; k++) way[k] /= fmax(distance, 1e-300);
    place_beside(chain, way, b);
    const bool is_it = chain->hit != EC_NO_ID && ec_rare_material_of(all, chain->hit) == light->material;
    const bool is_hidden = !is_it && chain->reach < 0.99 * distance; /* false where it is not known */
    b->is_open = !is_it && isnan(chain->reach);
    b->solid_angle = is_hidden ? 0 : size_of(chain, light, lamp);
}

/* Returns whether the chains surround the light. If all lie to one side, their directions end beside it. */
static bool surround(const beside *near, uint32_t count)
{
    double mean[3] = {0}, squares = 0;
    for (uint32_t i = 0; i < count; i++) {
        squares += near[i].square;
        for (int k = 0; k < 3; k++) mean[k] += near[i].offset[k];
    }
    const double length2 = (mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]) / count / count;
    const double most = AROUND + AROUND_CHANCE / sqrt(count);
    return length2 <= most * most * squares / count;
}

/* Adds what those chains bring; cap: steradians that they are spread over. With a lobe that is wider than the light, light sampling meets it more
 * often and brings less; the mean is the same. */
static void add_chains(const ec_rare_lights *all, const beside *near, uint32_t count, double cap, double weight, double radiance,
                       const ec_rare *rare, sums *s)
{
    for (uint32_t i = 0; i < count; i++) {
        const ec_chain *c = near[i].chain;
        const double lobe = isinf(c->pdf) ? 0 : 1 / c->pdf, own = near[i].solid_angle;
        if (!(own > 0)) continue;
        const double bright = weight * c->beta * radiance * own / cap;
        s->chance += weight * fmin(fmax(own, lobe) / cap, 1);
        s->luminance += bright;
        if (c->segment >= EC_DIRECT_SEGMENTS) s->clamped += bright;
        if (c->is_caustic) s->caustic += bright;
        s->share[ec_rare_tile(rare, c->place % rare->width, c->place / rare->width)] += bright;
        s->through[c->prim == EC_NO_ID ? all->material_count : ec_rare_material_of(all, c->prim)] += bright;
    }
}

/* Puts `next` among the nearest, which are sorted, the nearest first. */
static void keep_nearest(const beside *next, beside *near, uint32_t *count)
{
    if (*count == NEAREST && next->square >= near[NEAREST - 1].square) return;
    uint32_t i = *count < NEAREST ? (*count)++ : NEAREST - 1;
    for (; i > 0 && near[i - 1].square > next->square; i--) near[i] = near[i - 1];
    near[i] = *next;
}

static beside place(const ec_rare_lights *all, const ec_chain *chain, const ec_rare_light *light, const ec_rare_lamp *lamp, const ec_params *params)
{
    beside b;
    if (lamp) beside_lamp(all, chain, light, lamp, &b);
    else beside_environment(chain, light, params, &b);
    return b;
}

/* Returns the square of the distance of a chain's direction from the light's; *most: the largest solid angle that the light may have from there. Of
 * most chains that is enough to tell that they are neither near nor meet it. towards: an environment's part. */
static double distance_of(const ec_chain *chain, const ec_rare_light *light, const ec_rare_lamp *lamp, const float towards[3], double *most)
{
    double way[3], far = 0, square = 0;
    *most = light->solid_angle;
    for (int k = 0; k < 3; k++) way[k] = lamp ? (double)lamp->middle[k] - chain->origin[k] : (double)towards[k], far += way[k] * way[k];
    if (lamp) *most = lamp->area / fmax(far, 1e-300);
    const double length = lamp ? fmax(sqrt(far), 1e-300) : 1;
    for (int k = 0; k < 3; k++) square += (chain->direction[k] - way[k] / length) * (chain->direction[k] - way[k] / length);
    return square;
}

/* Takes the light to be as much in sight of chains that do not know as it is of those around them that do. */
static void settle_open(beside *near, uint32_t count)
{
    uint32_t known = 0, seen = 0;
    for (uint32_t i = 0; i < count; i++)
        if (!near[i].is_open) known++, seen += near[i].solid_angle > 0;
    for (uint32_t i = 0; i < count && known; i++)
        if (near[i].is_open) near[i].solid_angle *= (double)seen / known;
}

/* Adds what a light brings, by the chains that are nearest to it or, where it is so large that more meet it, by these; by all of them where it lies
 * all around; by those that have it in sight where there are too few to tell. */
static void add_light(const ec_rare_lights *all, const selection *of, const ec_rare_light *light, const ec_rare_lamp *lamp,
                      const ec_params *params, const ec_rare *rare, sums *s)
{
    const bool is_spread = ec_rare_light_is_all_around(light);
    const bool takes_all = is_spread || of->count < FEW;
    const double weight = of->weight * (lamp ? lamp->weight : 1);
    beside near[NEAREST];
    uint32_t count = 0, met = 0;
    float towards[3] = {0};
    if (!lamp) ec_rare_light_direction(light, params, towards);
    for (uint32_t i = 0; i < of->count; i++) {
        double most;
        const double square = distance_of(of->chains[i], light, lamp, towards, &most);
        if (count == NEAREST && square >= near[NEAREST - 1].square && PI * square >= most) continue;
        const beside next = place(all, of->chains[i], light, lamp, params);
        met += PI * next.square < next.solid_angle;
        keep_nearest(&next, near, &count);
    }
    for (uint32_t i = 0; i < of->count && (takes_all || met >= NEAREST); i++) {
        beside next = place(all, of->chains[i], light, lamp, params);
        if (of->in_sight && !is_spread) next.solid_angle = of->in_sight[i] ? size_of(of->chains[i], light, lamp) : 0;
        if (takes_all || PI * next.square < next.solid_angle)
            add_chains(all, &next, 1, takes_all ? 4 * PI : next.solid_angle, weight, light->radiance, rare, s);
    }
    if (takes_all || met >= NEAREST || !surround(near, count)) return;
    settle_open(near, count);
    add_chains(all, near, count, fmin(PI * fmax(near[count - 1].square, 1e-12), 4 * PI), weight, light->radiance, rare, s);
}

/* Kinds of chains: mirrors' and glass's, sharp lobes, wide ones; the same where the pixel sees through them; and the camera's. */
enum { ALIKE = 7, CAMERA = 6 };
static int kind_of(const ec_chain *c)
{
    if (c->prim == EC_NO_ID) return CAMERA;
    return (isinf(c->pdf) ? 0 : c->pdf > 2048 ? 1 : 2) + (c->is_direct ? 3 : 0);
}

/* Returns whether a chain is of a kind. What light paths bring is not rare, and left out. */
static bool is_of(const ec_chain *c, int kind, bool has_light_paths) { return kind_of(c) == kind && !(has_light_paths && c->is_caustic); }

/* Selects one of every `stride` chains, at random: paths come in the order of pixels. */
static void select_chains(const ec_chains *chains, int kind, bool has_light_paths, uint32_t most, selection *of)
{
    uint32_t found = 0, seen = 0, next = 0;
    for (uint32_t i = 0; i < chains->count; i++) found += is_of(&chains->chains[i], kind, has_light_paths);
    const uint32_t stride = (found + most - 1) / most;
    uint64_t random = 1;
    of->count = 0;
    for (uint32_t i = 0; i < chains->count; i++) {
        if (!is_of(&chains->chains[i], kind, has_light_paths)) continue;
        if (seen % stride == 0) next = seen + (uint32_t)(ec_random_unit(&random) * stride);
        if (seen++ == next) of->chains[of->count++] = &chains->chains[i];
    }
    of->weight = of->count ? (double)found / of->count / chains->paths : 0;
}

static void name_way(const ec_rare_lights *all, const sums *s, char *name)
{
    uint32_t best = all->material_count;
    for (uint32_t m = 0; m < all->material_count; m++)
        if (s->through[m] > s->through[best]) best = m;
    *name = 0;
    if (best < all->material_count) snprintf(name, EC_RARE_NAME, "%s", all->materials[best]);
}

/* Returns the root mean square over pixels of what a kind brings, over the mean. Seen directly it is the light's image, whose part of the picture is
 * its chance, but a pixel at least; else it lies as the chains do, tile by tile. */
static double gathered(const sums *s, bool is_direct, double pixels)
{
    double squares = 0;
    if (is_direct) return sqrt(fmin(1 / s->chance, pixels));
    for (int i = 0; i < EC_RARE_SHARES; i++) squares += s->share[i] * s->share[i];
    return sqrt(squares) * EC_RARE_TILES / s->luminance;
}

/* Keeps a kind if it is among those that matter most. */
static void keep_kind(const ec_rare_lights *all, const ec_rare_light *light, const sums *s, double spread, ec_rare *rare)
{
    ec_rare_kind *kind = s->luminance > 0 && s->chance <= EC_RARE_COMMON ? ec_rare_make_room(rare, s->luminance * spread) : NULL;
    uint32_t sum = 0;
    double most = 0;
    if (!kind) return;
    *kind = (ec_rare_kind){.chance = s->chance, .luminance = s->luminance, .clamped = s->clamped / s->luminance, .caustic = s->caustic / s->luminance,
                            .gathered = spread};
    for (int i = 0; i < EC_RARE_SHARES; i++) most = fmax(most, s->share[i]);
    for (int i = 0; i < EC_RARE_SHARES; i++) sum += kind->share[i] = (uint8_t)ceil(255 * (s->share[i] / most));
    kind->peak = 255.0 * EC_RARE_SHARES / sum;
    name_way(all, s, kind->through);
    memcpy(kind->light, light->name, sizeof kind->light);
}

/* Adds what one kind of chains brings from each light. */
static ec_result add_kind(const ec_rare_lights *all, selection *of, bool is_direct, ec_pipeline *p, double *through, ec_rare *rare, ec_error *err)
{
    const ec_params *params = &p->params;
    bool *in_sight = NULL, *at;
    if (of->count < FEW) EC_TRY(ec_rare_sight(all, of->chains, of->count, p, &in_sight, err));
    at = in_sight;
    for (uint32_t i = 0; of->count && i < all->count; i++) {
        const ec_rare_light *light = &all->lights[i];
        sums s = {.through = through};
        memset(through, 0, (all->material_count + (size_t)1) * sizeof *through);
        for (uint32_t l = 0; l < (light->lamp_count ? light->lamp_count : 1); l++) {
            of->in_sight = at;
            add_light(all, of, light, light->lamp_count ? &light->lamps[l] : NULL, params, rare, &s);
            if (at && !ec_rare_light_is_all_around(light)) at += of->count;
        }
        keep_kind(all, light, &s, gathered(&s, is_direct, (double)params->width * params->height), rare);
    }
    free(in_sight);
    return EC_OK;
}

ec_result ec_rare_paths_of(const ec_rare_lights *all, const ec_chains *chains, ec_pipeline *p, ec_rare *rare, ec_error *err)
{
    selection of = {.chains = malloc((chains->count + (size_t)1) * sizeof *of.chains)};
    double *through = malloc((all->material_count + (size_t)1) * sizeof *through);
    *rare = (ec_rare){.width = p->params.width, .height = p->params.height};
    ec_result result = of.chains && through ? EC_OK : ec_fail(err, "out of memory for %u paths", chains->count);
    uint32_t compared = 1;
    for (uint32_t i = 0; i < all->count; i++) compared += all->lights[i].lamp_count ? all->lights[i].lamp_count : 1;
    const uint32_t most = COMPARED / compared > LEAST ? COMPARED / compared : LEAST;
    for (int k = 0; result == EC_OK && k < ALIKE; k++) {
        select_chains(chains, k, (p->effects.called.bits & EC_FEATURE_LIGHT_PATHS) != 0, most, &of);
        result = add_kind(all, &of, k >= 3, p, through, rare, err);
    }
    free(of.chains);
    free(through);
    return result;
}

static ec_result predict(const ec_rare_lights *lights, ec_rare_follower *f, ec_rare_patches *patches, ec_chains *chains, ec_rare *rare,
                         ec_joined_choice *joined, ec_error *err)
{
    if (f->p->integrator == EC_INTEGRATOR_LIGHT) {
        EC_TRY(ec_chains_trace(f->p, lights, false, chains, err));
        return ec_rare_seldom_find(f, chains, rare, err);
    }
    EC_TRY(ec_rare_spots_find(f, patches, err));
    EC_TRY(ec_rare_openings_find(f, patches, err));
    EC_TRY(ec_chains_trace(f->p, lights, patches->count > 0, chains, err));
    if (chains->misses * OPEN < chains->paths) EC_TRY(ec_rare_sky_openings_find(f, patches, err));
    if (patches->count && !chains->vertices) {
        ec_chains_free(chains);
        EC_TRY(ec_chains_trace(f->p, lights, true, chains, err));
    }
    EC_TRY(ec_rare_paths_of(lights, chains, f->p, rare, err));
    if (joined && chains->may_join) EC_TRY(ec_chains_join(f->p, lights, joined, err));
    EC_TRY(ec_rare_blind_find(lights, chains, f->p, rare, err));
    return ec_rare_patches_judge(patches, f, chains, rare, err);
}

ec_result ec_rare_paths_predict(const ec_rare_lights *lights, ec_pipeline *p, ec_rare *rare, ec_joined_choice *joined, ec_error *err)
{
    ec_chains chains = {0};
    ec_rare_patches patches = {0};
    ec_rare_follower follower = {0};
    *rare = (ec_rare){0};
    if (joined) *joined = (ec_joined_choice){0};
    if (!lights->count && !lights->source_count) return EC_OK;
    if (!ec_traces_paths(p->integrator)) return EC_OK;
    patches.list = calloc(EC_RARE_PATCHES, sizeof *patches.list);
    ec_result result = patches.list ? ec_rare_follower_open(lights, p, &follower, err) : ec_fail(err, "out of memory for %d patches", EC_RARE_PATCHES);
    if (result == EC_OK) result = predict(lights, &follower, &patches, &chains, rare, joined, err);
    ec_rare_follower_close(&follower);
    ec_rare_patches_free(&patches);
    ec_chains_free(&chains);
    return result;
}

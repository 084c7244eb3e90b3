/* Light paths start at a light as often as it has flux. One of little flux can still be what lights the part of the picture that is near: a path of it
 * is as good as any other, but falls on few pixels. Rays from what the camera sees to all lights tell which of them brings how much direct light. */
#include "rare/seldom.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/freed.h"
#include "base/random.h"
#include "rare/sources.h"

#define PI 3.14159265358979323846
#define LEAST 0.1     /* of all direct light: what is brought by lights that are chosen more often is taken to be no less */
enum { POINTS = 512 };
enum { LIGHTS = EC_RARE_LIGHTS + EC_RARE_SOURCES + 1 };

/* A light, and what it brings: a part of the list of lights, a source, or with neither the sky. */
typedef struct sharer {
    const ec_rare_light *lamps;
    const ec_rare_source *source;
    const char *name;
    double power, light, tiles[EC_RARE_SHARES]; /* light: the sum over tiles */
} sharer;

typedef struct finder {
    ec_rare_follower *follower;
    const ec_rare_lights *all;
    const ec_rare *rare;
    ec_rare_landing points[POINTS];
    const ec_chain *seen[POINTS];  /* the camera's rays to them */
    uint32_t point_count, count;
    sharer sharers[LIGHTS];
} finder;

/* Takes one of every few of the camera's rays, at random, since these come in the order of pixels. */
static ec_result find_points(finder *f, const ec_chains *camera, ec_error *err)
{
    uint32_t found = 0, seen = 0;
    uint64_t random = 3;
    for (uint32_t i = 0; i < camera->count; i++) found += camera->chains[i].prim == EC_NO_ID && camera->chains[i].hit != EC_NO_ID;
    const uint32_t most = found < POINTS ? found : POINTS;
    double next = ec_random_unit(&random);
    for (uint32_t i = 0, taken = 0; i < camera->count && taken < most; i++) {
        const ec_chain *c = &camera->chains[i];
        if (c->prim != EC_NO_ID || c->hit == EC_NO_ID || seen++ < (uint32_t)(next * found / most)) continue;
        next = ++taken + ec_random_unit(&random);
        EC_TRY(ec_rare_land(f->follower, c, &f->points[f->point_count], err));
        f->seen[f->point_count] = c;
        f->point_count += f->points[f->point_count].cosine > 0;
    }
    return EC_OK;
}

static double power_of(const ec_rare_source *s, double disk)
{
    return s->type == EC_RARE_FAR ? disk * s->irradiance : s->power;
}

static void add_sharer(finder *f, const ec_rare_light *lamps, const ec_rare_source *source, const char *name, double power)
{
    f->sharers[f->count++] = (sharer){.lamps = lamps, .source = source, .name = name, .power = power};
}

static void list_lights(finder *f)
{
    const ec_rare_lights *all = f->all;
    const double disk = PI * all->radius * all->radius;
    double sky = 0;
    for (uint32_t i = 0; i < all->count; i++)
        if (all->lights[i].lamp_count) add_sharer(f, &all->lights[i], NULL, all->lights[i].name, all->lights[i].power);
    for (uint32_t i = 0; i < all->source_count; i++)
        if (all->sources[i].type != EC_RARE_LAMP) add_sharer(f, NULL, &all->sources[i], all->sources[i].name, power_of(&all->sources[i], disk));
    for (uint32_t i = 0; i < all->sky_count; i++) sky += power_of(&all->sky[i], disk);
    if (sky > 0) add_sharer(f, NULL, NULL, all->sky[0].name, sky);
}

/* Sets the source that a ray from a point is aimed at: lamps, and directions of the sky, take turns, and stand for all. */
static void choose_source(const finder *f, const sharer *s, uint32_t point, ec_rare_source *to)
{
    if (s->lamps) {
        ec_rare_source_of_lamp(s->lamps, point % s->lamps->lamp_count, 1, to);
        return;
    }
    *to = s->source ? *s->source : f->all->sky[point % f->all->sky_count];
    if (!s->source) to->irradiance *= f->all->sky_count;
}

/* Aims a ray from each point at the light. */
static void aim(const finder *f, const sharer *s, ec_chain *rays)
{
    for (uint32_t i = 0; i < f->point_count; i++) {
        ec_rare_source to;
        float towards[3];
        choose_source(f, s, i, &to);
        ec_rare_source_aim(&to, &f->follower->p->params, f->points[i].point, towards);
        ec_rare_ray(f->points[i].point, towards, 1, 0, &rays[i]);
        rays[i].prim = f->seen[i]->hit;
    }
}

/* Adds up the irradiance of the points by a light. */
static ec_result add_light(const finder *f, sharer *s, ec_chain *rays, ec_error *err)
{
    if (s->source && s->source->type == EC_RARE_POINT) EC_TRY(ec_rare_reach(f->follower, rays, f->point_count, err));
    for (uint32_t i = 0; i < f->point_count; i++) {
        const float *normal = f->points[i].normal, *d = rays[i].direction, along[3] = {-d[0], -d[1], -d[2]};
        const double cosine = (double)normal[0] * d[0] + (double)normal[1] * d[1] + (double)normal[2] * d[2];
        ec_rare_source from;
        choose_source(f, s, i, &from);
        if (!(cosine > 0) || !ec_rare_meets(f->follower, &from, &rays[i])) continue;
        const double light = cosine * rays[i].beta * ec_rare_source_irradiance(&from, f->points[i].point, along);
        s->light += light;
        s->tiles[ec_rare_tile(f->rare, f->seen[i]->place % f->rare->width, f->seen[i]->place / f->rare->width)] += light;
    }
    return EC_OK;
}

/* Adds a kind for a light: relative to what those bring that are chosen more often. */
static void add_kind(const finder *f, const sharer *s, double light_paths, ec_rare *rare)
{
    const double chance = s->power / f->all->power * light_paths;
    double all = 0, others = 0, squares = 0, most = 0, sum = 0;
    for (uint32_t i = 0; i < f->count; i++) all += f->sharers[i].light, others += f->sharers[i].power > s->power ? f->sharers[i].light : 0;
    for (int i = 0; i < EC_RARE_SHARES; i++) squares += s->tiles[i] * s->tiles[i], most = fmax(most, s->tiles[i]);
    if (!(squares > 0) || !isfinite(squares) || chance > EC_RARE_COMMON) return;
    const double light = s->light / fmax(others, LEAST * all), gathered = sqrt(squares) * EC_RARE_TILES / s->light;
    ec_rare_kind *kind = ec_rare_make_room(rare, light * gathered);
    if (!kind) return;
    *kind = (ec_rare_kind){.chance = chance, .luminance = light, .is_relative = true, .gathered = gathered};
    for (int i = 0; i < EC_RARE_SHARES; i++) sum += kind->share[i] = (uint8_t)ceil(255 * (s->tiles[i] / most));
    kind->peak = 255 * EC_RARE_SHARES / sum;
    snprintf(kind->light, sizeof kind->light, "what is lit by %.*s", EC_RARE_NAME - 16, s->name);
}

ec_result ec_rare_seldom_find(ec_rare_follower *follower, const ec_chains *camera, ec_rare *rare, ec_error *err)
{
    EC_FREED finder *f = calloc(1, sizeof *f);
    if (!f) return ec_fail(err, "out of memory for rays to %d lights", LIGHTS);
    *rare = (ec_rare){.width = follower->p->params.width, .height = follower->p->params.height};
    f->follower = follower;
    f->all = follower->lights;
    f->rare = rare;
    EC_TRY(find_points(f, camera, err));
    list_lights(f);
    const size_t each = f->point_count;
    EC_FREED ec_chain *rays = malloc((f->count * each + 1) * sizeof *rays);
    if (!rays) return ec_fail(err, "out of memory for rays to %u lights", f->count);
    for (uint32_t i = 0; i < f->count; i++) aim(f, &f->sharers[i], rays + i * each);
    EC_TRY(ec_rare_follow(follower, rays, (uint32_t)(f->count * each), err));
    for (uint32_t i = 0; i < f->count; i++) EC_TRY(add_light(f, &f->sharers[i], rays + i * each, err));
    for (uint32_t i = 0; i < f->count; i++) add_kind(f, &f->sharers[i], (double)follower->p->params.light_paths, rare);
    return EC_OK;
}

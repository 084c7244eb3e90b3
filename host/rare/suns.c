#include "rare/suns.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "base/text.h"
#include "film/film.h"

#define BESIDE 1e-4   /* of the scene's radius, from the edge … */
#define BESIDE_EDGE 0.1 /* … but at most this share of the edge's length: a hole in a wide landscape has short edges */
#define NARROW 0.02   /* steradians: of a wider light one ray does not tell where it falls */
#define ONE_SUN 0.995 /* cosine between parts of a map that are one sun */
#define WEAK 0.01     /* of the strongest sun's irradiance, or of all lamps' power */

/* Adds a sun, in place of the weakest where there is no room. */
static void add_sun(const ec_rare_sun *sun, ec_rare_lights *all)
{
    uint32_t at = all->sun_count;
    if (!(sun->irradiance > 0)) return;
    if (at < EC_RARE_SUNS) {
        all->suns[all->sun_count++] = *sun;
        return;
    }
    at = 0;
    for (uint32_t i = 1; i < EC_RARE_SUNS; i++)
        if (all->suns[i].irradiance < all->suns[at].irradiance) at = i;
    if (all->suns[at].irradiance < sun->irradiance) all->suns[at] = *sun;
}

static void add_directional(const ec_scene *scene, ec_rare_lights *all)
{
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const ec_light *l = &scene->lights[i];
        if (l->type != EC_LIGHT_DIRECTIONAL) continue;
        ec_rare_sun sun = {.irradiance = ec_luminance((double[3]){l->intensity[0], l->intensity[1], l->intensity[2]})};
        for (int k = 0; k < 3; k++) sun.direction[k] = -l->direction[k];
        if (l->name && *l->name) snprintf(sun.name, sizeof sun.name, "\"%.*s\"", EC_CUT(l->name, 16));
        else snprintf(sun.name, sizeof sun.name, "directional light %u", i);
        add_sun(&sun, all);
    }
}

/* Joins a sun to one of the map in the same direction: a disk's brightest octave comes first, and then what lies around it. */
static bool join_sun(const ec_rare_sun *sun, ec_rare_lights *all)
{
    for (uint32_t i = 0; i < all->sun_count; i++) {
        ec_rare_sun *one = &all->suns[i];
        double cosine = 0;
        for (int k = 0; k < 3; k++) cosine += (double)one->direction[k] * sun->direction[k];
        if (!one->is_on_map || cosine < ONE_SUN) continue;
        one->irradiance += sun->irradiance;
        return true;
    }
    return false;
}

static void add_from_map(ec_rare_lights *all)
{
    for (uint32_t i = 0; i < all->count; i++) {
        const ec_rare_light *l = &all->lights[i];
        if (l->lamp_count || l->solid_angle > NARROW || ec_rare_light_is_all_around(l)) continue;
        ec_rare_sun sun = {.is_on_map = true, .irradiance = l->radiance * l->solid_angle, .name = "the environment"};
        memcpy(sun.direction, l->direction, sizeof sun.direction);
        if (!join_sun(&sun, all)) add_sun(&sun, all);
    }
}

static void drop_weak_suns(ec_rare_lights *all)
{
    double most = 0;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < all->sun_count; i++) most = fmax(most, all->suns[i].irradiance);
    for (uint32_t i = 0; i < all->sun_count; i++)
        if (all->suns[i].irradiance >= WEAK * most) all->suns[kept++] = all->suns[i];
    all->sun_count = kept;
}

/* Adds a triangle of each of the first lamps, two where lamps are few; they are in order of power. */
static void add_lamps(ec_rare_lights *all)
{
    uint32_t aims = 0, lamps = 0;
    double power = 0;
    for (uint32_t i = 0; i < all->count; i++)
        if (all->lights[i].lamp_count) power += all->lights[i].power, lamps++;
    const uint32_t each = 2 * lamps <= EC_RARE_AIMS ? 2 : 1;
    for (uint32_t i = 0; i < all->count && aims < EC_RARE_AIMS; i++) {
        const ec_rare_light *l = &all->lights[i];
        if (l->power < WEAK * power) continue;
        const uint32_t parts = l->lamp_count < each ? l->lamp_count : each;
        for (uint32_t k = 0; k < parts && aims < EC_RARE_AIMS; k++, aims++) {
            const ec_rare_lamp *lamp = &l->lamps[k * (l->lamp_count / 2)];
            ec_rare_sun *sun = &all->suns[all->sun_count++];
            *sun = (ec_rare_sun){.is_lamp = true, .two_sided = lamp->two_sided, .material = l->material, .radiance = l->radiance};
            sun->irradiance = l->radiance * lamp->area * lamp->weight * l->lamp_count / parts;
            memcpy(sun->middle, lamp->middle, sizeof sun->middle);
            memcpy(sun->direction, lamp->normal, sizeof sun->direction);
            snprintf(sun->name, sizeof sun->name, "%.*s", EC_CUT(l->name, EC_RARE_NAME - 1));
        }
    }
}

/* Sets a point beside the middle of a triangle's edge, in its plane and outside of it. */
static void set_beside(const ec_prim *p, int edge, double radius, float point[3])
{
    const float *v[3] = {p->v0, p->v1, p->v2}, *a = v[edge], *b = v[(edge + 1) % 3], *c = v[(edge + 2) % 3];
    double along = 0, square = 0, length = 0, out[3];
    for (int k = 0; k < 3; k++) along += ((double)c[k] - a[k]) * ((double)b[k] - a[k]), square += ((double)b[k] - a[k]) * ((double)b[k] - a[k]);
    const double distance = fmin(BESIDE * radius, BESIDE_EDGE * sqrt(square));
    for (int k = 0; k < 3; k++) out[k] = a[k] + along / fmax(square, 1e-300) * ((double)b[k] - a[k]) - c[k], length += out[k] * out[k];
    for (int k = 0; k < 3; k++) point[k] = (float)(0.5 * ((double)a[k] + b[k]) + distance * out[k] / fmax(sqrt(length), 1e-300));
}

static double length_of(const ec_prim *p)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += pow((double)p->v1[k] - p->v0[k], 2) + pow((double)p->v2[k] - p->v0[k], 2);
    return sqrt(sum);
}

/* Chooses `count` triangles, each as often as it is long: around holes walls are cut in long ones, and what is finely meshed is mostly no wall. */
static void choose_by_length(const ec_pack *pack, uint32_t triangles, uint32_t count, uint64_t *random, uint32_t *chosen)
{
    double all = 0, sum = 0;
    uint32_t next = 0;
    for (uint32_t i = 0; i < triangles; i++) all += length_of(&pack->prims[i]);
    const double first = ec_random_unit(random);
    for (uint32_t i = 0; i < triangles; i++) {
        sum += length_of(&pack->prims[i]);
        while (next < count && sum >= all * (next + first) / count) chosen[next++] = i;
    }
    while (next < count) chosen[next++] = triangles - 1;
}

/* Takes points beside all edges; where there are many, beside some, half of them by the triangles' lengths and half evenly; in random order. */
static ec_result find_edges(const ec_pack *pack, ec_rare_lights *all, ec_error *err)
{
    const uint64_t edges = 3ull * all->flat_count;
    uint64_t random = 5;
    all->edge_count = edges < EC_RARE_EDGES ? (uint32_t)edges : EC_RARE_EDGES;
    if (!all->edge_count) return EC_OK;
    uint32_t *by_length = malloc(all->edge_count * sizeof *by_length);
    all->edges = malloc(all->edge_count * sizeof *all->edges);
    if (!all->edges || !by_length) {
        free(by_length);
        return ec_fail(err, "out of memory for %u edges", all->edge_count);
    }
    if (edges > all->edge_count) choose_by_length(pack, all->flat_count, all->edge_count / 2, &random, by_length);
    for (uint32_t i = 0; i < all->edge_count; i++) {
        const bool some = edges > all->edge_count;
        const uint64_t edge = !some ? i : i % 2 ? 3ull * by_length[i / 2] + ec_random_bits(&random) % 3 : ec_random_bits(&random) % edges;
        set_beside(&pack->prims[edge / 3], (int)(edge % 3), (double)all->radius, all->edges[i]);
    }
    free(by_length);
    for (uint32_t i = all->edge_count; i-- > 1;) { /* Fisher and Yates */
        const uint32_t k = (uint32_t)(ec_random_bits(&random) % (i + 1ull));
        float kept[3];
        memcpy(kept, all->edges[i], sizeof kept);
        memcpy(all->edges[i], all->edges[k], sizeof kept);
        memcpy(all->edges[k], kept, sizeof kept);
    }
    return EC_OK;
}

ec_result ec_rare_suns_find(const ec_pack *pack, ec_rare_lights *all, ec_error *err)
{
    add_directional(&pack->plain.scene, all);
    add_from_map(all);
    drop_weak_suns(all);
    add_lamps(all);
    all->flat_count = ec_scene_flat_count(&pack->plain.scene);
    return all->sun_count ? find_edges(pack, all, err) : EC_OK;
}

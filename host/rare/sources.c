#include "rare/sources.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "base/vec3.h"
#include "film/film.h"

#define PI 3.14159265358979323846
enum { FEW_LAMPS = 4 };
#define NARROW 0.02   /* steradians: of a wider light one ray does not tell where it falls */
#define ONE_SUN 0.995 /* cosine between parts of a map that are one sun */
#define WEAK 0.01     /* of the strongest sun's irradiance, or of all lamps' or all points' power */

/* Adds a sun, in place of the weakest where there is no room. */
static void add_sun(const ec_rare_source *sun, ec_rare_lights *all)
{
    uint32_t at = all->source_count;
    if (!(sun->irradiance > 0)) return;
    if (at < EC_RARE_SUNS) {
        all->sources[all->source_count++] = *sun;
        return;
    }
    at = 0;
    for (uint32_t i = 1; i < EC_RARE_SUNS; i++)
        if (all->sources[i].irradiance < all->sources[at].irradiance) at = i;
    if (all->sources[at].irradiance < sun->irradiance) all->sources[at] = *sun;
}

static void name_source(const ec_light *l, const char *type, uint32_t number, ec_rare_source *source)
{
    if (l->name && *l->name) snprintf(source->name, sizeof source->name, "\"%.*s\"", EC_CUT(l->name, 16));
    else snprintf(source->name, sizeof source->name, "%s %u", type, number);
}

static void add_directional(const ec_scene *scene, ec_rare_lights *all)
{
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const ec_light *l = &scene->lights[i];
        if (l->type != EC_LIGHT_DIRECTIONAL) continue;
        ec_rare_source sun = {.irradiance = ec_luminance((double[3]){l->intensity[0], l->intensity[1], l->intensity[2]})};
        for (int k = 0; k < 3; k++) sun.direction[k] = -l->direction[k];
        name_source(l, "directional light", i, &sun);
        add_sun(&sun, all);
    }
}

/* Joins a sun to one of the map in the same direction: a disk's brightest octave comes first, and then what lies around it. */
static bool join_sun(const ec_rare_source *sun, ec_rare_lights *all)
{
    for (uint32_t i = 0; i < all->source_count; i++) {
        ec_rare_source *one = &all->sources[i];
        double cosine = 0;
        for (int k = 0; k < 3; k++) cosine += (double)one->direction[k] * sun->direction[k];
        if (!one->is_on_map || cosine < ONE_SUN) continue;
        one->irradiance += sun->irradiance;
        return true;
    }
    return false;
}

bool ec_rare_light_is_sun(const ec_rare_light *l) { return !l->lamp_count && l->solid_angle <= NARROW && !ec_rare_light_is_all_around(l); }

static void add_from_map(ec_rare_lights *all)
{
    for (uint32_t i = 0; i < all->count; i++) {
        const ec_rare_light *l = &all->lights[i];
        if (!ec_rare_light_is_sun(l)) continue;
        ec_rare_source sun = {.is_on_map = true, .irradiance = l->radiance * l->solid_angle, .name = "the environment"};
        memcpy(sun.direction, l->direction, sizeof sun.direction);
        if (!join_sun(&sun, all)) add_sun(&sun, all);
    }
}

static void drop_weak_suns(ec_rare_lights *all)
{
    double most = 0;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < all->source_count; i++) most = fmax(most, all->sources[i].irradiance);
    for (uint32_t i = 0; i < all->source_count; i++)
        if (all->sources[i].irradiance >= WEAK * most) all->sources[kept++] = all->sources[i];
    all->source_count = kept;
}

/* Directions lie evenly, on a spiral of the golden angle. */
void ec_rare_sky_find(const double radiance[8], ec_rare_lights *all)
{
    double most = 0;
    for (int k = 0; k < 8; k++) most = fmax(most, radiance[k]);
    for (int i = 0; i < EC_RARE_SKY; i++) {
        const double y = 1 - (2 * i + 1.0) / EC_RARE_SKY, sine = sqrt(1 - y * y), angle = PI * (3 - sqrt(5)) * i;
        const double d[3] = {sine * cos(angle), y, sine * sin(angle)}, bright = radiance[(d[0] < 0) + 2 * (d[1] < 0) + 4 * (d[2] < 0)];
        if (!(bright > WEAK * most)) continue;
        ec_rare_source *source = &all->sky[all->sky_count++];
        *source = (ec_rare_source){.is_on_map = true, .solid_angle = 4 * PI / EC_RARE_SKY, .irradiance = bright * 4 * PI / EC_RARE_SKY,
                                   .name = "the environment"};
        for (int k = 0; k < 3; k++) source->direction[k] = (float)d[k];
    }
}

void ec_rare_source_of_lamp(const ec_rare_light *l, uint32_t number, uint32_t parts, ec_rare_source *source)
{
    const ec_rare_lamp *lamp = &l->lamps[number];
    *source = (ec_rare_source){.type = EC_RARE_LAMP, .two_sided = lamp->two_sided, .material = l->material, .radiance = l->radiance};
    source->irradiance = l->radiance * lamp->area * lamp->weight * l->lamp_count / parts;
    memcpy(source->middle, lamp->middle, sizeof source->middle);
    memcpy(source->direction, lamp->normal, sizeof source->direction);
    snprintf(source->name, sizeof source->name, "%.*s", EC_CUT(l->name, EC_RARE_NAME - 1));
}

/* Adds a triangle of each of the first lamps, two of FEW_LAMPS; they are in order of power. */
static void add_lamps(ec_rare_lights *all)
{
    uint32_t aims = 0, lamps = 0;
    double power = 0;
    for (uint32_t i = 0; i < all->count; i++)
        if (all->lights[i].lamp_count) power += all->lights[i].power, lamps++;
    const uint32_t each = lamps <= FEW_LAMPS ? 2 : 1;
    for (uint32_t i = 0; i < all->count && aims < EC_RARE_AIMS; i++) {
        const ec_rare_light *l = &all->lights[i];
        if (l->power < WEAK * power) continue;
        const uint32_t parts = l->lamp_count < each ? l->lamp_count : each;
        for (uint32_t k = 0; k < parts && aims < EC_RARE_AIMS; k++, aims++)
            ec_rare_source_of_lamp(l, k * (l->lamp_count / 2), parts, &all->sources[all->source_count++]);
    }
}

static void add_point(const ec_light *l, uint32_t number, ec_rare_lights *all)
{
    ec_rare_source *source = &all->sources[all->source_count++];
    const bool is_spot = l->type == EC_LIGHT_SPOT;
    *source = (ec_rare_source){.type = EC_RARE_POINT, .irradiance = ec_luminance((double[3]){l->intensity[0], l->intensity[1], l->intensity[2]}),
                               .cos_inner = is_spot ? l->cos_inner : -2, .cos_outer = is_spot ? l->cos_outer : -2, .range = l->range,
                               .power = ec_pack_punctual_power(l, 1)};
    memcpy(source->middle, l->position, sizeof source->middle);
    memcpy(source->direction, l->direction, sizeof source->direction);
    name_source(l, is_spot ? "spot light" : "point light", number, source);
}

/* Adds the point and spot lights with the most power. */
static void add_points(const ec_scene *scene, ec_rare_lights *all)
{
    double power = 0, last = INFINITY;
    uint32_t last_light = 0;
    for (uint32_t i = 0; i < scene->light_count; i++)
        if (scene->lights[i].type != EC_LIGHT_DIRECTIONAL) power += ec_pack_punctual_power(&scene->lights[i], 1);
    for (int n = 0; n < EC_RARE_POINTS; n++) {
        double most = 0;
        uint32_t best = 0;
        for (uint32_t i = 0; i < scene->light_count; i++) {
            const double own = scene->lights[i].type == EC_LIGHT_DIRECTIONAL ? 0 : ec_pack_punctual_power(&scene->lights[i], 1);
            const bool is_next = own < last || (own == last && i > last_light);
            if (is_next && own > most) most = own, best = i;
        }
        if (!(most > WEAK * power)) return;
        add_point(&scene->lights[best], best, all);
        last = most, last_light = best;
    }
}

void ec_rare_sources_find(const ec_scene *scene, ec_rare_lights *all)
{
    add_directional(scene, all);
    add_from_map(all);
    drop_weak_suns(all);
    add_lamps(all);
    add_points(scene, all);
}

void ec_rare_source_aim(const ec_rare_source *source, const ec_params *params, const float point[3], float towards[3])
{
    const double length = sqrt(ec_square_between(source->middle, point));
    if (source->is_on_map) ec_rare_turn_from_map(source->direction, params, towards);
    else if (source->type == EC_RARE_FAR) memcpy(towards, source->direction, sizeof source->direction);
    else
        for (int k = 0; k < 3; k++) towards[k] = (float)(((double)source->middle[k] - point[k]) / fmax(length, 1e-30));
}

/* Returns what a point or spot light sends along a direction, as kernels/lib/light.h has it, over what it sends along its axis near by. */
static double falloff(const ec_rare_source *s, double cosine, double square)
{
    const double cone = fmin(fmax((cosine - s->cos_outer) / fmax(0.001, s->cos_inner - s->cos_outer), 0), 1);
    const double part = s->range > 0 ? square / (s->range * s->range) : 0;
    return (s->cos_inner < -1 ? 1 : cone * cone) * fmax(1 - part * part, 0);
}

double ec_rare_source_irradiance(const ec_rare_source *s, const float point[3], const float along[3])
{
    if (s->type == EC_RARE_FAR) return s->irradiance;
    double cosine = 0;
    for (int k = 0; k < 3; k++) cosine += (double)s->direction[k] * along[k];
    const double square = fmax(ec_square_between(s->middle, point), 1e-30);
    if (s->type == EC_RARE_POINT) return s->irradiance * falloff(s, cosine, square) / square;
    const double far = s->irradiance * fmax(s->two_sided ? fabs(cosine) : cosine, 0) / square;
    return fmin(far, PI * s->radiance); /* no more than under a sky of such lamps */
}

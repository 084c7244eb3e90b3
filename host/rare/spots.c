/* Each ray from a light stands for part of its flux, and where it lands for the area that this part falls on. A surface close to the light has most of
 * its flux in little area, in rings of ever less irradiance: rays are grouped by octaves of it, and the brightest groups are spots as long as their
 * area is little in all, on however many surfaces. A narrow spot light has no more than that one group. */
#include "rare/spots.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/freed.h"
#include "base/random.h"
#include "rare/leave.h"

#define PI 3.14159265358979323846
#define SMALL 3e-4    /* of the disk around the scene, as in openings.c, and of all that the light falls on: what is more is met soon */
#define GRAZING 1e-3  /* cosine under which nobody can tell how much a ray lights */
#define ALIKE 0.99    /* cosine between normals of patches that are one */
#define PLANE 0.02    /* of the distance of two patches: how far one may lie from the other's plane */
enum { RAYS = 64 };
enum { OCTAVES = 8, OCTAVES_EACH = 2 }; /* groups of a light, from its brightest spot down */

/* The end of a ray. */
typedef struct landing {
    ec_rare_patch patch;
    double flux; /* W */
    uint32_t group;
} landing;

/* The rays of one light. */
typedef struct beam {
    const ec_rare_source *point; /* NULL: lamps */
    const char *light;           /* its name */
    ec_chain *rays;
    double flux[RAYS], solid_angle[RAYS], least_area[RAYS]; /* that a ray stands for; m^2 that its light falls on at least */
} beam;

typedef struct finder {
    const ec_rare_lights *all;
    ec_rare_follower *follower;
    ec_rare_patches *patches;
    beam beams[EC_RARE_POINTS + EC_RARE_AIMS];
    ec_chain rays[(EC_RARE_POINTS + EC_RARE_AIMS) * RAYS]; /* all are traced at once */
    uint32_t count;                                        /* beams */
} finder;

static beam *add_beam(finder *f, const ec_rare_source *point, const char *light)
{
    beam *b = &f->beams[f->count];
    *b = (beam){.point = point, .light = light, .rays = f->rays + (size_t)f->count++ * RAYS};
    return b;
}

static void start_from_point(const ec_rare_source *source, beam *b)
{
    for (uint32_t k = 0; k < RAYS; k++) b->solid_angle[k] = ec_rare_leave_point(source, k, RAYS, &b->rays[k]);
}

/* Directions are those of a lamp's light: each stands for as much of its flux, and for a solid angle that goes by the cosine. */
static void start_from_lamps(const ec_rare_light *light, beam *b)
{
    const uint32_t lamps = light->lamp_count, each = lamps < RAYS ? RAYS / lamps : 1;
    double area = 0;
    uint64_t random = 13;
    for (uint32_t k = 0; k < RAYS; k++) area += (double)light->lamps[k % lamps].area * light->lamps[k % lamps].weight;
    for (uint32_t k = 0; k < RAYS; k++) {
        const ec_rare_lamp *lamp = &light->lamps[k % lamps];
        double cosine = 0;
        ec_rare_leave_lamp(lamp, &random, &b->rays[k]);
        b->rays[k].beta = 1;
        for (int c = 0; c < 3; c++) cosine += (double)b->rays[k].direction[c] * lamp->normal[c];
        b->flux[k] = light->power * lamp->area * lamp->weight / area;
        b->solid_angle[k] = PI / (each * fmax(fabs(cosine), 1e-6)) * (lamp->two_sided ? 2 : 1);
        b->least_area[k] = (double)lamp->area * lamp->weight / each;
    }
}

/* Finds where the rays have landed; *count: of those that tell. */
static ec_result land(finder *f, const beam *b, landing *landings, uint32_t *count, ec_error *err)
{
    double most = 0;
    *count = 0;
    for (uint32_t k = 0; k < RAYS; k++) {
        landing *l = &landings[*count];
        ec_rare_landing at;
        if (b->rays[k].hit == EC_NO_ID) continue;
        EC_TRY(ec_rare_land(f->follower, &b->rays[k], &at, err));
        const double lit = b->solid_angle[k] * at.distance * at.distance;
        const double flux = b->point ? lit * ec_rare_source_irradiance(b->point, at.point, b->rays[k].direction) : b->flux[k];
        l->flux = flux * b->rays[k].beta;
        if (!(at.cosine > GRAZING && l->flux > 0)) continue;
        l->patch = (ec_rare_patch){.area = lit / at.cosine + b->least_area[k], .chance = 1, .weight = 1};
        memcpy(l->patch.point, at.point, sizeof at.point);
        memcpy(l->patch.normal, at.normal, sizeof at.normal);
        l->patch.irradiance = l->flux / l->patch.area;
        most = fmax(most, l->patch.irradiance);
        ++*count;
    }
    for (uint32_t k = 0; k < *count; k++) {
        const double octave = log2(most / landings[k].patch.irradiance) / OCTAVES_EACH;
        landings[k].group = octave < OCTAVES ? (uint32_t)octave : OCTAVES;
    }
    return EC_OK;
}

static bool is_one(const ec_rare_patch *a, const ec_rare_patch *b)
{
    double cosine = 0, height = 0, square = 0;
    for (int k = 0; k < 3; k++) {
        const double way = (double)b->point[k] - a->point[k];
        cosine += (double)a->normal[k] * b->normal[k];
        height += way * a->normal[k];
        square += way * way;
    }
    return cosine > ALIKE && fabs(height) <= PLANE * sqrt(square);
}

/* Adds a group's patches, those of one plane as one. */
static void add_group(finder *f, const landing *landings, uint32_t count, uint32_t group, const char *light)
{
    const uint32_t first = f->patches->count;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = first;
        if (landings[i].group != group) continue;
        while (at < f->patches->count && !is_one(&f->patches->list[at], &landings[i].patch)) at++;
        if (at == EC_RARE_PATCHES) return;
        ec_rare_patch *patch = &f->patches->list[at];
        if (at == f->patches->count) {
            *patch = landings[i].patch;
            patch->light = light;
            patch->joins = f->patches->count++ > first;
            continue;
        }
        const double flux = patch->irradiance * patch->area + landings[i].flux;
        patch->area += landings[i].patch.area;
        patch->irradiance = flux / patch->area;
    }
}

static double area_of(const landing *landings, uint32_t count, uint32_t group)
{
    double area = 0;
    for (uint32_t i = 0; i < count; i++) area += landings[i].group == group ? landings[i].patch.area : 0;
    return area;
}

static ec_result find_spots(finder *f, const beam *b, ec_error *err)
{
    landing landings[RAYS];
    uint32_t count;
    double all = 0, area = 0, most = SMALL * PI * f->all->radius * f->all->radius;
    EC_TRY(land(f, b, landings, &count, err));
    for (uint32_t i = 0; i < count; i++) all += landings[i].patch.area;
    for (uint32_t i = 0; i < count && all < most; i++) landings[i].group = 0;
    if (all >= most) most = fmin(most, SMALL * all);
    for (uint32_t group = 0; group < OCTAVES; group++) {
        area += area_of(landings, count, group);
        if (area >= most) break;
        add_group(f, landings, count, group, b->light);
    }
    return EC_OK;
}

static void start_all(finder *f)
{
    uint32_t lamps = 0;
    for (uint32_t i = 0; i < f->all->source_count; i++) {
        const ec_rare_source *source = &f->all->sources[i];
        if (source->type == EC_RARE_POINT) start_from_point(source, add_beam(f, source, source->name));
    }
    for (uint32_t i = 0; i < f->all->count && lamps < EC_RARE_AIMS; i++) { /* they are in order of power */
        const ec_rare_light *light = &f->all->lights[i];
        if (!light->lamp_count) continue;
        lamps++;
        start_from_lamps(light, add_beam(f, NULL, light->name));
    }
}

ec_result ec_rare_spots_find(ec_rare_follower *follower, ec_rare_patches *patches, ec_error *err)
{
    EC_FREED finder *f = calloc(1, sizeof *f);
    if (!f) return ec_fail(err, "out of memory for rays from lights");
    f->all = follower->lights;
    f->follower = follower;
    f->patches = patches;
    start_all(f);
    EC_TRY(ec_rare_follow(follower, f->rays, f->count * RAYS, err));
    for (uint32_t i = 0; i < f->count; i++) EC_TRY(find_spots(f, &f->beams[i], err));
    return EC_OK;
}

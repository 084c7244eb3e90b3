/* The rungs: what `eclat render` does by default, and that with one thing changed. First those that tell most, since a budget that
 * is too small ends the list early. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accel/accel.h"
#include "cost/cost.h"

enum { ROWS_MOST = 64, LAMPS_MOST = 6, DEPTH_CUT = 8 };

const double ec_cost_targets[EC_COST_TARGETS] = {0.05, 0.02, 0.01, 0.005};

typedef struct rung_list {
    const ec_scene *scene;
    const ec_render_options *base;
    ec_cost_row *rows;
    uint32_t count;
    const char *group, *title; /* of what is added next */
} rung_list;

__attribute__((format(printf, 3, 4))) static ec_cost_rung *add(rung_list *list, const char *id, const char *name, ...)
{
    ec_cost_rung *rung = &list->rows[list->count++].rung;
    va_list args;
    va_start(args, name);
    vsnprintf(rung->name, sizeof rung->name, name, args);
    va_end(args);
    snprintf(rung->id, sizeof rung->id, "%s", id);
    rung->group = list->group;
    rung->title = list->title;
    rung->options = *list->base;
    rung->unbiased = true;
    return rung;
}

static void begin(rung_list *list, const char *group, const char *title)
{
    list->group = group;
    list->title = title;
}

static void add_integrators(rung_list *list)
{
    begin(list, "integrator", "Integrator, instead of path");
    ec_cost_rung *raster = add(list, "raster", "raster"), *whitted = add(list, "whitted", "whitted");
    raster->options.integrator = EC_INTEGRATOR_RASTER;
    whitted->options.integrator = EC_INTEGRATOR_WHITTED;
    whitted->options.max_depth = EC_WHITTED_DEPTH;
    raster->unbiased = whitted->unbiased = false;
}

static void add_samplings(rung_list *list)
{
    begin(list, "sampling", "Sampling of directions, instead of mis");
    add(list, "sample-light", "light")->options.sample = EC_SAMPLE_LIGHT;
    add(list, "sample-bsdf", "bsdf")->options.sample = EC_SAMPLE_BSDF;
    add(list, "sample-hemisphere", "hemisphere")->options.sample = EC_SAMPLE_HEMISPHERE;
    begin(list, "sampler", "Random numbers, instead of sobol");
    add(list, "sampler-independent", "independent")->options.sampler = EC_SAMPLER_INDEPENDENT;
}

static void add_roulettes(rung_list *list)
{
    begin(list, "roulette", "Russian roulette, instead of auto");
    add(list, "rr-0.8", "0.8 from the first surface on")->options.survival = 0.8;
    add(list, "rr-0.5", "0.5 from the first surface on")->options.survival = 0.5;
    ec_cost_rung *off = add(list, "rr-off", "off, cut at %d segments", DEPTH_CUT);
    off->options.survival = 1;
    off->options.max_depth = DEPTH_CUT;
    off->unbiased = false;
}

static void add_arithmetic(rung_list *list)
{
    begin(list, "arithmetic", "Arithmetic, instead of exact");
    ec_cost_rung *fast = add(list, "fast-math", "fast-math build");
    fast->options.fast_math = true;
    fast->unbiased = false;
}

static ec_cost_rung *add_speed(rung_list *list, const char *option, const char *name)
{
    char id[48];
    snprintf(id, sizeof id, "%s-%s", option, name);
    ec_cost_rung *rung = add(list, id, "%s", name);
    rung->speed_only = true;
    return rung;
}

static void add_speeds(rung_list *list)
{
    static const char *const order[] = {"bvh8", "bvh2", "kdtree", "grid"};
    begin(list, "accelerator", "Accelerator, instead of auto");
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) add_speed(list, "accel", order[i])->options.accel = order[i];
    begin(list, "lanes", "Paths in a work-item, instead of auto");
    add_speed(list, "lanes", "1")->options.lanes = 1;
    add_speed(list, "lanes", "4")->options.lanes = 4;
    add_speed(list, "lanes", "8")->options.lanes = 8;
    add_speed(list, "lanes", "16")->options.lanes = 16;
}

static void add_effect(rung_list *list, ec_cost_effect effect, const char *id, const char *name)
{
    if (!ec_cost_has_effect(list->scene, effect)) return;
    ec_cost_rung *rung = add(list, id, "%s", name);
    rung->effect = effect;
    rung->unbiased = false;
    if (effect.kind == EC_EFFECT_INDIRECT) rung->options.max_depth = 2;
}

/* A light group is the environment, all lights without extent, or what shines with one material. */
static void add_lights(rung_list *list)
{
    uint32_t lamps = 0;
    begin(list, "lights", "The scene without the light of");
    add_effect(list, (ec_cost_effect){EC_EFFECT_ENVIRONMENT, 0}, "no-environment", "environment");
    add_effect(list, (ec_cost_effect){EC_EFFECT_PUNCTUAL, 0}, "no-punctual", "points, spots and suns");
    for (uint32_t m = 0; m < list->scene->material_count && lamps < LAMPS_MOST; m++) {
        char id[48], name[96];
        const char *called = list->scene->materials[m].name;
        snprintf(id, sizeof id, "no-lamps-%u", m);
        if (called && *called)
            snprintf(name, sizeof name, "lamps \"%.60s\"", called);
        else
            snprintf(name, sizeof name, "lamps of material %u", m);
        uint32_t before = list->count;
        add_effect(list, (ec_cost_effect){EC_EFFECT_LAMPS, m}, id, name);
        lamps += list->count - before;
    }
}

static void add_effects(rung_list *list)
{
    static const struct {
        ec_cost_effect_kind kind;
        const char *id, *name;
    } effects[] = {
        {EC_EFFECT_INDIRECT, "no-indirect", "indirect light"},
        {EC_EFFECT_GLOSS, "no-gloss", "gloss and metal"},
        {EC_EFFECT_TRANSMISSION, "no-transmission", "glass"},
        {EC_EFFECT_BASE_TEXTURES, "no-base-textures", "colour textures"},
        {EC_EFFECT_NORMAL_MAPS, "no-normal-maps", "normal maps"},
        {EC_EFFECT_OTHER_TEXTURES, "no-other-textures", "other textures"},
        {EC_EFFECT_ALPHA, "no-alpha", "alpha"},
        {EC_EFFECT_SMOOTH_NORMALS, "no-smooth-normals", "smooth normals"},
    };
    begin(list, "effect", "The scene without");
    for (size_t i = 0; i < sizeof effects / sizeof *effects; i++)
        add_effect(list, (ec_cost_effect){effects[i].kind, 0}, effects[i].id, effects[i].name);
}

ec_result ec_cost_list(const ec_scene *scene, const ec_render_options *base, ec_cost_row **rows, uint32_t *count, ec_error *err)
{
    rung_list list = {scene, base, calloc(ROWS_MOST, sizeof(ec_cost_row)), 0, NULL, NULL};
    *rows = list.rows;
    *count = 0;
    if (!list.rows) return ec_fail(err, "out of memory for the rungs of a study");
    begin(&list, "base", "As eclat render does it");
    add(&list, "path", "path, mis, sobol, rr auto, exact")->is_base = true;
    add_samplings(&list);
    add_integrators(&list);
    add_roulettes(&list);
    add_arithmetic(&list);
    add_effects(&list);
    add_speeds(&list);
    add_lights(&list);
    *count = list.count;
    return EC_OK;
}

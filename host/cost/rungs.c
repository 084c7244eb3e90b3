/* The rungs: the default of `eclat render`, and the default with one thing changed. The most informative come first, since a small budget ends the
 * list early. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accel/accel.h"
#include "base/text.h"
#include "cost/cost.h"
#include "denoise/denoise.h"
#include "pack/pack.h"

enum { ROWS_MOST = 96, LAMPS_MOST = 6, DEPTH_CUT = 8 };

const double ec_cost_targets[EC_COST_TARGETS] = {0.05, 0.02, 0.01, 0.005};

typedef struct rung_list {
    const ec_scene *scene;
    uint64_t called; /* effects that the scene calls for */
    bool is_rough;   /* there is metal or glass for which --scattering makes a difference */
    const ec_render_options *base;
    ec_cost_row *rows;
    uint32_t count;
    const char *group, *title; /* those of the rungs added next */
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
    ec_cost_rung *light = add(list, "light", "light");
    light->options.integrator = EC_INTEGRATOR_LIGHT;
    light->options.light_paths = EC_LIGHT_PATHS_ALONE;
    light->options.guiding = light->options.adaptive = false;
    light->options.clamp = 0;
    raster->unbiased = whitted->unbiased = light->unbiased = false;
}

static void add_samplings(rung_list *list)
{
    if (ec_scene_casts(list->scene)) {
        begin(list, "light-paths", "Paths from the lights, instead of none");
        ec_cost_rung *chosen = add(list, "light-paths-guiding", "what auto takes if it pays");
        chosen->options.light_paths = EC_LIGHT_PATHS_RARE;
        chosen->options.guiding = true;
        add(list, "light-paths", "--light-paths %g", EC_LIGHT_PATHS_RARE)->options.light_paths = EC_LIGHT_PATHS_RARE;
        add(list, "guiding", "--guiding")->options.guiding = true;
    }
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
    add(list, "rr-0.8", "0.8 at every surface")->options.survival = 0.8;
    add(list, "rr-0.5", "0.5 at every surface")->options.survival = 0.5;
    ec_cost_rung *off = add(list, "rr-off", "off, cut at %d segments", DEPTH_CUT);
    off->options.survival = 1;
    off->options.max_depth = DEPTH_CUT;
    off->unbiased = false;
}

/* Adds clamps, which remove fireflies at a price: their floor is the light that is missing. */
static void add_clamps(rung_list *list)
{
    static const double limits[] = {1, 10, 100};
    begin(list, "clamp", "Limit of a sample's indirect light, in mean luminances, instead of none");
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        char id[48];
        snprintf(id, sizeof id, "clamp-%g", limits[i]);
        ec_cost_rung *clamp = add(list, id, "%g", limits[i]);
        clamp->options.clamp = limits[i];
        clamp->unbiased = false;
    }
}

/* Adds multiple scattering, another model of surfaces and so another picture: the floor is the light that single scattering loses. */
static void add_scattering(rung_list *list)
{
    if (!list->is_rough) return;
    begin(list, "scattering", "Rough metal and glass, instead of scattering once");
    ec_cost_rung *again = add(list, "scattering-multiple", "multiple");
    again->options.scattering = EC_SCATTERING_MULTIPLE;
    again->unbiased = false;
}

/* Adds the denoiser. A library that is named but missing is reported by --denoise; the study goes on without it. */
static void add_denoiser(rung_list *list)
{
    ec_denoiser found;
    if (ec_denoiser_find(EC_DENOISER_AUTO, &found, NULL) != EC_OK) return;
    begin(list, "denoiser", "Denoised, instead of as it is");
    ec_cost_rung *best = add(list, "denoise", "best of both, --denoise");
    best->options.denoise = EC_DENOISER_AUTO;
    best->unbiased = false;
    best->fades = true;
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

/* Adds a rung without an effect. without: an effect of the scene; 0: of light transport. of: a material's index plus 1, or 0 for all. */
static ec_cost_rung *add_effect(rung_list *list, uint64_t without, uint32_t of, const char *id, const char *name)
{
    ec_cost_rung *rung = add(list, id, "%s", name);
    rung->is_effect = true;
    rung->options.without = without;
    rung->options.without_of = of;
    rung->unbiased = false;
    return rung;
}

/* Adds effects of the scene by name. */
static void add_called(rung_list *list, uint64_t which)
{
    for (uint32_t i = 0; i < ec_feature_count; i++) {
        char id[48];
        if (!(which & list->called & ec_effects_optional & ec_features[i].bit) || list->count == ROWS_MOST) continue;
        snprintf(id, sizeof id, "no-%s", ec_features[i].name);
        add_effect(list, ec_features[i].bit, 0, id, ec_features[i].name);
    }
}

static bool is_lamp(const ec_scene *scene, uint32_t material)
{
    const ec_material *m = &scene->materials[material];
    if (m->unlit || !ec_emits(m)) return false;
    for (uint32_t t = 0; t < scene->triangle_count; t++)
        if (scene->triangle_material[t] == material) return true;
    return false;
}

/* Adds groups of lights: the environment, all lights without extent, and each of the materials that emit. */
#define LIGHTS (EC_FEATURE_ENVIRONMENT | EC_FEATURE_PUNCTUAL_LIGHTS | EC_FEATURE_EMISSION)
static void add_lights(rung_list *list)
{
    uint32_t lamps = 0;
    begin(list, "lights", "The scene without the light of");
    add_called(list, LIGHTS & ~EC_FEATURE_EMISSION);
    for (uint32_t m = 0; m < list->scene->material_count && lamps < LAMPS_MOST; m++) {
        char id[48], name[96];
        const char *called = list->scene->materials[m].name;
        if (!is_lamp(list->scene, m)) continue;
        snprintf(id, sizeof id, "no-lamps-%u", m);
        if (called && *called)
            snprintf(name, sizeof name, "lamps \"%.*s\"", EC_CUT(called, 60));
        else
            snprintf(name, sizeof name, "lamps of material %u", m);
        add_effect(list, EC_FEATURE_EMISSION, m + 1, id, name);
        lamps++;
    }
}

static void add_effects(rung_list *list)
{
    begin(list, "effect", "The scene without");
    add_effect(list, 0, 0, "no-indirect", "indirect light")->options.max_depth = 2;
    add_called(list, ~(uint64_t)LIGHTS);
}

ec_result ec_cost_list(const ec_scene *scene, const ec_render_options *base, ec_cost_row **rows, uint32_t *count, ec_error *err)
{
    ec_effects effects, rough;
    EC_TRY(ec_scene_calls(scene, &effects, err));
    EC_TRY(ec_scene_rough(scene, &rough, err));
    rung_list list = {scene, effects.bits, rough.bits != 0, base, calloc(ROWS_MOST, sizeof(ec_cost_row)), 0, NULL, NULL};
    *rows = list.rows;
    *count = 0;
    if (!list.rows) return ec_fail(err, "out of memory for the rungs of a study");
    begin(&list, "base", "As eclat render does it");
    add(&list, "path", "path, mis, sobol, rr auto, exact")->is_base = true;
    add_denoiser(&list);
    add_samplings(&list);
    add_integrators(&list);
    add_roulettes(&list);
    add_scattering(&list);
    add_clamps(&list);
    add_arithmetic(&list);
    add_effects(&list);
    add_speeds(&list);
    add_lights(&list);
    *count = list.count;
    return EC_OK;
}

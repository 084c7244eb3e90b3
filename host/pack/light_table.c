/* Makes the table of everything that can be sampled as light. Half of the numbers go to lights at infinity, half to those in the scene, and within
 * each half they are divided by power (radiant flux, weighted by luminance); device/light_share.h says how many samples a half has. The order is that
 * of light_order.h. */
#include <math.h>
#include <string.h>

#include "base/freed.h"
#include "base/luminance.h"
#include "base/vec3.h"
#include "pack/coincident.h"
#include "pack/distribution.h"
#include "pack/lamp_parts.h"
#include "pack/light_order.h"
#include "pack/pack.h"
#include "pack/texture_mean.h"

#define PI 3.14159265358979323846

/* Computes a triangle's mean emission. Its own part of the texture decides how often it is sampled; a little of the whole texture's mean ensures that
 * what the sampled points miss is sampled too. */
static void textured_mean(const ec_scene *scene, const ec_texture_mean *whole, const ec_material *m, uint32_t prim, double mean[3])
{
    for (int k = 0; k < 3; k++) mean[k] = whole->rgb[k];
    if (m->textures[EC_SLOT_EMISSION].texture < 0) return;
    double own[3];
    ec_texture_triangle_mean(scene, &m->textures[EC_SLOT_EMISSION], prim, own);
    for (int k = 0; k < 3; k++) mean[k] = 0.98 * own[k] + 0.02 * whole->rgb[k];
}

typedef struct light_list {
    ec_light_data *lights;
    double *power;
    uint32_t *source; /* for ec_pack.light_source */
    uint32_t count;
} light_list;

/* Makes *l the light of triangle l->prim. Returns its power; 0 or less, or NaN, if it gives no light. */
static double fill_triangle(const ec_scene *scene, const ec_pack *pack, const ec_texture_mean *whole, ec_light_data *l)
{
    const uint32_t prim = l->prim;
    const ec_prim *p = &pack->prims[prim];
    const ec_material *m = &scene->materials[p->material];
    double mean[3];
    textured_mean(scene, &whole[p->material], m, prim, mean);
    double n[3];
    ec_triangle_normal(p->v0, p->v1, p->v2, n);
    double area = 0.5 * sqrt(ec_dot(n, n));
    double radiance[3] = {m->emission[0] * mean[0], m->emission[1] * mean[1], m->emission[2] * mean[2]};
    memset(l, 0, sizeof *l);
    memcpy(l->a, p->v0, sizeof l->a);
    memcpy(l->b, p->v1, sizeof l->b);
    memcpy(l->c, p->v2, sizeof l->c);
    memcpy(l->emission, m->emission, sizeof l->emission);
    l->kind = EC_KIND_TRIANGLE | (m->double_sided ? EC_LIGHT_TWO_SIDED : 0) |
              (m->textures[EC_SLOT_EMISSION].texture >= 0 ? EC_LIGHT_TEXTURED : 0) | (m->coat > 0.0f ? EC_LIGHT_COATED : 0) |
              (m->alpha_mode != EC_ALPHA_OPAQUE ? EC_LIGHT_OPEN : 0);
    l->prim = prim;
    l->pdf_a = (float)(1.0 / area); /* to be multiplied by pmf once that is known */
    return PI * area * ec_luminance(radiance) * (m->double_sided ? 2.0 : 1.0);
}

/* Cuts textured lamps into parts, except triangles that coincide, of which only one is sampled. */
static ec_result cut_lamps(const ec_scene *scene, ec_pack *pack, const bool *emits, const uint32_t *first, light_list *list, ec_error *err)
{
    EC_FREED bool *may_cut = malloc((pack->prim_count + (size_t)1) * sizeof *may_cut);
    if (!may_cut) return ec_fail(err, "out of memory for %u triangles", pack->prim_count);
    for (uint32_t p = 0; p < pack->prim_count; p++) may_cut[p] = true;
    for (uint32_t p = 0; p < pack->prim_count; p++)
        if (emits[pack->prims[p].material] && first[p] != p) may_cut[first[p]] = false;
    return ec_lamp_parts_find(scene, pack, list->lights, list->power, list->count, may_cut, err);
}

/* Adds each emissive triangle, coinciding ones once. whole: by material. */
static void add_triangles(const ec_scene *scene, const ec_pack *pack, const bool *emits, const uint32_t *first,
                          const ec_texture_mean *whole, light_list *list)
{
    uint32_t count = 0;
    for (uint32_t p = 0; p < pack->prim_count; p++)
        if (emits[pack->prims[p].material] && first[p] == p) list->lights[count++].prim = p;
#pragma omp parallel for schedule(dynamic, 64) if (count > 256)
    for (uint32_t i = 0; i < count; i++) list->power[i] = fill_triangle(scene, pack, whole, &list->lights[i]);
    for (uint32_t i = 0; i < count; i++) {
        if (!(list->power[i] > 0.0) || !isfinite(list->power[i])) continue;
        list->lights[list->count] = list->lights[i];
        list->power[list->count++] = list->power[i];
    }
}

double ec_pack_punctual_power(const ec_light *in, double scene_radius)
{
    double power = ec_luminance_of_floats(in->intensity);
    if (in->type == EC_LIGHT_POINT) power *= 4.0 * PI;
    if (in->type == EC_LIGHT_SPOT) power *= 2.0 * PI * (1.0 - 0.5 * (in->cos_inner + in->cos_outer));
    if (in->type == EC_LIGHT_DIRECTIONAL) power *= PI * scene_radius * scene_radius;
    return power > 0.0 && isfinite(power) ? power : 0.0;
}

static void add_punctual(const ec_light *in, uint32_t number, uint32_t moves, double scene_radius, light_list *list)
{
    double power = ec_pack_punctual_power(in, scene_radius);
    if (power == 0.0) return;
    ec_light_data *l = &list->lights[list->count];
    memset(l, 0, sizeof *l);
    memcpy(l->a, in->position, sizeof l->a);
    memcpy(l->b, in->direction, sizeof l->b);
    memcpy(l->emission, in->intensity, sizeof l->emission);
    /* KHR_lights_punctual, "Inner and Outer Cone Angles": scale = 1 / max(0.001, cos_inner - cos_outer). */
    l->c[0] = 1.0f / fmaxf(0.001f, in->cos_inner - in->cos_outer);
    l->c[1] = in->cos_outer;
    l->c[2] = in->range > 0.0f ? 1.0f / in->range : 0.0f;
    l->kind = in->type == EC_LIGHT_POINT ? EC_KIND_POINT : (in->type == EC_LIGHT_SPOT ? EC_KIND_SPOT : EC_KIND_DIRECTIONAL);
    l->prim = moves ? moves - 1 : EC_NO_ID;
    if (moves) l->kind |= EC_LIGHT_MOVES;
    list->source[list->count] = number;
    list->power[list->count++] = power;
}

/* Shares out the numbers. The power of a sky or sun grows with the scene's size and says nothing about a corner lit by a lamp: by power alone that
 * lamp would be chosen so seldom that its light becomes fireflies. Halving at most doubles the variance of the other side. */
static void share_out(const light_list *list, ec_pack *pack, double *pmf)
{
    const uint64_t half = (uint64_t)1 << 31;
    double sum[2] = {0.0, 0.0};
    uint32_t far = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        sum[ec_light_is_far(&list->lights[i])] += list->power[i];
        far += ec_light_is_far(&list->lights[i]);
    }
    pack->lamp_share = (float)(sum[0] > 0.0 ? sum[0] / (sum[0] + sum[1]) : 0.0);
    pack->lamp_power = sum[0];
    pack->lights_are_halved = sum[0] > 0.0 && sum[1] > 0.0;
    if (!pack->lights_are_halved) {
        ec_distribution_build(list->power, list->count, pack->light_shares, pmf);
        return;
    }
    ec_distribution_share(list->power, far, 0, half, pack->light_shares, pmf);
    ec_distribution_share(list->power + far, list->count - far, half, 2 * half, pack->light_shares + far, pmf + far);
    ec_distribution_guide(list->count, pack->light_shares);
}

static ec_result finish_table(ec_pack *pack, light_list *list, ec_error *err)
{
    EC_TRY(ec_light_order(list->lights, list->power, list->source, list->count, err));
    EC_FREED double *pmf = malloc((list->count + 1) * sizeof *pmf);
    pack->light_shares = malloc((list->count + 1) * sizeof *pack->light_shares);
    if (!pmf || !pack->light_shares) return ec_fail(err, "out of memory for %u lights", list->count);
    if (list->count) share_out(list, pack, pmf);
    for (uint32_t i = 0; i < list->count; i++) {
        ec_light_data *l = &list->lights[i];
        l->pmf = (float)pmf[i];
        l->pdf_a *= l->pmf;
        if (l->kind == EC_KIND_ENVIRONMENT) {
            pack->environment_pmf = l->pmf;
            pack->environment_stretch = ec_distribution_stretch((uint64_t)(pmf[i] * 0x1p32));
        }
        if ((l->kind & EC_LIGHT_KIND_MASK) == EC_KIND_TRIANGLE) pack->prims[l->prim].light_pdf_a = l->pdf_a;
    }
    pack->light_choices = list->count;
    return EC_OK;
}

/* Marks triangles that move: their area depends on the time, so their density leaves it out. */
static void mark_moving(const ec_scene *scene, ec_pack *pack, light_list *list)
{
    const uint32_t moving = scene->motion.segments ? scene->motion.triangle_count : 0;
    for (uint32_t i = 0; i < list->count; i++) {
        ec_light_data *l = &list->lights[i];
        if ((l->kind & EC_LIGHT_KIND_MASK) == EC_KIND_TRIANGLE && l->prim < moving) {
            l->kind |= EC_LIGHT_MOVES;
            l->pdf_a = pack->prims[l->prim].light_pdf_a = l->pmf;
        }
        pack->lamps_move |= (l->kind & EC_LIGHT_MOVES) && !ec_light_is_far(l);
    }
}

/* Records the light of each triangle. */
static ec_result note_prims(ec_pack *pack, const light_list *list, const bool *emits, const uint32_t *first, ec_error *err)
{
    pack->light_of_prim = malloc((pack->prim_count + 1) * sizeof *pack->light_of_prim);
    if (!pack->light_of_prim) return ec_fail(err, "out of memory for %u triangles", pack->prim_count);
    for (uint32_t p = 0; p < pack->prim_count; p++) pack->light_of_prim[p] = EC_NO_ID;
    for (uint32_t i = 0; i < list->count; i++)
        if ((list->lights[i].kind & EC_LIGHT_KIND_MASK) == EC_KIND_TRIANGLE) pack->light_of_prim[list->lights[i].prim] = i;
    for (uint32_t p = 0; p < pack->prim_count; p++)
        if (emits[pack->prims[p].material]) pack->light_of_prim[p] = pack->light_of_prim[first[p]];
    return EC_OK;
}

static ec_result fill_table(const ec_scene *scene, ec_pack *pack, const bool *emits, const ec_texture_mean *whole, double environment_luminance,
                            light_list *list, ec_error *err)
{
    EC_FREED uint32_t *first = NULL;
    EC_TRY(ec_coincident_find(scene, pack, emits, &first, err));
    add_triangles(scene, pack, emits, first, whole, list);
    EC_TRY(cut_lamps(scene, pack, emits, first, list, err));
    for (uint32_t i = 0; i < scene->light_count; i++)
        add_punctual(&scene->lights[i], i, scene->motion.segments ? scene->lights[i].moves : 0, pack->scene_radius, list);
    if (environment_luminance > 0.0) {
        double r = pack->scene_radius;
        list->lights[list->count] = (ec_light_data){.kind = EC_KIND_ENVIRONMENT, .prim = EC_NO_ID};
        list->power[list->count++] = 4.0 * PI * PI * r * r * environment_luminance;
    }
    EC_TRY(finish_table(pack, list, err));
    mark_moving(scene, pack, list);
    for (uint32_t p = 0; p < pack->prim_count; p++)
        if (emits[pack->prims[p].material]) pack->prims[p].light_pdf_a = pack->prims[first[p]].light_pdf_a;
    return note_prims(pack, list, emits, first, err);
}

static bool emits_light(const ec_material *m) { return ec_luminance_of_floats(m->emission) > 0.0 && !m->unlit; }

bool ec_scene_mixes_lights(const ec_scene *scene)
{
    bool far = scene->has_environment, lamps = false;
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const bool is_far = scene->lights[i].type == EC_LIGHT_DIRECTIONAL;
        far |= is_far;
        lamps |= !is_far;
    }
    for (uint32_t m = 0; m < scene->material_count; m++) lamps |= emits_light(&scene->materials[m]);
    return far && lamps;
}

ec_result ec_pack_lights(const ec_scene *scene, ec_pack *pack, ec_error *err)
{
    double environment_luminance;
    EC_TRY(ec_pack_environment(scene, pack, &environment_luminance, err));
    EC_FREED ec_texture_mean *mean = malloc(scene->material_count * sizeof *mean);
    EC_FREED bool *emits = calloc(scene->material_count, sizeof *emits);
    if (!mean || !emits) return ec_fail(err, "out of memory for %u materials", scene->material_count);
    for (uint32_t m = 0; m < scene->material_count; m++) {
        const ec_material *material = &scene->materials[m];
        emits[m] = emits_light(material);
        if (emits[m]) mean[m] = ec_texture_whole_mean(scene, &material->textures[EC_SLOT_EMISSION]);
    }
    uint32_t most = scene->light_count + 1;
    for (uint32_t p = 0; p < pack->prim_count; p++) most += emits[pack->prims[p].material];
    EC_FREED double *power = malloc(most * sizeof *power);
    light_list list = {pack->lights = malloc(most * sizeof *list.lights), power, pack->light_source = malloc(most * sizeof *list.source), 0};
    for (uint32_t i = 0; list.source && i < most; i++) list.source[i] = EC_NO_ID;
    if (!list.lights || !power || !list.source) return ec_fail(err, "out of memory for %u lights", most);
    ec_result result = fill_table(scene, pack, emits, mean, environment_luminance, &list, err);
    pack->light_count = list.count;
    return result;
}

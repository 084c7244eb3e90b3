#include "pack/casters.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/freed.h"
#include "base/luminance.h"
#include "pack/distribution.h"
#include "pack/light_order.h"
#include "scene/texture_range.h"

#define PI 3.14159265358979323846
#define SHARP_ROUGHNESS 0.4 /* camera paths meet wider lobes often enough */
#define LEAST_SHARE 0.02    /* least share of the light paths for each caster and light */
#define SCENE_SHARE 0.2f    /* share of light paths aimed at the scene as a whole, if that is asked for beside casters */
#define WORTH_SPLITTING 0.7 /* a cluster is split if the squared radii of its halves add up to less than this share of its own */

/* Panes do not bend light, nor do bodies of index 1. */
bool ec_material_bends(const ec_material *m) { return ec_refracts(m) && m->ior != 1.0f && m->transmission > 0.1f; }

static bool material_casts(const ec_scene *scene, const ec_material *m)
{
    float least, most;
    ec_texture_range(scene, &m->textures[EC_SLOT_METALLIC_ROUGHNESS], 1, &least, &most);
    if (m->unlit || m->roughness * least > SHARP_ROUGHNESS) return false;
    return ec_material_bends(m) || m->metallic > 0.5f;
}

bool *ec_scene_casters(const ec_scene *scene)
{
    bool *casts = calloc(scene->material_count + (size_t)1, sizeof *casts), any = false;
    for (uint32_t m = 0; m < scene->material_count; m++) any |= material_casts(scene, &scene->materials[m]);
    if (!casts || !any) return casts;
    for (uint32_t t = 0; t < scene->triangle_count; t++) casts[scene->triangle_material[t]] = true;
    for (uint32_t m = 0; m < scene->material_count; m++) casts[m] = casts[m] && material_casts(scene, &scene->materials[m]);
    return casts;
}

bool ec_scene_casts(const ec_scene *scene)
{
    EC_FREED bool *casts = ec_scene_casters(scene);
    return casts && memchr(casts, true, scene->material_count);
}

typedef struct box {
    float low[3], high[3];
} box;

typedef struct boxes {
    box *list;
    size_t count;
} boxes;

static void add_point(box *b, const float p[3])
{
    for (int k = 0; k < 3; k++) b->low[k] = fminf(b->low[k], p[k]), b->high[k] = fmaxf(b->high[k], p[k]);
}

static const box no_box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

/* Adds the box of triangle t, at a place or (NULL) as it is; only counts it if there is no list. */
static void add_triangle(const ec_scene *s, uint32_t t, const ec_placed *placed, boxes *all)
{
    const size_t at = all->count++;
    if (!all->list) return;
    box *b = &all->list[at];
    *b = no_box;
    for (int v = 0; v < 3; v++) {
        const float *corner = s->positions + 3 * (size_t)s->indices[3 * (size_t)t + v];
        float p[3];
        if (placed) ec_placed_point(placed, corner, p);
        add_point(b, placed ? p : corner);
    }
}

/* Adds the triangles that cast; those of a mesh kept once at each of its places. */
static void add_casting(const ec_scene *s, const bool *casts, boxes *all)
{
    for (uint32_t t = 0; t < ec_scene_flat_count(s); t++)
        if (casts[s->triangle_material[t]]) add_triangle(s, t, NULL, all);
    for (uint32_t i = 0; i < s->placed_count; i++) {
        const ec_shape *shape = &s->shapes[s->placed[i].shape];
        for (uint32_t t = shape->first; t < shape->first + shape->count; t++)
            if (casts[s->triangle_material[t]]) add_triangle(s, t, &s->placed[i], all);
    }
}

static ec_result find_boxes(const ec_scene *s, boxes *all, ec_error *err)
{
    EC_FREED bool *casts = ec_scene_casters(s);
    if (!casts) return ec_fail(err, "out of memory for %u materials", s->material_count);
    add_casting(s, casts, all);
    all->list = malloc((all->count + 1) * sizeof *all->list);
    if (!all->list) return ec_fail(err, "out of memory for %zu triangles", all->count);
    all->count = 0;
    add_casting(s, casts, all);
    return EC_OK;
}

typedef struct cluster {
    size_t first, end; /* range of boxes */
    bool is_whole;     /* not worth splitting */
    ec_caster sphere;
} cluster;

static box box_about(const box *list, size_t first, size_t end)
{
    box all = no_box;
    for (size_t i = first; i < end; i++) add_point(&all, list[i].low), add_point(&all, list[i].high);
    return all;
}

static ec_caster sphere_about(const box *list, size_t first, size_t end)
{
    const box all = box_about(list, first, end);
    double r2 = 0;
    ec_caster c = {.share = 0};
    for (int k = 0; k < 3; k++) c.centre[k] = 0.5f * (all.low[k] + all.high[k]);
    for (size_t i = first; i < end; i++) {
        double d2 = 0;
        for (int k = 0; k < 3; k++) {
            const double far = fmax(c.centre[k] - (double)list[i].low[k], list[i].high[k] - (double)c.centre[k]);
            d2 += far * far;
        }
        r2 = fmax(r2, d2);
    }
    c.radius = (float)(sqrt(r2) * 1.0001);
    return c;
}

/* Splits a cluster in the middle of its longest axis, into *a and *b. Returns false if that is not worth it. */
static bool split(box *list, const cluster *c, cluster *a, cluster *b)
{
    const box all = box_about(list, c->first, c->end);
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (all.high[k] - all.low[k] > all.high[axis] - all.low[axis]) axis = k;
    const float middle = all.low[axis] + all.high[axis];
    size_t at = c->first;
    for (size_t i = c->first; i < c->end; i++) {
        if (list[i].low[axis] + list[i].high[axis] >= middle) continue;
        const box one = list[i];
        list[i] = list[at];
        list[at++] = one;
    }
    if (at == c->first || at == c->end) return false;
    *a = (cluster){.first = c->first, .end = at, .sphere = sphere_about(list, c->first, at)};
    *b = (cluster){.first = at, .end = c->end, .sphere = sphere_about(list, at, c->end)};
    const double r = c->sphere.radius, ra = a->sphere.radius, rb = b->sphere.radius;
    return ra * ra + rb * rb < WORTH_SPLITTING * r * r;
}

/* Splits the largest clusters first, as long as there is room. */
static uint32_t make_clusters(boxes *all, uint32_t most, cluster *clusters)
{
    uint32_t count = 0;
    if (all->count) clusters[count++] = (cluster){.end = all->count, .sphere = sphere_about(all->list, 0, all->count)};
    while (count && count < most) {
        uint32_t largest = count;
        for (uint32_t i = 0; i < count; i++)
            if (!clusters[i].is_whole && (largest == count || clusters[i].sphere.radius > clusters[largest].sphere.radius)) largest = i;
        if (largest == count) break;
        cluster a, b;
        clusters[largest].is_whole = !split(all->list, &clusters[largest], &a, &b);
        if (clusters[largest].is_whole) continue;
        clusters[largest] = a;
        clusters[count++] = b;
    }
    return count;
}

/* Estimates the flux that a light sends to a sphere, in W of luminance; power: of a lamp of pmf 1. */
static double flux(const ec_pack *pack, const ec_light_data *l, double power, const ec_caster *c)
{
    const uint32_t kind = l->kind & EC_LIGHT_KIND_MASK;
    const double r2 = (double)c->radius * c->radius;
    double d2 = 0;
    if (kind == EC_KIND_ENVIRONMENT) return 4 * PI * PI * r2 * ec_luminance_of_floats(pack->environment_mean);
    if (kind == EC_KIND_DIRECTIONAL) return PI * r2 * ec_luminance_of_floats(l->emission);
    for (int k = 0; k < 3; k++) {
        const double q = kind == EC_KIND_TRIANGLE ? (l->a[k] + (double)l->b[k] + l->c[k]) / 3 : l->a[k], d = q - c->centre[k];
        d2 += d * d;
    }
    return power * l->pmf * fmin(0.5, r2 / (d2 > 0 ? d2 : r2));
}

static ec_result fill_emission(ec_pack *pack, double *weights, ec_error *err)
{
    const uint32_t n = pack->light_count;
    pack->emission_words = ec_emission_prims(n) + pack->prim_count;
    pack->emission = calloc(pack->emission_words + 1, sizeof *pack->emission);
    if (!pack->emission) return ec_fail(err, "out of memory for %u lights", n);
    ec_distribution_build(weights, n, (ec_distribution_entry *)pack->emission, weights);
    for (uint32_t i = 0; i < n; i++) {
        const float pmf = (float)weights[i];
        memcpy(pack->emission + 2 * (size_t)n + i, &pmf, sizeof pmf);
    }
    memcpy(pack->emission + ec_emission_prims(n), pack->light_of_prim, pack->prim_count * sizeof *pack->emission);
    return EC_OK;
}

/* Finds up to `most` spheres around what casts. */
static ec_result find_clusters(const ec_scene *scene, uint32_t most, cluster *clusters, uint32_t *count, ec_error *err)
{
    boxes all = {.count = 0};
    const ec_result result = find_boxes(scene, &all, err);
    if (result == EC_OK) *count = make_clusters(&all, most, clusters);
    free(all.list);
    return result;
}

/* Returns the power of a lamp of pmf 1, in W of luminance. */
static double power_of_lamps(const ec_pack *pack)
{
    double pmf = 0;
    for (uint32_t i = 0; i < pack->light_count; i++) pmf += ec_light_is_far(&pack->lights[i]) ? 0 : pack->lights[i].pmf;
    return pmf > 0 ? pack->lamp_power / pmf : 0;
}

/* Sets each sphere's share to the flux that lights send there, in W, and adds it to the weights of the lights. Returns the sum. */
static double add_fluxes(const ec_pack *pack, cluster *clusters, uint32_t count, double *weights)
{
    const double power = power_of_lamps(pack);
    double sum = 0;
    for (uint32_t j = 0; j < count; j++) {
        double own = 0;
        for (uint32_t i = 0; i < pack->light_count; i++) {
            const double w = flux(pack, &pack->lights[i], power, &clusters[j].sphere);
            weights[i] += w;
            own += w;
        }
        clusters[j].sphere.share = (float)own;
        sum += own;
    }
    return sum;
}

ec_result ec_pack_caster_flux(ec_pack *pack, ec_error *err)
{
    cluster clusters[EC_CASTERS_MOST];
    uint32_t count = 0;
    pack->caster_flux = 0;
    if (!pack->light_count) return EC_OK;
    EC_TRY(find_clusters(&pack->plain.scene, EC_CASTERS_MOST, clusters, &count, err));
    EC_FREED double *weights = calloc(pack->light_count, sizeof *weights);
    if (!weights) return ec_fail(err, "out of memory for %u lights", pack->light_count);
    pack->caster_flux = add_fluxes(pack, clusters, count, weights);
    return EC_OK;
}

ec_result ec_pack_casters(ec_pack *pack, ec_aim aim, ec_error *err)
{
    const uint32_t n = pack->light_count;
    const bool with_scene = aim == EC_AIM_CASTERS_AND_SCENE;
    const ec_caster scene = {.radius = pack->scene_radius, .share = with_scene ? SCENE_SHARE : 0};
    cluster clusters[EC_CASTERS_MOST] = {{.sphere = scene}};
    uint32_t count = 1;
    if (!n) return EC_OK;
    if (aim != EC_AIM_SCENE) EC_TRY(find_clusters(&pack->plain.scene, EC_CASTERS_MOST - with_scene, clusters, &count, err));
    EC_FREED double *weights = calloc(n, sizeof *weights);
    if (!weights) return ec_fail(err, "out of memory for %u lights", n);
    const double power = power_of_lamps(pack), sum = add_fluxes(pack, clusters, count, weights);
    double shares = 0, emitted = 0;
    if (!(sum > 0) || !isfinite(sum)) return EC_OK;
    for (uint32_t j = 0; j < count; j++) {
        pack->casters[j] = clusters[j].sphere;
        pack->casters[j].share = (float)(clusters[j].sphere.share / sum + LEAST_SHARE);
        shares += pack->casters[j].share;
    }
    for (uint32_t j = 0; j < count; j++) pack->casters[j].share *= (float)((1 - scene.share) / shares);
    if (with_scene) pack->casters[count++] = scene;
    for (uint32_t i = 0; i < n; i++)
        emitted += ec_light_is_far(&pack->lights[i]) ? flux(pack, &pack->lights[i], power, &scene) : power * pack->lights[i].pmf;
    pack->caster_count = count;
    pack->mean_radiance = emitted / (4 * PI * PI * pack->scene_radius * pack->scene_radius);
    return fill_emission(pack, weights, err);
}

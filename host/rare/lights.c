#include "rare/lights.h"
#include "rare/edges.h"
#include "rare/sources.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "film/film.h"
#include "pack/light_order.h"

#define PI 3.14159265358979323846
#define OCTAVES 24          /* of luminance below the map's brightest, each a light of its own */
#define SMALL (4 * PI / 50) /* steradians: whatever is larger is met soon */
#define SHARP_ROUGHNESS 0.2f /* lobes of more are wider than EC_CHAIN_SHARP */
#define GATHERED 0.9        /* length of the mean direction from which on a part lies in one place */

static double luminance(const float rgb[3]) { return ec_luminance((double[3]){rgb[0], rgb[1], rgb[2]}); }

/* An octave of a map's luminance, in one of the eight octants of directions: two suns are two lights. */
enum { OCTANTS = 8 };
typedef struct octave {
    double solid_angle, light, direction[3];
} octave;

static float brightest(const ec_pack *pack)
{
    float most = 0;
    const size_t texels = (size_t)pack->environment_width * (pack->environment_height + 1);
    for (size_t i = 0; i < texels; i++) {
        const float bright = (float)luminance(pack->environment_texels + 4 * i);
        if (bright > most) most = bright;
    }
    return most;
}

/* Returns what ilogb says of a double that is not denormal, as none from a float is; it is called for half a million texels. */
static int octave_of(double bright)
{
    uint64_t bits;
    memcpy(&bits, &bright, sizeof bits);
    return (int)(bits >> 52) - 1023;
}

/* columns: cosine and sine of each column's angle. */
static void sort_into_octaves(const ec_pack *pack, float most, const double *columns, octave *octaves)
{
    const uint32_t width = pack->environment_width, height = pack->environment_height;
    const int first = octave_of(most);
    for (uint32_t y = 0; y < height; y++) {
        const double theta = PI * (y + 0.5) / height, sine = sin(theta), cosine = cos(theta), solid = 2 * PI * PI / width / height * sine;
        const float *row = pack->environment_texels + 4 * (size_t)width * (y + 1);
        for (uint32_t x = 0; x < width; x++) {
            const double bright = luminance(row + 4 * (size_t)x);
            const int k = bright > 0 ? first - octave_of(bright) : OCTAVES;
            if (k >= OCTAVES) continue;
            const double direction[3] = {sine * columns[2 * (size_t)x], cosine, sine * columns[2 * (size_t)x + 1]};
            octave *o = &octaves[k * OCTANTS + (direction[0] < 0) + 2 * (direction[1] < 0) + 4 * (direction[2] < 0)];
            o->solid_angle += solid;
            o->light += bright * solid;
            for (int c = 0; c < 3; c++) o->direction[c] += direction[c] * solid;
        }
    }
}

static void light_of(const octave *o, const ec_rare_lights *all, ec_rare_light *light)
{
    const double length = sqrt(o->direction[0] * o->direction[0] + o->direction[1] * o->direction[1] + o->direction[2] * o->direction[2]);
    *light = (ec_rare_light){.material = UINT32_MAX, .radiance = o->light / o->solid_angle, .solid_angle = o->solid_angle,
                             .power = o->light * PI * all->radius * all->radius};
    snprintf(light->name, sizeof light->name, "the environment's brightest spot");
    for (int c = 0; c < 3 && length > GATHERED * o->solid_angle; c++) light->direction[c] = (float)(o->direction[c] / length);
}

/* Adds the brightest octaves of the map that are small, up to half of the lights, as the other half is the lamps'; all but the suns are sky. */
static ec_result find_on_map(const ec_pack *pack, ec_rare_lights *all, ec_error *err)
{
    octave octaves[OCTAVES * OCTANTS] = {0};
    const uint32_t width = pack->environment_width;
    const float most = brightest(pack);
    double sky[OCTANTS] = {0};
    if (!(most > 0)) return EC_OK;
    double *columns = malloc(2 * sizeof *columns * width);
    if (!columns) return ec_fail(err, "out of memory for an environment map %u texels wide", width);
    for (uint32_t x = 0; x < width; x++) {
        const double phi = 2 * PI * ((x + 0.5) / width - 0.5);
        columns[2 * (size_t)x] = cos(phi);
        columns[2 * (size_t)x + 1] = sin(phi);
    }
    sort_into_octaves(pack, most, columns, octaves);
    free(columns);
    for (int k = 0; k < OCTAVES * OCTANTS; k++) {
        ec_rare_light light;
        if (!(octaves[k].solid_angle > 0)) continue;
        light_of(&octaves[k], all, &light);
        if (!ec_rare_light_is_sun(&light)) sky[k % OCTANTS] += octaves[k].light / (4 * PI / OCTANTS);
        if (light.solid_angle < SMALL && all->count < EC_RARE_LIGHTS / 2) all->lights[all->count++] = light;
    }
    ec_rare_sky_find(sky, all);
    return EC_OK;
}

static ec_result find_in_environment(const ec_pack *pack, ec_rare_lights *all, ec_error *err)
{
    double sky[OCTANTS];
    if (!pack->plain.scene.has_environment) return EC_OK;
    if (pack->environment_texels) return find_on_map(pack, all, err);
    for (int k = 0; k < OCTANTS; k++) sky[k] = luminance(pack->environment_mean);
    ec_rare_sky_find(sky, all);
    return EC_OK;
}

static void lamp_of(const ec_light_data *l, ec_rare_lamp *lamp)
{
    double e[3], f[3];
    for (int c = 0; c < 3; c++) {
        e[c] = (double)l->b[c] - l->a[c], f[c] = (double)l->c[c] - l->a[c];
        lamp->middle[c] = (l->a[c] + l->b[c] + l->c[c]) / 3;
    }
    const double n[3] = {e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
    const double twice = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int c = 0; c < 3; c++) lamp->normal[c] = (float)(n[c] / fmax(twice, 1e-300));
    for (int c = 0; c < 3; c++) lamp->corner[c] = l->a[c], lamp->edges[0][c] = (float)e[c], lamp->edges[1][c] = (float)f[c];
    lamp->prim = l->prim;
    lamp->area = (float)(twice / 2);
    lamp->two_sided = l->kind & EC_LIGHT_TWO_SIDED;
}

/* A lamp, or a part of one whose texture varies, of even radiance. */
typedef struct piece {
    ec_rare_lamp lamp;
    uint32_t material;
    double radiance, power;
} piece;

/* Pieces of one material and octave of radiance, from that of the material's factor down. */
enum { LAMP_OCTAVES = 12 };
typedef struct lamp_group {
    uint32_t count, seen, stride;
    double power, area;   /* area: of all that shines, twice where two-sided */
    ec_rare_light *light; /* NULL: not kept */
} lamp_group;

typedef void take_piece(const piece *piece, lamp_group *group);

static void give_piece(const piece *p, const ec_light_data *l, lamp_group *groups, take_piece *take)
{
    const int octave = ilogb(luminance(l->emission)) - ilogb(p->radiance);
    if (p->radiance > 0) take(p, &groups[p->material * LAMP_OCTAVES + (uint32_t)(octave < 0 ? 0 : octave < LAMP_OCTAVES ? octave : LAMP_OCTAVES - 1)]);
}

/* Gives the leaves of what lib/lamp_parts.h descends in: numbers from `first` to `end` choose this node, whose edges are `size` of the lamp's. */
static void give_parts(const ec_pack *pack, const ec_light_data *l, uint32_t node, const piece *whole, const double b[2], double size, uint32_t first,
                       uint32_t end, lamp_group *groups, take_piece *take)
{
    const ec_lamp_node *n = &pack->lamp_nodes[node];
    uint32_t next = n->link >> 4;
    for (uint32_t child = 0; child < 4; child++) {
        const uint32_t from = child ? n->first[child - 1] : first, to = child < 3 ? n->first[child] : end;
        const double half = size / 2, own = child == 3 ? -half : half, at[2] = {b[0] + (child & 1 ? half : 0), b[1] + (child & 2 ? half : 0)};
        if (n->link >> child & 1) {
            give_parts(pack, l, next++, whole, at, own, from, to, groups, take);
            continue;
        }
        piece part = *whole;
        for (int c = 0; c < 3; c++) {
            const float e = whole->lamp.edges[0][c], f = whole->lamp.edges[1][c];
            part.lamp.corner[c] += (float)(at[0] * e + at[1] * f);
            part.lamp.edges[0][c] = (float)(own * e), part.lamp.edges[1][c] = (float)(own * f);
            part.lamp.middle[c] = part.lamp.corner[c] + (part.lamp.edges[0][c] + part.lamp.edges[1][c]) / 3;
        }
        part.lamp.area *= (float)(own * own);
        part.power *= (double)(to - from) / EC_LAMP_PARTS_NUMBERS;
        part.radiance *= (double)(to - from) / EC_LAMP_PARTS_NUMBERS / (own * own);
        give_piece(&part, l, groups, take);
    }
}

static void give_all(const ec_pack *pack, const ec_rare_lights *all, lamp_group *groups, take_piece *take)
{
    double shares = 0;
    for (uint32_t i = 0; i < pack->light_count; i++) shares += ec_light_is_far(&pack->lights[i]) ? 0 : pack->lights[i].pmf;
    for (uint32_t i = 0; i < pack->light_count; i++) {
        const ec_light_data *l = &pack->lights[i];
        if ((l->kind & EC_LIGHT_KIND_MASK) != EC_KIND_TRIANGLE || l->prim >= all->stored_count) continue;
        piece whole = {.material = all->triangle_material[l->prim], .power = pack->lamp_power * l->pmf / shares};
        lamp_of(l, &whole.lamp);
        whole.radiance = whole.power / fmax(PI * whole.lamp.area * (whole.lamp.two_sided ? 2 : 1), 1e-300);
        if (l->kind >> EC_LIGHT_PARTS) give_parts(pack, l, l->kind >> EC_LIGHT_PARTS, &whole, (double[2]){0, 0}, 1, 0, EC_LAMP_PARTS_NUMBERS, groups, take);
        else give_piece(&whole, l, groups, take);
    }
}

static void count_piece(const piece *p, lamp_group *group)
{
    group->count++;
    group->power += p->power;
    group->area += p->lamp.area * (p->lamp.two_sided ? 2 : 1);
}

/* Keeps some of a group's pieces, evenly spaced. */
static void keep_piece(const piece *p, lamp_group *group)
{
    if (!group->light || group->seen++ % group->stride) return;
    ec_rare_lamp *lamp = &group->light->lamps[group->light->lamp_count++];
    *lamp = p->lamp;
    lamp->weight = (float)group->count / (float)((group->count + group->stride - 1) / group->stride);
}

static void add_group(lamp_group *group, uint32_t material, ec_rare_lights *all)
{
    group->light = &all->lights[all->count++];
    *group->light = (ec_rare_light){.material = material, .power = group->power, .radiance = group->power / (PI * group->area)};
    snprintf(group->light->name, sizeof group->light->name, "\"%.*s\"", EC_CUT(all->materials[material], EC_RARE_NAME - 3));
    all->power += group->power;
}

/* Adds the groups with the most power, as far as there is room. */
static ec_result find_lamps(const ec_pack *pack, ec_rare_lights *all, ec_error *err)
{
    const uint32_t count = all->material_count * LAMP_OCTAVES, before = all->count;
    lamp_group *groups = calloc(count + (size_t)1, sizeof *groups);
    if (!groups) return ec_fail(err, "out of memory for %u materials", all->material_count);
    give_all(pack, all, groups, count_piece);
    while (all->count < EC_RARE_LIGHTS) {
        uint32_t best = count; /* of no power */
        for (uint32_t g = 0; g < count; g++)
            if (!groups[g].light && groups[g].power > groups[best].power) best = g;
        if (best == count) break;
        add_group(&groups[best], best / LAMP_OCTAVES, all);
    }
    uint32_t most = all->count > before ? EC_RARE_LAMPS_IN_ALL / (all->count - before) : 0;
    most = most < EC_RARE_LAMPS ? most : EC_RARE_LAMPS;
    for (uint32_t g = 0; g < count; g++) groups[g].stride = groups[g].light ? (groups[g].count + most - 1) / most : 1;
    give_all(pack, all, groups, keep_piece);
    free(groups);
    return EC_OK;
}

static void *copy_of(const void *data, size_t bytes)
{
    void *copy = malloc(bytes + 1);
    if (copy && bytes) memcpy(copy, data, bytes);
    return copy;
}

/* Returns the share of head-on light that a material sends on in a narrow lobe. Takes its roughness factor alone: where a texture changes that, paths
 * that get there tell. */
static float sharp_share(const ec_material_data *m)
{
    const double f0 = luminance(m->f0), base = luminance(m->base_color);
    double share = 0;
    if (m->roughness < SHARP_ROUGHNESS) share = m->metallic * base + (1 - m->metallic) * (f0 + (1 - f0) * m->transmission * base);
    if (m->coat_roughness < SHARP_ROUGHNESS) share = fmax(share, 0.04 * m->coat);
    return (float)share;
}

/* Returns the power of all lights but triangles. */
static double power_of_others(const ec_pack *pack)
{
    const ec_scene *scene = &pack->plain.scene;
    const double disk = PI * pack->scene_radius * pack->scene_radius;
    double power = scene->has_environment ? 4 * PI * disk * luminance(pack->environment_mean) : 0;
    for (uint32_t i = 0; i < scene->light_count; i++) power += ec_pack_punctual_power(&scene->lights[i], pack->scene_radius);
    return power;
}

static float straight_share(const ec_material *m) { return (float)((1 - m->metallic) * m->transmission * luminance(m->base_color)); }

/* Copies the materials of the scene's triangles, without its lights. */
static ec_result copy_materials(const ec_scene *scene, ec_rare_lights *all, ec_error *err)
{
    all->stored_count = scene->triangle_count;
    all->material_count = scene->material_count;
    all->placed_count = scene->placed_count;
    all->triangle_material = copy_of(scene->triangle_material, 4ull * scene->triangle_count);
    all->materials = calloc(scene->material_count + (size_t)1, sizeof *all->materials);
    all->shapes = copy_of(scene->shapes, scene->shape_count * sizeof *scene->shapes);
    all->placed = copy_of(scene->placed, scene->placed_count * sizeof *scene->placed);
    all->lights = calloc(EC_RARE_LIGHTS, sizeof *all->lights);
    all->sharp = calloc(scene->material_count + (size_t)1, sizeof *all->sharp);
    all->straight = calloc(scene->material_count + (size_t)1, sizeof *all->straight);
    all->casts = ec_scene_casters(scene);
    if (!all->triangle_material || !all->materials || !all->shapes || !all->placed || !all->lights || !all->sharp || !all->straight ||
        !all->casts)
        return ec_fail(err, "out of memory for the materials of %u triangles", scene->triangle_count);
    for (uint32_t m = 0; m < scene->material_count; m++) {
        const char *name = scene->materials[m].name;
        if (name && *name) snprintf(all->materials[m], EC_RARE_NAME, "%.*s", EC_CUT(name, EC_RARE_NAME - 1));
        else snprintf(all->materials[m], EC_RARE_NAME, "material %u", m);
        all->straight[m] = ec_pack_is_pane(scene, &scene->materials[m]) ? straight_share(&scene->materials[m]) : 0;
    }
    return EC_OK;
}

ec_result ec_rare_lights_find(const ec_pack *pack, ec_rare_lights *all, ec_error *err)
{
    *all = (ec_rare_lights){0};
    ec_result result = copy_materials(&pack->plain.scene, all, err);
    all->radius = pack->scene_radius;
    all->power = power_of_others(pack);
    all->flux = pack->caster_flux;
    for (uint32_t m = 0; result == EC_OK && m < all->material_count && m < pack->material_count; m++) all->sharp[m] = sharp_share(&pack->materials[m]);
    if (result == EC_OK) result = find_in_environment(pack, all, err);
    if (result == EC_OK) result = find_lamps(pack, all, err);
    if (result == EC_OK) ec_rare_sources_find(&pack->plain.scene, all);
    if (result == EC_OK && (all->source_count || (all->count && all->sky_count))) result = ec_rare_edges_find(pack, all, err);
    if (result != EC_OK || (!all->count && !all->source_count)) ec_rare_lights_free(all);
    return result;
}

void ec_rare_lights_free(ec_rare_lights *all)
{
    free(all->lights);
    free(all->sharp);
    free(all->straight);
    free(all->casts);
    free(all->triangle_material);
    free(all->materials);
    free(all->shapes);
    free(all->placed);
    free(all->edges);
    *all = (ec_rare_lights){0};
}

/* Finds what moves while the shutter is open. The document is posed at more and more moments in between, until straight lines from key to key are
 * close enough to the true motion. A vertex is identified by the placement, primitive and number it comes from, so that moving nodes, skins and morph
 * targets share one path: only positions of vertices count. */
#include "gltf/motion.h"
#include "gltf/thicken.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Returns the first step: four moments for each interval between keyframes within the shutter, in which a rotation turns by at most half a turn.
 * Counts are powers of two, so that keys of all counts are among the moments. */
static uint32_t first_step(const ec_gltf *g)
{
    uint32_t count = 4;
    while (count < EC_MOMENTS && count < 4 * (g->shutter_keys + 1)) count *= 2;
    return EC_MOMENTS / count;
}

static double seconds_of(const ec_tracks *t, uint32_t moment)
{
    if (moment == EC_MOMENTS) return t->choice->closes;
    return t->choice->opens + (t->choice->closes - t->choice->opens) * ((double)moment / EC_MOMENTS);
}

static void read_vertex(const ec_draw *d, uint32_t vertex, const ec_tracks *t, float *out)
{
    double world[3];
    float tangent[4] = {0};
    memset(out, 0, t->words * sizeof *out);
    ec_draw_world_position(d, vertex, world);
    for (int k = 0; k < 3; k++) out[k] = (float)(world[k] - d->center[k]);
    ec_draw_frame(d, vertex, t->normals ? out + t->normals : NULL, t->tangents ? tangent : NULL);
    if (t->tangents) memcpy(out + t->tangents, tangent, 3 * sizeof *out);
}

static ec_result read_vertices(ec_tracks *t, const ec_gltf *g, const ec_placement_list *placements, float *values, ec_error *err)
{
    ec_draw d = {.g = NULL};
    uint32_t placement = EC_STILL;
    for (uint32_t i = 0; i < t->count; i++) {
        const ec_source *from = &t->base->sources[t->vertex[i]];
        if (from->placement != placement) {
            placement = from->placement;
            int32_t mesh = placement < placements->count ? placements->items[placement].mesh : -1;
            if (mesh < 0) return ec_fail(err, "%s: a mesh is missing for part of the time while the shutter is open", g->path);
            d = ec_draw_of(g, &placements->items[placement], t->scene->center);
        }
        d.p = &g->meshes[d.at->mesh].primitives[from->primitive];
        read_vertex(&d, from->vertex, t, values + (size_t)i * t->words);
    }
    return EC_OK;
}

static ec_result read_views(ec_tracks *t, ec_gltf *g, const ec_placement_list *placements, uint32_t moment, ec_error *err)
{
    ec_scene shown = {.bounds_min = {0}};
    memcpy(shown.center, t->scene->center, sizeof shown.center);
    memcpy(shown.bounds_min, t->scene->bounds_min, sizeof shown.bounds_min);
    memcpy(shown.bounds_max, t->scene->bounds_max, sizeof shown.bounds_max);
    ec_result result = ec_gltf_cameras_place(g, placements, &shown, NULL, err);
    if (result == EC_OK) result = ec_gltf_lights_place(g, placements, &shown, NULL, err);
    if (result == EC_OK && (shown.camera_count != t->scene->camera_count || shown.light_count != t->scene->light_count))
        result = ec_fail(err, "%s: a camera or a light stands at infinity at %g s, within the shutter", g->path,
                         seconds_of(t, moment));
    for (uint32_t i = 0; i < shown.camera_count; i++) free(shown.cameras[i].name), shown.cameras[i].name = NULL;
    for (uint32_t i = 0; i < shown.light_count; i++) free(shown.lights[i].name), shown.lights[i].name = NULL;
    t->cameras[moment] = shown.cameras;
    t->lights[moment] = shown.lights;
    return result;
}

static ec_result read_placed(ec_tracks *t, ec_gltf *g, ec_placement_list *placements, uint32_t moment, ec_error *err)
{
    ec_scene counted = {0};
    EC_TRY(ec_gltf_place_nodes(g, placements, err));
    EC_TRY(ec_gltf_place_instances(g, placements, NULL, err));
    EC_TRY(ec_flatten_prepare(g, placements, &counted, NULL, err));
    EC_TRY(ec_gltf_deform(g, placements, err));
    EC_TRY(ec_gltf_thicken(g, placements, true, err));
    t->values[moment] = malloc(((size_t)t->count * t->words + 1) * sizeof(float));
    if (!t->values[moment]) return ec_fail(err, "%s: out of memory for %u moving vertices", g->path, t->count);
    EC_TRY(read_vertices(t, g, placements, t->values[moment], err));
    return read_views(t, g, placements, moment, err);
}

static ec_result read_moment(ec_tracks *t, uint32_t moment, ec_error *err)
{
    ec_scene_choice choice = *t->choice;
    ec_gltf *g = t->base;
    ec_placement_list placements = {0};
    choice.at = seconds_of(t, moment);
    EC_TRY(ec_gltf_pose(g, &choice, false, NULL, err));
    for (uint32_t i = 0; i < g->node_count; i++) g->nodes[i].hidden = t->hidden[i];
    ec_result result = read_placed(t, g, &placements, moment, err);
    free(placements.items);
    return result;
}

/* Fails if the positions at all moments examined would take more than half of the memory. */
static ec_result check_memory(const ec_tracks *t, uint32_t step, ec_error *err)
{
    uint64_t bytes = (uint64_t)t->count * t->words * sizeof(float) * (EC_MOMENTS / step + 1);
    uint64_t memory = ec_memory_of_machine();
    if (bytes <= memory / 2) return EC_OK;
    return ec_fail(
        err,
        "%s: %u vertices that may move, at %u moments, need %llu MB, and this machine has %llu MB; give a shorter --shutter",
        t->base->path, t->count, EC_MOMENTS / step + 1, (unsigned long long)(bytes >> 20),
        (unsigned long long)(memory >> 20));
}

static ec_result read_moments(ec_tracks *t, uint32_t step, ec_error *err)
{
    EC_TRY(check_memory(t, step, err));
    for (uint32_t m = 0; m <= EC_MOMENTS; m += step)
        if (!t->values[m]) EC_TRY(read_moment(t, m, err));
    t->step = step;
    return EC_OK;
}

/* Chooses the fewest segments whose straight lines are close enough at all moments examined; examines more moments if none are. */
static ec_result choose_segments(ec_tracks *t, ec_error *err)
{
    EC_TRY(read_moments(t, first_step(t->base), err));
    for (t->segments = 1;; t->segments *= 2) {
        if (t->segments * 2 > EC_MOMENTS / t->step) EC_TRY(read_moments(t, t->step / 2, err));
        t->deviation = ec_tracks_deviation(t);
        if (t->deviation <= EC_MOTION_DEVIATION || t->segments == EC_MOTION_SEGMENTS_MOST) return EC_OK;
    }
}

static ec_result find_vertices(ec_tracks *t, ec_error *err)
{
    const ec_scene *s = t->scene;
    t->hidden = malloc(((size_t)t->base->node_count + 1) * sizeof *t->hidden);
    if (!t->hidden) return ec_fail(err, "%s: out of memory for %u nodes", t->base->path, t->base->node_count);
    for (uint32_t i = 0; i < t->base->node_count; i++) t->hidden[i] = t->base->nodes[i].hidden;
    uint32_t flat = s->shape_count ? s->shapes[0].first_vertex : s->vertex_count;
    t->vertex = malloc(((size_t)flat + 1) * sizeof *t->vertex);
    if (!t->vertex) return ec_fail(err, "%s: out of memory for %u vertices", t->base->path, flat);
    for (uint32_t v = 0; v < flat; v++)
        if (t->base->sources[v].placement != EC_STILL) t->vertex[t->count++] = v;
    t->words = 3;
    if (s->normals) t->normals = t->words, t->words += 3;
    if (s->tangents) t->tangents = t->words, t->words += 3;
    return EC_OK;
}

static void free_tracks(ec_tracks *t)
{
    for (uint32_t m = 0; m <= EC_MOMENTS; m++) {
        free(t->values[m]);
        free(t->cameras[m]);
        free(t->lights[m]);
    }
    free(t->vertex);
    free(t->hidden);
}

ec_result ec_gltf_move(const ec_scene_choice *choice, ec_gltf *base, ec_scene *s, const ec_log *log,
                       ec_error *err)
{
    ec_tracks *t = calloc(1, sizeof *t);
    if (!t) return ec_fail(err, "%s: out of memory", base->path);
    *t = (ec_tracks){.choice = choice, .base = base, .scene = s};
    ec_result result = find_vertices(t, err);
    if (result == EC_OK) result = choose_segments(t, err);
    if (result == EC_OK) result = ec_tracks_keep(t, s, log, err);
    free_tracks(t);
    free(t);
    EC_TRY(result);
    if (!s->motion.segments)
        ec_note(log, "%s: nothing moves from %g s to %g s", base->path, choice->opens, choice->closes);
    else if (s->motion.deviation > EC_MOTION_DEVIATION)
        ec_warn(log, "%s: %u straight pieces deviate from the true motion by %.2g %% of the distance moved; give a shorter --shutter", base->path,
                s->motion.segments, 100 * s->motion.deviation);
    return EC_OK;
}

/* tier: full */
/* A room in other sizes, places and orientations has the same hits and the same picture. No epsilon may have a unit. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "robust/cases.h"
#include "robust/exact_hit.h"
#include "robust/leave.h"
#include "robust/room.h"
#include "selftest/shot.h"
#include "selftest/tracer.h"

#define EC_VIEW_SPP 512 /* the standard error is far below the 2 % by which pictures may differ */

typedef struct ray {
    double o[3], d[3], next[3]; /* in the room's frame; next: the direction after the first hit */
} ray;

typedef struct view {
    uint32_t count;
    ray *rays;
    ec_traced *camera, *bounce; /* hits of the original room */
    ec_shot shot;
    uint64_t traced, other;     /* number of ids that differ */
    double t;                   /* largest difference, relative to reach / cosine */
    double mean;                /* largest distance from the shot's hits */
} view;

static void free_view(view *v)
{
    free(v->rays);
    free(v->camera);
    free(v->bounce);
    ec_shot_free(&v->shot);
}

static void floats(const double p[3], float out[3])
{
    for (int k = 0; k < 3; k++) out[k] = (float)p[k];
}

/* Directions stay unit vectors; origins are transformed with the room. */
static void put_rays(ec_tracer *r, const ec_room *room, const view *v)
{
    for (uint32_t i = 0; i < v->count; i++) {
        const double nowhere[3] = {0, 0, 0};
        double moved[3];
        float o[3], d[3];
        ec_room_moved(room, v->rays[i].o, moved);
        floats(moved, o);
        ec_room_moved(room, v->rays[i].d, moved);
        ec_float_direction(nowhere, moved, d);
        ec_tracer_ray(r, i, o, d, EC_NO_ID);
    }
}

static ec_result put_bounces(ec_tracer *r, const ec_room *room, const view *v, ec_error *err)
{
    for (uint32_t i = 0; i < v->count; i++) {
        const double nowhere[3] = {0, 0, 0};
        const float unset[3] = {0, 0, 0};
        double moved[3];
        float d[3];
        ec_traced h = ec_tracer_hit(r, i);
        ec_room_moved(room, v->rays[i].next, moved);
        ec_float_direction(nowhere, moved, d);
        ec_tracer_ray(r, i, unset, d, h.prim);
        if (h.prim == EC_NO_ID) set_hit(r, i, 0, 0, 0);
    }
    return leave_hits(r, err);
}

static void keep(const ec_tracer *r, uint32_t count, ec_traced *hits)
{
    for (uint32_t i = 0; i < count; i++) hits[i] = ec_tracer_hit(r, i);
}

static ec_result first_view(ec_selftest *t, ec_tracer *r, uint32_t count, view *v, ec_error *err)
{
    const ec_room room = {0};
    ec_render_options o = ec_shot_options(t, 16, EC_VIEW_SPP);
    uint64_t random = 9;
    ec_scene *scene;
    ec_soup soup = {0};
    *v = (view){.count = count, .rays = malloc(count * sizeof *v->rays), .camera = malloc(count * sizeof *v->camera),
                .bounce = malloc(count * sizeof *v->bounce)};
    if (!v->rays || !v->camera || !v->bounce) return ec_fail(err, "out of memory for %u rays", count);
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) v->rays[i].o[k] = ec_random_between(&random, -0.95, 0.95);
        ec_direction(&random, v->rays[i].d);
        ec_direction(&random, v->rays[i].next);
    }
    EC_TRY(ec_room_scene(&room, &scene, err));
    ec_result result = ec_shot_take(t, scene, &o, &v->shot, err);
    v->mean = v->shot.mean;
    if (result == EC_OK) result = ec_soup_from_scene(scene, &soup, err);
    ec_scene_free(scene);
    if (result == EC_OK) result = ec_tracer_build(r, &soup, err);
    put_rays(r, &room, v);
    if (result == EC_OK) result = ec_tracer_trace(r, 0, count, err);
    keep(r, count, v->camera);
    if (result == EC_OK) result = put_bounces(r, &room, v, err);
    if (result == EC_OK) result = ec_tracer_trace(r, 0, count, err);
    keep(r, count, v->bounce);
    ec_soup_free(&soup);
    return result;
}

/* Camera rays: triangles and positions. */
static void compare_hits(const ec_tracer *r, const ec_room *room, view *v)
{
    double scale = room->scale > 0 ? room->scale : 1;
    for (uint32_t i = 0; i < v->count; i++) {
        ec_traced h = ec_tracer_hit(r, i), first = v->camera[i];
        v->other += h.prim != first.prim || h.prim == EC_NO_ID; /* the room is closed */
        if (h.prim != first.prim || h.prim == EC_NO_ID) continue;
        float o[3], d[3];
        ec_tracer_given(r, i, o, d);
        exact_hit x = exact_meet(o, d, ec_tracer_triangle(r, h.prim));
        v->t = ec_worse(v->t, fabs(h.t / scale - first.t) * x.cosine / (x.reach / scale + 1));
    }
    v->traced += v->count;
}

/* Second segments, where the first hits were the same. */
static void compare_bounces(const ec_tracer *r, view *v, const ec_traced *camera)
{
    for (uint32_t i = 0; i < v->count; i++) {
        if (camera[i].prim != v->camera[i].prim) continue;
        v->other += ec_tracer_hit(r, i).prim != v->bounce[i].prim;
        v->traced++;
    }
}

static ec_result compare_rays(ec_tracer *r, const ec_room *room, view *v, ec_traced *camera, ec_error *err)
{
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        if (!ec_tracer_has(r, a)) continue;
        put_rays(r, room, v);
        EC_TRY(ec_tracer_trace(r, a, v->count, err));
        compare_hits(r, room, v);
        keep(r, v->count, camera);
        EC_TRY(put_bounces(r, room, v, err));
        EC_TRY(ec_tracer_trace(r, a, v->count, err));
        compare_bounces(r, v, camera);
    }
    return EC_OK;
}

static ec_result other_view(ec_selftest *t, ec_tracer *r, const ec_room *room, bool has_picture, view *v, ec_error *err)
{
    ec_render_options o = ec_shot_options(t, 16, EC_VIEW_SPP);
    ec_scene *scene;
    ec_soup soup = {0};
    ec_shot shot = {0};
    ec_traced *camera = malloc(v->count * sizeof *camera);
    EC_TRY(camera ? EC_OK : ec_fail(err, "out of memory for %u rays", v->count));
    ec_result result = ec_room_scene(room, &scene, err);
    if (result == EC_OK && has_picture) result = ec_shot_take(t, scene, &o, &shot, err);
    if (has_picture && !(fabs(shot.mean - v->shot.mean) <= fabs(v->mean - v->shot.mean))) v->mean = shot.mean;
    if (result == EC_OK) result = ec_soup_from_scene(scene, &soup, err);
    if (result == EC_OK) result = ec_tracer_build(r, &soup, err);
    if (result == EC_OK) result = compare_rays(r, room, v, camera, err);
    ec_scene_free(scene);
    ec_soup_free(&soup);
    ec_shot_free(&shot);
    free(camera);
    return result;
}

/* Two hits, each with such an error, and coordinates rounded in both rooms, whose error is smaller. */
#define T_DIFFERENCE (2 * EXACT_T_BOUND)

static ec_result view_rows(ec_selftest *t, const char *what, const view *v, ec_error *err)
{
    char name[64];
    snprintf(name, sizeof name, "%s, other triangle hit", what);
    EC_TRY(ec_selftest_value(t, name, 0, (double)v->other / (double)v->traced, 1.0 / (double)v->traced, 1e-5, err));
    snprintf(name, sizeof name, "%s, t", what);
    EC_TRY(ec_selftest_largest(t, name, v->t, T_DIFFERENCE, "of reach / cosine", err));
    snprintf(name, sizeof name, "%s, picture", what);
    /* Paths that diverge at an edge differ. In a mirrored room, whose frames and order of lights differ, all of them do. */
    return ec_selftest_value(t, name, v->shot.mean, v->mean, v->shot.noise, fmin(4 * v->shot.noise, 0.02 * v->shot.mean), err);
}

static ec_result compare_rooms(ec_selftest *t, const char *what, const ec_room *rooms, uint32_t count, ec_error *err)
{
    view v;
    ec_tracer *r;
    EC_TRY(ec_tracer_of(t, &r, err));
    ec_result result = first_view(t, r, EC_TRACER_RAYS, &v, err);
    for (uint32_t i = 0; i < count && result == EC_OK; i++) result = other_view(t, r, &rooms[i], true, &v, err);
    if (result == EC_OK) result = view_rows(t, what, &v, err);
    free_view(&v);
    return result;
}

/* Powers of ten, which floats must round. */
static ec_result scale_case(ec_selftest *t, ec_error *err)
{
    ec_room rooms[12];
    uint32_t count = 0;
    for (int power = -6; power <= 6; power++)
        if (power) rooms[count++] = (ec_room){.scale = pow(10, power)};
    return compare_rooms(t, "1e-6 to 1e6", rooms, count, err);
}

/* Node matrices are multiplied in double, and the centre is subtracted before rounding. Sizes: two units, the room's. */
static ec_result translation_case(ec_selftest *t, ec_error *err)
{
    ec_room rooms[5];
    uint32_t count = 0;
    for (int power = 0; power <= 4; power++) {
        double way = 2 * pow(10, power);
        rooms[count++] = (ec_room){.has_matrix = true, .matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, way, -0.7 * way, 0.3 * way, 1}};
    }
    return compare_rooms(t, "by 1e4 sizes", rooms, count, err);
}

/* A mirrored node reverses its triangles: their front sides stay lit. */
static ec_result turned_case(ec_selftest *t, ec_error *err)
{
    static const ec_room rooms[] = {
        {.has_matrix = true, .matrix = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
        {.has_matrix = true, .matrix = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 3, 2, 1, 1}},
    };
    static const ec_room mirrored[] = {
        {.has_matrix = true, .matrix = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
        {.has_matrix = true, .matrix = {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 3, 2, 1, 1}},
    };
    EC_TRY(compare_rooms(t, "by 90 degrees", rooms, 2, err));
    return compare_rooms(t, "mirrored", mirrored, 2, err);
}

/* Coordinates that are large in the file itself have lost digits: half an ulp each, sqrt 3 of it in space, twice, since the centre comes
 * from rounded corners. At 1e4 sizes that is 1e-3 of the room, at 1e6 a tenth.
 *
 * Rays that pass so near to an edge may hit the triangle beside it: of lines through a room of surface 24, a share of 2 d 88 pi / 24 comes
 * within d of its 88 of edges (Crofton). If most did, there would be nothing to compare. */
static ec_result baked_case(ec_selftest *t, ec_error *err)
{
    view v;
    ec_tracer *r;
    EC_TRY(ec_tracer_of(t, &r, err));
    ec_result result = first_view(t, r, EC_TRACER_RAYS / 8, &v, err);
    for (int power = 0; power <= 6 && result == EC_OK; power++) {
        ec_room room = {.offset = 2 * pow(10, power)};
        char what[64];
        double off = 2 * sqrt(3) * 0x1p-24 * (room.offset + 1);
        v.t = 0;
        v.other = v.traced = 0;
        if ((result = other_view(t, r, &room, false, &v, err)) != EC_OK) break;
        snprintf(what, sizeof what, "1e%d sizes away, t", power);
        if ((result = ec_selftest_largest(t, what, v.t, T_DIFFERENCE + off, "of reach / cosine", err)) != EC_OK) break;
        snprintf(what, sizeof what, "1e%d sizes away, other triangle hit", power);
        result = ec_selftest_value(t, what, 0, (double)v.other / (double)v.traced, 1.0 / (double)v.traced,
                                   fmin(1e-5 + 23 * off, 0.5), err);
    }
    free_view(&v);
    return result;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"rays/scale", false, scale_case, "absolute epsilons: scenes in millimetres or kilometres break"},
        {"rays/translation", false, translation_case, "scenes far from the origin lose their digits"},
        {"rays/turned", false, turned_case, "mirrored nodes turn inside out"},
        {"rays/baked coordinates", false, baked_case, "what the file itself has lost of a scene far from the origin"},
    };
    return RUN_CASES(cases);
}

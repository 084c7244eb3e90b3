/* Turns tracks into keys: decides which vertices move, and puts them first. */
#include <float.h>
#include <math.h>

#include "base/freed.h"
#include "gltf/motion.h"

static bool differs(const ec_tracks *t, numbers_at *at, uint32_t thing, size_t first, size_t count)
{
    for (uint32_t m = t->step; m <= EC_MOMENTS; m += t->step)
        if (memcmp(at(t, m, thing) + first, at(t, 0, thing) + first, count * sizeof(float))) return true;
    return false;
}

/* The sorting of the scene's flat vertices and triangles: they stay, move or are dropped. */
typedef struct sorting {
    const ec_tracks *t;
    ec_scene *s;
    uint32_t vertices, triangles; /* numbers of flat ones */
    uint32_t *track;              /* by vertex: its index in the tracks, or EC_STILL */
    bool *moving;                 /* by vertex: it moves; later: it belongs to a triangle that moves */
    uint32_t *place;              /* by vertex: its new index */
    uint8_t *fate;                /* by triangle */
} sorting;
enum { STAYS, MOVES, GOES };

static const float *key_of(const sorting *o, uint32_t vertex, uint32_t key)
{
    return vertex_at(o->t, key * (EC_MOMENTS / o->t->segments), o->track[vertex]);
}

static bool is_placeable(const float *v[3])
{
    double world[3][3];
    for (int i = 0; i < 9; i++) world[i / 3][i % 3] = (double)v[i / 3][i % 3];
    return ec_is_placeable((const double(*)[3])world);
}

static uint8_t fate_of(sorting *o, uint32_t triangle)
{
    const uint32_t *i = o->s->indices + 3 * (size_t)triangle;
    bool has_area = false;
    if (o->track[i[0]] == EC_STILL) return STAYS;
    for (uint32_t key = 0; key <= o->t->segments; key++) {
        const float *v[3] = {key_of(o, i[0], key), key_of(o, i[1], key), key_of(o, i[2], key)};
        if (!is_placeable(v)) {
            o->s->dropped_nonfinite++;
            return GOES;
        }
        has_area = has_area || !ec_placed_is_flat(v[0], v[1], v[2]);
    }
    if (!has_area) o->s->dropped_degenerate++;
    return !has_area ? GOES : o->moving[i[0]] || o->moving[i[1]] || o->moving[i[2]] ? MOVES : STAYS;
}

static void decide(sorting *o)
{
    ec_motion *m = &o->s->motion;
    for (uint32_t v = 0; v < o->vertices; v++) o->track[v] = EC_STILL;
    for (uint32_t i = 0; i < o->t->count; i++) {
        o->track[o->t->vertex[i]] = i;
        o->moving[o->t->vertex[i]] = differs(o->t, vertex_at, i, 0, o->t->words);
    }
    for (uint32_t t = 0; t < o->triangles; t++) o->fate[t] = fate_of(o, t);
    memset(o->moving, 0, o->vertices * sizeof *o->moving);
    for (uint32_t t = 0; t < o->triangles; t++)
        for (int k = 0; o->fate[t] == MOVES && k < 3; k++) o->moving[o->s->indices[3 * (size_t)t + (size_t)k]] = true;
    for (uint32_t t = 0; t < o->triangles; t++) m->triangle_count += o->fate[t] == MOVES;
    for (uint32_t v = 0; v < o->vertices; v++)
        if (o->moving[v]) o->place[v] = m->vertex_count++;
    for (uint32_t v = 0, next = m->vertex_count; v < o->vertices; v++)
        if (!o->moving[v]) o->place[v] = next++;
}

static ec_result permute(const sorting *o, float *stream, size_t words, ec_error *err)
{
    if (!stream) return EC_OK;
    EC_FREED float *old = malloc(o->vertices * words * sizeof *old);
    if (!old) return ec_fail(err, "%s: out of memory for %u vertices", o->t->base->path, o->vertices);
    memcpy(old, stream, o->vertices * words * sizeof *old);
    for (size_t v = 0; v < o->vertices; v++) memcpy(stream + o->place[v] * words, old + v * words, words * sizeof *old);
    return EC_OK;
}

/* Moves meshes that are kept once, which follow the flat triangles, from index `from` to `to`. */
static void close_up(ec_scene *s, uint32_t from, uint32_t to)
{
    size_t rest = s->triangle_count - from;
    memmove(s->indices + 3 * (size_t)to, s->indices + 3 * (size_t)from, 3 * rest * sizeof *s->indices);
    memmove(s->triangle_material + to, s->triangle_material + from, rest * sizeof *s->triangle_material);
    s->triangle_count -= from - to;
    for (uint32_t i = 0; i < s->shape_count; i++) s->shapes[i].first -= from - to;
    for (uint32_t i = 0; i < s->placed_count; i++) s->placed[i].id -= from - to;
}

/* Rebuilds the parts: moving and still triangles of a node become separate parts; those of meshes kept once follow, shifted. */
static ec_result reorder_parts(const sorting *o, uint32_t used, ec_error *err)
{
    ec_scene *s = o->s;
    const uint32_t count = s->part_count;
    EC_FREED ec_part *old = s->parts;
    uint32_t triangle = 0;
    s->part_count = 0;
    s->parts = malloc((3 * (size_t)count + 1) * sizeof *s->parts);
    if (!s->parts) return ec_fail(err, "%s: out of memory for %u nodes", o->t->base->path, count);
    for (int pass = MOVES; pass >= STAYS; pass--)
        for (uint32_t p = 0; p < count; p++) {
            const uint32_t next = p + 1 < count ? old[p + 1].first : o->triangles, end = next < o->triangles ? next : o->triangles;
            for (uint32_t t = old[p].first; t < end; t++) {
                if (o->fate[t] != pass) continue;
                ec_part_add(s, triangle++, old[p].node);
            }
        }
    for (uint32_t p = 0; p < count; p++)
        if (old[p].first >= o->triangles) ec_part_add(s, old[p].first - (o->triangles - used), old[p].node);
    return EC_OK;
}

static ec_result reorder(const sorting *o, ec_error *err)
{
    ec_scene *s = o->s;
    const size_t n = o->triangles;
    uint32_t used = 0;
    EC_FREED uint32_t *corners = malloc(3 * n * sizeof *corners + 4);
    EC_FREED uint32_t *materials = malloc(n * sizeof *materials + 4);
    if (!corners || !materials) return ec_fail(err, "%s: out of memory for %zu triangles", o->t->base->path, n);
    for (int pass = MOVES; pass >= STAYS; pass--)
        for (size_t t = 0; t < n; t++) {
            if (o->fate[t] != pass) continue;
            for (int k = 0; k < 3; k++) corners[3 * (size_t)used + (size_t)k] = o->place[s->indices[3 * t + (size_t)k]];
            materials[used++] = s->triangle_material[t];
        }
    memcpy(s->indices, corners, 3 * (size_t)used * sizeof *corners);
    memcpy(s->triangle_material, materials, used * sizeof *materials);
    close_up(s, o->triangles, used);
    EC_TRY(reorder_parts(o, used, err));
    for (int i = 0; i < EC_STREAMS; i++) EC_TRY(permute(o, ec_scene_stream(s, i), ec_stream_width[i], err));
    return EC_OK;
}

static ec_result write_stream(const sorting *o, uint32_t word, float **stream, ec_error *err)
{
    const size_t keys = o->t->segments + 1;
    *stream = malloc((o->s->motion.vertex_count * keys * 3 + 1) * sizeof **stream);
    if (!*stream)
        return ec_fail(err, "%s: out of memory for %u moving vertices at %zu moments", o->t->base->path,
                       o->s->motion.vertex_count, keys);
    for (uint32_t v = 0; v < o->vertices; v++)
        for (uint32_t key = 0; o->moving[v] && key < keys; key++)
            memcpy(*stream + (o->place[v] * keys + key) * 3, key_of(o, v, key) + word, 3 * sizeof **stream);
    return EC_OK;
}

static ec_result write_swept(ec_scene *s, uint32_t segments, ec_error *err)
{
    ec_motion *m = &s->motion;
    const size_t keys = segments + 1;
    m->swept = malloc(((size_t)m->triangle_count * 6 + 1) * sizeof *m->swept);
    if (!m->swept) return ec_fail(err, "out of memory for %u moving triangles", m->triangle_count);
    for (size_t t = 0; t < m->triangle_count; t++)
        for (size_t k = 0; k < 3; k++) {
            float low = FLT_MAX, high = -FLT_MAX;
            for (size_t i = 0; i < 3 * keys; i++) {
                float x = m->positions[(s->indices[3 * t + i / keys] * keys + i % keys) * 3 + k];
                low = fminf(low, x);
                high = fmaxf(high, x);
            }
            m->swept[6 * t + k] = low;
            m->swept[6 * t + 3 + k] = high;
            s->bounds_min[k] = fminf(s->bounds_min[k], low);
            s->bounds_max[k] = fmaxf(s->bounds_max[k], high);
        }
    return EC_OK;
}

static ec_result keep_views(const ec_tracks *t, ec_scene *s, ec_error *err)
{
    ec_motion *m = &s->motion;
    const size_t keys = t->segments + 1, stride = EC_MOMENTS / t->segments;
    m->cameras = malloc((s->camera_count * keys + 1) * sizeof *m->cameras);
    m->lights = malloc((s->light_count * keys + 1) * sizeof *m->lights);
    if (!m->cameras || !m->lights)
        return ec_fail(err, "%s: out of memory for cameras and lights at %zu moments", t->base->path, keys);
    for (uint32_t i = 0; i < s->camera_count; i++) {
        if (!differs(t, camera_place, i, 0, 12) && !differs(t, camera_view, i, 0, 4)) continue;
        for (size_t k = 0; k < keys; k++) m->cameras[m->camera_count * keys + k] = t->cameras[k * stride][i];
        s->cameras[i].moves = ++m->camera_count;
    }
    for (uint32_t i = 0; i < s->light_count; i++) {
        bool turns = s->lights[i].type != EC_LIGHT_POINT && differs(t, light_place, i, 3, 3);
        bool goes = s->lights[i].type != EC_LIGHT_DIRECTIONAL && differs(t, light_place, i, 0, 3);
        if (!turns && !goes) continue;
        for (size_t k = 0; k < keys; k++) m->lights[m->light_count * keys + k] = t->lights[k * stride][i];
        s->lights[i].moves = ++m->light_count;
    }
    return EC_OK;
}

static ec_result keep(sorting *o, ec_error *err)
{
    const ec_tracks *t = o->t;
    ec_motion *m = &o->s->motion;
    decide(o);
    EC_TRY(write_stream(o, 0, &m->positions, err));
    if (t->normals) EC_TRY(write_stream(o, t->normals, &m->normals, err));
    if (t->tangents) EC_TRY(write_stream(o, t->tangents, &m->tangents, err));
    EC_TRY(reorder(o, err));
    EC_TRY(write_swept(o->s, t->segments, err));
    return keep_views(t, o->s, err);
}

ec_result ec_tracks_keep(const ec_tracks *t, ec_scene *s, const ec_log *log, ec_error *err)
{
    ec_motion *m = &s->motion;
    const uint32_t bad = s->dropped_nonfinite, before = s->triangle_count, triangles = ec_scene_flat_count(s);
    const uint32_t vertices = s->shape_count ? s->shapes[0].first_vertex : s->vertex_count;
    EC_FREED uint32_t *track = malloc(((size_t)vertices + 1) * sizeof *track);
    EC_FREED uint32_t *place = malloc(((size_t)vertices + 1) * sizeof *place);
    EC_FREED bool *moving = calloc((size_t)vertices + 1, sizeof *moving);
    EC_FREED uint8_t *fate = calloc((size_t)triangles + 1, sizeof *fate);
    if (!track || !place || !moving || !fate) return ec_fail(err, "%s: out of memory for %u vertices", t->base->path, vertices);
    EC_TRY(keep(&(sorting){t, s, vertices, triangles, track, moving, place, fate}, err));
    if (s->dropped_nonfinite > bad)
        ec_warn(log, "%s: %u triangles with NaN or infinite positions within the shutter are left out", t->base->path,
                s->dropped_nonfinite - bad);
    if (before && !s->triangle_count) {
        if (s->dropped_nonfinite)
            return ec_fail(err, "%s: nothing to render: no triangle has an area while the shutter is open", t->base->path);
        ec_warn(log, "%s: no surface shows while the shutter is open: none has an area", t->base->path);
        memset(s->bounds_min, 0, sizeof s->bounds_min);
        memset(s->bounds_max, 0, sizeof s->bounds_max);
    }
    if (!m->triangle_count && !m->light_count && !m->camera_count) {
        ec_motion_free(m);
        return EC_OK;
    }
    m->segments = t->segments;
    m->deviation = t->deviation;
    m->opens = t->choice->opens;
    m->closes = t->choice->closes;
    s->whole = true;
    return EC_OK;
}

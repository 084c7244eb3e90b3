/* Flattens placed meshes into one set of triangles: positions are computed in double and recentred before they are rounded to float. */
#include "gltf/keep.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Calls the function for each primitive of each placement, except for meshes that are kept once. */
static ec_result for_each_draw(ec_flattener *f, const ec_gltf *g, const ec_placement_list *list, ec_draw_function function)
{
    for (uint32_t i = 0; i < list->count; i++) {
        int32_t mesh = list->items[i].mesh;
        if (mesh < 0 || (f->is_kept && f->is_kept[i])) continue;
        f->placement = list->items[i].moves ? i : EC_STILL;
        f->node = list->items[i].node;
        EC_TRY(ec_flattener_draw(f, g, mesh, &list->items[i], f->scene->center, function));
    }
    return EC_OK;
}

/* Fails if the scene does not fit into memory, as many instances of one mesh make a small file huge: an error is better than being killed. */
static ec_result check_memory(const ec_flattener *f, const char *path)
{
    uint64_t per_vertex = 0;
    for (int i = 0; i < EC_STREAMS; i++) per_vertex += (f->streams >> i & 1) * ec_stream_width[i] * sizeof(float);
    uint64_t bytes = f->vertex_bound * per_vertex + f->triangle_bound * 16;
    uint64_t memory = ec_memory_of_machine();
    if (bytes <= memory) return EC_OK;
    return ec_fail(f->err, "%s: %llu triangles, with all instances counted, need %llu MB, but this machine has %llu MB; simplify the scene",
                   path, (unsigned long long)f->triangle_bound, (unsigned long long)(bytes >> 20),
                   (unsigned long long)(memory >> 20));
}

/* First pass: measures the extent. Vertices of triangles that will be dropped must not move the centre. */
static ec_result measure_draw(ec_flattener *f, const ec_draw *d)
{
    ec_draw_span(d, f->low, f->high);
    return EC_OK;
}

static ec_result allocate(ec_flattener *f, const char *path)
{
    size_t v = f->vertex_bound + 1, t = f->triangle_bound + 1; /* there may be none */
    f->remap = malloc((f->remap_size + 1) * sizeof *f->remap);
    bool ok = ec_scene_allocate(f->scene, f->streams | 1u << EC_POSITION, v, t) && f->remap;
    return ok ? EC_OK : ec_fail(f->err, "%s: out of memory for %zu triangles", path, t);
}

static void set_bounds(ec_scene *s, uint32_t flat_vertices)
{
    for (int k = 0; k < 3; k++) {
        s->bounds_min[k] = FLT_MAX;
        s->bounds_max[k] = -FLT_MAX;
    }
    for (size_t i = 0; i < 3 * (size_t)flat_vertices; i++) {
        s->bounds_min[i % 3] = fminf(s->bounds_min[i % 3], s->positions[i]);
        s->bounds_max[i % 3] = fmaxf(s->bounds_max[i % 3], s->positions[i]);
    }
}

static ec_result flatten(ec_flattener *f, ec_gltf *g, const ec_placement_list *placements, ec_keeping *keeping)
{
    ec_scene *s = f->scene;
    EC_TRY(for_each_draw(f, g, placements, ec_flattener_count));
    EC_TRY(ec_keep_count(keeping, f));
    EC_TRY(check_memory(f, g->path));
    EC_TRY(for_each_draw(f, g, placements, measure_draw));
    EC_TRY(ec_keep_measure(keeping, f));
    bool any_finite = f->low[0] <= f->high[0];
    for (int k = 0; k < 3; k++) s->center[k] = any_finite ? 0.5 * (f->low[k] + f->high[k]) : 0;
    EC_TRY(allocate(f, g->path));
    EC_TRY(ec_parts_start(s, g, placements->count, f->err));
    free(g->sources);
    g->sources = NULL;
    if (g->blurs) {
        f->sources = g->sources = malloc((f->vertex_bound + 1) * sizeof *g->sources);
        if (!f->sources)
            return ec_fail(f->err, "%s: out of memory for %llu vertices", g->path, (unsigned long long)f->vertex_bound);
    }
    EC_TRY(for_each_draw(f, g, placements, ec_flattener_fill));
    set_bounds(s, s->vertex_count);
    f->placement = EC_STILL;
    f->node = -1;
    f->sources = NULL; /* meshes kept once stand still */
    EC_TRY(ec_keep_fill(keeping, f));
    if (!s->triangle_count) {
        memset(s->bounds_min, 0, sizeof s->bounds_min);
        memset(s->bounds_max, 0, sizeof s->bounds_max);
        return ec_flatten_empty(f, g, placements);
    }
    ec_scene_trim(s);
    return EC_OK;
}

static void warn_odd(const struct ec_odd_values *odd, const ec_gltf *g, const char *what, const char *done, const ec_log *log)
{
    if (!odd->count) return;
    ec_warn(log, "%s: %llu %s, the first in %s; %s", g->path, (unsigned long long)odd->count, what,
            ec_label_of("meshes", (uint32_t)odd->mesh, g->meshes[odd->mesh].name).text, done);
}

ec_result ec_flatten(ec_gltf *g, const ec_placement_list *placements, ec_scene *s, const ec_log *log, ec_error *err)
{
    ec_flattener f = {.scene = s, .log = log, .err = err, .low = {INFINITY, INFINITY, INFINITY},
                   .high = {-INFINITY, -INFINITY, -INFINITY}};
    ec_keeping keeping;
    ec_result result = ec_keep_choose(g, placements, s, &keeping, err);
    f.is_kept = keeping.is_kept;
    if (result == EC_OK) result = flatten(&f, g, placements, &keeping);
    free(f.remap);
    ec_keep_free(&keeping);
    EC_TRY(result);
    if (s->dropped_nonfinite)
        ec_warn(log, "%s: %u triangles are left out: their positions are NaN, infinite or beyond 1e18", g->path, s->dropped_nonfinite);
    if (s->dropped_degenerate)
        ec_note(log, "%s: %u triangles without area are left out", g->path, s->dropped_degenerate);
    warn_odd(&f.odd_uv, g, "texture coordinates are NaN or beyond 1e18", "they are clamped", log);
    warn_odd(&f.odd_colors, g, "values of vertex colours are NaN or out of 0..1", "they are clamped", log);
    warn_odd(&f.odd_normals, g, "normals are NaN or infinite", "the triangles' own normals are used instead", log);
    return EC_OK;
}

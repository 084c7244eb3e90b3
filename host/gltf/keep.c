/* Chooses which meshes are kept once. Excluded are meshes that emit, since lights are sampled in the world; those that bound bodies or let light pass
 * straight through, since it is also in the world that bodies are found within one another; and places whose matrix is singular or nearly so, since
 * its inverse, which takes rays to the mesh, would be noise. */
#include "gltf/keep.h"

#include <math.h>

#include "base/freed.h"

#define CONDITION_MOST 1e6 /* largest condition of a matrix; its inverse in double is then accurate to 2^-32, far below a float's rounding */
#define SMALL_MESH 64u     /* triangles: keeping fewer once saves little more than their instances take */
#define WORTH_TRIANGLES (1u << 20)

const ec_placement ec_at_home = {.linear = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

static bool emits_or_bounds(const ec_gltf *g, int32_t mesh, const ec_scene *scene)
{
    for (uint32_t k = 0; k < g->meshes[mesh].primitive_count; k++) {
        const ec_gltf_primitive *p = &g->meshes[mesh].primitives[k];
        const ec_material *m = &scene->materials[p->scene_material];
        if (p->drawn && (ec_emits(m) || ec_bounds(m) || m->transmission > 0)) return true;
    }
    return false;
}

/* Measures the extent and the number of the triangles; corners that are not numbers do not count for the extent. */
static void span_mesh(const ec_gltf *g, ec_kept_mesh *m)
{
    for (int k = 0; k < 3; k++) {
        m->low[k] = INFINITY;
        m->high[k] = -INFINITY;
    }
    ec_draw d = ec_draw_of(g, &ec_at_home, NULL);
    for (uint32_t i = 0; i < g->meshes[m->mesh].primitive_count; i++) {
        d.p = &g->meshes[m->mesh].primitives[i];
        if (!d.p->drawn) continue;
        m->triangles += d.p->triangle_count;
        ec_draw_span(&d, m->low, m->high);
    }
}

static double frobenius(const double m[9])
{
    double sum = 0;
    for (int i = 0; i < 9; i++) sum += m[i] * m[i];
    return sqrt(sum);
}

/* Tells whether rays can be taken to the mesh and back. Sizes far from 1 would bring squares near the limits of floats. */
static bool fits(const ec_placement *at, const ec_kept_mesh *m)
{
    double adjoint[9], scale = frobenius(at->linear), size = 0, reach = 0;
    double determinant = fabs(ec_gltf_determinant(at->linear));
    ec_gltf_normal_matrix(at->linear, adjoint); /* the transposed adjugate of the matrix divided by its largest element */
    double largest = 0;
    for (int i = 0; i < 9; i++) largest = fmax(largest, fabs(at->linear[i]));
    double condition = scale * frobenius(adjoint) * largest * largest / determinant;
    for (int k = 0; k < 3; k++) {
        size = fmax(size, m->high[k] - m->low[k]);
        reach = fmax(reach, fabs(at->origin[k]) + scale * fmax(fabs(m->low[k]), fabs(m->high[k])));
    }
    return condition < CONDITION_MOST && size > 1e-9 && size * scale > 1e-9 && size < 1e12 && reach < 1e12; /* false for NaN */
}

static ec_result find_candidates(ec_keeping *k, const ec_scene *scene, ec_error *err)
{
    const ec_gltf *g = k->g;
    EC_FREED uint32_t *uses = calloc((size_t)g->mesh_count + 1, sizeof *uses);
    EC_FREED int32_t *index = malloc(((size_t)g->mesh_count + 1) * sizeof *index);
    k->meshes = calloc((size_t)g->mesh_count + 1, sizeof *k->meshes);
    k->candidate = malloc(((size_t)k->placements->count + 1) * sizeof *k->candidate);
    if (!uses || !index || !k->meshes || !k->candidate) return ec_fail(err, "%s: out of memory for %u meshes", g->path, g->mesh_count);
    for (uint32_t i = 0; i < k->placements->count; i++) {
        int32_t mesh = k->placements->items[i].mesh;
        if (mesh >= 0) uses[mesh]++;
    }
    for (uint32_t mesh = 0; mesh < g->mesh_count; mesh++) {
        index[mesh] = -1;
        if (uses[mesh] < 2 || emits_or_bounds(g, (int32_t)mesh, scene)) continue;
        ec_kept_mesh *m = &k->meshes[k->mesh_count];
        *m = (ec_kept_mesh){.mesh = (int32_t)mesh};
        span_mesh(g, m);
        if (m->low[0] <= m->high[0]) index[mesh] = (int32_t)k->mesh_count++;
    }
    for (uint32_t i = 0; i < k->placements->count; i++) {
        int32_t mesh = k->placements->items[i].mesh, c = mesh >= 0 ? index[mesh] : -1;
        k->candidate[i] = c >= 0 && !k->placements->items[i].moves && fits(&k->placements->items[i], &k->meshes[c]) ? c : -1;
        if (k->candidate[i] >= 0) k->meshes[c].places++;
    }
    return EC_OK;
}

/* Decides EC_INSTANCING_AUTO: instances are worth it only if they save a million triangles, and half of all, as rays through instances cost more. */
static bool is_worth_it(const ec_keeping *k)
{
    uint64_t all = 0, saved = 0;
    for (uint32_t i = 0; i < k->placements->count; i++) {
        int32_t mesh = k->placements->items[i].mesh;
        for (uint32_t p = 0; mesh >= 0 && p < k->g->meshes[mesh].primitive_count; p++)
            if (k->g->meshes[mesh].primitives[p].drawn) all += k->g->meshes[mesh].primitives[p].triangle_count;
    }
    for (uint32_t m = 0; m < k->mesh_count; m++)
        if (k->meshes[m].places > 1 && k->meshes[m].triangles >= SMALL_MESH)
            saved += (k->meshes[m].places - 1) * k->meshes[m].triangles;
    return saved >= WORTH_TRIANGLES && saved >= all / 2;
}

ec_result ec_keep_choose(const ec_gltf *g, const ec_placement_list *placements, const ec_scene *scene, ec_keeping *k, ec_error *err)
{
    *k = (ec_keeping){.g = g, .placements = placements};
    if (g->instancing == EC_INSTANCING_OFF) return EC_OK;
    EC_TRY(find_candidates(k, scene, err));
    bool is_forced = g->instancing == EC_INSTANCING_ON, any = false;
    if (!is_forced && !is_worth_it(k)) return EC_OK;
    for (uint32_t m = 0; m < k->mesh_count; m++)
        any |= k->meshes[m].is_kept = k->meshes[m].places > 1 && (is_forced || k->meshes[m].triangles >= SMALL_MESH);
    if (!any) return EC_OK;
    k->is_kept = calloc((size_t)placements->count + 1, sizeof *k->is_kept);
    if (!k->is_kept) return ec_fail(err, "%s: out of memory for %u nodes", g->path, placements->count);
    for (uint32_t i = 0; i < placements->count; i++) k->is_kept[i] = k->candidate[i] >= 0 && k->meshes[k->candidate[i]].is_kept;
    return EC_OK;
}

void ec_keep_free(ec_keeping *k)
{
    free(k->meshes);
    free(k->candidate);
    free(k->is_kept);
}

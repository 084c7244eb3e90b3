/* tiers: quick, long */
/* Every accelerator against brute force, bit by bit: the stages' own kernels on structures of the host's own builders, with awkward rays
 * and triangles. Culling must never change an answer (kernels/lib/ray.h). */
#include "kernel/traversal_run.h"

static uint32_t rays = 3000; /* a set; not a multiple of the lanes: */
#define COUNT (rays - 3u)

static uint32_t everywhere_node(ec_bvh2_node *nodes, uint32_t *count, uint32_t first, uint32_t end)
{
    if (end - first <= 8 && *count) return EC_LEAF_BIT | first << 4 | (end - first);
    uint32_t at = (*count)++, middle = first + (end - first) / 2;
    for (int side = 0; side < 2; side++)
        for (int axis = 0; axis < 3; axis++) nodes[at].lo[side][axis] = -1e30f, nodes[at].hi[side][axis] = 1e30f;
    uint32_t left = everywhere_node(nodes, count, first, middle), right = everywhere_node(nodes, count, middle, end);
    nodes[at].child[0] = left;
    nodes[at].child[1] = right;
    return at;
}

/* Brute force is a tree that culls nothing: infinite boxes, and triangles one by one in scene order. It uses the same kernels. */
static ec_accel make_brute(const set *s)
{
    ec_bvh2_node *nodes = calloc(s->triangles + 2, sizeof *nodes);
    ec_tri *triangles = calloc(s->triangles + 1, sizeof *triangles);
    uint32_t node_count = 0;
    for (uint32_t i = 0; i < s->triangles; i++) {
        ec_tri *t = &triangles[i];
        const float *v = s->vertices + 9 * i;
        memcpy(t->v0, v, sizeof t->v0);
        memcpy(t->v1, v + 3, sizeof t->v1);
        memcpy(t->v2, v + 6, sizeof t->v2);
        t->id = i;
    }
    everywhere_node(nodes, &node_count, 0, s->triangles);
    return (ec_accel){.buffers = {{"nodes", nodes, node_count * sizeof *nodes}, {"triangles", triangles, (s->triangles + 1) * sizeof *triangles}}};
}

static void check_closest(const set *s, const ec_accel *accels, const ec_accel *brute, const tracer *bvh2, float *queue, float *expected)
{
    make_rays(s, queue, rays, EC_PATH_FIELDS, EC_PATH_PRIM, true);
    if (!intersect(s, bvh2, brute, rays, COUNT, queue, expected)) return;
    float *hits = calloc(EC_HIT_PROBE_FIELDS * rays, sizeof *hits);
    uint32_t hit = 0;
    for (uint32_t i = 0; i < tracer_count; i++)
        if (accels[tracers[i].accel].buffers[0].data && intersect(s, &tracers[i], &accels[tracers[i].accel], rays, COUNT, queue, hits))
            hit = same_hits(s, queue, rays, COUNT, hits, expected, tracers[i].label, "brute force");
    /* Rays that hit nothing prove little. */
    if (s->triangles) CHECK_MSG(hit > COUNT / 20, "%s: only %u rays hit", s->name, hit);
    free(hits);
}

/* Eight rays in a row have nearly the first one's direction: bundles from one origin, and from origins as far apart as on a lens. */
static void make_bundles(const set *s, float *queue)
{
    static const double spreads[] = {0.0, 1e-7, 1e-4, 1e-2, 0.3};
    make_rays(s, queue, rays, EC_PATH_FIELDS, EC_PATH_PRIM, true);
    for (uint32_t i = 0; i < rays; i++) {
        const uint32_t first = i - i % 8, bundle = i / 8;
        const double spread = spreads[bundle % 5], lens = bundle / 5 % 2 ? spread * (double)s->scene_max : 0.0;
        for (uint32_t c = 0; c < 3 && i != first; c++) {
            queue[(EC_PATH_OX + c) * rays + i] = queue[(EC_PATH_OX + c) * rays + first] + random_float(-lens, lens);
            queue[(EC_PATH_DX + c) * rays + i] = queue[(EC_PATH_DX + c) * rays + first] * (1.0f + random_float(-spread, spread));
        }
    }
}

/* Packets find what each ray finds alone. */
static void check_bundles(const set *s, const ec_accel *accels, const ec_accel *brute, const tracer *bvh2, float *queue, float *expected)
{
    make_bundles(s, queue);
    if (!intersect(s, bvh2, brute, rays, COUNT, queue, expected)) return;
    float *hits = calloc(EC_HIT_PROBE_FIELDS * rays, sizeof *hits);
    for (uint32_t i = 0; i < tracer_count; i++)
        if (strstr(tracers[i].label, "INTERLEAVE") && intersect(s, &tracers[i], &accels[tracers[i].accel], rays, COUNT, queue, hits))
            same_hits(s, queue, rays, COUNT, hits, expected, "bundles", "brute force");
    free(hits);
}

static void check_shadows(const set *s, const ec_accel *accels, const ec_accel *brute, const tracer *bvh2, float *queue, float *expected)
{
    make_rays(s, queue, rays, EC_SHADOW_FIELDS, EC_SHADOW_PRIM, false);
    uint32_t *words = (uint32_t *)queue;
    for (uint32_t i = 0; i < rays; i++) {
        words[EC_SHADOW_SLOT * rays + i] = rays - 1 - i;
        words[EC_SHADOW_TARGET * rays + i] = s->triangles && i % 3 == 0 ? random_below(s->triangles) : EC_NO_ID;
        for (uint32_t c = 0; c < 3; c++) queue[(EC_SHADOW_LR + c) * rays + i] = (float)(1 + c);
    }
    if (!connect(s, bvh2, brute, rays, COUNT, queue, expected)) return;
    uint32_t open = 0, traced = 0;
    float *radiance = calloc(3 * rays, sizeof *radiance);
    for (uint32_t k = 0; k < tracer_count; k++) {
        if (!accels[tracers[k].accel].buffers[0].data) continue;
        if (!connect(s, &tracers[k], &accels[tracers[k].accel], rays, COUNT, queue, radiance)) continue;
        uint32_t wrong = 0;
        traced++;
        for (uint32_t i = 0; i < rays; i++) {
            uint32_t slot = rays - 1 - i;
            float light = expected[slot];
            if (i >= COUNT && light != 0.0f) wrong++;
            open += light != 0.0f;
            if (radiance[slot] == light && radiance[rays + slot] == 2 * light && radiance[2 * rays + slot] == 3 * light) continue;
            if (!wrong++) print_ray(s, queue, rays, i, EC_NO_ID);
        }
        CHECK_MSG(wrong == 0, "%s, %s: %u of %u shadow rays differ", s->name, tracers[k].label, wrong, COUNT);
    }
    open /= traced ? traced : 1;
    if (s->triangles > 1) CHECK_MSG(open > COUNT / 50 && open < COUNT - COUNT / 50, "%s: %u of %u shadow rays arrive", s->name, open, COUNT);
    free(radiance);
}

/* Brute-force hits with the triangles in reverse order, renumbered back: order must not matter. */
static void check_order(const set *s, const tracer *bvh2, const float *queue, const float *expected)
{
    ec_accel reversed = make_brute(s);
    ec_tri *triangles = reversed.buffers[1].data;
    for (uint32_t i = 0; i < s->triangles / 2; i++) {
        ec_tri swap = triangles[i];
        triangles[i] = triangles[s->triangles - 1 - i];
        triangles[s->triangles - 1 - i] = swap;
    }
    float *hits = calloc(EC_HIT_PROBE_FIELDS * rays, sizeof *hits);
    if (intersect(s, bvh2, &reversed, rays, COUNT, queue, hits)) same_hits(s, queue, rays, COUNT, hits, expected, "reverse order", "brute force");
    free(hits);
    ec_accel_free(&reversed);
}

/* A grid of a single block of cells, and one so fine that it reaches its memory limit. */
static void check_densities(const set *s, const float *queue, const float *expected)
{
    const tracer *t = tracers;
    while (t->accel != ec_accel_find("grid")) t++;
    float *hits = calloc(EC_HIT_PROBE_FIELDS * rays, sizeof *hits);
    for (int i = 0; i < 2; i++) {
        ec_error err = {0};
        ec_accel grid;
        uint32_t *indices;
        ec_accel_input input = set_input(s, &indices);
        input.grid_density = i ? 10000.0f : 0.01f;
        CHECK_OK(ec_accel_build(t->accel, &input, &grid, &err), err);
        if (grid.buffers[0].data && intersect(s, t, &grid, rays, COUNT, queue, hits))
            same_hits(s, queue, rays, COUNT, hits, expected, i ? "fine grid" : "coarse grid", "brute force");
        ec_accel_free(&grid);
        ec_accel_input_free(&input);
        free(indices);
    }
    free(hits);
}

/* Cut triangles: there are more references than triangles, and each has a box of its own, on the device too. */
static void check_parts(const set *s, const ec_accel *accels, bool expected)
{
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        uint64_t references = accels[a].stats.references;
        bool has_boxes = false;
        for (int k = 0; k < EC_ACCEL_BUFFERS; k++) has_boxes |= accels[a].buffers[k].data && !strcmp(accels[a].buffers[k].label, "boxes");
        if (!accels[a].buffers[0].data) continue;
        CHECK_MSG(has_boxes == expected, "%s, %s: boxes of references: %d", s->name, ec_accels[a].name, has_boxes);
        if (expected) CHECK_MSG(references > s->triangles, "%s, %s: %llu references of %u triangles", s->name, ec_accels[a].name,
                                (unsigned long long)references, s->triangles);
    }
}

/* Whole triangles, or some in parts. Brute force tests whole ones. Parts give the same hits, except for rounding of t where a ray sees a
 * cut triangle edge-on (kernels/lib/ray.h), which no ray here does. */
static void check_set_of(set s, bool in_parts)
{
    ec_accel accels[EC_ACCEL_COUNT], brute = make_brute(&s);
    const tracer *bvh2 = tracers;
    while (strncmp(bvh2->label, "bvh2", 4)) bvh2++;
    set_finish(&s);
    float *queue = calloc(EC_SHADOW_FIELDS * rays + EC_PATH_FIELDS * rays, sizeof *queue), *expected = calloc(EC_HIT_PROBE_FIELDS * rays, sizeof *expected);
    if (build_accels(&s, accels)) {
        check_parts(&s, accels, in_parts);
        check_bundles(&s, accels, &brute, bvh2, queue, expected);
        check_shadows(&s, accels, &brute, bvh2, queue, expected);
        check_closest(&s, accels, &brute, bvh2, queue, expected);
        check_order(&s, bvh2, queue, expected);
        check_densities(&s, queue, expected);
        const uint32_t *prim = (const uint32_t *)expected, *skip = (const uint32_t *)queue + EC_PATH_PRIM * rays;
        bool all_copies = strcmp(s.name, "duplicated") == 0;
        for (uint32_t i = 0; all_copies && i < COUNT; i++) /* the lowest id of four copies, or another if that is skipped */
            if (prim[i] != EC_NO_ID && prim[i] >= s.triangles / 4 && prim[i] % (s.triangles / 4) != skip[i]) {
                CHECK_MSG(false, "ray %u hits copy %u", i, prim[i]);
                break;
            }
    }
    free_accels(accels);
    ec_accel_free(&brute);
    free(queue);
    free(expected);
    free(s.vertices);
}

static void check_set(set s) { check_set_of(s, false); }

int main(void)
{
    int open = open_tracers(true);
    if (open) return open;
    if (test_tier("long")) rays = 6000;
    check_set(set_random("nothing", 0, 1.0f, 0.1f));
    check_set(set_random("one", 1, 1.0f, 1.0f));
    check_set(set_random("random", 1500, 1.0f, 0.1f));
    check_set(set_random("tiny", 1000, 1e-6f, 0.1f));
    check_set(set_random("huge", 1000, 1e6f, 0.1f));
    check_set(set_slivers(1500));
    for (int axis = 0; axis < 3; axis++) check_set(set_coplanar(500, axis));
    check_set(set_tilted(800));
    check_set(set_duplicated(800));
    check_set(set_blocks(1500));
    check_set(set_mixed(1000));
    check_set(set_fan(720));
    check_set_of(set_beams(4800), true);
    check_set_of(set_building(6000), true);
    close_tracers();
    TEST_END();
}

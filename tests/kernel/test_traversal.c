/* Traversal against brute force, bit by bit: the stages' own kernels on scenes of the host's own builder, on rays and
 * triangles chosen to be awkward. Culling must never change an answer (kernels/lib/ray.h). */
#include "accel/bvh.h"
#include "kernel/kernel_run.h"
#include "shared/params.h"
#include "shared/path_state.h"

#define RAYS 6000u /* a set; not a multiple of the lanes: */
#define COUNT (RAYS - 3u)

static ec_cl cl;
static cl_program packet_programs[LANE_WIDTHS], wide_program;

typedef struct set {
    const char *name;
    uint32_t triangles;
    float *vertices; /* 9 a triangle */
    float scene_max;
    float size;      /* of the region that rays are aimed into */
} set;

static float random_float(double a, double b) { return (float)test_random_in(a, b); }
static uint32_t random_below(uint32_t n) { return (uint32_t)(test_random_u64() % n); }

static set set_make(const char *name, uint32_t triangles, float size)
{
    return (set){name, triangles, calloc(9 * (size_t)triangles + 9, sizeof(float)), 0.0f, size};
}

static set set_random(const char *name, uint32_t n, float scale, float edge)
{
    set s = set_make(name, n, scale);
    for (uint32_t i = 0; i < n; i++) {
        float at[3] = {random_float(-1, 1), random_float(-1, 1), random_float(-1, 1)};
        for (int k = 0; k < 9; k++) s.vertices[9 * i + k] = scale * (at[k % 3] + edge * random_float(-1, 1));
    }
    return s;
}

/* Aspect ratios up to 10^6, half of them along an axis. */
static set set_slivers(uint32_t n)
{
    set s = set_make("slivers", n, 1.0f);
    for (uint32_t i = 0; i < n; i++) {
        float *p = s.vertices + 9 * i, thin = (float)pow(10.0, test_random_in(-6, -2));
        for (int k = 0; k < 3; k++) p[k] = random_float(-1, 1);
        for (int k = 0; k < 3; k++) p[3 + k] = p[k] + (i % 2 ? random_float(-1, 1) : 0.0f);
        if (i % 2 == 0) p[3 + i / 2 % 3] += random_float(-1, 1);
        float along = random_float(0, 1);
        for (int k = 0; k < 3; k++) p[6 + k] = p[k] + along * (p[3 + k] - p[k]) + thin * random_float(-1, 1);
    }
    return s;
}

static set set_coplanar(uint32_t n, int axis)
{
    set s = set_random("coplanar", n, 1.0f, 0.2f);
    for (uint32_t i = 0; i < 3 * n; i++) s.vertices[3 * i + axis] = 0.25f;
    return s;
}

/* A plane that no axis is parallel to: rays in it see every triangle edge-on, and what they compute is rounding alone. Only
 * the clamping of t keeps boxes and triangles in agreement there. */
static set set_tilted(uint32_t n)
{
    set s = set_make("tilted plane", n, 1.0f);
    for (uint32_t i = 0; i < n; i++) {
        double at[2] = {test_random_in(-1, 1), test_random_in(-1, 1)}, size = pow(10, test_random_in(-2, 0));
        for (int corner = 0; corner < 3; corner++) {
            double a = at[0] + size * test_random_in(-1, 1), b = at[1] + size * test_random_in(-1, 1);
            s.vertices[9 * i + 3 * corner] = (float)(0.61 * a + 0.23 * b);
            s.vertices[9 * i + 3 * corner + 1] = (float)(-0.37 * a + 0.71 * b);
            s.vertices[9 * i + 3 * corner + 2] = (float)(0.53 * a + 0.29 * b);
        }
    }
    return s;
}

/* Four copies of everything: all four at the same distance. */
static set set_duplicated(uint32_t n)
{
    set s = set_random("duplicated", n, 1.0f, 0.3f);
    uint32_t quarter = n / 4;
    for (uint32_t i = quarter; i < 4 * quarter; i++)
        memcpy(s.vertices + 9 * i, s.vertices + 9 * (i % quarter), 9 * sizeof(float));
    return s;
}

/* Faces of cubes with whole coordinates: all boxes flat or touching. */
static set set_blocks(uint32_t n)
{
    set s = set_make("axis-aligned", n, 8.0f);
    for (uint32_t i = 0; i < n; i++) {
        float *p = s.vertices + 9 * i;
        int a = (int)random_below(3), b = (a + 1) % 3, c = (a + 2) % 3;
        float at[3] = {(float)random_below(16) - 8, (float)random_below(16) - 8, (float)random_below(16) - 8};
        int far = (int)random_below(2);
        for (int corner = 0; corner < 3; corner++) {
            p[3 * corner + a] = at[a];
            p[3 * corner + b] = at[b] + (float)(corner == 1 || (far && corner == 0));
            p[3 * corner + c] = at[c] + (float)(corner == 2 || (far && corner == 0));
        }
    }
    return s;
}

/* Triangles of all sizes about one centre, and far from it. */
static set set_mixed(uint32_t n)
{
    set s = set_make("all sizes", n, 1000.0f);
    for (uint32_t i = 0; i < n; i++) {
        double size = pow(10.0, test_random_in(-3, 3)), where = pow(10.0, test_random_in(-3, 3));
        float at[3];
        for (int k = 0; k < 3; k++) at[k] = (float)(where * test_random_in(-1, 1));
        for (int k = 0; k < 9; k++) s.vertices[9 * i + k] = at[k % 3] + (float)(size * test_random_in(-1, 1));
    }
    return s;
}

/* A strip of needles that share vertices: rays through shared edges and tips. */
static set set_fan(uint32_t n)
{
    set s = set_make("fan", n, 1.0f);
    for (uint32_t i = 0; i < n; i++) {
        float *p = s.vertices + 9 * i;
        for (int k = 0; k < 2; k++) {
            double angle = 6.283185307179586 * ((i + (uint32_t)k) % n) / n;
            p[3 + 3 * k] = (float)cos(angle);
            p[4 + 3 * k] = (float)sin(angle);
            p[5 + 3 * k] = 0.5f;
        }
        p[2] = 0.125f;
    }
    return s;
}

/* Beams across a room at a slant, up to 10^5 times as long as thick, among small triangles: the builder cuts them. */
static set set_beams(uint32_t n)
{
    set s = set_random("beams", n, 1.0f, 0.03f);
    for (uint32_t i = 0; i < n; i += 10) {
        float *p = s.vertices + 9 * i, thin = (float)pow(10.0, test_random_in(-5, -1));
        for (int k = 0; k < 6; k++) p[k] = random_float(-1, 1);
        if (i % 40 == 0) p[1] = p[4] = random_float(-1, 1); /* some level */
        for (int k = 0; k < 3; k++) p[6 + k] = p[k] + thin * random_float(-1, 1);
    }
    return s;
}

/* Walls, floors and slanting roofs of quads, in packets tested two triangles as one, each cut where it passes furniture. */
static set set_building(uint32_t n, float slant)
{
    set s = set_random(slant == 0.0f ? "building" : "slanting building", n, 1.0f, 0.03f);
    for (uint32_t i = 0; i + 1 < n && i < n / 8; i += 2) {
        int a = (int)(i / 2 % 3), b = (a + 1) % 3, c = (a + 2) % 3;
        float at = random_float(-1, 1), lo = random_float(-1, 0), hi = random_float(0, 1), quad[4][3];
        for (int k = 0; k < 4; k++) {
            quad[k][b] = k == 1 || k == 2 ? hi : lo;
            quad[k][c] = k >= 2 ? hi : lo;
            quad[k][a] = at + slant * (quad[k][b] + 0.5f * quad[k][c]);
        }
        static const int corners[6] = {0, 1, 2, 0, 2, 3};
        for (int k = 0; k < 6; k++) memcpy(s.vertices + 9 * i + 3 * k, quad[corners[k]], sizeof quad[0]);
    }
    return s;
}

static void set_finish(set *s)
{
    for (size_t i = 0; i < 9 * (size_t)s->triangles; i++) s->scene_max = fmaxf(s->scene_max, fabsf(s->vertices[i]));
}

/* A point that something awkward may happen at: a vertex, on an edge, in a face, or anywhere. */
static void aim(const set *s, float *p)
{
    uint32_t kind = random_below(8);
    if (s->triangles && kind < 6) {
        const float *v = s->vertices + 9 * random_below(s->triangles);
        float a = random_float(0, 1), b = random_float(0, 1 - a);
        if (kind < 2) a = b = 0.0f;
        else if (kind < 4) b = 0.0f;
        for (int k = 0; k < 3; k++) p[k] = v[k] + a * (v[3 + k] - v[k]) + b * (v[6 + k] - v[k]);
    } else {
        for (int k = 0; k < 3; k++) p[k] = s->size * random_float(-1.2, 1.2);
    }
}

/* Rays between awkward points; along axes in the planes of boxes; with components of 0, -0 and nearly 0. */
static void make_rays(const set *s, float *queue, uint32_t fields, uint32_t skip_field, bool normalize)
{
    uint32_t *words = (uint32_t *)queue;
    for (uint32_t i = 0; i < RAYS; i++) {
        float o[3], to[3], d[3];
        aim(s, o);
        aim(s, to);
        uint32_t kind = i % 8;
        if (kind < 2) for (int k = 0; k < 3; k++) o[k] = s->size * random_float(-3, 3);
        for (int k = 0; k < 3; k++) d[k] = to[k] - o[k];
        if (kind == 3 || kind == 4) { /* one or two components are 0, of either sign */
            d[i / 8 % 3] = test_random_u64() & 1 ? 0.0f : -0.0f;
            if (kind == 4) d[(i / 8 + 1) % 3] = test_random_u64() & 1 ? 0.0f : -0.0f;
            if (i / 64 % 2) for (int k = 0; k < 3; k++) o[k] = d[k] == 0.0f ? to[k] : o[k];
        }
        if (kind == 5) d[i / 8 % 3] *= (float)pow(10.0, -(double)random_below(24));
        if (kind == 6) for (int k = 0; k < 3; k++) o[k] = to[k] - 300.0f * (to[k] - o[k]); /* from afar */
        if (kind == 6) for (int k = 0; k < 3; k++) d[k] = to[k] - o[k];
        float length = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        if (!(length > 0.0f)) d[2] = length = 1.0f;
        float scale = normalize ? 1.0f / length : (i % 3 ? 1.0f : random_float(0.5, 2.0));
        for (int k = 0; k < 3; k++) {
            queue[(uint32_t)k * RAYS + i] = o[k];
            queue[(3 + (uint32_t)k) * RAYS + i] = d[k] * scale;
        }
        words[skip_field * RAYS + i] = EC_NO_ID;
        if (fields > EC_PATH_FIELDS - 1 && s->triangles && i % 5 == 0) words[skip_field * RAYS + i] = random_below(s->triangles);
    }
}

typedef struct layouts {
    ec_bvh2_node *nodes;
    ec_tri *triangles;
    ec_box *boxes;
    ec_bvh8_node *wide_nodes;
    ec_tri8 *blocks;
    ec_box8 *wide_boxes;
    uint32_t node_count, triangle_count, wide_node_count, block_count;
} layouts;

/* bvh: the tree they come from, for ec_bvh_free. */
static bool make_layouts(const set *s, layouts *l, ec_bvh *bvh)
{
    ec_error err = {""};
    int before = test_failures;
    uint32_t *indices = malloc((3 * (size_t)s->triangles + 1) * sizeof *indices);
    for (uint32_t i = 0; i < 3 * s->triangles; i++) indices[i] = i;
    *l = (layouts){0};
    CHECK_OK(ec_bvh_build(s->vertices, indices, s->triangles, 1, bvh, NULL, &err), err);
    CHECK_OK(ec_bvh2_layout(bvh, s->vertices, indices, &l->nodes, &l->node_count, &l->triangles, &l->boxes, &l->triangle_count, &err), err);
    CHECK_OK(ec_bvh8_layout(bvh, s->vertices, indices, &l->wide_nodes, &l->wide_node_count, &l->blocks, &l->wide_boxes, &l->block_count, &err), err);
    free(indices);
    return test_failures == before;
}

static void free_layouts(layouts *l)
{
    free(l->nodes);
    free(l->triangles);
    free(l->wide_nodes);
    free(l->blocks);
    free(l->boxes);
    free(l->wide_boxes);
}

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

/* Brute force is a tree that culls nothing: all of space in every box, and references one by one in the order of bvh, or
 * without that whole triangles in scene order. Such a tree goes through the same kernels. */
static layouts make_brute(const set *s, const ec_bvh *bvh)
{
    uint32_t count = bvh ? bvh->ref_count : s->triangles;
    layouts l = {.nodes = calloc(count + 2, sizeof *l.nodes), .triangles = calloc(count + 1, sizeof *l.triangles),
                 .triangle_count = count};
    if (bvh && bvh->boxes) l.boxes = memcpy(malloc(count * sizeof *l.boxes), bvh->boxes, count * sizeof *l.boxes);
    for (uint32_t k = 0; k < count; k++) {
        uint32_t i = bvh ? bvh->order[k] : k;
        ec_tri *t = &l.triangles[k];
        const float *v = s->vertices + 9 * i;
        memcpy(t->v0, v, sizeof t->v0);
        memcpy(t->v1, v + 3, sizeof t->v1);
        memcpy(t->v2, v + 6, sizeof t->v2);
        t->id = i;
    }
    everywhere_node(l.nodes, &l.node_count, 0, count);
    return l;
}

static uint32_t zero = 0;
static float nothing[256];

#define NO_ATTRIBUTES IN(nothing, 16), IN(nothing, 16), IN(nothing, 16), IN(nothing, 16), IN(nothing, 64), IN(nothing, 16), \
    IN(nothing, 16), IN(nothing, 256)
#define BOXES(boxes, count) IN(boxes, (boxes) ? (count) : 0)
#define WAVE IN(&params, 1), SCALAR(zero), SCALAR(zero), SCALAR(zero), SCALAR(zero), IN(&counters, 1)

/* Closest hits of a path queue. lanes_index LANE_WIDTHS is the 8-wide BVH. */
static bool intersect(const set *s, const layouts *l, int lanes_index, uint32_t wave, uint32_t count, const float *paths, float *hits)
{
    ec_params params = {.wave = wave, .part = wave, .batch = 1, .width = 1, .height = 1, .scene_max = s->scene_max};
    ec_counters counters = {.rays = {{count}}};
    if (lanes_index == LANE_WIDTHS)
        return KERNEL_CALL(&cl, wide_program, "ec_intersect_bvh8", count, WAVE, IN(paths, EC_PATH_FIELDS * wave),
                           OUT(hits, EC_HIT_FIELDS * wave), IN(l->wide_nodes, l->wide_node_count), IN(l->blocks, l->block_count),
                           BOXES(l->wide_boxes, l->block_count), NO_ATTRIBUTES);
    uint32_t lanes = (uint32_t)lane_widths[lanes_index];
    return KERNEL_CALL(&cl, packet_programs[lanes_index], "ec_intersect_packet", (count + lanes - 1) / lanes, WAVE,
                       IN(paths, EC_PATH_FIELDS * wave), OUT(hits, EC_HIT_FIELDS * wave), IN(l->nodes, l->node_count),
                       IN(l->triangles, l->triangle_count), BOXES(l->boxes, l->triangle_count), NO_ATTRIBUTES);
}

static bool connect(const set *s, const layouts *l, int lanes_index, const float *shadows, float *radiance)
{
    ec_params params = {.wave = RAYS, .part = RAYS, .batch = 1, .width = 1, .height = 1, .scene_max = s->scene_max};
    ec_counters counters = {.shadows = {{COUNT}}};
    uint32_t invalid[EC_STAGE_COUNT] = {0};
    memset(radiance, 0, 3 * RAYS * sizeof *radiance);
    bool good;
    if (lanes_index == LANE_WIDTHS) {
        good = KERNEL_CALL(&cl, wide_program, "ec_connect_bvh8", COUNT, WAVE, OUT(invalid, EC_STAGE_COUNT),
                           IN(shadows, EC_SHADOW_FIELDS * RAYS), OUT(radiance, 3 * RAYS), IN(l->wide_nodes, l->wide_node_count),
                           IN(l->blocks, l->block_count), BOXES(l->wide_boxes, l->block_count), NO_ATTRIBUTES);
    } else {
        uint32_t lanes = (uint32_t)lane_widths[lanes_index];
        good = KERNEL_CALL(&cl, packet_programs[lanes_index], "ec_connect_packet", (COUNT + lanes - 1) / lanes, WAVE,
                           OUT(invalid, EC_STAGE_COUNT), IN(shadows, EC_SHADOW_FIELDS * RAYS), OUT(radiance, 3 * RAYS),
                           IN(l->nodes, l->node_count), IN(l->triangles, l->triangle_count), BOXES(l->boxes, l->triangle_count),
                           NO_ATTRIBUTES);
    }
    for (int i = 0; i < EC_STAGE_COUNT; i++) CHECK(invalid[i] == 0);
    return good;
}

static const char *kernel_label(int lanes_index)
{
    static char text[32];
    if (lanes_index == LANE_WIDTHS) return "8-wide BVH";
    snprintf(text, sizeof text, "packets of %d", lane_widths[lanes_index]);
    return text;
}

static void print_ray(const set *s, const float *queue, uint32_t i, uint32_t prim)
{
    fprintf(stderr, "  o");
    for (uint32_t k = 0; k < 6; k++) fprintf(stderr, "%s%a", k == 3 ? " d " : " ", (double)queue[k * RAYS + i]);
    fprintf(stderr, " scene_max %a", (double)s->scene_max);
    for (uint32_t k = 0; prim != EC_NO_ID && k < 9; k++) fprintf(stderr, "%s%a", k % 3 ? " " : " v ", (double)s->vertices[9 * prim + k]);
    fputc('\n', stderr);
}

static uint32_t same_hits(const set *s, const float *paths, const float *hits, const float *expected, const char *label)
{
    const uint32_t *got = (const uint32_t *)hits, *want = (const uint32_t *)expected;
    uint32_t wrong = 0, hit = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        bool same = true;
        for (uint32_t f = 0; f < EC_HIT_FIELDS; f++) same &= got[f * RAYS + i] == want[f * RAYS + i];
        hit += want[i] != EC_NO_ID;
        if (same || wrong++) continue;
        fprintf(stderr, "%s, %s: ray %u hits %d (b %.9g %.9g), brute force %d (b %.9g %.9g)\n", s->name, label, i,
                (int)got[i], (double)hits[RAYS + i], (double)hits[2 * RAYS + i], (int)want[i], (double)expected[RAYS + i],
                (double)expected[2 * RAYS + i]);
        print_ray(s, paths, i, want[i]);
    }
    CHECK_MSG(wrong == 0, "%s, %s: %u of %u rays differ", s->name, label, wrong, COUNT);
    return hit;
}

static void check_closest(const set *s, const layouts *l, const layouts *brute, float *queue, float *expected)
{
    make_rays(s, queue, EC_PATH_FIELDS, EC_PATH_PRIM, true);
    if (!intersect(s, brute, LANE_WIDTHS - 1, RAYS, COUNT, queue, expected)) return;
    float *hits = calloc(EC_HIT_FIELDS * RAYS, sizeof *hits);
    uint32_t hit = 0;
    for (int i = 0; i <= LANE_WIDTHS; i++)
        if (intersect(s, l, i, RAYS, COUNT, queue, hits)) hit = same_hits(s, queue, hits, expected, kernel_label(i));
    /* Rays that meet nothing prove little. */
    if (s->triangles) CHECK_MSG(hit > COUNT / 20, "%s: only %u rays hit", s->name, hit);
    free(hits);
}

static void check_shadows(const set *s, const layouts *l, const layouts *brute, float *queue, float *expected)
{
    make_rays(s, queue, EC_SHADOW_FIELDS, EC_SHADOW_PRIM, false);
    uint32_t *words = (uint32_t *)queue;
    for (uint32_t i = 0; i < RAYS; i++) {
        words[EC_SHADOW_SLOT * RAYS + i] = RAYS - 1 - i;
        words[EC_SHADOW_TARGET * RAYS + i] = s->triangles && i % 3 == 0 ? random_below(s->triangles) : EC_NO_ID;
        for (uint32_t c = 0; c < 3; c++) queue[(EC_SHADOW_LR + c) * RAYS + i] = (float)(1 + c);
    }
    if (!connect(s, brute, LANE_WIDTHS - 1, queue, expected)) return;
    uint32_t open = 0;
    float *radiance = calloc(3 * RAYS, sizeof *radiance);
    for (int k = 0; k <= LANE_WIDTHS; k++) {
        if (!connect(s, l, k, queue, radiance)) continue;
        uint32_t wrong = 0;
        for (uint32_t i = 0; i < RAYS; i++) {
            uint32_t slot = RAYS - 1 - i;
            float light = expected[slot];
            if (i >= COUNT && light != 0.0f) wrong++;
            open += light != 0.0f;
            if (radiance[slot] == light && radiance[RAYS + slot] == 2 * light && radiance[2 * RAYS + slot] == 3 * light) continue;
            if (!wrong++) print_ray(s, queue, i, EC_NO_ID);
        }
        CHECK_MSG(wrong == 0, "%s, %s: %u of %u shadow rays differ", s->name, kernel_label(k), wrong, COUNT);
    }
    open /= LANE_WIDTHS + 1;
    if (s->triangles > 1) CHECK_MSG(open > COUNT / 50 && open < COUNT - COUNT / 50, "%s: %u of %u shadow rays arrive", s->name, open, COUNT);
    free(radiance);
}

/* Hits of the brute force's own with the references in reverse order: order must not matter. */
static void check_order(const set *s, const ec_bvh *bvh, const float *queue, const float *expected)
{
    layouts reversed = make_brute(s, bvh);
    for (uint32_t i = 0, k = reversed.triangle_count; i + 1 < k--; i++) {
        ec_tri swap = reversed.triangles[i];
        reversed.triangles[i] = reversed.triangles[k];
        reversed.triangles[k] = swap;
        if (!reversed.boxes) continue;
        ec_box box = reversed.boxes[i];
        reversed.boxes[i] = reversed.boxes[k];
        reversed.boxes[k] = box;
    }
    float *hits = calloc(4 * RAYS, sizeof *hits);
    if (intersect(s, &reversed, 0, RAYS, COUNT, queue, hits)) same_hits(s, queue, hits, expected, "reverse order");
    free(hits);
    free_layouts(&reversed);
}

/* Whole triangles give the same hits as their parts. Not for a ray within a triangle's plane, which has no point to hit: its
 * distance is rounding alone, clamped into whichever box the ray goes through. */
static void check_parts(const set *s, const float *queue, const float *expected)
{
    layouts whole = make_brute(s, NULL);
    float *hits = calloc(4 * RAYS, sizeof *hits);
    const uint32_t *got = (const uint32_t *)hits, *want = (const uint32_t *)expected;
    uint32_t other = 0;
    if (intersect(s, &whole, LANE_WIDTHS - 1, RAYS, COUNT, queue, hits))
        for (uint32_t i = 0; i < COUNT; i++) other += got[i] != want[i];
    printf("%s: %u of %u rays hit another triangle when none is cut\n", s->name, other, COUNT);
    CHECK_MSG(other <= COUNT / 500, "%s: %u rays hit another triangle when none is cut", s->name, other);
    free(hits);
    free_layouts(&whole);
}

static void check_set(set s, bool is_cut)
{
    layouts l, brute = {0};
    ec_bvh bvh = {0};
    set_finish(&s);
    float *queue = calloc(EC_SHADOW_FIELDS * RAYS + EC_PATH_FIELDS * RAYS, sizeof *queue), *expected = calloc(4 * RAYS, sizeof *expected);
    if (make_layouts(&s, &l, &bvh)) {
        CHECK_MSG(!bvh.boxes == !is_cut, "%s: %u references of %u triangles", s.name, bvh.ref_count, s.triangles);
        brute = make_brute(&s, &bvh);
        check_shadows(&s, &l, &brute, queue, expected);
        check_closest(&s, &l, &brute, queue, expected);
        check_order(&s, &bvh, queue, expected);
        if (is_cut) check_parts(&s, queue, expected);
        const uint32_t *prim = (const uint32_t *)expected, *skip = (const uint32_t *)queue + EC_PATH_PRIM * RAYS;
        bool all_copies = strcmp(s.name, "duplicated") == 0;
        for (uint32_t i = 0; all_copies && i < COUNT; i++) /* of four copies the lowest id, or if that is skipped another */
            if (prim[i] != EC_NO_ID && prim[i] >= s.triangles / 4 && prim[i] % (s.triangles / 4) != skip[i]) {
                CHECK_MSG(false, "ray %u hits copy %u", i, prim[i]);
                break;
            }
    }
    free_layouts(&l);
    free_layouts(&brute);
    ec_bvh_free(&bvh);
    free(queue);
    free(expected);
    free(s.vertices);
}

/* ---- a closed sphere from inside ---- */

typedef struct sphere {
    float *points;
    uint32_t *corners;
    uint32_t point_count, triangle_count;
} sphere;

static uint32_t sphere_point(sphere *s, double x, double y, double z)
{
    double length = sqrt(x * x + y * y + z * z);
    float *p = s->points + 3 * s->point_count;
    p[0] = (float)(x / length);
    p[1] = (float)(y / length);
    p[2] = (float)(z / length);
    for (uint32_t i = 0; i < s->point_count; i++) /* few enough for that */
        if (memcmp(s->points + 3 * i, p, 3 * sizeof *p) == 0) return i;
    return s->point_count++;
}

/* An octahedron, each triangle cut in four `levels` times. */
static sphere sphere_make(int levels)
{
    static const uint32_t faces[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    sphere s = {malloc(3 * 8192 * sizeof(float)), malloc(24 * sizeof(uint32_t)), 0, 8};
    for (int axis = 0; axis < 3; axis++)
        for (int side = 1; side >= -1; side -= 2) sphere_point(&s, axis == 0 ? side : 0, axis == 1 ? side : 0, axis == 2 ? side : 0);
    memcpy(s.corners, faces, sizeof faces);
    for (int level = 0; level < levels; level++) {
        uint32_t *finer = malloc(12 * s.triangle_count * sizeof *finer);
        for (uint32_t t = 0; t < s.triangle_count; t++) {
            const uint32_t *c = s.corners + 3 * t;
            uint32_t m[3];
            for (int k = 0; k < 3; k++) {
                const float *a = s.points + 3 * c[k], *b = s.points + 3 * c[(k + 1) % 3];
                m[k] = sphere_point(&s, (double)a[0] + b[0], (double)a[1] + b[1], (double)a[2] + b[2]);
            }
            const uint32_t four[12] = {c[0], m[0], m[2], m[0], c[1], m[1], m[2], m[1], c[2], m[0], m[1], m[2]};
            memcpy(finer + 12 * t, four, sizeof four);
        }
        free(s.corners);
        s.corners = finer;
        s.triangle_count *= 4;
    }
    return s;
}

#define SPHERE_RAYS 65536u

/* Rays at vertices, at edges and anywhere, from origins inside: none may leave. */
static void check_sphere(const sphere *shape, float scale, const float at[3], const float stretch[3], const char *name)
{
    set s = set_make(name, shape->triangle_count, scale);
    for (uint32_t i = 0; i < 3 * s.triangles; i++)
        for (int k = 0; k < 3; k++) s.vertices[3 * i + k] = at[k] + scale * stretch[k] * shape->points[3 * shape->corners[i] + k];
    set_finish(&s);
    layouts l;
    ec_bvh bvh = {0};
    float *paths = calloc(EC_PATH_FIELDS * SPHERE_RAYS, sizeof *paths), *hits = calloc(EC_HIT_FIELDS * SPHERE_RAYS, sizeof *hits);
    uint32_t *words = (uint32_t *)paths;
    for (uint32_t i = 0; i < SPHERE_RAYS; i++) {
        const float *v = s.vertices + 9 * random_below(s.triangles);
        float a = random_float(0, 1), b = random_float(0, 1 - a), o[3], d[3];
        if (i % 5 < 2) a = b = 0.0f;
        else if (i % 5 < 4) b = 0.0f;
        if (i % 7 == 0) a = 0.5f * (float)(i % 5 > 1);
        for (int k = 0; k < 3; k++) {
            o[k] = at[k] + scale * stretch[k] * (i % 11 == 0 ? 0.0f : random_float(-0.55, 0.55));
            d[k] = v[k] + a * (v[3 + k] - v[k]) + b * (v[6 + k] - v[k]) - o[k];
            if (i % 13 == 0 && k != (int)(i / 13 % 3)) { /* along an axis, through vertices of the equators */
                o[k] = i % 2 ? at[k] : v[k] * 0.5f + at[k] * 0.5f;
                d[k] = i % 4 < 2 ? 0.0f : -0.0f;
            }
        }
        float length = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        if (!(length > 0.0f)) d[0] = length = 1.0f;
        for (uint32_t k = 0; k < 3; k++) {
            paths[k * SPHERE_RAYS + i] = o[k];
            paths[(3 + k) * SPHERE_RAYS + i] = d[k] / length;
        }
        words[EC_PATH_PRIM * SPHERE_RAYS + i] = EC_NO_ID;
    }
    if (make_layouts(&s, &l, &bvh))
        for (int k = 2; k <= LANE_WIDTHS; k += 2) { /* packets of 8; the 8-wide BVH */
            if (!intersect(&s, &l, k, SPHERE_RAYS, SPHERE_RAYS, paths, hits)) continue;
            uint32_t leaks = 0, first = 0;
            for (uint32_t i = 0; i < SPHERE_RAYS; i++)
                if (((const uint32_t *)hits)[i] == EC_NO_ID && !leaks++) first = i;
            if (leaks) fprintf(stderr, "ray %u: %a %a %a, %a %a %a\n", first, paths[first], paths[SPHERE_RAYS + first],
                               paths[2 * SPHERE_RAYS + first], paths[3 * SPHERE_RAYS + first], paths[4 * SPHERE_RAYS + first],
                               paths[5 * SPHERE_RAYS + first]);
            CHECK_MSG(leaks == 0, "%s, %s: %u of %u rays leave a closed surface", name, kernel_label(k), leaks, SPHERE_RAYS);
        }
    free_layouts(&l);
    ec_bvh_free(&bvh);
    free(paths);
    free(hits);
    free(s.vertices);
}

static void closed_surfaces_have_no_cracks(void)
{
    sphere shape = sphere_make(4);
    CHECK(shape.triangle_count == 2048 && shape.point_count == 1026); /* closed: Euler's V - F / 2 = 2 */
    static const float here[3] = {0, 0, 0}, there[3] = {700.0f, -300.0f, 1.0f / 3}, round[3] = {1, 1, 1}, flat[3] = {1, 1e-4f, 1};
    check_sphere(&shape, 1.0f, here, round, "sphere");
    check_sphere(&shape, 1.0f, there, round, "sphere far away");
    check_sphere(&shape, 1e-6f, here, round, "tiny sphere");
    check_sphere(&shape, 1e6f, here, round, "huge sphere");
    check_sphere(&shape, 1.0f, here, flat, "flat ellipsoid");
    free(shape.points);
    free(shape.corners);
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    ec_error err = {""};
    const char *const packet[] = {"intersect_packet", "connect_packet", NULL}, *const wide[] = {"intersect_bvh8", "connect_bvh8", NULL};
    char *source = NULL;
    CHECK_OK(ec_kernel_sources_join(packet, &source, &err), err);
    for (int i = 0; source && i < LANE_WIDTHS; i++) {
        char options[64];
        snprintf(options, sizeof options, "-DFEATURES=0 -DLANES=%d", lane_widths[i]);
        CHECK_OK(ec_program_build(&cl, "traverse_packet", source, options, &packet_programs[i], &err), err);
    }
    free(source);
    CHECK_OK(ec_kernel_sources_join(wide, &source, &err), err);
    if (source) CHECK_OK(ec_program_build(&cl, "traverse_bvh8", source, "-DFEATURES=0 -DLANES=8", &wide_program, &err), err);
    free(source);
    if (!test_failures) {
        check_set(set_random("nothing", 0, 1.0f, 0.1f), false);
        check_set(set_random("one", 1, 1.0f, 1.0f), false);
        check_set(set_random("random", 1500, 1.0f, 0.1f), false);
        check_set(set_random("tiny", 1000, 1e-6f, 0.1f), false);
        check_set(set_random("huge", 1000, 1e6f, 0.1f), false);
        check_set(set_slivers(1500), false);
        for (int axis = 0; axis < 3; axis++) check_set(set_coplanar(500, axis), false);
        check_set(set_tilted(800), false);
        check_set(set_duplicated(800), false);
        check_set(set_blocks(1500), false);
        check_set(set_mixed(1000), false);
        check_set(set_fan(720), false);
        check_set(set_beams(4000), true);
        check_set(set_building(4000, 0.0f), true);
        check_set(set_building(4000, 0.4f), true);
        closed_surfaces_have_no_cracks();
    }
    for (int i = 0; i < LANE_WIDTHS; i++)
        if (packet_programs[i]) clReleaseProgram(packet_programs[i]);
    if (wide_program) clReleaseProgram(wide_program);
    ec_cl_close(&cl);
    TEST_END();
}

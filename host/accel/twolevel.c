/* A tree of instances over one tree for each mesh, beside the tree of the triangles that belong to no instance: nodes and blocks of all of them are
 * in one buffer each. Memory depends on the meshes, not on how many instances they have. */
#include <float.h>
#include <math.h>

#include "accel/accel_internal.h"
#include "accel/build_internal.h"
#include "accel/leaf.h"
#include "accel/shape_trees.h"
#include "base/freed.h"

#define OFF_BOUND 40.0 /* u |M^-1| (|o| + reach): derived in kernels/lib/traverse_twolevel.h */
#define UNIT 0x1p-24

/* One mesh, in its own space. */
typedef struct shape_facts {
    uint32_t root;
    double half[3];    /* largest |coordinate| */
    double edge[3];    /* longest edges of a triangle's box */
    ec_box parts[8];   /* the boxes below the root: together they hold the mesh, more closely than its own box */
    uint32_t part_count;
} shape_facts;

typedef struct twolevel {
    ec_bvh8 all;
    ec_instance *instances;
    uint32_t node_room, block_room;
    shape_facts *shapes;
} twolevel;

/* Appends a tree; its child references are shifted accordingly. */
static ec_result append(twolevel *t, const ec_bvh8 *tree, ec_error *err)
{
    ec_bvh8 *all = &t->all;
    const uint64_t nodes = (uint64_t)all->node_count + tree->node_count, blocks = (uint64_t)all->block_count + tree->block_count;
    if (nodes >= EC_INSTANCE_BIT || blocks >= EC_INSTANCE_BIT) return ec_fail(err, "more meshes than two levels of trees can number");
    if (!ec_reserve_lines(&all->nodes, &t->node_room, all->node_count, nodes, sizeof *all->nodes) ||
        !ec_reserve_lines(&all->blocks, &t->block_room, all->block_count, blocks, sizeof *all->blocks))
        return ec_fail(err, "out of memory for the trees of meshes");
    memcpy(all->nodes + all->node_count, tree->nodes, tree->node_count * sizeof *all->nodes);
    if (tree->block_count) memcpy(all->blocks + all->block_count, tree->blocks, tree->block_count * sizeof *all->blocks);
    for (uint32_t i = all->node_count; i < nodes; i++)
        for (int k = 0; k < 8; k++) {
            uint32_t *child = &all->nodes[i].child[k];
            if (!(*child & EC_LEAF_BIT)) *child += all->node_count;
            else if (!(*child & EC_INSTANCE_BIT)) *child += all->block_count; /* references to instances, and EC_NO_CHILD, stay as they are */
        }
    all->node_count = (uint32_t)nodes;
    all->block_count = (uint32_t)blocks;
    return EC_OK;
}

static void measure(const ec_accel_input *in, const ec_shape *shape, shape_facts *f)
{
    for (uint32_t i = 0; i < shape->count; i++) {
        const ec_box box = ec_triangle_box(in->positions, in->indices, shape->first + i);
        for (int k = 0; k < 3; k++) {
            f->half[k] = fmax(f->half[k], fmax(fabs(box.lo[k]), fabs(box.hi[k])));
            f->edge[k] = fmax(f->edge[k], (double)box.hi[k] - box.lo[k]);
        }
    }
}

static ec_result build_shape(const ec_accel_input *in, const ec_shape *shape, ec_bvh8 *tree, ec_error *err)
{
    const uint32_t *indices = in->indices + 3 * (size_t)shape->first;
    ec_bvh bvh;
    EC_TRY(ec_bvh_build_whole(in->positions, indices, shape->count, NULL, 0, in->threads, &bvh, NULL, err));
    ec_result result = ec_bvh8_layout(&bvh, in->positions, indices, tree, err);
    ec_bvh_free(&bvh);
    return result;
}

/* Returns the key of a mesh by itself, wherever its vertices lie among all. */
static ec_fingerprint key_of(const ec_accel_input *in, const ec_shape *shape)
{
    ec_fingerprint key = {{shape->count}};
    for (size_t i = 0; i < 3 * (size_t)shape->count; i++) {
        uint32_t corner = in->indices[3 * (size_t)shape->first + i] - shape->first_vertex;
        key = ec_fingerprint_add(key, &corner, sizeof corner);
    }
    return ec_fingerprint_add(key, in->positions + 3 * (size_t)shape->first_vertex,
                              3 * (size_t)shape->vertex_count * sizeof(float));
}

static void note_parts(const ec_bvh8_node *root, shape_facts *f)
{
    for (int k = 0; k < 8; k++) {
        if (root->child[k] == EC_NO_CHILD) continue;
        ec_box *part = &f->parts[f->part_count++];
        for (int axis = 0; axis < 3; axis++) {
            part->lo[axis] = root->bound[2 * axis][k];
            part->hi[axis] = root->bound[2 * axis + 1][k];
        }
    }
}

static ec_result append_shape(const ec_accel_input *in, uint32_t index, twolevel *t, ec_error *err)
{
    const ec_shape *shape = &in->shapes[index];
    shape_facts *f = &t->shapes[index];
    ec_shape_tree built = {.wanted = true};
    if (in->trees) built.key = key_of(in, shape);
    const ec_shape_tree *tree = in->trees ? ec_shape_trees_find(in->trees, built.key) : NULL;
    bool is_kept = tree != NULL;
    if (!is_kept) EC_TRY(build_shape(in, shape, &built.bvh, err));
    if (!is_kept) tree = &built;
    measure(in, shape, f);
    f->root = t->all.node_count;
    note_parts(&tree->bvh.nodes[0], f);
    ec_result result = append(t, &tree->bvh, err);
    if (!is_kept && in->trees && result == EC_OK) return ec_shape_trees_add(in->trees, &built, err);
    free(built.bvh.nodes);
    free(built.bvh.blocks);
    return result;
}

/* Returns the largest sum that rounding a corner of an instance goes through, along an axis. */
static double reach_of(const ec_placed *p, const shape_facts *f, int row)
{
    double sum = fabs(p->place[row][3]);
    for (int k = 0; k < 3; k++) sum += fabs(p->place[row][k]) * f->half[k];
    return sum;
}

static ec_box box_of(const ec_placed *p, const shape_facts *f)
{
    ec_box box = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
    for (uint32_t i = 0; i < f->part_count; i++)
        for (int row = 0; row < 3; row++) {
            double middle = p->place[row][3], half = 8 * UNIT * reach_of(p, f, row);
            for (int k = 0; k < 3; k++) {
                middle += p->place[row][k] * (0.5 * f->parts[i].lo[k] + 0.5 * f->parts[i].hi[k]);
                half += fabs(p->place[row][k]) * (0.5 * f->parts[i].hi[k] - 0.5 * f->parts[i].lo[k]);
            }
            box.lo[row] = fminf(box.lo[row], (float)(middle - half));
            box.hi[row] = fmaxf(box.hi[row], (float)(middle + half));
        }
    return box;
}

/* reach: no coordinate of the scene is larger. */
static ec_instance instance_of(const ec_placed *p, const shape_facts *f, double reach)
{
    ec_instance n = {.id = p->id, .root = f->root, .turned = p->mirrored, .reach = (float)(reach * 1.000001)};
    double m[3][3], longest = 0;
    for (int row = 0; row < 3; row++) {
        double edge = 0;
        memcpy(n.place[row], p->place[row], sizeof n.place[row]);
        for (int k = 0; k < 3; k++) {
            m[row][k] = p->place[row][k];
            edge += fabs(m[row][k]) * f->edge[k];
        }
        longest = fmax(longest, edge);
    }
    n.longest = (float)((longest + 16 * UNIT * reach) * 1.000001);
    double inverse[3][3], determinant = 0;
    for (int row = 0; row < 3; row++)
        for (int k = 0; k < 3; k++) {
            int a = (k + 1) % 3, b = (k + 2) % 3, c = (row + 1) % 3, d = (row + 2) % 3;
            inverse[row][k] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
    for (int k = 0; k < 3; k++) determinant += m[0][k] * inverse[k][0];
    for (int row = 0; row < 3; row++) {
        double sum = 0;
        for (int k = 0; k < 3; k++) {
            n.inverse[row][k] = (float)(inverse[row][k] / determinant);
            sum += fabs(inverse[row][k] / determinant);
        }
        n.inverse[row][3] = (float)(OFF_BOUND * UNIT * sum);
    }
    return n;
}

static ec_result add_instances(const ec_accel_input *in, twolevel *t, ec_error *err)
{
    double reach = 0;
    for (size_t i = 0; i < 3 * (size_t)in->triangle_count; i++)
        for (int k = 0; k < 3; k++) reach = fmax(reach, fabs(in->positions[3 * (size_t)in->indices[i] + (size_t)k]));
    for (uint32_t i = 0; i < in->placed_count; i++)
        for (int row = 0; row < 3; row++) reach = fmax(reach, reach_of(&in->placed[i], &t->shapes[in->placed[i].shape], row));
    const uint32_t root = t->all.node_count;
    ec_bvh8 top = {0};
    EC_FREED ec_box *boxes = malloc(in->placed_count * sizeof *boxes);
    t->instances = ec_allocate_lines(in->placed_count + (size_t)1, sizeof *t->instances);
    ec_result result = boxes && t->instances ? EC_OK : ec_fail(err, "out of memory for %u instances", in->placed_count);
    for (uint32_t i = 0; result == EC_OK && i < in->placed_count; i++) {
        boxes[i] = box_of(&in->placed[i], &t->shapes[in->placed[i].shape]);
        t->instances[i + 1] = instance_of(&in->placed[i], &t->shapes[in->placed[i].shape], reach);
    }
    if (result == EC_OK) result = ec_bvh8_of_boxes(boxes, in->placed_count, in->threads, &top, err);
    if (result == EC_OK) result = append(t, &top, err);
    if (result == EC_OK) t->instances[0] = (ec_instance){.root = root};
    free(top.nodes);
    return result;
}

ec_result ec_twolevel_accel(ec_accel_input *in, ec_accel *accel, ec_error *err)
{
    EC_FREED shape_facts *shapes = calloc(in->shape_count + (size_t)1, sizeof *shapes);
    twolevel t = {.shapes = shapes};
    if (!shapes) return ec_fail(err, "out of memory for %u meshes", in->shape_count);
    EC_TRY(ec_accel_bvh(in, err));
    EC_TRY(ec_bvh8_layout(&in->bvh, in->positions, in->indices, &t.all, err));
    ec_result result = EC_OK;
    const uint64_t box_bytes = t.all.boxes ? t.all.block_count * (uint64_t)sizeof *t.all.boxes : 0; /* if triangles were cut: there are no instances then */
    uint64_t references = in->bvh.ref_count;
    t.node_room = t.all.node_count;
    t.block_room = t.all.block_count;
    for (uint32_t i = 0; result == EC_OK && i < in->shape_count; i++) {
        result = append_shape(in, i, &t, err);
        references += in->shapes[i].count;
    }
    if (result == EC_OK && in->placed_count) result = add_instances(in, &t, err);
    accel->buffers[0] = (ec_accel_buffer){"nodes", t.all.nodes, (uint64_t)t.all.node_count * sizeof *t.all.nodes};
    accel->buffers[1] = (ec_accel_buffer){"triangle blocks", t.all.blocks, (uint64_t)t.all.block_count * sizeof *t.all.blocks};
    if (t.all.boxes) accel->buffers[2] = (ec_accel_buffer){"boxes", t.all.boxes, box_bytes};
    if (t.instances) accel->buffers[3] = (ec_accel_buffer){"instances", t.instances, (in->placed_count + (uint64_t)1) * sizeof *t.instances};
    accel->stats = (ec_accel_stats){.nodes = t.all.node_count, .leaves = t.all.block_count, .references = references,
                                    .sah_cost = in->placed_count ? 0.0 : in->bvh_stats.sah_cost};
    return result;
}

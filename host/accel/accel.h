/* Acceleration structures behind one interface. Each is a builder that writes the buffers its kernels read
 * (kernels/lib/traverse_NAME.h); who renders knows only this table. All find the same hits bit for bit. Knows nothing of
 * OpenCL. */
#ifndef EC_ACCEL_ACCEL_H
#define EC_ACCEL_ACCEL_H

#include <stdbool.h>

#include "accel/bvh.h"
#include "scene/placed.h"

/* The triangles to build from. positions: 3 floats a vertex; indices: 3 a triangle; both the caller's. */
typedef struct ec_accel_input {
    const float *positions;
    const uint32_t *indices;
    uint32_t triangle_count;
    uint32_t vertex_count;      /* of all positions; 0: not told, which only follow.h minds */
    bool whole;                 /* no triangle may be cut */
    const float *swept;         /* of the first triangles, which move: 6 floats each, the box over all the places they take, which stands */
    uint32_t swept_count;       /* for them (motion.h in kernels/lib takes their corners); with any, `whole` is meant */
    uint32_t shape_count, placed_count; /* instances; twolevel alone knows them, and takes them whole */
    const ec_shape *shapes;     /* their triangles lie in indices too, behind those that are counted here */
    const ec_placed *placed;
    uint32_t threads;           /* 0 = all; the result is the same for any number */
    float grid_density;         /* cells a reference, within what grid.c allows; 0 = EC_GRID_DENSITY */
    ec_bvh bvh;                 /* built when first asked for, and shared: see ec_accel_bvh */
    ec_bvh_stats bvh_stats;
    struct ec_shape_trees *trees; /* of meshes that may have been built before; NULL: none are kept */
} ec_accel_input;
void ec_accel_input_free(ec_accel_input *input); /* what was built on the way, not what the caller gave */

typedef struct ec_accel_buffer {
    const char *label;
    void *data;                 /* malloc'ed, owned */
    uint64_t bytes;
} ec_accel_buffer;

typedef struct ec_accel_stats {
    double build_seconds;       /* of this build; a BVH that was there already is not in it */
    uint64_t bytes;             /* of all buffers */
    uint64_t nodes;             /* or cells */
    uint64_t leaves;            /* blocks of triangles, or cells that are not empty */
    uint64_t references;        /* triangles in all leaves */
    double sah_cost;            /* expected cost of a ray in visits to a binary node; 0 where that means nothing */
} ec_accel_stats;

typedef struct ec_accel {
    ec_accel_buffer buffers[EC_ACCEL_BUFFERS]; /* in the order of the kernels' arguments; data NULL: not used */
    ec_accel_stats stats;
} ec_accel;

typedef struct ec_accel_kind {
    const char *name;           /* of --accel, and of kernels/lib/traverse_NAME.h */
    const char *summary;
    uint32_t lanes;             /* of its kernels: 8 = one ray a work-item, 0 = packets as wide as the device likes */
    ec_result (*build)(ec_accel_input *input, ec_accel *accel, ec_error *err); /* may leave half of it on failure */
} ec_accel_kind;

#define EC_GRID_DENSITY 27.0f   /* three cells along each axis for every object that a row holds */

/* Every kind: name, lanes, summary; ec_NAME_accel builds it. Packets come first: trials begin with them (device/trace.c). */
#define EC_ACCELS(X)                                                                               \
    X(bvh2, 0, "binary BVH, packets of rays")                                                      \
    X(bvh8, 8, "8-wide BVH, one ray against eight boxes")                                          \
    X(grid, 8, "uniform grid, one ray against 64 cells")                                           \
    X(kdtree, 8, "kd-tree, one ray against seven planes")                                          \
    X(none, 8, "every triangle with every ray")                                                    \
    X(twolevel, 8, "8-wide BVHs, one a mesh under one of instances")

#define EC_ACCEL_ONE(name, lanes, summary) +1
enum { EC_ACCEL_COUNT = EC_ACCELS(EC_ACCEL_ONE) };
extern const ec_accel_kind ec_accels[EC_ACCEL_COUNT];
extern const char *const ec_accel_names[]; /* "auto" and theirs, NULL-terminated */

/* Index of the kind with that name; EC_ACCEL_COUNT if there is none. */
uint32_t ec_accel_find(const char *name);
/* "auto" or NULL, or a name: a bit for each kind worth having. Where there are several, the fastest wins by trial. */
ec_result ec_accels_choose(const char *name, uint32_t triangle_count, bool is_cpu, uint32_t *chosen, ec_error *err);

/* Kinds (bits) that trace one ray a work-item, out of those given; the given ones where there is none. A render needs no others: packets make it
 * faster, but their kernels compile for longer. */
uint32_t ec_accels_needed(uint32_t chosen);

/* accel need not be initialised; it is empty after a failure. */
ec_result ec_accel_build(uint32_t which, ec_accel_input *input, ec_accel *accel, ec_error *err);
void ec_accel_free(ec_accel *accel);

#endif

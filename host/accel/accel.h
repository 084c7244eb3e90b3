/* Acceleration structures behind one interface. Each is a builder that writes the buffers its kernels read (kernels/lib/traverse_NAME.h); a render
 * knows only this table. All find the same hits bit for bit. Knows nothing of OpenCL. */
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
    uint32_t vertex_count;      /* of all positions; 0: not given, which only follow.h needs */
    bool whole;                 /* no triangle may be cut */
    const float *swept;         /* of the first triangles, which move: 6 floats each, the box over all the places they take, which stands in */
    uint32_t swept_count;       /* for them (motion.h in kernels/lib makes their corners); if there are any, `whole` is implied */
    uint32_t shape_count, placed_count; /* instances; only twolevel supports them, and does not cut them */
    const ec_shape *shapes;     /* their triangles lie in indices too, behind the triangle_count counted here */
    const ec_placed *placed;
    uint32_t threads;           /* 0 = all; the result is the same for any number */
    float grid_density;         /* cells a reference, within what grid.c allows; 0 = EC_GRID_DENSITY */
    ec_bvh bvh;                 /* built when first asked for, and shared: see ec_accel_bvh */
    ec_bvh_stats bvh_stats;
    struct ec_shape_trees *trees; /* trees of meshes that may have been built before; NULL: none are kept */
} ec_accel_input;
void ec_accel_input_free(ec_accel_input *input); /* frees what was built, not what the caller gave */

typedef struct ec_accel_buffer {
    const char *label;
    void *data;                 /* malloc'ed, owned */
    uint64_t bytes;
} ec_accel_buffer;

typedef struct ec_accel_stats {
    double build_seconds;       /* of this build, without a BVH that was there already */
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
    ec_result (*build)(ec_accel_input *input, ec_accel *accel, ec_error *err); /* may leave a partial result on failure */
} ec_accel_kind;

#define EC_GRID_DENSITY 27.0f   /* three cells along each axis for every object in a row */

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
extern const char *const ec_accel_names[]; /* "auto" and the kinds' names, NULL-terminated */

/* Returns the index of the kind with that name; EC_ACCEL_COUNT if there is none. */
uint32_t ec_accel_find(const char *name);
/* Sets a bit for each kind worth having, by "auto" (or NULL) or a kind's name. If there are several, the fastest is found by trial. */
ec_result ec_accels_choose(const char *name, uint32_t triangle_count, bool is_cpu, uint32_t *chosen, ec_error *err);

/* Returns the kinds (bits) out of those given that trace one ray per work-item, or the given ones if there is none. A render needs no others: packets
 * make it faster, but their kernels take longer to compile. */
uint32_t ec_accels_needed(uint32_t chosen);

/* Builds a structure. accel need not be initialised; it is empty after a failure. */
ec_result ec_accel_build(uint32_t which, ec_accel_input *input, ec_accel *accel, ec_error *err);
void ec_accel_free(ec_accel *accel);

#endif

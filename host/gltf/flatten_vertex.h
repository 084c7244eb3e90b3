/* Shared by the parts of flattening: flatten*.c, keep*.c, empty.c and motion*.c. */
#ifndef EC_GLTF_FLATTEN_VERTEX_H
#define EC_GLTF_FLATTEN_VERTEX_H

#include "gltf/flatten.h"

/* One primitive at one place. */
typedef struct ec_draw {
    const ec_gltf *g;
    const ec_gltf_primitive *p;
    const ec_placement *at;
    int32_t mesh;            /* the mesh of p */
    const double *center;    /* subtracted from world positions */
    double normal_matrix[9];
    bool mirrored;
} ec_draw;

typedef struct ec_flattener {
    ec_scene *scene;
    const ec_log *log;
    ec_error *err;
    double low[3], high[3];
    uint64_t vertex_bound, triangle_bound;
    struct ec_odd_values {
        uint64_t count;
        int32_t mesh; /* index in the file of the mesh with the first one */
    } odd_uv, odd_colors, odd_normals;
    uint32_t *remap; /* by vertex of a primitive, less its lowest: vertex of the scene */
    uint64_t remap_size;
    unsigned streams;    /* bits of the streams that any primitive has */
    ec_source *sources;  /* NULL: not wanted */
    uint32_t placement;  /* the placement being drawn, or EC_STILL */
    int32_t node;        /* node of the triangles being drawn; -1: a mesh that is kept once */
    const bool *is_kept; /* by placement: it is an instance of a mesh that is kept once. NULL: none is */
} ec_flattener;

typedef ec_result (*ec_draw_function)(ec_flattener *f, const ec_draw *d);
/* flatten_draw.c: calls the function for all primitives of a mesh at one place. */
ec_result ec_flattener_draw(ec_flattener *f, const ec_gltf *g, int32_t mesh, const ec_placement *at, const double *center,
                            ec_draw_function function);
ec_result ec_flattener_count(ec_flattener *f, const ec_draw *d); /* first pass: counts how much there can be at most */
ec_result ec_flattener_fill(ec_flattener *f, const ec_draw *d);  /* second pass: appends the triangles */

/* Tells whether all three corners are at positions that a scene can hold. */
bool ec_is_placeable(const double world[3][3]);
/* Beyond this, squares of distances no longer fit a float; such a position counts as infinite. */
#define EC_MAX_COORDINATE 1e18

/* Computes a vertex' normal (3 floats) and tangent (4) in the world; either may be NULL. What the mesh lacks is left unchanged. */
void ec_draw_frame(const ec_draw *d, uint32_t vertex, float *normal, float *tangent);
/* Returns a draw for a place; the caller sets p. */
ec_draw ec_draw_of(const ec_gltf *g, const ec_placement *at, const double *center);

/* Computes a vertex' position in the world. */
void ec_draw_world_position(const ec_draw *d, uint32_t vertex, double out[3]);
/* Gets a triangle's corners. Returns false if a scene cannot hold one of their positions. */
bool ec_draw_corners(const ec_draw *d, uint64_t triangle, uint32_t vertices[3], double world[3][3]);

/* Grows a box by the triangles of a primitive whose corners all have positions that a scene can hold. */
void ec_draw_span(const ec_draw *d, double low[3], double high[3]);

/* Appends a vertex with all of its streams; `position` is the recentred one. Returns its index. */
uint32_t ec_flattener_append_vertex(ec_flattener *f, const ec_draw *d, uint32_t vertex, const float position[3]);

/* node_parts.c: ec_scene.parts tells which node a triangle belongs to. Makes room for `most` parts, and copies the nodes' names. */
ec_result ec_parts_start(ec_scene *scene, const ec_gltf *gltf, uint32_t most, ec_error *err);
void ec_part_add(ec_scene *scene, uint32_t first, uint32_t node); /* triangles from id `first` on belong to the node; ids ascend */

/* empty.c: called if no triangle is left. Warns why, or fails. */
ec_result ec_flatten_empty(const ec_flattener *f, const ec_gltf *g, const ec_placement_list *placements);

#endif

/* What the two halves of flattening share. Only flatten.c and flatten_vertex.c include this. */
#ifndef EC_SCENE_FLATTEN_VERTEX_H
#define EC_SCENE_FLATTEN_VERTEX_H

#include "scene/flatten.h"

/* One primitive at one place. */
typedef struct ec_draw {
    const ec_gltf *g;
    const ec_gltf_primitive *p;
    const ec_placement *at;
    double normal_matrix[9];
    bool mirrored;
} ec_draw;

typedef struct ec_flattener {
    ec_scene *scene;
    const ec_log *log;
    ec_error *err;
    double low[3], high[3];
    uint64_t vertex_bound, triangle_bound, odd_values;
    uint32_t *remap; /* primitive's vertex - lowest -> scene's vertex */
    uint64_t remap_size;
    bool has_normals, has_tangents, has_uv[2], has_colors;
} ec_flattener;

/* Where a vertex lies in the world. */
void ec_draw_world_position(const ec_draw *d, uint32_t vertex, double out[3]);

/* Appends a vertex with all of its streams; `position` is the recentred one. Returns its index. */
uint32_t ec_flattener_append_vertex(ec_flattener *f, const ec_draw *d, uint32_t vertex, const float position[3]);

#endif

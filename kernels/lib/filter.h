/* Filters out hits that do not count: backs of single-sided surfaces for camera rays, and points that coverage leaves open. Whether a ray passes is a
 * function of (seed, slot's sample, bounce, triangle), never of traversal order. */
#ifndef EC_LIB_FILTER_H
#define EC_LIB_FILTER_H

#include "../shared/params.h"
#include "geometry.h"
#include "sampler.h"

typedef struct hit_filter {
    geometry g;
    lane_u key;      /* random key of this ray */
    bool cull_backs; /* camera rays */
    lane_i *panes;   /* if not NULL, possible panes do not count, and their lanes are set here (lib/pane.h) */
} hit_filter;

/* Kernel parameters that a hit_filter needs; alpha comes from textures. */
#define FILTER_PARAMETERS(DO)                                                                                                                         \
    DO(global const float *, prims) DO(global const float *, indices) DO(global const float *, uvs) DO(global const float *, colors)                  \
    DO(global const float *, materials) DO(global const float *, texture_table) DO(global const uint *, texels) DO(constant float *, srgb)            \
    DO(global const float *, places) DO(global const float *, motion) DO(global const float *, times) DO(global const uint *, coplanar)
#define FILTER_GEOMETRY {prims, indices, 0, 0, uvs, colors, materials, {texture_table, texels, srgb}, places, motion}
/* times: those of the paths, by slot. */
#define HAS_TIMES (HAS(MOTION) && motion != 0)
/* Shadow rays of light paths lead to the camera, so backs are culled for them as for camera rays. */
#define CAMERA_SHADOWS(bounce) (HAS(LIGHT_PATHS) && ((bounce) & EC_LIGHT_BOUNCE) != 0u)

/* Returns the random key of a ray. bounce: number of vertices before it. Keys of shadow rays differ from those of path rays. */
EC_FN lane_u filter_key(uint seed, lane_u pixel, lane_u sample, uint bounce, bool is_shadow)
{
    return hash_u(hash_u(hash_u(pixel) ^ seed) + sample * 0x9e3779b9u + (2u * bounce + (is_shadow ? 1u : 0u)) * 0x85ebca6bu);
}

/* Returns which of the candidate hits (mask m) count. */
EC_FN lane_i filter_hits(const hit_filter *f, lane_i m, lane_u prim, lane_f b1, lane_f b2, lane_i front)
{
    bool culls = HAS(CULLING) ? f->cull_backs : false;
    bool opens = HAS(PANES) ? f->panes != 0 : false;
    if (!HAS(ALPHA) & !culls & !opens) return m;
    lane_u id = m ? prim : U(0);
    lane_u flags = as_lane_u(gather_f(f->g.prims, geometry_prim(&f->g, id) * EC_PRIM_WORDS + 11u));
    if (culls) m = m & (front | ((flags & EC_PRIM_SINGLE_SIDED) == 0u));
    if (opens) {
        lane_i pane = m & ((flags & EC_PRIM_PANE) != 0u);
        *f->panes = *f->panes | pane;
        m = m & !pane;
    }
    if (HAS(ALPHA)) {
        lane_i look = m & ((flags & EC_PRIM_ALPHA) != 0u);
        if (any_lane(look)) {
            hit_point h = hit_point_make(&f->g, id, b1, b2);
            lane_f chance = to_unit(hash_u(f->key ^ hash_u(id))); /* under 1 */
            m = m & ((chance < surface_coverage(&f->g, &h, look)) | !look);
        }
    }
    return m;
}

#endif

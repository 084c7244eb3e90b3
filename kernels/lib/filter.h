/* Hits that do not count: backs of single-sided surfaces for camera rays, and points that coverage leaves open. Whether a
 * ray passes is a function of (seed, slot's sample, bounce, triangle), never of traversal order. */
#ifndef EC_LIB_FILTER_H
#define EC_LIB_FILTER_H

#include "../shared/params.h"
#include "geometry.h"
#include "sampler.h"

typedef struct hit_filter {
    geometry g;
    lane_u key;      /* random key of this ray */
    bool cull_backs; /* camera rays */
    lane_i *panes;   /* where not NULL, what may be a pane does not count and is noted here (lib/pane.h) */
} hit_filter;

/* What a kernel must be given for it: alpha is a matter of textures. */
#define FILTER_PARAMETERS(DO)                                                                                                                         \
    DO(global const float *, prims) DO(global const float *, indices) DO(global const float *, uvs) DO(global const float *, colors)                  \
    DO(global const float *, materials) DO(global const float *, texture_table) DO(global const uint *, texels) DO(constant float *, srgb)            \
    DO(global const float *, places) DO(global const float *, motion) DO(global const float *, times) DO(global const uint *, coplanar)
#define FILTER_GEOMETRY {prims, indices, 0, 0, uvs, colors, materials, {texture_table, texels, srgb}, places, motion}
/* times: of paths, by slot. */
#define HAS_TIMES (HAS(MOTION) && motion != 0)
/* Do shadow rays come from the camera, to be culled as its others? Those of light paths do. */
#define CAMERA_SHADOWS(bounce) (HAS(LIGHT_PATHS) && ((bounce) & EC_LIGHT_BOUNCE) != 0u)

/* Random key of a ray: bounce counts the vertices before it, shadow rays differ from path rays. */
EC_FN lane_u filter_key(uint seed, lane_u pixel, lane_u sample, uint bounce, bool is_shadow)
{
    return hash_u(hash_u(hash_u(pixel) ^ seed) + sample * 0x9e3779b9u + (2u * bounce + (is_shadow ? 1u : 0u)) * 0x85ebca6bu);
}

/* Which of the candidate hits (mask m) count. */
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

/* Triangle set-up and tiles for the rasteriser; scalar, one triangle a work-item.
 *
 * Edge functions are triple products of the ray to a sample with two vertices, so there is nothing to clip: behind the camera
 * they have the wrong sign. Every product is rounded by itself, so that two triangles that share an edge compute exactly
 * opposite functions for it, and the fill rule gives a sample on the edge to one of them. */
#ifndef EC_LIB_RASTER_H
#define EC_LIB_RASTER_H

#include "../shared/raster.h"
#include "film.h"

typedef struct point3 {
    float x, y, z;
} point3;

EC_FN point3 point3_make(float x, float y, float z)
{
    point3 p = {x, y, z};
    return p;
}
EC_FN point3 point3_load(constant float *v) { return point3_make(v[0], v[1], v[2]); }
EC_FN point3 point3_sub(point3 a, point3 b) { return point3_make(a.x - b.x, a.y - b.y, a.z - b.z); }
EC_FN float point3_dot(point3 a, point3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
EC_FN point3 point3_cross(point3 a, point3 b)
{
    return point3_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

typedef struct view {
    point3 right, up, forward;
    bool is_flat; /* orthographic */
} view;

/* Writes the edge function from p to q; vertices are relative to the camera. */
EC_FN void raster_edge(const view *c, point3 p, point3 q, float sign, global float *f)
{
    point3 n = point3_cross(p, q);
    point3 along = c->is_flat ? point3_cross(point3_sub(p, q), c->forward) : n;
    f[0] = sign * point3_dot(along, c->right);
    f[1] = sign * point3_dot(along, c->up);
    f[2] = sign * point3_dot(n, c->forward);
}

/* Projects a vertex to the picture, in pixels. */
EC_FN void raster_project(const view *c, constant ec_params *params, point3 v, float *x, float *y)
{
    float w = c->is_flat ? 1.0f : point3_dot(v, c->forward);
    float sx = point3_dot(v, c->right) / point3_dot(c->right, c->right) / w;
    float sy = point3_dot(v, c->up) / point3_dot(c->up, c->up) / w;
    *x = (sx - params->screen[0]) / params->screen[2];
    *y = (sy - params->screen[1]) / params->screen[3];
}

/* Bounds the triangle's part beyond the near plane, in pixels; returns false if none of it is in the picture. */
EC_FN bool raster_box(const view *c, constant ec_params *params, const point3 *v, float *lo, float *hi)
{
    float near = params->scene_max * 1e-6f; /* nearer parts could only be seen in their own projection's rounding */
    lo[0] = lo[1] = 3.0e38f;
    hi[0] = hi[1] = -3.0e38f;
    for (uint k = 0; k < 3; k++) {
        point3 p = v[k], q = v[k == 2 ? 0 : k + 1];
        float dp = point3_dot(p, c->forward) - near, dq = point3_dot(q, c->forward) - near;
        if (!c->is_flat && dp < 0.0f && dq < 0.0f) continue;
        for (uint end = 0; end < 2; end++) {
            point3 e = end ? q : p;
            float d = end ? dq : dp;
            if (!c->is_flat && d < 0.0f) { /* the point of the edge on the plane */
                float t = (end ? dp : dq) / ((end ? dp : dq) - d);
                point3 other = end ? p : q;
                e = point3_make(other.x + t * (e.x - other.x), other.y + t * (e.y - other.y), other.z + t * (e.z - other.z));
            }
            float x, y;
            raster_project(c, params, e, &x, &y);
            lo[0] = fmin(lo[0], x);
            lo[1] = fmin(lo[1], y);
            hi[0] = fmax(hi[0], x);
            hi[1] = fmax(hi[1], y);
        }
    }
    return lo[0] <= (float)params->width && lo[1] <= (float)params->height && hi[0] >= 0.0f && hi[1] >= 0.0f;
}

/* Returns whether the triangle may be seen in tile (x, y): unless an edge function is negative in all of it. The slack covers the rounding of the
 * sample's own place and of the function. */
EC_FN bool raster_meets_tile(constant ec_params *params, global const ec_raster_tri *t, uint x, uint y)
{
    float sx = EC_TILE * params->screen[2], sy = EC_TILE * params->screen[3];
    float x0 = (float)x * sx + params->screen[0], y0 = (float)y * sy + params->screen[1];
    for (uint k = 0; k < 3; k++) {
        float a = t->edge[k][0], b = t->edge[k][1], c = t->edge[k][2];
        float most = a * (a > 0.0f ? x0 + sx : x0) + b * (b > 0.0f ? y0 : y0 + sy) + c;
        if (most < -1e-5f * (fabs(a) + fabs(b) + fabs(c))) return false;
    }
    return true;
}

/* Returns the tile in which a pixel lies. */
EC_FN lane_u raster_tile(constant ec_params *params, lane_u x, lane_u y)
{
    return y / EC_TILE * ((params->width + EC_TILE - 1u) / EC_TILE) + x / EC_TILE;
}
EC_FN uint raster_tile_one(constant ec_params *params, uint x, uint y) { return LANE(raster_tile(params, U(x), U(y)), 0); }

#endif

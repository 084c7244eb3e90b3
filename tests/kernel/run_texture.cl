/* Texture look-ups over arrays, and the arithmetic at the seam. */
#include "lib/geometry.h"

kernel void sample(uint n, uint is_srgb, global const int *id, global const float *u, global const float *v, global const uint *on,
                   global const float *table, global const uint *texels, constant float *srgb, global float *out)
{
    uint at = get_global_id(0) * LANES;
    textures t = {table, texels, srgb};
    lane_i m = LANE_LOAD(on + at) != 0u;
    rgba r = texture_sample(t, m, gather_quad(table, int_to_lane_u(m ? LANE_LOAD(id + at) : I(0)) * 4u), LANE_LOAD(u + at), LANE_LOAD(v + at), is_srgb != 0u);
    LANE_STORE(r.rgb.x, out + at);
    LANE_STORE(r.rgb.y, out + n + at);
    LANE_STORE(r.rgb.z, out + 2 * n + at);
    LANE_STORE(r.a, out + 3 * n + at);
}

/* By a material: uv set and transform of its base colour. prims and attributes as in a scene. */
kernel void look_up(uint n, global const uint *prim, global const float *b1, global const float *b2, global const float *prims,
                    global const float *indices, global const float *uvs, global const float *materials,
                    global const float *table, global const uint *texels, constant float *srgb, global float *out)
{
    uint at = get_global_id(0) * LANES;
    geometry g = {prims, indices, 0, 0, uvs, 0, materials, {table, texels, srgb}};
    hit_point h = hit_point_make(&g, LANE_LOAD(prim + at), LANE_LOAD(b1 + at), LANE_LOAD(b2 + at));
    rgba r = surface_base_color(&g, &h, TRUE_MASK);
    LANE_STORE(r.rgb.x, out + at);
    LANE_STORE(r.rgb.y, out + n + at);
    LANE_STORE(r.rgb.z, out + 2 * n + at);
    LANE_STORE(r.a, out + 3 * n + at);
}

/* Texels chosen along one axis, including coordinates that are not finite. */
kernel void axis(global const float *u, global const uint *size, global const uint *wrap, global const uint *nearest,
                 global uint *first, global uint *second, global float *weight)
{
    uint at = get_global_id(0) * LANES;
    lane_u a, b;
    lane_f w;
    texture_axis(LANE_LOAD(u + at), uint_to_lane_i(LANE_LOAD(size + at)), LANE_LOAD(wrap + at), LANE_LOAD(nearest + at) != 0u,
                 &a, &b, &w);
    LANE_STORE(a, first + at);
    LANE_STORE(b, second + at);
    LANE_STORE(w, weight + at);
}

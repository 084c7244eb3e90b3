/* lib/geometry.h, surface.h, medium.h, scatter.h, ray.h */
#ifndef EC_PRECISION_KERNEL_SURFACE_H
#define EC_PRECISION_KERNEL_SURFACE_H

#include "lib/medium.h"
#include "lib/ray.h"
#include "lib/scatter.h"
#include "kernel.h"

/* Words: vertices 0, 3, 6; b1, b2 9; three uv pairs 11; three normals 18. The normals are in memory, as if each input had a mesh of one
 * triangle. */
EC_FN hit_point hit_of(global const float *in)
{
    hit_point h;
    h.is_one_material = false;
    h.p0 = V(0);
    h.p1 = V(3);
    h.p2 = V(6);
    h.b1 = X(9);
    h.b2 = X(10);
    h.b0 = 1.0f - h.b1 - h.b2;
    h.i0 = ITEM * (EC_PRECISION_WORDS / 3);
    h.i1 = h.i0 + 1u;
    h.i2 = h.i0 + 2u;
    quad none = {F(0.0f), F(0.0f), F(0.0f), F(0.0f)};
    h.uv = h.uv0 = h.uv1 = h.uv2 = none;
    h.uv0.a = X(11);
    h.uv0.b = X(12);
    h.uv1.a = X(13);
    h.uv1.b = X(14);
    h.uv2.a = X(15);
    h.uv2.b = X(16);
    h.material = U(0);
    h.light_pdf_a = F(0.0f);
    h.parts = U(0);
    h.placed = h.turned = !TRUE_MASK;
    h.place = U(0);
    return h;
}
EC_FN geometry geometry_of(global const float *in, global const float *memory)
{
    geometry g = {.normals = in + 18,
                  .materials = memory + EC_PRECISION_MATERIALS,
                  .tex = {memory + EC_PRECISION_TEXTURES, (global const uint *)(memory + EC_PRECISION_TEXELS), 0}};
    return g;
}

PRECISION(interpolate)
{
    hit_point h = hit_of(in);
    PUT(0, interpolate(&h, X(0), X(1), X(2)));
}
PRECISION(surface_place)
{
    hit_point h = hit_of(in);
    surface s;
    surface_place(&h, V(27), &s);
    PUT_V(0, s.p);
    PUT_V(3, s.p_error);
    PUT_V(6, s.ng);
}
PRECISION(surface_offset) { PUT_V(0, surface_offset(V(0), V(3), V(6), V(9))); }
PRECISION(surface_tangent)
{
    hit_point h = hit_of(in);
    geometry g = geometry_of(in, memory);
    quad as_is = {F(1.0f), F(0.0f), F(0.0f), F(1.0f)};
    lane_f handedness;
    PUT_V(0, surface_tangent(&g, &h, !TRUE_MASK, as_is, v3_zero(), &handedness));
    PUT(3, handedness);
}
/* Words 27: wo; 30: the first word of the material. */
PRECISION(surface_frame)
{
    hit_point h = hit_of(in);
    geometry g = geometry_of(in, memory);
    h.material = BITS(30);
    h.uv = interpolate_quad(&h, h.uv0, h.uv1, h.uv2);
    surface s;
    surface_place(&h, V(27), &s);
    surface_frame(&g, &h, TRUE_MASK, V(27), &s);
    PUT_V(0, s.ns);
    PUT_V(3, s.s);
    PUT_V(6, s.t);
}
PRECISION(surface_to_local)
{
    surface s;
    s.ns = V(0);
    v3_frame(s.ns, &s.s, &s.t);
    v3 w = surface_to_local(&s, V(3));
    PUT_V(0, w);
    PUT_V(3, surface_to_world(&s, w));
}
PRECISION(medium_transmittance)
{
    geometry g = {.materials = in};
    PUT_V(0, medium_transmittance(&g, ITEM * EC_PRECISION_WORDS, X(0)));
}

/* Words: mean cosine 0, direction of the light 1, direction after scattering 4, u 7. */
PRECISION(phase_value) { PUT(0, phase_value(X(0), V(1), V(4))); }
PRECISION(phase_sample) { PUT_V(0, phase_sample(X(0), V(1), X(7), X(8))); }
/* Words: extinction 0, u 1. */
PRECISION(scatter_distance) { PUT(0, scatter_distance(X(0), X(1))); }
/* Words: origin 0, direction 3, metres to the surface 6. */
PRECISION(fog_span)
{
    lane_f from, span = fog_span(params, V(0), V(3), X(6), &from);
    PUT(0, from);
    PUT(1, span);
}

/* Words: o 0, d 3, box or vertices 6. */
PRECISION(slab)
{
    ray r = ray_make(V(0), V(3), 0.0f);
    lane_f far, near = slab_near(&r, V(6), V(9), F(EC_HUGE), &far);
    PUT(0, near);
    PUT(1, far);
}
/* Edge functions are products rounded one by one, so that their signs agree between neighbours (ray_edge). t is a mean of the vertices'
 * depths and may move by their rounding over the triangle's area, which matters only for slivers. */
PRECISION(triangle)
{
    ray r = ray_make(V(0), V(3), 0.0f);
    v3 v[3] = {V(6), V(9), V(12)};
    for (int k = 0; k < 3; k++) v[k] = ray_vertex(&r, v[k]);
    edges e = edges_make(v[0], v[1], v[2]);
    lane_f t, inverse, products = F(0.0f), depth = F(0.0f);
    lane_i close;
    e.det = e.u + e.v + e.w;
    edges_distance(&r, &e, TRUE_MASK, F(EC_HUGE), &close, &inverse, &t);
    for (int k = 0; k < 3; k++) {
        v3 p = v[k], q = v[k == 2 ? 0 : k + 1];
        products += fabs(p.x * q.y) + fabs(p.y * q.x);
        depth = max(depth, fabs(p.z * r.scale_z));
    }
    PUT(0, t);
    PUT(1, products * depth * fabs(inverse));
    PUT(2, e.v * inverse);
    PUT(3, e.w * inverse);
    PUT(4, F(1.0f));
}

#endif

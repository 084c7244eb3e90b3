/* Emitting triangles seen from points, for test_lamp.c. Arrays hold n numbers for each component. */
#include "lib/light.h"

static v3 load(global const float *from, uint n, uint at)
{
    return v3_make(LANE_LOAD(from + at), LANE_LOAD(from + n + at), LANE_LOAD(from + 2 * n + at));
}

/* points: 3; corners: 9; u: 2. out: solid angle; then of a sample: b1, b2, density, density found by a path to it, whether it can be
 * sampled, whether the lamp is near. Every lamp is two-sided and the only one. */
kernel void lamps(uint n, global const float *points, global const float *corners, global const float *u, global float *out)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    v3 p = load(points, n, at), v0 = load(corners, n, at), v1 = load(corners + 3 * n, n, at), v2 = load(corners + 6 * n, n, at);
    v3 normal = v3_cross(v3_sub(v1, v0), v3_sub(v2, v0));
    v3 a = v3_sub(v0, p);
    spherical_triangle t = spherical_triangle_make(a, v3_sub(v1, p), v3_sub(v2, p), fabs(v3_dot(a, normal)));
    LANE_STORE(t.turns * (4.0f * EC_PI), out + at);

    lane_f pdf_a = 2.0f / sqrt(v3_dot(normal, normal)), u1 = LANE_LOAD(u + at), u2 = LANE_LOAD(u + n + at), b1, b2;
    light_record l = {v0, v1, v2, v3_splat(F(1.0f)), U(EC_KIND_TRIANGLE | EC_LIGHT_TWO_SIDED), U(0), F(1.0f), pdf_a};
    geometry g = {0, 0, 0, 0, 0, 0, 0, {0, 0, 0}};
    lamp_part whole = lamp_part_all();
    light_sample s = light_sample_triangle(&l, &g, &whole, TRUE_MASK, p, u1, u2);
    spherical_triangle_sample(&t, v0, v1, v2, p, u1, u2, &b1, &b2);
    hit_point h;
    h.p0 = v0;
    h.p1 = v1;
    h.p2 = v2;
    h.light_pdf_a = pdf_a;
    h.parts = U(0);
    lane_f found = light_found_pdf(&g, &h, TRUE_MASK, p, v3_dot(s.towards, s.towards), fabs(v3_dot(s.wi, s.end_normal)));
    LANE_STORE(b1, out + n + at);
    LANE_STORE(b2, out + 2 * n + at);
    LANE_STORE(s.pdf, out + 3 * n + at);
    LANE_STORE(found, out + 4 * n + at);
    LANE_STORE(s.valid ? F(1.0f) : F(0.0f), out + 5 * n + at);
    LANE_STORE(light_is_near(v0, v1, v2, p) ? F(1.0f) : F(0.0f), out + 6 * n + at);
    LANE_STORE(s.towards.x, out + 7 * n + at);
    LANE_STORE(s.towards.y, out + 8 * n + at);
    LANE_STORE(s.towards.z, out + 9 * n + at);
}

/* Parts of lamps, for test_lamp_parts.c. Arrays hold n numbers for each component. */
#include "lib/light.h"

/* For hashed numbers: the part's corner and size, its first number and count, the part found from a point in it, and the rescaled number. */
kernel void choices(uint n, uint seed, global const float *nodes, uint node, global uint *numbers, global float *out)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    lane_f left;
    lane_u r = hash_u(hash_u(LANE_NUMBERS + at) ^ seed);
    lamp_part part = lamp_part_choose(nodes, TRUE_MASK, U(node), r, &left);
    lane_f third = part.size * (1.0f / 3.0f);
    lamp_part found = lamp_part_descend(nodes, TRUE_MASK, U(node), false, U(0), part.b1 + third, part.b2 + third);
    LANE_STORE(part.first, numbers + at);
    LANE_STORE(part.share, numbers + n + at);
    LANE_STORE(part.size == 1.0f ? part.first : found.first, numbers + 2 * n + at);
    LANE_STORE(part.size == 1.0f ? part.share : found.share, numbers + 3 * n + at);
    LANE_STORE(left, out + at);
    LANE_STORE(part.size, out + n + at);
}

EC_FN v3 corner(global const float *p, uint k) { return v3_make(F(p[3 * k]), F(p[3 * k + 1]), F(p[3 * k + 2])); }

/* Seen from p: for a sample, its density and the density found from its direction; for a uniform point of the lamp, the density found times
 * the factor from area to solid angle, whose mean is 1. corners: the lamp's three, and p. */
kernel void densities(uint n, uint seed, global const float *nodes, uint node, global const float *corners, global float *out)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    lane_u r1 = hash_u(hash_u(LANE_NUMBERS + at) ^ seed), r2 = hash_u(r1 ^ 0x5bd1e995u);
    v3 v0 = corner(corners, 0), v1 = corner(corners, 1), v2 = corner(corners, 2), p = corner(corners, 3);
    v3 e = v3_sub(v1, v0), f = v3_sub(v2, v0), normal = v3_cross(e, f);
    lane_f twice = sqrt(v3_dot(normal, normal)), b1, b2;
    geometry g = {0, 0, 0, 0, 0, 0, 0, {0, 0, 0}};
    g.parts = nodes;
    hit_point h;
    h.p0 = v0;
    h.p1 = v1;
    h.p2 = v2;
    h.light_pdf_a = 2.0f / twice;
    h.parts = U(node);
    light_record l = {v0, v1, v2, v3_splat(F(1.0f)), U(EC_KIND_TRIANGLE | EC_LIGHT_TWO_SIDED | node << EC_LIGHT_PARTS), U(0), F(1.0f), h.light_pdf_a};
    light_sample s = light_sample_lamp(&l, &g, TRUE_MASK, p, to_unit(r1), r2);
    v3 q = v3_sub(v3_add(p, s.towards), v0);
    h.b1 = v3_dot(v3_cross(q, f), normal) / (twice * twice);
    h.b2 = v3_dot(v3_cross(e, q), normal) / (twice * twice);
    lane_f found = light_found_pdf(&g, &h, TRUE_MASK, p, v3_dot(s.towards, s.towards), fabs(v3_dot(s.wi, s.end_normal)));
    LANE_STORE(s.valid ? s.pdf : F(0.0f), out + at);
    LANE_STORE(found, out + n + at);

    lane_f root = sqrt(to_unit(hash_u(r2 ^ 1u)));
    h.b1 = root * to_unit(hash_u(r2 ^ 2u));
    h.b2 = root - h.b1;
    v3 way = v3_sub(v3_fma(f, h.b2, v3_fma(e, h.b1, v0)), p);
    lane_f d2 = v3_dot(way, way), cosine = fabs(v3_dot(way, normal)) / (sqrt(d2) * twice);
    LANE_STORE(light_found_pdf(&g, &h, TRUE_MASK, p, d2, cosine) * cosine / d2 * 0.5f * twice, out + 2 * n + at);
}

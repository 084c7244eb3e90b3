/* Pairs of lamp triangles that face opposite ways (host/pack/lamp_pairs.c). On a bulb one of the two faces a point outside, and that one is chosen. */
#ifndef EC_LIB_LAMP_PAIRS_H
#define EC_LIB_LAMP_PAIRS_H

#include "light_record.h"

/* Returns whether the triangle's front faces p, judged from its centroid, so that all callers get the same answer. */
EC_FN lane_i pair_faces(v3 a, v3 b, v3 c, v3 p)
{
    v3 way = v3_sub(p, v3_scale(v3_add(a, v3_add(b, c)), F(1.0f / 3.0f)));
    return v3_dot(v3_cross(v3_sub(b, a), v3_sub(c, a)), way) > 0.0f;
}

/* Returns the probability with which a triangle is chosen for p over that by power: where only one of a pair faces p, it has the probability of both. */
EC_FN lane_f pair_chance(v3 a, v3 b, v3 c, lane_f pmf, const light_record *other, v3 p)
{
    lane_i own = pair_faces(a, b, c, p), their = pair_faces(other->a, other->b, other->c, p);
    return own == their ? F(1.0f) : own ? (pmf + other->pmf) / pmf : F(0.0f);
}

EC_FN lane_u pair_partner(lane_u kind, lane_u id) { return (kind & EC_LIGHT_PAIR_FIRST) != 0u ? id + 1u : id - 1u; }
#define EC_LIGHT_PAIRED (EC_LIGHT_PAIR_FIRST | EC_LIGHT_PAIR_SECOND)

/* Likewise for triangle prim, which a path from p has met at h. pairs: for each triangle the index of its partner in the table of lights. */
EC_FN lane_f pair_found_chance(const lights *l, global const uint *pairs, const hit_point *h, lane_i m, lane_u prim, v3 p)
{
    lane_u partner = gather_u(pairs, m ? prim : U(0));
    lane_i paired = m & (partner != EC_NO_ID) & (h->light_pdf_a > 0.0f);
    if (!any_lane(paired)) return F(1.0f);
    light_record other = light_load(l, paired ? partner : U(0));
    v3 n = v3_cross(v3_sub(h->p1, h->p0), v3_sub(h->p2, h->p0));
    lane_f pmf = h->light_pdf_a * 0.5f * sqrt(v3_dot(n, n));
    return paired ? pair_chance(h->p0, h->p1, h->p2, pmf, &other, p) : F(1.0f);
}

EC_FN light_record light_record_select(lane_i m, light_record a, light_record b)
{
    light_record r = {v3_select(m, a.a, b.a), v3_select(m, a.b, b.b), v3_select(m, a.c, b.c), v3_select(m, a.emission, b.emission),
                      m ? a.kind : b.kind, m ? a.prim : b.prim, m ? a.pmf : b.pmf, m ? a.pdf_a : b.pdf_a};
    return r;
}

/* Replaces *one by its partner where only the partner faces p. Where only one of the pair does, *u1 is rescaled over the numbers of both. */
EC_FN void light_choose_of_pair(const lights *l, lane_i m, v3 p, light_record *one, lane_u *id, lane_f *u1)
{
    lane_i paired = m & ((one->kind & EC_LIGHT_PAIRED) != 0u), second = (one->kind & EC_LIGHT_PAIR_SECOND) != 0u;
    if (!any_lane(paired)) return;
    lane_u partner = paired ? pair_partner(one->kind, *id) : *id;
    light_record other = light_load(l, partner);
    lane_i own = pair_faces(one->a, one->b, one->c, p), their = pair_faces(other.a, other.b, other.c, p);
    lane_i alone = paired & (own != their), leaves = alone & their;
    lane_f both = one->pmf + other.pmf, at = (*u1 * one->pmf + (second ? other.pmf : F(0.0f))) / both;
    *one = light_record_select(leaves, other, *one);
    *id = leaves ? partner : *id;
    *u1 = alone ? min(at, F(0x1.fffffep-1f)) : *u1;
    one->pdf_a *= alone ? both / one->pmf : F(1.0f);
    one->pmf = alone ? both : one->pmf;
}

#endif

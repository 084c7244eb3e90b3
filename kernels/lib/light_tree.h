/* Chooses one of many lamps by what it may send to a point (Conty Estevez and Kulla 2018): descends from the root of a tree to a leaf, at each node
 * by the power of its two children over their squared distance, times the cosine that the best of their normals could have.
 *
 * Probabilities are shares of 2^31 random numbers that are handed down as whole numbers, so that the probability divided by is the one sampled, and
 * those of all lamps add up exactly. Children have contiguous shares, and the number's place in the share of a leaf is reused for the point on the
 * lamp. The point's own normal is left out: a path that meets a lamp knows where it comes from, but not how the surface there lay. */
#ifndef EC_LIB_LIGHT_TREE_H
#define EC_LIB_LIGHT_TREE_H

#include "bulb.h"
#include "choice.h"

#define EC_TREE_FEW 0x10000u /* shares of fewer numbers are too coarse to divide, and become 2^15 times as fine */
#define EC_TREE_FINER 15u
/* Sines made of cosines near 1 are good to sqrt(2 u) = 3.5e-4, and two angles are taken off: a node whose cosine is under -EC_TREE_DARK is surely
 * dark. The cosine of any other counts as EC_TREE_DARK at least. */
#define EC_TREE_DARK 0.004f

/* Returns a node's power times the largest cosine that one of its lamps may have towards p. *d2: squared distance, no less than the node's size;
 * *link: where the node leads. */
EC_FN lane_f light_node_weight(quad place, quad cone, quad rest, v3 p, lane_f *d2, lane_u *link)
{
    v3 way = v3_sub(p, v3_make(place.a, place.b, place.c));
    lane_f distance2 = v3_dot(way, way), radius2 = place.d, cos_spread = cone.d, sin_spread = rest.b;
    /* Near or within a cluster the mean of its lamps' 1 / d^2 is not that of its centre. This is the mean over a ball of half the
     * sphere's squared radius: 3 / r^2 at its centre, 3 / 2 r^2 at its edge, far off 1 / d^2, between these within 18 %. Without it the
     * lamps around a point would lose a part of their share at each level at which the point lies in both clusters. */
    lane_f ball2 = 0.5f * radius2, size = ball2 / distance2;
    *d2 = distance2 > ball2 ? distance2 / fma(0.5f * size, size, F(1.0f)) : (ball2 + distance2) * (1.0f / 3.0f);
    lane_f cosine = v3_dot(way, v3_make(cone.a, cone.b, cone.c)) / sqrt(distance2);
    lane_u flags = as_lane_u(rest.d);
    *link = as_lane_u(rest.c);
    if (HAS(LAMP_PAIRS)) {
        lane_i is_bulb = ((flags & EC_LIGHT_NODE_BULB) != 0u) & (distance2 > EC_LIGHT_BULB_FAR * radius2);
        *link = is_bulb ? (*link + 2u) | (EC_LIGHT_LEAF | EC_LIGHT_BULB) : *link;
    }
    cosine = (flags & EC_LIGHT_NODE_TWO_SIDED) != 0u ? fabs(cosine) : cosine;
    lane_f sine = sqrt(max(fma(-cosine, cosine, F(1.0f)), F(0.0f)));
    lane_i within = cosine >= cos_spread; /* the cone of normals */
    lane_f c = within ? F(1.0f) : fma(cosine, cos_spread, sine * sin_spread);
    lane_f s = within ? F(0.0f) : fma(sine, cos_spread, -(cosine * sin_spread));
    lane_f sine2 = radius2 / distance2; /* of the angle that the node's sphere subtends */
    lane_f cos_size = sqrt(max(1.0f - sine2, F(0.0f)));
    c = c >= cos_size ? F(1.0f) : fma(c, cos_size, s * sqrt(sine2));
    c = distance2 > radius2 ? c : F(1.0f);
    return c < -EC_TREE_DARK ? F(0.0f) : rest.a * max(c, F(EC_TREE_DARK));
}

/* Returns how many of `all` numbers the first of the two children at `child` gets; *first, *second: where they lead. at_root: they are the root's, on
 * all lanes. */
EC_FN lane_u light_tree_share(global const float *tree, lane_u child, bool at_root, v3 p, lane_u all, lane_u *first, lane_u *second)
{
    lane_u at = child * EC_LIGHT_NODE_WORDS;
    lane_f da, db;
    quad a = gather_quad_if(at_root, tree, at + 8u), b = gather_quad_if(at_root, tree, at + 20u);
    lane_f wa = light_node_weight(gather_quad_if(at_root, tree, at), gather_quad_if(at_root, tree, at + 4u), a, p, &da, first);
    lane_f wb = light_node_weight(gather_quad_if(at_root, tree, at + 12u), gather_quad_if(at_root, tree, at + 16u), b, p, &db, second);
    lane_f ia = wa * db, ib = wb * da, sum = ia + ib;
    lane_i good = (sum > 0.0f) & is_finite_bits(sum), dark = (wa == 0.0f) & (wb == 0.0f);
    lane_f share = good ? ia / sum : F(0.5f);
    lane_u n = int_to_lane_u(to_lane_i(to_lane_f(all >> 1) * share)) << 1;
    n = wb > 0.0f ? min(max(n, wa > 0.0f ? U(1u) : U(0u)), all - 1u) : all;
    return dark ? all >> 1 : n; /* both are dark: any split will do that adds up */
}

/* Chooses a lamp for p, on the lanes m; *pmf: its probability. rest: a random number under `numbers`, of 2^31; *left: its place in the lamp's share,
 * in [0, 1). r: bits that refine it. */
EC_FN lane_u light_tree_choose(const lights *l, lane_i m, v3 p, lane_u rest, uint numbers, lane_u r, lane_f *pmf, lane_f *left)
{
    lane_u link = U(1u), all = U(numbers);
    bool at_root = LANES > 1;
    *pmf = F(1.0f / 2147483648.0f);
    for (lane_i going = m; any_lane(going); going = m & (link < EC_LIGHT_LEAF)) {
        lane_u first, second, share = light_tree_share(l->tree, going ? link : U(1u), at_root, p, all, &first, &second);
        at_root = false;
        lane_i is_first = rest < share;
        rest = (going & !is_first) ? rest - share : rest;
        all = going ? (is_first ? share : all - share) : all;
        link = going ? (is_first ? first : second) : link;
        lane_i few = going & (all < EC_TREE_FEW);
        *pmf = few ? *pmf * (1.0f / (1u << EC_TREE_FINER)) : *pmf;
        rest = few ? rest << EC_TREE_FINER | hash_u(r + link) >> (32u - EC_TREE_FINER) : rest;
        all = few ? all << EC_TREE_FINER : all;
    }
    lane_u lamp = m ? link & ~EC_LIGHT_LEAF : U(0u);
    lane_i is_bulb = m & ((link & EC_LIGHT_BULB) != 0u);
    if (HAS(LAMP_PAIRS) && any_lane(is_bulb)) {
        bulb b = bulb_at(l->tree, is_bulb, link, all);
        rest = rest << b.shift | (hash_u(r + link) >> 1u) >> (31u - b.shift);
        lane_u low, high, chosen = bulb_choose(&b, l, is_bulb, p, rest, &low, &high);
        *pmf *= bulb_unit(&b);
        lamp = is_bulb ? chosen : lamp;
        rest = is_bulb ? rest - low : rest;
        all = is_bulb ? high - low : all;
    }
    *pmf *= to_lane_f(all);
    *left = choice_rest(rest, all, r);
    return lamp;
}

/* Returns the lamp at the end of `trail`, followed from the two children at `child` without computing weights. */
EC_FN lane_u light_tree_end(global const float *tree, lane_i m, lane_u child, lane_u trail)
{
    lane_u link = child;
    for (lane_i going = m; any_lane(going); going = m & (link < EC_LIGHT_LEAF)) {
        lane_u next = gather_u((global const uint *)tree, (going ? link + (trail & 1u) : U(0)) * EC_LIGHT_NODE_WORDS + 10u);
        link = going ? next : link;
        trail >>= 1;
    }
    return link & ~EC_LIGHT_LEAF;
}

/* Returns the probability with which light_tree_choose reaches the lamp at the end of `trail`. */
EC_FN lane_f light_tree_pmf(const lights *l, lane_i m, v3 p, uint numbers, lane_u trail)
{
    lane_u link = U(1u), all = U(numbers);
    bool at_root = LANES > 1;
    lane_f pmf = F(1.0f / 2147483648.0f);
    for (lane_i going = m; any_lane(going); going = m & (link < EC_LIGHT_LEAF)) {
        lane_u first, second, share = light_tree_share(l->tree, going ? link : U(1u), at_root, p, all, &first, &second);
        at_root = false;
        lane_i is_first = (trail & 1u) == 0u;
        trail = going ? trail >> 1 : trail;
        all = going ? (is_first ? share : all - share) : all;
        link = going ? (is_first ? first : second) : link;
        lane_i few = going & (all < EC_TREE_FEW);
        pmf = few ? pmf * (1.0f / (1u << EC_TREE_FINER)) : pmf;
        all = few ? all << EC_TREE_FINER : all;
    }
    lane_i is_bulb = m & ((link & EC_LIGHT_BULB) != 0u);
    if (HAS(LAMP_PAIRS) && any_lane(is_bulb)) {
        bulb b = bulb_at(l->tree, is_bulb, link, all);
        lane_u place = light_tree_end(l->tree, is_bulb, (link & ~(EC_LIGHT_LEAF | EC_LIGHT_BULB)) - 2u, trail);
        lane_u numbers_of_lamp = bulb_numbers(&b, l, is_bulb, p, place);
        pmf *= bulb_unit(&b);
        all = is_bulb ? numbers_of_lamp : all;
    }
    return pmf * to_lane_f(all);
}

#endif

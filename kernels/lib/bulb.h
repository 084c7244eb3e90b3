/* Bulbs: groups of lamps of one body that the light tree treats as one where they are far away (host/pack/bulbs.c). A lamp of the bulb is then chosen
 * by its power and by whether it faces the point (lamp_pairs.h), which is cheaper than a descent to a leaf of many. A bulb's record starts at a node
 * of the tree and holds, in words: the index of its first lamp in the table of lights, the number of lamps, for each lamp the first of the 2^32
 * numbers that choose it, and as many guides (distribution.h). */
#ifndef EC_LIB_BULB_H
#define EC_LIB_BULB_H

#include "../shared/light_tree.h"
#include "lamp_pairs.h"

typedef struct bulb {
    global const uint *words;
    lane_u at, first, count;
    lane_u all;   /* how many numbers choose the bulb: at least 2^30, so that each lamp has some */
    lane_u shift; /* log2 of `all` over the numbers that the tree gave it */
} bulb;

/* Reads the bulb that `link` leads to; all: how many numbers the tree gives it. */
EC_FN bulb bulb_at(global const float *tree, lane_i m, lane_u link, lane_u all)
{
    lane_u shift = m ? max(clz(all), U(1)) - 1u : U(0);
    lane_u at = (m ? link & ~(EC_LIGHT_LEAF | EC_LIGHT_BULB) : U(0)) * EC_LIGHT_NODE_WORDS;
    global const uint *words = (global const uint *)tree;
    bulb b = {words, at, gather_u(words, at), m ? gather_u(words, at + 1u) : U(1), all << shift, shift};
    return b;
}

/* Returns 2^-shift: one of the bulb's numbers over one of the tree's. */
EC_FN lane_f bulb_unit(const bulb *b) { return as_lane_f((127u - b->shift) << 23u); }

/* Returns the first number of lamp k; `all` after the last lamp. */
EC_FN lane_u bulb_edge(const bulb *b, lane_u k)
{
    lane_i is_end = k >= b->count;
    lane_u edge = mul_hi(gather_u(b->words, b->at + 2u + (is_end ? U(0) : k)), b->all);
    return is_end ? b->all : edge;
}

/* Sets *low … *high - 1 to the numbers of lamp k for p, which are those of its pair if only one of the two faces p. Returns the lamp that they
 * choose: k or its partner. */
EC_FN lane_u bulb_faces(const bulb *b, const lights *l, lane_i m, v3 p, lane_u k, lane_u *low, lane_u *high)
{
    light_record one = light_load(l, m ? b->first + k : U(0));
    lane_i paired = m & ((one.kind & EC_LIGHT_PAIRED) != 0u);
    *low = bulb_edge(b, k);
    *high = bulb_edge(b, k + 1u);
    if (!any_lane(paired)) return k;
    lane_i is_first = (one.kind & EC_LIGHT_PAIR_FIRST) != 0u;
    lane_u partner = paired ? pair_partner(one.kind, k) : k;
    light_record other = light_load(l, m ? b->first + partner : U(0));
    lane_i own = pair_faces(one.a, one.b, one.c, p), alone = paired & (own != pair_faces(other.a, other.b, other.c, p));
    *low = (alone & !is_first) ? bulb_edge(b, partner) : *low;
    *high = (alone & is_first) ? bulb_edge(b, k + 2u) : *high;
    return (alone & !own) ? partner : k;
}

/* Returns the lamp that number `rest` chooses for p; the numbers that do so are *low … *high - 1. */
EC_FN lane_u bulb_choose(const bulb *b, const lights *l, lane_i m, v3 p, lane_u rest, lane_u *low, lane_u *high)
{
    /* The guides of the neighbouring buckets bound the bisection, since floats may miss the bucket of `rest` by one. */
    lane_u end = b->count - 1u, guides = b->at + 2u + b->count;
    lane_u bucket = int_to_lane_u(to_lane_i(to_lane_f(rest) / to_lane_f(b->all) * to_lane_f(b->count)));
    lane_u last = gather_u(b->words, guides + min(bucket + 1u, end));
    lane_u k = bucket < 2u ? U(0) : gather_u(b->words, guides + (bucket < 2u ? U(0) : bucket - 2u));
    while (any_lane(m & (k < last))) {
        lane_u middle = (k + last + 1u) >> 1u;
        lane_i is_past = bulb_edge(b, middle) > rest;
        last = is_past ? middle - 1u : last;
        k = is_past ? k : middle;
    }
    return b->first + bulb_faces(b, l, m, p, k, low, high);
}

/* Returns how many of the bulb's numbers choose, for p, the lamp at index `place` of the table. */
EC_FN lane_u bulb_numbers(const bulb *b, const lights *l, lane_i m, v3 p, lane_u place)
{
    lane_u low, high, k = m ? place - b->first : U(0), chosen = bulb_faces(b, l, m, p, k, &low, &high);
    return chosen == k ? high - low : U(0);
}

#endif

/* Numbers that choose and go on: of [0, 1) each of several things has an interval, and what is left of a number in the one that it fell
 * into, stretched to [0, 1), is as uniform as it was, and as evenly spread over the samples (pbrt-v4's light BVH and Mitsuba 3 reuse numbers
 * so). A coordinate that chooses first thereby keeps the points of each thing a net, which a number of its own would make a random part of
 * one. */
#ifndef EC_LIB_CHOICE_H
#define EC_LIB_CHOICE_H

#include "sampler.h"

#define EC_LAST_UNIT 0.99999994f /* the largest float under 1 */

/* A number on its way. */
typedef struct chooser {
    lane_f u;    /* in [0, 1) */
    lane_f step; /* how far apart such numbers are: every choice leaves fewer of them */
    lane_f fill; /* in [0, 1): what to put between them at last */
} chooser;

EC_FN chooser chooser_make(lane_u r)
{
    chooser c = {to_unit(r), F(5.9604644775390625e-8f), to_unit(hash_u(r))};
    return c;
}

/* Is it, on the lanes m, the first of two things, of probability p? The other has what is left. Elsewhere the number stays. */
EC_FN lane_i choose(chooser *c, lane_i m, lane_f p)
{
    lane_i first = m & (c->u < p);
    lane_f whole = first ? p : 1.0f - p;
    c->u = m ? min((first ? c->u : c->u - p) / whole, F(EC_LAST_UNIT)) : c->u;
    c->step = m ? min(c->step / whole, 1.0f - c->u) : c->step;
    return first;
}

/* What is left of it. */
EC_FN lane_f chooser_end(const chooser *c) { return min(fma(c->step, c->fill, c->u), F(EC_LAST_UNIT)); }

/* Number `rest` of `all` (0: of 2^32) as one in [0, 1), with digits below those of its own from r, which it came from. */
EC_FN lane_f choice_rest(lane_u rest, lane_u all, lane_u r)
{
    lane_f whole = all == 0u ? F(4294967296.0f) : to_lane_f(all);
    return min((to_lane_f(rest) + to_unit(hash_u(r))) / whole, F(EC_LAST_UNIT));
}

/* Number `rest` of `all` as one of 2^32, for choices to come. high, low: words of floor(2^64 / all); digits below those of rest come from r.
 * floor((rest + fill) stretch / 2^32), fill in [0, 1). */
EC_FN lane_u choice_stretch(lane_u rest, lane_u high, lane_u low, lane_u r)
{
    lane_u fill = hash_u(r);
    lane_u a = rest * low, b = fill * high, ab = a + b, c = mul_hi(fill, low), abc = ab + c;
    lane_u carry = (ab < a ? U(1) : U(0)) + (abc < c ? U(1) : U(0));
    return rest * high + mul_hi(rest, low) + mul_hi(fill, high) + carry;
}

#endif

/* Random numbers that choose and are then reused. Each of several alternatives has an interval of [0, 1); a number's place in the one that it falls into,
 * stretched to [0, 1), is as uniform as before and as evenly spread over the samples (pbrt-v4's light BVH and Mitsuba 3 reuse numbers so). A coordinate that
 * chooses first thereby keeps the points of each alternative a net, which a separate number for the choice would make a random part of one. */
#ifndef EC_LIB_CHOICE_H
#define EC_LIB_CHOICE_H

#include "sampler.h"

#define EC_LAST_UNIT 0.99999994f /* the largest float under 1 */

/* A number that is being reused. */
typedef struct chooser {
    lane_f u;    /* in [0, 1) */
    lane_f step; /* spacing of the values that u may have; every choice widens it */
    lane_f fill; /* in [0, 1): what fills the spacing at the end */
} chooser;

EC_FN chooser chooser_make(lane_u r)
{
    chooser c = {to_unit(r), F(5.9604644775390625e-8f), to_unit(hash_u(r))};
    return c;
}

/* Chooses, on the lanes m, the first of two alternatives with probability p, and returns the lanes where it is chosen. The number is rescaled to the
 * chosen interval; off m it stays. */
EC_FN lane_i choose(chooser *c, lane_i m, lane_f p)
{
    lane_i first = m & (c->u < p);
    lane_f whole = first ? p : 1.0f - p;
    c->u = m ? min((first ? c->u : c->u - p) / whole, F(EC_LAST_UNIT)) : c->u;
    c->step = m ? min(c->step / whole, 1.0f - c->u) : c->step;
    return first;
}

/* Returns what is left of the number, in [0, 1). */
EC_FN lane_f chooser_end(const chooser *c) { return min(fma(c->step, c->fill, c->u), F(EC_LAST_UNIT)); }

/* Maps number `rest` of 0 … all - 1 (all = 0: of 2^32) to [0, 1). Digits below its own come from a hash of r, the number that it came from. */
EC_FN lane_f choice_rest(lane_u rest, lane_u all, lane_u r)
{
    lane_f whole = all == 0u ? F(4294967296.0f) : to_lane_f(all);
    return min((to_lane_f(rest) + to_unit(hash_u(r))) / whole, F(EC_LAST_UNIT));
}

/* Stretches number `rest` of 0 … all - 1 to 32 bits, for further choices: floor((rest + fill) stretch / 2^32). high, low: words of stretch =
 * floor(2^64 / all); fill, in [0, 1), is a hash of r. */
EC_FN lane_u choice_stretch(lane_u rest, lane_u high, lane_u low, lane_u r)
{
    lane_u fill = hash_u(r);
    lane_u a = rest * low, b = fill * high, ab = a + b, c = mul_hi(fill, low), abc = ab + c;
    lane_u carry = (ab < a ? U(1) : U(0)) + (abc < c ? U(1) : U(0));
    return rest * high + mul_hi(rest, low) + mul_hi(fill, high) + carry;
}

#endif

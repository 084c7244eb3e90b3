/* lib/choice.h and lib/light_share.h on arrays, for test_choice.c. */
#include "lib/light_share.h"

kernel void stretch(uint n, global const uint *rest, constant uint *factor, global const uint *r, global uint *out)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    LANE_STORE(choice_stretch(LANE_LOAD(rest + at), U(factor[0]), U(factor[1]), LANE_LOAD(r + at)), out + at);
}

/* Chooses one of p.length things in order, or the remainder: which one, and the rescaled number. */
kernel void chain(uint n, global const uint *r, constant float *p, uint count, global uint *which, global float *out)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    chooser c = chooser_make(LANE_LOAD(r + at));
    lane_i left = TRUE_MASK;
    lane_u chosen = U(count);
    for (uint i = 0; i < count; i++) {
        lane_i is = choose(&c, left, F(p[i]));
        chosen = is ? U(i) : chosen;
        left = left & !is;
    }
    LANE_STORE(chosen, which + at);
    LANE_STORE(chooser_end(&c), out + at);
}

/* Rescales numbers that are in the remaining part, `rest` of `all`. */
kernel void rests(uint n, global const uint *rest, uint all, global const uint *r, global float *out)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    LANE_STORE(choice_rest(LANE_LOAD(rest + at), U(all), LANE_LOAD(r + at)), out + at);
}

/* Maps numbers to the table of lights. */
kernel void shares(uint n, constant ec_params *params, global const uint *r, global uint *out)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    LANE_STORE(light_share_number(params, LANE_LOAD(r + at)), out + at);
}

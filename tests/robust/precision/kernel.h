/* Macros that make a library function a kernel of the precision check. Input i is EC_PRECISION_WORDS words of `in`, its results
 * EC_PRECISION_RESULTS words of `out`. */
#ifndef EC_PRECISION_KERNEL_H
#define EC_PRECISION_KERNEL_H

#include "lib/math.h"
#include "shared/params.h"
#include "words.h"

#define PRECISION(name)                                                                            \
    kernel void precision_##name(global const float *in, global float *out, global const float *memory, constant ec_params *params)

#define ITEM (LANE_NUMBERS + (uint)get_global_id(0) * LANES)
#define X(k) gather_f(in + (k), ITEM * EC_PRECISION_WORDS)
#define V(k) v3_make(X(k), X((k) + 1), X((k) + 2))
#define BITS(k) as_lane_u(X(k))
#define PUT(k, v) scatter_f(out + (k), ITEM * EC_PRECISION_RESULTS, v, ~0u)
#define PUT_V(k, v)                                                                                \
    do {                                                                                           \
        v3 put_ = (v);                                                                             \
        PUT(k, put_.x);                                                                            \
        PUT((k) + 1, put_.y);                                                                      \
        PUT((k) + 2, put_.z);                                                                      \
    } while (0)

#endif

/* Each operation that kernels expect to be correctly rounded, on arrays. Also combinations of two, for which compilers have shortcuts. */
#include "lib/lanes.h"

#define LOAD(array) LANE_LOAD((array) + get_global_id(0) * LANES)
#define STORE(value, array) LANE_STORE(value, (array) + get_global_id(0) * LANES)

kernel void rounding(global const float *a, global const float *b, global const float *c, global float *add, global float *multiply,
                     global float *divide, global float *root, global float *fused, global float *unfused,
                     global float *inverse_root, global float *down, global float *back,
                     global float *twice, global float *lost)
{
    lane_f x = LOAD(a), y = LOAD(b), z = LOAD(c);
    STORE(x + y, add);
    STORE(x * y, multiply);
    STORE(x / y, divide);
    STORE(sqrt(fabs(x)), root);
    STORE(fma(x, y, z), fused);
    STORE(x * y + z, unfused);
    STORE(1.0f / sqrt(fabs(x)), inverse_root);
    STORE(floor(x), down);
    STORE(x + y - y, back);
    STORE(x * y + x * z, twice);
    STORE(1.0f / (1.0f / x), lost);
}

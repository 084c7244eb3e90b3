/* Builds frames around normals, as the shading stages do, for test_rays_normals.c. */
#include "lib/math.h"
#include "lib/queue.h"

/* Writes s and t for n: three fields each. */
kernel void frame(uint wave, global const float *normals, global float *frames)
{
    uint i = get_global_id(0) * LANES;
    if (i >= wave) return;
    v3 s, t;
    v3_frame(queue_load_v3(normals, wave, 0, i), &s, &t);
    queue_store_v3(frames, wave, 0, i, s);
    queue_store_v3(frames, wave, 3, i, t);
}

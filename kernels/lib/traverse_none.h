/* No acceleration at all: every ray is tested against every triangle, eight at a time. The yardstick for all others. */
#ifndef EC_LIB_TRAVERSE_NONE_H
#define EC_LIB_TRAVERSE_NONE_H

#include "block8.h"

EC_FN void none_closest(const accel *a, const ray8 *q, const hit_filter *filter, uint skip0, uint skip1, hit8 *h)
{
    global const ec_tri8 *blocks = a->at[1];
    global const ec_box8 *boxes = a->at[2];
    for (uint i = 0, count = *(global const uint *)a->at[0]; i < count; i++)
        block8_triangles(q, filter, blocks + i, boxes ? boxes + i : 0, skip0, skip1, false, h);
}

EC_FN bool none_any(const accel *a, const ray8 *q, const hit_filter *filter, uint skip0, uint skip1, hit8 *h)
{
    global const ec_tri8 *blocks = a->at[1];
    global const ec_box8 *boxes = a->at[2];
    uint count = *(global const uint *)a->at[0];
    for (uint i = 0; i < count && h->prim == EC_NO_ID; i++)
        block8_triangles(q, filter, blocks + i, boxes ? boxes + i : 0, skip0, skip1, true, h);
    return h->prim != EC_NO_ID;
}

#define ACCEL none
#include "trace_rays.h"
#undef ACCEL

#endif

/* Entry points. PoCL compiles what stands in one three times: as a kernel, and inlined into two launchers of a work-group. What a kernel does is
 * therefore a function of its own, which is compiled once: `shade` of the showcase in 1.0 s in place of 2.7. On graphics cards it is inlined. */
#ifndef EC_LIB_KERNEL_H
#define EC_LIB_KERNEL_H

#include "queue.h"

/* Kernel `name`, whose body follows: for the entry i that a work-item begins at, of the `takes` that it has, in part `row` of the queue, and how many
 * there are from it on. LIST(DO): DO(type, name) of its parameters, but for params, in the order of host/device/stages.c. entries: how many, by i, row
 * and the parameters; none, and the body is not called.
 * A launch's second dimension are the parts. A group has one, so compilers of cards see that its work-items count up one counter, and make one atomic
 * operation of those of all that go in step. A body does not ask where its work-item is: PoCL would inline it. */
#define EC_KERNEL(name, takes, LIST, entries)                                                                                                         \
    EC_CALLED void EC_CAT(name, _item)(uint row, uint i, uint left, constant ec_params *params LIST(EC_PARAMETER));                                   \
    kernel void name(constant ec_params *params LIST(EC_PARAMETER))                                                                                   \
    {                                                                                                                                                 \
        uint row = (uint)get_group_id(1), i = queue_entry(params->part, row, (uint)get_global_id(0), takes), left = entries;                          \
        if (left) EC_CAT(name, _item)(row, i, left, params LIST(EC_ARGUMENT));                                                                        \
    }                                                                                                                                                 \
    EC_CALLED void EC_CAT(name, _item)(uint row, uint i, uint left, constant ec_params *params LIST(EC_PARAMETER))

/* One whose body is for a single entry i: a work-item has RUN of them, one after the other. */
#define EC_RUN_KERNEL(name, LIST, entries)                                                                                                            \
    EC_INLINED void EC_CAT(name, _entry)(uint i, constant ec_params *params LIST(EC_PARAMETER));                                                      \
    EC_KERNEL(name, RUN, LIST, entries)                                                                                                               \
    {                                                                                                                                                 \
        for (uint end = i + min(left, RUN); i < end; i++) EC_CAT(name, _entry)(i, params LIST(EC_ARGUMENT));                                          \
    }                                                                                                                                                 \
    EC_INLINED void EC_CAT(name, _entry)(uint i, constant ec_params *params LIST(EC_PARAMETER))
/* What counters say of entry i, for `entries`. */
#define QUEUED(count) queue_entries((global const uint *)counters->count, params->wave, params->part, row, i)
#define EC_PARAMETER(type, name) , type name
#define EC_ARGUMENT(type, name) , name

/* Parameters that many kernels have: of a wave, and what a surface is made of. */
#define WAVE_PARAMETERS(DO) DO(uint, seed) DO(uint, first_pixel) DO(global const uint *, pixel_list) DO(uint, bounce) DO(uint, step)
#define SURFACE_PARAMETERS(DO)                                                                                                                        \
    DO(global const float *, prims) DO(global const float *, indices) DO(global const float *, normals) DO(global const float *, tangents)            \
    DO(global const float *, uvs) DO(global const float *, colors) DO(global const float *, materials) DO(global const float *, texture_table)        \
    DO(global const uint *, texels) DO(constant float *, srgb) DO(global const float *, places)

#endif

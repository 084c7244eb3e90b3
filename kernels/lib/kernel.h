/* Entry points. PoCL compiles what stands in one three times: as a kernel, and inlined into two launchers of a work-group. What a kernel does is
 * therefore a function of its own, which is compiled once: `shade` of the showcase in 1.0 s in place of 2.7. On graphics cards it is inlined. */
#ifndef EC_LIB_KERNEL_H
#define EC_LIB_KERNEL_H

#include "queue.h"

/* Kernel `name`, whose body follows: for the entry i that a work-item begins at, of `lanes` entries each, in part `row` of the queue, and how many
 * there are from it on. LIST(DO): DO(type, name) of its parameters, but for params, in the order of host/device/stages.c. entries: how many, by i and
 * the parameters; none, and the body is not called. EC_KERNEL_AT: a work-item begins at entry `first`, by the parameters. A body does not ask where its
 * work-item is: PoCL would inline it. */
#define EC_KERNEL(name, lanes, LIST, entries) EC_KERNEL_AT(name, queue_entry(params->part, lanes), LIST, entries)
#define EC_KERNEL_AT(name, first, LIST, entries)                                                                                                      \
    EC_CALLED void EC_CAT(name, _item)(uint row, uint i, uint left, constant ec_params *params LIST(EC_PARAMETER));                                   \
    kernel void name(constant ec_params *params LIST(EC_PARAMETER))                                                                                   \
    {                                                                                                                                                 \
        uint row = queue_part(), i = first, left = entries;                                                                                           \
        if (left) EC_CAT(name, _item)(row, i, left, params LIST(EC_ARGUMENT));                                                                        \
    }                                                                                                                                                 \
    EC_CALLED void EC_CAT(name, _item)(uint row, uint i, uint left, constant ec_params *params LIST(EC_PARAMETER))

/* One whose body is for a single entry i: a work-item has RUN of them, one after the other. */
#define EC_RUN_KERNEL(name, LIST, entries)                                                                                                            \
    EC_INLINED void EC_CAT(name, _entry)(uint i, constant ec_params *params LIST(EC_PARAMETER));                                                      \
    EC_KERNEL_AT(name, queue_entry(params->part, RUN), LIST, entries)                                                                                 \
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

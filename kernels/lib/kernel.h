/* Macros that define entry points. PoCL compiles the body of one three times: as a kernel, and inlined into two launchers of a work-group. A kernel's work
 * is therefore in a function of its own, which is compiled once: `shade` of the showcase in 1.0 s in place of 2.7. On graphics cards it is inlined. */
#ifndef EC_LIB_KERNEL_H
#define EC_LIB_KERNEL_H

#include "queue.h"

/* Defines kernel `name`, whose body follows. The body is given part `row` of the queue, the first entry i of the `takes` that the work-item has, and
 * `left`, the number of entries from i on. LIST(DO): DO(type, name) for each parameter but params, in the order of host/device/stages.c. entries: an
 * expression for `left` by i, row and the parameters; where it is 0, the body is not called.
 * The second dimension of a launch is the parts. A work-group is in one part, so compilers for graphics cards see that its work-items increment
 * the same counter, and combine the atomic operations of those that run in step. A body does not ask for its work-item's id: PoCL would inline it. */
#define EC_KERNEL(name, takes, LIST, entries)                                                                                                         \
    EC_CALLED void EC_CAT(name, _item)(uint row, uint i, uint left, constant ec_params *params LIST(EC_PARAMETER));                                   \
    kernel void name(constant ec_params *params LIST(EC_PARAMETER))                                                                                   \
    {                                                                                                                                                 \
        uint row = (uint)get_group_id(1), i = queue_entry(params->part, row, (uint)get_global_id(0), takes), left = entries;                          \
        if (left) EC_CAT(name, _item)(row, i, left, params LIST(EC_ARGUMENT));                                                                        \
    }                                                                                                                                                 \
    EC_CALLED void EC_CAT(name, _item)(uint row, uint i, uint left, constant ec_params *params LIST(EC_PARAMETER))

/* Defines a kernel whose body handles a single entry i; a work-item calls it for RUN of them in turn. */
#define EC_RUN_KERNEL(name, LIST, entries)                                                                                                            \
    EC_INLINED void EC_CAT(name, _entry)(uint i, constant ec_params *params LIST(EC_PARAMETER));                                                      \
    EC_KERNEL(name, RUN, LIST, entries)                                                                                                               \
    {                                                                                                                                                 \
        for (uint end = i + min(left, RUN); i < end; i++) EC_CAT(name, _entry)(i, params LIST(EC_ARGUMENT));                                          \
    }                                                                                                                                                 \
    EC_INLINED void EC_CAT(name, _entry)(uint i, constant ec_params *params LIST(EC_PARAMETER))
/* Argument `entries` of a queue's kernels: what its counters say of entry i. */
#define QUEUED(count) queue_entries((global const uint *)counters->count, params->wave, params->part, row, i)
#define EC_PARAMETER(type, name) , type name
#define EC_ARGUMENT(type, name) , name

/* Parameters that many kernels have: those of a wave, and those of surfaces. */
#define WAVE_PARAMETERS(DO) DO(uint, seed) DO(uint, first_pixel) DO(global const uint *, pixel_list) DO(uint, bounce) DO(uint, step)
#define SURFACE_PARAMETERS(DO)                                                                                                                        \
    DO(global const float *, prims) DO(global const float *, indices) DO(global const float *, normals) DO(global const float *, tangents)            \
    DO(global const float *, uvs) DO(global const float *, colors) DO(global const float *, materials) DO(global const float *, texture_table)        \
    DO(global const uint *, texels) DO(constant float *, srgb) DO(global const float *, places)

#endif

/* Parameters of an accelerator's two kernels, whose templates are trace_rays.h, trace_packets.h and trace_interleaved.h. */
#ifndef EC_LIB_TRACE_H
#define EC_LIB_TRACE_H

#include "coplanar.h"
#include "film.h"
#include "kernel.h"
#include "slot_layers.h"
#include "tally.h"

#define INTERSECT_PARAMETERS(DO)                                                                                                                      \
    WAVE_PARAMETERS(DO) DO(global const ec_counters *, counters) DO(uint, sorts) DO(global const float *, paths) DO(global float *, hits)             \
    ACCEL_PARAMETERS(DO) FILTER_PARAMETERS(DO)
#define CONNECT_PARAMETERS(DO)                                                                                                                        \
    WAVE_PARAMETERS(DO) DO(global const ec_counters *, counters) DO(uint, sorts) DO(volatile global uint *, invalid)                                  \
    DO(global const float *, shadows) DO(global float *, radiance) ACCEL_PARAMETERS(DO) FILTER_PARAMETERS(DO) DO(global const float *, normals)       \
    DO(global const float *, tangents)

#endif

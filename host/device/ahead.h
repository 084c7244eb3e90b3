/* Builds kernels while the host still packs the scene, or even loads it. */
#ifndef EC_DEVICE_AHEAD_H
#define EC_DEVICE_AHEAD_H

#include "device/payload.h"

/* All that decides which kernels are built. It is compared and stored as bytes, so that padding has to be zero. */
typedef struct ec_build_plan {
    uint64_t built, called, without, never; /* EC_FEATURE_* */
    uint32_t launched, integrator, fast_math, lanes, wave, width, height, batch, triangles, accels;
} ec_build_plan;

/* The plan of a scene's last render, and whether building by it has begun. */
typedef struct ec_last_build {
    char name[4200]; /* of the note that keeps the plan */
    ec_build_plan plan;
    bool is_begun;
} ec_last_build;

/* Begins to build, while a scene is loaded, the programs of its last render on this device: most renders need the same. The first ec_build_ahead
 * notes its own plan for the next render if it differs; last_build must stay at its address until then. scene: its path. */
void ec_last_build_begin(ec_last_build *last_build, ec_cl *cl, const char *scene, uint32_t integrator);

/* Begins to build kernels before the payload is whole, when its accelerators and the effects that it calls for are known. Takes only programs that the
 * driver has in its cache, in a thread of their own (cl/ahead.h); batch: samples of a pixel, as for ec_payload_make. */
void ec_build_ahead(ec_cl *cl, const ec_payload *payload, const ec_render_effects *effects, uint32_t width, uint32_t height, uint32_t batch);

#endif

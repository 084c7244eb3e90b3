/* Kernels are built while the host still packs the scene, or even loads it. */
#ifndef EC_DEVICE_AHEAD_H
#define EC_DEVICE_AHEAD_H

#include "device/cargo.h"

/* All that says which kernels there are to build. Compared and kept as bytes: made of zeros first. */
typedef struct ec_build_plan {
    uint64_t built, called, without, never; /* EC_FEATURE_* */
    uint32_t launched, integrator, fast_math, lanes, wave, width, height, batch, triangles, accels;
} ec_build_plan;

/* Of one scene: what its last render built. */
typedef struct ec_recall {
    char name[4200];
    ec_build_plan plan;
    bool is_begun;
} ec_recall;

/* While a scene is loaded: begins with the programs that its last render on this device began with, of which most renders of it need the same. What is
 * noted at the first ec_build_ahead, where they are others, is for the next. scene: its path. Both stay where they are until that. */
void ec_recall_begin(ec_recall *recall, ec_cl *cl, const char *scene, uint32_t integrator);

/* Before the cargo is whole: its accelerators are there, and it is known what effects it will call for. Builds the programs that the driver has in its
 * cache, by a thread of their own (cl/ahead.h); batch: samples of a pixel, as for ec_cargo_make. */
void ec_build_ahead(ec_cl *cl, const ec_cargo *cargo, const ec_render_effects *effects, uint32_t width, uint32_t height, uint32_t batch);

#endif

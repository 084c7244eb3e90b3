/* Kernels are built while the host still packs the scene. */
#ifndef EC_DEVICE_AHEAD_H
#define EC_DEVICE_AHEAD_H

#include "device/cargo.h"

/* Before the cargo is whole: its accelerators are there, and it is known what effects it will call for. Builds the programs that the driver has in its
 * cache, by a thread of their own (cl/ahead.h); batch: samples of a pixel, as for ec_cargo_make. */
void ec_build_ahead(ec_cl *cl, const ec_cargo *cargo, const ec_render_effects *effects, uint32_t width, uint32_t height, uint32_t batch);

#endif

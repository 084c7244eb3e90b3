/* The light paths of a batch. */
#ifndef EC_DEVICE_LIGHT_BATCH_H
#define EC_DEVICE_LIGHT_BATCH_H

#include "device/pipeline.h"

/* Asked between waves; false stops the batch. */
typedef bool ec_light_go_on(void *user);

/* Returns the light paths a pixel: as many as asked for, rounded so that a picture of this size has a whole number of them, at least one. */
float ec_light_paths_a_pixel(double asked, uint32_t width, uint32_t height);

/* Traces params.batch light paths for each of those of a round of samples, and leaves their light in the splats. *complete: false if go_on, which may
 * be NULL, said no. Does nothing where there are no light paths. */
ec_result ec_light_batch_run(ec_pipeline *p, uint32_t seed, ec_light_go_on *go_on, void *user, bool *complete, ec_error *err);

#endif

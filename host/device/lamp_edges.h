/* Pixels that a lamp's edge goes through have most of the noise of many interiors. What their samples see of lamps at first sight is the mean of
 * EC_EDGE_RAYS camera rays of its own, which are cheap; a sample's path goes on from the surface that it meets, without that light. These pixels are
 * found by camera rays with random numbers of their own, which do not depend on the seed: the picture's mean stays what it is. */
#ifndef EC_DEVICE_LAMP_EDGES_H
#define EC_DEVICE_LAMP_EDGES_H

#include "device/pipeline.h"

/* Finds the pixels, before the first wave that this camera sees. */
ec_result ec_lamp_edges_find(ec_pipeline *pipeline, ec_error *err);
/* Gives the next wave the rays that its pixels need, for as many of *count pixels as there is room for; sets *count to that. first: pixel number of
 * the first one, or its place in `list`, as for ec_pipeline_run_wave; list: of the order, or NULL. */
ec_result ec_lamp_edges_prepare(ec_pipeline *pipeline, const uint32_t *list, uint32_t first, uint32_t *count, ec_error *err);

#endif

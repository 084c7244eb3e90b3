/* Which kernels a render begins with. Where a driver takes seconds to compile the fast ones, it begins with narrow ones, which compile sooner,
 * while another process compiles the fast ones into the driver's cache; they take over between two waves. The bits of the picture are the same. */
#ifndef EC_DEVICE_TIERS_H
#define EC_DEVICE_TIERS_H

#include "device/pipeline.h"

/* Builds the kernels that the pipeline begins with. */
ec_result ec_tiers_begin(ec_pipeline *pipeline, const ec_payload_head *head, ec_error *err);

/* Between two waves: lets the fast kernels take over, if they are there by now. */
ec_result ec_tiers_step(ec_pipeline *pipeline, ec_error *err);

#endif

/* Measures what an accelerator costs on a scene: to build, to keep, to trace a ray. For `eclat info --accel`. */
#ifndef EC_DEVICE_PROBE_H
#define EC_DEVICE_PROBE_H

#include "accel/accel.h"
#include "cl/cl.h"
#include "scene/scene.h"

#define EC_PROBE_RAYS 65536u

typedef struct ec_accel_probe {
    ec_accel_stats build;
    double nodes;           /* visited by a ray on average; for a grid blocks of cells and occupied cells */
    double triangles;       /* that a ray is tested against on average */
    double rays_per_second; /* closest hits, on all units of the device */
} ec_accel_probe;

/* Builds accelerator `which` and sends EC_PROBE_RAYS rays through it: from points spread evenly over the scene's surfaces, in
 * directions spread evenly over the sphere, the same ones for every accelerator. grid_density: see ec_accel_input. */
ec_result ec_probe_accel(ec_cl *cl, const ec_scene *scene, uint32_t which, float grid_density, ec_accel_probe *probe,
                         ec_error *err);

#endif

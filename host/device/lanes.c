/* How wide a device's kernels are. */
#include "cl/workarounds.h"
#include "device/pipeline.h"

ec_result ec_pipeline_lanes(const ec_cl *cl, uint32_t wanted, uint32_t *lanes, ec_error *err)
{
    const ec_workaround *driver = ec_workaround_for(&cl->info);
    uint32_t most = driver && driver->most_lanes ? driver->most_lanes : 16, n = wanted;
    if (wanted > most)
        return ec_fail(err, "--lanes %u on %s: %s (%s %s); leave --lanes out or choose %u", wanted, cl->info.name, driver->what,
                       driver->driver, driver->seen, most);
    if (!wanted) n = cl->info.type & CL_DEVICE_TYPE_GPU ? 1 : cl->info.native_float_width < most ? cl->info.native_float_width : most;
    *lanes = n >= 16 ? 16 : n >= 8 ? 8 : n >= 4 ? 4 : 1;
    return EC_OK;
}

/* Chooses how many lanes a device's kernels have. */
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

#define EC_CACHE_LARGE (UINT64_C(32) << 20) /* bytes; a larger cache is shared by many cores, and slow: waiting for it costs as much */

ec_traversal ec_traversal_of(const ec_device_info *device, uint32_t accel, uint64_t bytes, uint64_t features, uint32_t packet)
{
    const uint32_t lanes = ec_accels[accel].lanes;
    const ec_traversal packets = {"", packet, packet}, one = {"", lanes, 1}, runs = {" -DRUN=16u", lanes, 16}, turns = {" -DINTERLEAVE=8 -DRUN=64u", lanes, 64};
    const uint64_t cache = device->cache_bytes < EC_CACHE_LARGE ? device->cache_bytes : EC_CACHE_LARGE;
    bool is_large = bytes > cache / 8; /* of the last cache: those of a core are so much smaller */
    bool is_known = !(features & (EC_FEATURE_PANES | EC_FEATURE_MOTION | EC_FEATURE_COPLANAR)); /* trace_interleaved.h can do without these effects only */
    if (lanes == EC_LANES_OF_PIPELINE) return packets;
    if (!(device->type & CL_DEVICE_TYPE_CPU)) return one;
    return accel == ec_accel_find("bvh8") && is_large && is_known ? turns : runs;
}

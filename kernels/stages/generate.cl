/* Makes camera rays. Reads: params, and the camera's keys where it moves. Writes: the path queue, one entry a slot, and zeroes the slots' radiance;
 * with MOTION the slots' times. Next: intersect.
 * Slot s of a wave is sample s % batch of the wave's pixel s / batch. */
#include "../lib/camera.h"
#include "../lib/camera_axes.h"
#include "../lib/kernel.h"
#include "../lib/lens.h"
#include "../shared/features.h"
#include "../shared/params.h"

#define GENERATE_PARAMETERS(DO)                                                                                                                       \
    DO(uint, seed) DO(uint, first_pixel) DO(global const uint *, pixel_list) DO(global const float *, filter) DO(uint, path_count)                    \
    DO(global float *, paths) DO(global float *, radiance) DO(global const float *, camera_keys) DO(global const float *, motion)                     \
    DO(global float *, times) DO(global const uint *, edges)

/* Returns EC_PATH_PDF of camera rays, which says how lamps that the ray sees at first sight are counted (shared/path_state.h). */
EC_FN lane_f first_pdf(constant ec_params *params, uint first_pixel, global const uint *pixel_list, global const uint *edges, lane_u slot)
{
    uint count = params->width * params->height;
    if (!edges) return F(-1.0f);
    lane_u pixel, sample;
    slot_to_pixel(params, first_pixel, pixel_list, slot, &pixel, &sample);
    lane_u number = pixel - divide(pixel, count) * count;
    lane_i ends = pixel >= params->edge_numbers, is_edge = ((gather_u(edges, number / 32u) >> (number % 32u)) & 1u) != 0u;
    return ends ? F(EC_PDF_ENDS) : is_edge ? F(EC_PDF_BESIDE) : F(-1.0f);
}

EC_KERNEL(ec_generate, LANES, GENERATE_PARAMETERS, slot_entries(path_count, i))
{
    uint wave = params->wave;
    lane_u slot = LANE_NUMBERS + i;
    lane_u x, y;
    lane_f sx, sy;
    sampler random = camera_sample(params, seed, first_pixel, pixel_list, filter, slot, &x, &y, &sx, &sy);
    camera_axes v = camera_axes_make(params);
    if (HAS(MOTION) && motion) {
        lane_f time, unused;
        sample_pair(random, EC_PAIR_TIME, &time, &unused);
        queue_store_f(times, wave, 0, i, time);
        if (camera_keys) v = camera_axes_at(camera_keys, motion, time);
    }
    v3 offset = v3_fma(v.right, sx, v3_scale(v.up, sy)), o = v.origin, d = v.forward;
    if (params->orthographic)
        o = v3_add(o, offset);
    else
        d = v3_add(d, offset);
    if (HAS(LENS) && !params->orthographic) lens_shift(&v, params->lens_nearness, random, &o, &d);
    if (HAS(LIGHT_PATHS) && params->light_paths > 0.0f) { /* d is 1 long along the axis, so 1 / its length is the cosine */
        lane_f cosine = params->orthographic ? F(1.0f) : 1.0f / sqrt(v3_dot(d, d));
        queue_store_f(paths, wave, EC_PATH_K, i, -params->light_paths * params->film_area * cosine * cosine * cosine);
    }
    if (!params->orthographic) d = v3_normalize(d);

    queue_store_v3(paths, wave, EC_PATH_OX, i, o);
    queue_store_v3(paths, wave, EC_PATH_DX, i, d);
    queue_store_v3(paths, wave, EC_PATH_BR, i, v3_splat(F(1.0f)));
    queue_store_f(paths, wave, EC_PATH_PDF, i, first_pdf(params, first_pixel, pixel_list, edges, slot));
    queue_store_f(paths, wave, EC_PATH_SLOT, i, as_lane_f(slot));
    queue_store_f(paths, wave, EC_PATH_PRIM, i, as_lane_f(U(0xffffffffu)));
    if (HAS_MEDIUM) queue_store_f(paths, wave, EC_PATH_MEDIUM, i, as_lane_f(U(params->camera_medium)));
    queue_store_v3(radiance, wave, 0, i, v3_zero());
    for (uint k = 1; HAS(LAYERS) && k <= params->layer_count; k++) queue_store_v3(radiance, wave, 3 * k, i, v3_zero());
    if (HAS(LAYERS) && params->layer_ids) queue_store_v3(radiance, wave, 3 * params->layer_ids, i, v3_zero());
    if (params->apart) queue_store_v3(radiance, wave, 3, i, v3_zero());
}

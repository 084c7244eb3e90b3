/* Kernels and buffers of one render on one device, and the bounce loop. Inside host/device and host/rare only. */
#ifndef EC_DEVICE_PIPELINE_H
#define EC_DEVICE_PIPELINE_H

#include "cl/compiler.h"
#include "device/payload.h"
#include "device/options.h"
#include "device/stats.h"
#include "device/kernel_set.h"
#include "device/stages.h"
#include "shared/params.h"
#include "shared/path_state.h"

#define EC_TUNED_BOUNCES 4 /* bounces with a tuning of their own; later ones share the last */

typedef struct ec_help ec_help;

typedef struct ec_pipeline {
    ec_cl *cl;
    ec_integrator integrator;
    ec_params params;
    ec_counters counters;         /* the host's copy */
    ec_render_effects effects;
    uint32_t lanes, wave, triangle_count;
    uint32_t bounces[2];          /* of the last wave that had a path: of paths from the camera, and from lights; 0: none yet */
    uint32_t held;                /* most entries that a part of a queue holds in the segment under way; 0: not known */
    uint32_t room;                /* paths that the buffers of the wave hold; a wave of the first kernels has fewer (tiers.h) */
    uint32_t first_room;          /* what should have fitted the device; room is smaller if it had no memory for that */
    uint64_t wave_bytes;          /* size of the wave's buffers, for which drivers may not have given memory yet */
    uint64_t film_pixels;         /* pixels that the films have room for */
    bool fast_math, wave_is_given;
    cl_mem buffers[EC_ARG_COUNT];
    cl_mem path_queues[2];
    ec_kernel_set kernels;        /* the kernels that are launched */
    bool is_narrow;               /* they are those that the render began with (tiers.h) */
    uint32_t waves_until_fast;    /* 0: until the fast kernels are compiled; UINT32_MAX: never */
    uint32_t narrow_waves;        /* waves that were not rendered by all of the fast kernels */
    ec_begun begun;
    bool keeps_kernels;           /* kernels never change, since the device does not say that it rounds as others do */
    double fast_since;            /* base/clock.h; 0: from the beginning, or not yet */
    ec_compiler compiler;
    ec_help *help;                /* its own part in compiling; NULL: it has none */
    struct {
        bool in_use;
        uint64_t bytes;
        cl_mem buffers[EC_ACCEL_BUFFERS];
        /* Rays a second of each way, the best trial at each bounce. All ways give the same hits. */
        struct ec_tuning {
            double best_rate;
            uint32_t trials;
        } tuning[2][2][EC_TUNED_BOUNCES][2]; /* indices: paths from the camera, or from lights; intersect, or connect; bounce; rays as they come, or
                                              * sorted */
    } accels[EC_ACCEL_COUNT];
    struct {
        uint32_t *marks;     /* copy of EC_ARG_EDGES; owned; NULL: none */
        uint32_t *list;      /* copy of EC_ARG_EDGE_LIST, with room for `room` entries; owned */
        uint32_t room, positions; /* positions: of rays in the next wave, beside its pixels */
    } edges;                 /* device/lamp_edges.h */
    float *guide;                 /* copy of EC_ARG_GUIDE; owned; NULL: none */
    uint64_t rays;                /* traced so far, shadow rays included */
    double clocked_seconds, clocked_rays; /* of trials (trace.c) */
} ec_pipeline;

/* Puts a payload on a device and builds the kernels that it calls for. spent: the same payload, if nobody else needs it: each of its buffers is freed as
 * soon as the device has it, and then the rest; else NULL. stats gets times, lanes and wave. */
ec_result ec_pipeline_create(ec_cl *cl, const ec_payload *payload, ec_payload *spent, ec_pipeline *pipeline,
                             ec_render_stats *stats, ec_error *err);
void ec_pipeline_destroy(ec_pipeline *pipeline);

/* Puts what light paths have brought to so many pixels into the batch film, as if it were a batch. */
ec_result ec_pipeline_show_light(ec_pipeline *pipeline, uint32_t first_pixel, uint32_t pixel_count, ec_error *err);
/* Renders one wave: `pixel_count` pixels from `first_pixel`, params.batch samples each, into the batch film. */
ec_result ec_pipeline_run_wave(ec_pipeline *pipeline, uint32_t seed, uint32_t first_pixel, uint32_t pixel_count,
                               bool with_features, ec_error *err);
/* Traces one camera ray, which ends at the first hit, for each of so many entries of EC_ARG_EDGE_LIST: what it sees of lamps is the slots' radiance.
 * params.batch must be 1. */
ec_result ec_pipeline_run_edge_rays(ec_pipeline *pipeline, uint32_t seed, uint32_t count, ec_error *err);
/* Traces light paths first … first + count - 1 of each round of params.batch samples, into the splats; seed: of the replicate's light paths. */
ec_result ec_pipeline_run_light_wave(ec_pipeline *pipeline, uint32_t seed, uint32_t first, uint32_t count, ec_error *err);
/* train.c: makes the table of the guide, if that is called for; before the first wave. *seconds: the time that took. */
ec_result ec_pipeline_train(ec_pipeline *pipeline, double *seconds, ec_error *err);
/* Reads how many samples were dropped so far, by ec_stage. */
ec_result ec_pipeline_read_invalid(ec_pipeline *pipeline, uint32_t counts[EC_STAGE_COUNT], ec_error *err);
/* Traces a wave's camera rays by an integrator, and adds to their slots' radiance. scalars: by ec_arg. */
typedef ec_result ec_integrate(ec_pipeline *pipeline, uint32_t *scalars, ec_error *err);
ec_integrate ec_integrate_paths;   /* wave.c */
ec_integrate ec_integrate_whitted; /* whitted.c */
ec_integrate ec_integrate_raster;  /* raster.c */

/* queues.c: the sum of a queue's parts, and the largest of them; puts the first paths into one part after the other; swaps the queues that are read
 * and written */
uint64_t ec_pipeline_total(const uint32_t *parts);
uint32_t ec_pipeline_fullest(const uint32_t *parts);
void ec_pipeline_fill_parts(ec_pipeline *pipeline, uint32_t paths);
void ec_pipeline_swap_queues(ec_pipeline *pipeline, uint32_t bounce);
/* Returns the size of the counters of so many bounces and of the paths that are left after them. */
uint64_t ec_counters_bytes(uint32_t bounces);
/* Zeroes them, but for the rays of the first bounce; returns their size. */
uint64_t ec_counters_clear(ec_counters *counters, uint32_t bounces);

/* raster.c: triangles are sorted into tiles once a camera */
void ec_raster_forget(ec_pipeline *pipeline);

/* Returns the words of a slot's stack for Whitted's trees; max_depth as in the options. */
static inline uint64_t ec_whitted_stack_words(uint32_t max_depth)
{
    return 1 + (uint64_t)((max_depth ? max_depth : EC_WHITTED_DEPTH) - 1) * EC_BRANCH_FIELDS;
}

/* Returns whether pixels can have rays to lamps' edges (lamp_edges.h). */
static inline bool ec_pipeline_edges_can_be(const ec_pipeline *p)
{
    return (p->integrator == EC_INTEGRATOR_PATH || p->integrator == EC_INTEGRATOR_LIGHT) && p->effects.called.bits & EC_FEATURE_EMISSION;
}

/* camera.c: sets the camera without a lens, and with one */
void ec_pipeline_set_view(const ec_camera *camera, const ec_render_options *options, ec_params *params);
ec_result ec_pipeline_set_camera(const ec_camera *camera, const ec_render_options *options, ec_params *params, ec_error *err);
/* upload.c; spent: as for ec_pipeline_create */
ec_result ec_pipeline_upload(ec_pipeline *pipeline, const ec_payload *payload, ec_payload *spent, ec_error *err);
/* upload_plan.c: plans what of the scene goes to the device, and for which effects */
typedef struct ec_upload {
    ec_arg arg;
    const void *data; /* NULL: made when it is uploaded */
    uint64_t slack;   /* spare bytes behind the end, for streams that are read past it in fours of words */
    ec_scene_buffer buffer;
} ec_upload;
uint32_t ec_upload_plan(const ec_scene *scene, const ec_pack *pack, ec_upload plan[EC_SCENE_BUFFERS], ec_render_effects *effects);
/* Returns the scene's triangles and instances, as builders take them. */
ec_accel_input ec_accel_input_of(const ec_scene *scene, float grid_density);
/* queues.c: fits the wave to the device and makes its buffers; params must be complete but for the wave. wave: paths in flight; 0 = whatever suits
 * the device. */
ec_result ec_pipeline_create_queues(ec_pipeline *pipeline, uint32_t wave, ec_error *err);
/* Sets the wave alone, as if there were memory for it. */
void ec_pipeline_plan_wave(ec_pipeline *pipeline, uint32_t wave);
/* Returns how many paths a wave has with narrow kernels with these features: fewer, since they are slower, and may keep more of each path. 0: there
 * is no room for a batch. */
uint32_t ec_pipeline_narrow_wave(const ec_pipeline *pipeline, uint64_t features);
/* Sets how many paths the next waves have, at most those that there is room for. */
ec_result ec_pipeline_use_wave(ec_pipeline *pipeline, uint32_t wave, ec_error *err);
/* Makes room for films of so many pixels and batches of so many positions, which ec_pipeline_run_wave needs; contents are lost where they grow. */
ec_result ec_pipeline_fit_films(ec_pipeline *pipeline, uint64_t pixels, uint64_t positions, ec_error *err);
/* launch.c: returns the work-items of a launch of this stage over each part of a wave, of which *rows is the number, or over triangles. takes: as
 * in ec_bound_kernel */
uint64_t ec_pipeline_items(ec_stage_id stage, uint32_t takes, uint32_t wave, uint32_t triangles, uint32_t *rows);
ec_result ec_pipeline_launch(ec_pipeline *pipeline, ec_stage_id stage, const uint32_t *scalars, ec_error *err);
ec_result ec_pipeline_launch_trace(ec_pipeline *pipeline, int connect, uint32_t accel, const uint32_t *scalars, ec_error *err);
/* Notes that a launch of a stage had the entries of a queue, counted by parts. */
void ec_pipeline_busy(ec_pipeline *pipeline, ec_stage_id stage, const uint32_t *parts);
/* trace.c: traces the closest hits or the shadow rays of a bounce, in the way that has proved the fastest there; sets EC_ARG_SORTS. */
ec_result ec_pipeline_trace(ec_pipeline *pipeline, int connect, uint32_t bounce, uint32_t *scalars, ec_error *err);

/* effects.c: sets what is called for, built and launched; returns the features of universal kernels, all but other random numbers and what is left
 * out on purpose; those that can change a stage's code; and whether light is sampled by shadow rays */
void ec_pipeline_effects(const ec_render_options *options, const ec_pack *pack, ec_render_effects *effects);
uint64_t ec_universal_features(const ec_render_effects *effects);
uint64_t ec_stage_features(const ec_stage_entry *stage, uint64_t features);
bool ec_pipeline_joins(const ec_render_options *options, const ec_pack *pack);

/* Sets how many lanes a device gets; wanted 0: whatever suits it. Fails if its compiler cannot do what is wanted. */
ec_result ec_pipeline_lanes(const ec_cl *cl, uint32_t wanted, uint32_t *lanes, ec_error *err);

#endif

/* Kernels and buffers of one render on one device, and the bounce loop. Internal to pipeline/. */
#ifndef EC_PIPELINE_PIPELINE_H
#define EC_PIPELINE_PIPELINE_H

#include "accel/bvh.h"
#include "pack/pack.h"
#include "pipeline/render.h"
#include "pipeline/stages.h"
#include "shared/params.h"
#include "shared/path_state.h"

/* Which traversal a bounce uses; both give the same hits. */
typedef enum ec_trace { EC_TRACE_PACKET, EC_TRACE_BVH8, EC_TRACE_COUNT } ec_trace;
#define EC_LANES_MOST 16
#define EC_TUNED_BOUNCES 4 /* bounces with a choice of their own; later ones share the last */

typedef struct ec_pipeline {
    ec_cl *cl;
    ec_integrator integrator;
    ec_params params;
    ec_counters counters;         /* the host's copy */
    uint32_t features, lanes, wave, triangle_count;
    cl_mem buffers[EC_ARG_COUNT];
    cl_mem path_queues[2];
    cl_program programs[EC_LANES_MOST + 1]; /* by lane width */
    cl_kernel kernels[EC_STAGE_ID_COUNT];
    bool has_trace[EC_TRACE_COUNT];
    /* Measured choice of traversal, at each bounce: the best rays a second of each kind while both are being tried. */
    struct {
        double best_rate[EC_TRACE_COUNT];
        uint32_t trials[EC_TRACE_COUNT];
    } tuning[2][EC_TUNED_BOUNCES]; /* [0] intersect, [1] connect */
    uint64_t rays;                /* traced so far, shadow rays included */
} ec_pipeline;

/* Uploads the scene and builds the kernels that it calls for. */
ec_result ec_pipeline_create(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, uint32_t batch,
                             ec_pipeline *pipeline, ec_render_stats *stats, ec_error *err);
void ec_pipeline_destroy(ec_pipeline *pipeline);

/* One wave: `pixel_count` pixels from `first_pixel`, params.batch samples each, into the batch film. */
ec_result ec_pipeline_run_wave(ec_pipeline *pipeline, uint32_t seed, uint32_t first_pixel, uint32_t pixel_count,
                               bool with_features, ec_error *err);
/* What an integrator does with a wave's camera rays: adds to their slots' radiance. scalars: by ec_arg. */
typedef ec_result ec_integrate(ec_pipeline *pipeline, uint32_t *scalars, ec_error *err);
ec_integrate ec_integrate_paths;  /* wave.c */
ec_integrate ec_integrate_raster; /* raster.c */

/* upload.c */
ec_result ec_pipeline_upload(ec_pipeline *pipeline, const ec_scene *scene, const ec_pack *pack, ec_error *err);
ec_result ec_pipeline_upload_accel(ec_pipeline *pipeline, const ec_scene *scene, ec_error *err);
ec_result ec_pipeline_create_queues(ec_pipeline *pipeline, ec_error *err);
/* build.c */
ec_result ec_pipeline_build(ec_pipeline *pipeline, ec_error *err);
/* launch.c */
ec_result ec_pipeline_launch(ec_pipeline *pipeline, ec_stage_id stage, const uint32_t *scalars, ec_error *err);

/* Names of the features in a mask, blank separated. */
void ec_feature_names(uint32_t features, char *text, size_t size);

#endif

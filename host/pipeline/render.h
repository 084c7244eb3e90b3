/* Renders a scene on a device into a film: the one entry that the CLI, the tests and later the preview use. */
#ifndef EC_PIPELINE_RENDER_H
#define EC_PIPELINE_RENDER_H

#include <stdbool.h>
#include <stdint.h>

#include "accel/follow.h"
#include "base/error.h"
#include "cl/cl.h"
#include "film/film.h"
#include "pipeline/content.h"
#include "pipeline/effects.h"
#include "pipeline/goal.h"
#include "scene/scene.h"
#include "shared/params.h"

typedef enum ec_sampler_type { EC_SAMPLER_SOBOL, EC_SAMPLER_INDEPENDENT } ec_sampler_type;

/* Where rays leave a facet with vertex normals: kernels/lib/terminator.h. */
typedef enum ec_scattering { EC_SCATTERING_SINGLE, EC_SCATTERING_MULTIPLE } ec_scattering; /* by rough facets: kernels/lib/multiscatter.h */
typedef enum ec_terminator { EC_TERMINATOR_GEOMETRIC, EC_TERMINATOR_SMOOTH } ec_terminator;

/* Which light a surface is joined to: by power wherever it is, or by a tree that knows where lights are (kernels/lib/light_tree.h). */
typedef enum ec_light_choice { EC_LIGHTS_AUTO, EC_LIGHTS_BY_POWER, EC_LIGHTS_BY_TREE } ec_light_choice;

/* What makes the picture; the words are in report/names.c, the functions in wave.c, the options of each in
 * cli/combinations.c. */
typedef enum ec_integrator {
    EC_INTEGRATOR_PATH,   /* global illumination */
    EC_INTEGRATOR_WHITTED, /* a tree of mirrored and refracted rays, direct light from the lights' centres */
    EC_INTEGRATOR_RASTER, /* direct light from the lights' centres, without shadows */
    EC_INTEGRATOR_COUNT
} ec_integrator;

#define EC_WHITTED_DEPTH 10     /* segments of Whitted's trees where max_depth is 0 */
#define EC_WHITTED_DEPTH_MOST 64 /* each takes 48 bytes a path in flight */

/* Rasterising has the box alone: its samples look at the triangles of their pixel's tile. */
typedef enum ec_pixel_filter { EC_FILTER_BOX, EC_FILTER_BLACKMAN_HARRIS } ec_pixel_filter;
#define EC_FILTER_WIDTH 1.5 /* as Cycles has it */

typedef struct ec_render_options {
    uint32_t width, height;     /* pixels */
    uint32_t camera;            /* index into the scene's cameras */
    ec_pixel_filter filter;
    double filter_width;        /* pixels from the centre to the edge, of other filters than the box; 0 = EC_FILTER_WIDTH */
    double fstop;               /* of a thin lens; 0 = a pinhole. The aperture's diameter is focal length / fstop */
    double focus;               /* metres to the plane in focus, along the camera's axis */
    uint32_t spp;               /* stop after so many samples a pixel; 0 = no such limit */
    double time_limit;          /* stop before this many seconds of rendering; 0 = none */
    double error_target;        /* stop when the image's error bound is under this (0.02 = 2 %); 0 = none */
    uint32_t replicates;        /* independent copies of the sample sequence, up to EC_REPLICATES_MOST; 0 = EC_REPLICATES */
    ec_integrator integrator;
    uint32_t max_depth;         /* path segments: 1 = emission only, 2 = direct light; 0 = unlimited, Whitted: 10 */
    double cutoff;              /* Whitted: branches of less weight than this are not followed */
    double clamp;               /* most luminance of a sample's indirect light, in mean luminances of the picture (limit.c); 0 = no limit */
    double clamp_luminance;     /* the same in itself, where it is known beforehand; 0 = a pilot finds the picture's mean */
    double survival;            /* of Russian roulette at every surface; 0 = by throughput, 1 = off: refused without a max_depth */
    ec_sampler_type sampler;
    ec_sample sample;           /* all converge to the same image */
    ec_light_choice light_choice;
    ec_scattering scattering;
    ec_terminator terminator;   /* smooth: rays start on the smooth surface, not on its facets */
    uint64_t seed;
    uint32_t lanes;             /* 1, 4, 8, 16; 0 = the device's native vector width */
    uint32_t wave;              /* paths in flight; 0 = fitted to the device */
    uint64_t memory;            /* bytes that the process should not exceed: else it renders strips (strips.h); 0 = what is free */
    uint32_t slice_first, slice_end; /* batches (film/schedule.h) of a slice, for what they take of it; slice_end 0: it is none */
    bool adaptive;              /* more samples where the pilot finds more noise; spp is then their mean */
    bool all_effects;           /* build the universal kernels instead of the specialised ones */
    uint64_t without;           /* EC_FEATURE_*, switched off on purpose: of ec_effects_optional */
    uint32_t without_of;        /* in material n - 1 alone; 0: in all */
    uint64_t more_effects;      /* EC_FEATURE_*, built in though the scene may not call for them: so that scenes share kernels */
    const char *accel;          /* "auto" (NULL), or the name of an acceleration structure: see accel/accel.h */
    float grid_density;         /* cells a reference, where that is a grid; 0 = EC_GRID_DENSITY */
    struct ec_followed *followed; /* acceleration structures of the render before, which goes on with them (accel/follow.h); NULL: none */
    bool identify;              /* say in the stats what is rendered: content */
    bool fast_math;             /* kernels by -cl-fast-relaxed-math: for `eclat cost` alone, to see what exact arithmetic costs */
} ec_render_options;

typedef struct ec_progress {
    double seconds, seconds_left;       /* seconds_left < 0: unknown */
    double fraction;                    /* 0..1 of the first limit that will end the render */
    uint64_t samples_per_pixel, samples; /* done */
    double samples_per_second;
    double error, error_bound;
    const ec_forecast *pilot;           /* the first one, once there is one; then the one of now */
    ec_forecast forecast;
} ec_progress;
/* Called after every batch and at least twice a second where waves allow; returning false stops cleanly: the film keeps
 * the batches that are complete, and where none is, what there is of the first. */
typedef bool (*ec_progress_fn)(void *user, const ec_progress *progress);

/* What came from one of several devices. */
typedef struct ec_render_share {
    double samples;               /* a pixel, in the mean */
    uint32_t lanes, wave;
    uint64_t device_bytes;        /* peak of all buffers */
    bool has_failed;
} ec_render_share;
enum { EC_DEVICES_MOST = 32 };    /* that one render takes */

typedef struct ec_render_stats {
    double seconds;               /* rendering, without set-up */
    double cpu_seconds;           /* processor time of this process meanwhile, all threads; on a CPU device the kernels' too */
    double accel_seconds, pack_seconds, kernel_seconds; /* set-up: BVH, buffers, kernel build or cache look-up */
    double first_pixel_seconds;   /* from ec_render's start to the first finished wave */
    uint64_t samples_per_pixel, samples, rays; /* samples: in the film; rays: those of a batch that was given up too */
    double samples_per_second, rays_per_second;
    ec_film_error film;           /* the error, its bound, or why there is none */
    ec_forecast forecast;         /* the pilot's */
    double clamp_luminance;       /* most of a sample's indirect light; 0: no limit */
    double allotment_gain;        /* adaptive: error^2 over uniform sampling's, foretold; 1 where there was nothing to gain */
    uint64_t invalid_generate, invalid_intersect, invalid_shade, invalid_connect, invalid_accumulate;
    uint64_t invalid_samples;     /* their sum: non-finite contributions dropped, still counted in N */
    uint32_t lanes, wave, replicates;
    uint32_t strips;              /* in which the picture was rendered: 1, the whole, where it fitted into memory */
    uint32_t instances;           /* of meshes that are kept once; 0: none, or they were written out */
    uint64_t triangles, stored_triangles; /* that rays can meet, and that take memory */
    uint64_t device_bytes;        /* peak of all buffers, on all devices */
    uint64_t scene_bytes;         /* of what goes to each device, made of the scene */
    ec_render_share shares[EC_DEVICES_MOST]; /* by device, where there are several */
    uint32_t share_count;
    uint32_t allies;              /* other processes that took part … */
    double allied_samples;        /* … what they took, samples a pixel in the mean … */
    uint64_t allied_bytes;        /* … and what came of it to this process */
    ec_render_effects effects;    /* which were called for, why, and what came of it */
    ec_content content;           /* with options.identify */
    char stopped_by[16];          /* "spp", "time", "error", "user"; "device" or "failure" where ec_render failed */
    uint32_t cache_hits, cache_misses;
    double trace_seconds;         /* of rays through structures: what clocked launches took, for all rays; else an upper bound, `seconds` */
    ec_follow_report followed;    /* with options.followed: what became of the structures */
    uint32_t programs_found, programs_built; /* kept by the device since the one before; made or read from the cache */
    uint64_t bytes_found, bytes_uploaded;    /* likewise of the scene's buffers */
} ec_render_stats;

/* film must be zero-initialised; the caller destroys it. cl stays the caller's. On failure too the film keeps the batches that were
 * complete, and stats tells of them: film->batch_count says whether there is a picture. */
ec_result ec_render(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, ec_progress_fn progress,
                    void *user, ec_film *film, ec_render_stats *stats, const ec_log *log, ec_error *err);

/* Replicates of the options. */
static inline uint32_t ec_render_replicates(const ec_render_options *o) { return o->replicates ? o->replicates : EC_REPLICATES; }

/* What the kernels seed a render of that seed with. */
uint32_t ec_render_seed(uint64_t seed);

/* How many lanes a device gets; wanted 0: what suits it. Fails where its compiler cannot do what is wanted. */
ec_result ec_pipeline_lanes(const ec_cl *cl, uint32_t wanted, uint32_t *lanes, ec_error *err);

/* Bytes of device memory the scene itself will take (geometry, BVH of ref_count references, textures, lights), and what a render
 * makes of its effects. For `eclat info`. */
ec_result ec_scene_estimate(const ec_scene *scene, const ec_render_options *options, uint32_t ref_count, uint64_t *device_bytes,
                            ec_render_effects *effects, ec_error *err);

#endif

/* How a picture is to be rendered. */
#ifndef EC_DEVICE_OPTIONS_H
#define EC_DEVICE_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "film/denoiser.h"
#include "film/layers.h"
#include "film/schedule.h"
#include "scene/light_groups.h"
#include "shared/params.h"

typedef enum ec_sampler_type { EC_SAMPLER_SOBOL, EC_SAMPLER_INDEPENDENT } ec_sampler_type;

/* How often light is scattered by rough facets: kernels/lib/multiscatter.h. */
typedef enum ec_scattering { EC_SCATTERING_SINGLE, EC_SCATTERING_MULTIPLE } ec_scattering;
/* How rays leave a facet that has vertex normals: kernels/lib/terminator.h. */
typedef enum ec_terminator { EC_TERMINATOR_GEOMETRIC, EC_TERMINATOR_SMOOTH } ec_terminator;

/* How a surface chooses the light that it samples: by power wherever it is, or by a tree that knows where lights are (kernels/lib/light_tree.h). */
typedef enum ec_light_choice { EC_LIGHTS_AUTO, EC_LIGHTS_BY_POWER, EC_LIGHTS_BY_TREE } ec_light_choice;

/* The algorithm that makes the picture; the words are in report/names.c, the functions in wave.c, the options of each in jobs/render_settle.c. */
typedef enum ec_integrator {
    EC_INTEGRATOR_PATH,   /* global illumination */
    EC_INTEGRATOR_WHITTED, /* a tree of mirrored and refracted rays, direct light from the lights' centres */
    EC_INTEGRATOR_RASTER, /* direct light from the lights' centres, without shadows */
    EC_INTEGRATOR_LIGHT,  /* light tracing: paths from the lights, joined to the camera */
    EC_INTEGRATOR_COUNT
} ec_integrator;

/* Returns whether paths go through queues, bounce by bounce. */
static inline bool ec_traces_paths(ec_integrator i) { return i == EC_INTEGRATOR_PATH || i == EC_INTEGRATOR_LIGHT; }

#define EC_LIGHT_PATHS_MOST 16
#define EC_LIGHT_PATHS_AUTO (-1.0) /* render/caustics.c decides */
#define EC_LIGHT_PATHS_RARE 0.25   /* for caustics that camera paths hardly ever meet */
#define EC_LIGHT_PATHS_ALONE 1.0 /* of --integrator light */
#define EC_WHITTED_DEPTH 10     /* segments of Whitted's trees where max_depth is 0 */
#define EC_WHITTED_DEPTH_MOST 64 /* each takes 48 bytes a path in flight */

/* The rasteriser has the box alone: its samples look at the triangles of their pixel's tile. */
typedef enum ec_pixel_filter { EC_FILTER_BOX, EC_FILTER_BLACKMAN_HARRIS } ec_pixel_filter;
#define EC_FILTER_WIDTH 1.5 /* as Cycles has it */

/* When kernels are compiled that take long: beside the render, which begins with others (tiers.h), first, or not at all. */
typedef enum ec_compile { EC_COMPILE_AUTO /* $ECLAT_COMPILE, else beside */, EC_COMPILE_BESIDE, EC_COMPILE_FIRST, EC_COMPILE_NARROW, EC_COMPILE_COUNT } ec_compile;

typedef struct ec_render_options {
    uint32_t width, height;     /* pixels */
    uint32_t camera;            /* index into the scene's cameras */
    double screen_window[4];    /* left, right, bottom, top of the picture in the image plane, in half heights of the camera's view; all 0: that view */
    ec_pixel_filter filter;
    double filter_width;        /* pixels from the centre to the edge, of other filters than the box; 0 = EC_FILTER_WIDTH */
    double fstop;               /* of a thin lens; 0 = a pinhole. The aperture's diameter is focal length / fstop */
    double focus;               /* metres to the plane in focus, along the camera's axis */
    uint32_t spp;               /* stop after so many samples a pixel; 0 = no such limit */
    double time_limit;          /* stop before this many seconds of rendering; 0 = none */
    double error_target;        /* stop when the image's error bound is under this (0.02 = 2 %); 0 = none */
    uint32_t replicates;        /* independent copies of the sample sequence, up to EC_REPLICATES_MOST; 0 = the default of ec_render_replicates */
    ec_integrator integrator;
    uint32_t max_depth;         /* path segments: 1 = emission only, 2 = direct light; 0 = unlimited, Whitted: 10 */
    double cutoff;              /* Whitted: branches of less weight than this are not followed */
    double clamp;               /* most luminance of a sample's indirect light, in mean luminances of the picture (limit.c); 0 = no limit */
    double clamp_luminance;     /* the same in itself, where it is known beforehand; 0 = a pilot finds the picture's mean */
    bool guiding;               /* directions are guided by what light paths have found */
    double light_paths;         /* for each camera path, where there is something that bends light sharply; 0 = none; EC_LIGHT_PATHS_AUTO: path tracing by all ways, without clamp and layers */
    double fog[3];              /* around bodies: extinction, 1/m, 0 = none; albedo; mean cosine of scattering */
    double survival;            /* of Russian roulette at every surface; 0 = by throughput, 1 = off: refused without a max_depth */
    ec_sampler_type sampler;
    ec_sample sample;           /* all converge to the same image */
    ec_light_choice light_choice;
    double far_share;           /* share of light samples that goes to lights at infinity, where there are lamps too; 0: the one with the least noise */
    ec_scattering scattering;
    ec_terminator terminator;   /* smooth: rays start on the smooth surface, not on its facets */
    uint64_t seed;
    uint32_t lanes;             /* 1, 4, 8, 16; 0 = the device's native vector width */
    ec_compile compile;
    uint32_t waves_until_fast;  /* render so many waves with the kernels that compile soonest, then switch; 0 = by `compile`. For tests */
    uint32_t wave;              /* paths in flight; 0 = whatever suits the device */
    uint64_t memory;            /* bytes that the process should not exceed: else it renders strips (strips.h); 0 = what is free */
    uint32_t slice_first, slice_end; /* batches (film/schedule.h) of a slice, by which its memory is estimated; slice_end 0: no slice */
    ec_denoiser denoise;        /* asks for more first hits, which a denoiser uses; error_target is the clean picture's then */
    bool hides_environment;     /* from the camera: where it sees no surface the picture is black, and its alpha 0 */
    ec_layers layers;           /* layers of the picture beside its radiance */
    const ec_light_groups *groups; /* which light belongs to which group; NULL: no groups. Not owned */
    bool adaptive;              /* more samples where the pilot finds more noise; spp is then their mean */
    bool all_effects;           /* build the universal kernels instead of the specialised ones */
    uint64_t without;           /* EC_FEATURE_*, switched off on purpose: of ec_effects_optional */
    uint32_t without_of;        /* in material n - 1 alone; 0: in all */
    uint64_t more_effects;      /* EC_FEATURE_*, built in though the scene may not call for them: so that scenes share kernels */
    const char *accel;          /* "auto" (NULL), or the name of an acceleration structure: see accel/accel.h */
    float grid_density;         /* cells a reference, where that is a grid; 0 = EC_GRID_DENSITY */
    struct ec_followed *followed; /* acceleration structures of the render before, which goes on with them (accel/follow.h); NULL: none */
    bool identify;              /* fills in the stats' content: what is rendered */
    bool fast_math;             /* kernels by -cl-fast-relaxed-math: for `eclat cost` alone, to see what exact arithmetic costs */
} ec_render_options;

static inline bool ec_has_screen_window(const ec_render_options *o) { return o->screen_window[0] < o->screen_window[1]; }

/* Returns the number of replicates. */
static inline uint32_t ec_render_replicates(const ec_render_options *o)
{
    return o->replicates ? o->replicates : o->denoise ? EC_REPLICATES_DENOISED : EC_REPLICATES;
}

/* Return the number of sets of first-hit features (film/sums.h) of a film, and the batch from which on samples bring none: UINT32_MAX where a
 * denoiser uses them, or the picture's alpha. */
static inline uint32_t ec_render_feature_sets(const ec_render_options *o) { return o->denoise ? 2 : 1; }
static inline uint32_t ec_render_feature_end(const ec_render_options *o)
{
    return o->denoise || o->hides_environment ? UINT32_MAX : ec_schedule_features(ec_render_replicates(o));
}

/* Returns the kernels' seed of a render with that seed. */
uint32_t ec_render_seed(uint64_t seed);
/* Returns the seed of a replicate's light paths, where seed is that of camera paths. */
uint32_t ec_light_path_seed(uint32_t seed, uint32_t replicate);

#endif

/* Figures of a render: what it took and what came of it. */
#ifndef EC_DEVICE_STATS_H
#define EC_DEVICE_STATS_H

#include "accel/follow.h"
#include "device/content.h"
#include "device/effects.h"
#include "film/forecast.h"

/* The kernels that a render began with: tiers.h. */
typedef enum ec_begun { EC_BEGUN_FAST, EC_BEGUN_NARROW, EC_BEGUN_UNIVERSAL } ec_begun;

/* One device's part in a render with several. */
typedef struct ec_render_share {
    double samples;               /* samples a pixel, in the mean */
    uint32_t lanes, wave;
    uint64_t device_bytes;        /* peak of all buffers */
    bool has_failed;
} ec_render_share;
enum { EC_DEVICES_MOST = 32 };    /* devices that one render takes at most */

typedef struct ec_render_stats {
    double seconds;               /* rendering, without set-up */
    double cpu_seconds;           /* processor time of this process meanwhile and in looks at the scene before, all threads; on a CPU device the kernels' too */
    double accel_seconds, pack_seconds, kernel_seconds, guide_seconds; /* set-up: BVH, buffers, kernel build or cache look-up, --guiding */
    ec_begun begun;               /* kernels that the only device began with */
    bool keeps_kernels;           /* the only device's kernels never change, since it does not say that it rounds as others do */
    double fast_after_seconds;    /* from ec_render's start until the fast ones took over; 0: never, or from the beginning */
    double first_pixel_seconds;   /* from ec_render's start to the first finished wave */
    uint64_t samples_per_pixel, samples, rays; /* samples: in the film; rays: those of a batch that was given up too */
    double samples_per_second, rays_per_second;
    ec_film_error film;           /* the error, its bound, or why there is none */
    ec_error_sums sums;           /* what `film` is made of; zeros: not of a single film */
    ec_forecast forecast;         /* the pilot's */
    bool is_clean;                /* film->clean is of all its samples: of the last look at its error */
    double clamp_luminance;       /* limit of the luminance of a sample's indirect light; 0: none */
    double light_paths;           /* for each camera path: the options', or what was chosen */
    bool is_guided;               /* directions are guided: by the option, or because that was chosen */
    double far_share;             /* share of light samples that was chosen for lights at infinity; 0: there are not both these and lamps */
    double allotment_gain;        /* adaptive: error^2 over uniform sampling's, predicted; 1 where there was nothing to gain */
    uint64_t invalid_generate, invalid_intersect, invalid_shade, invalid_connect, invalid_accumulate;
    uint64_t invalid_samples;     /* their sum: non-finite contributions dropped, still counted in N */
    uint32_t lanes, wave, replicates;
    uint32_t strips;              /* strips in which the picture was rendered: 1 where it fitted into memory */
    uint32_t instances;           /* of meshes that are kept once; 0: none, or they were written out */
    uint64_t triangles, stored_triangles; /* triangles that rays can meet, and those that take memory */
    uint64_t device_bytes;        /* peak of all buffers, on all devices */
    uint64_t launches, pieces;    /* kernels launched on devices whose launches are bounded (cl/pace.h), and the pieces that these were cut into; 0:
                                   * there was no such device */
    double longest_piece;         /* seconds */
    uint64_t scene_bytes;         /* scene data that each device gets */
    ec_render_share shares[EC_DEVICES_MOST]; /* by device, where there are several */
    uint32_t share_count;
    uint32_t peers;              /* other processes that took part … */
    double peer_samples;        /* … samples a pixel that they took, in the mean … */
    uint64_t peer_bytes;        /* … and bytes that this process got from them */
    ec_render_effects effects;    /* which were called for, why, and what came of it */
    ec_content content;           /* with options.identify */
    char stopped_by[16];          /* "spp", "time", "error", "user"; "device" or "failure" where ec_render failed */
    uint32_t cache_hits, cache_misses;
    double trace_seconds;         /* tracing rays through structures: what clocked launches took, scaled to all rays; else an upper bound, `seconds` */
    ec_follow_report followed;    /* with options.followed: what was done with the structures */
    uint32_t programs_found, programs_built; /* programs kept by the device since the render before; built, or read from the cache */
    uint64_t bytes_found, bytes_uploaded;    /* likewise for the scene's buffers */
} ec_render_stats;

#endif

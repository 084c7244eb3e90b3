/* What a render took and what came of it, in figures. */
#ifndef EC_DEVICE_STATS_H
#define EC_DEVICE_STATS_H

#include "accel/follow.h"
#include "device/content.h"
#include "device/effects.h"
#include "film/forecast.h"

/* With which kernels a render began: tiers.h. */
typedef enum ec_begun { EC_BEGUN_FAST, EC_BEGUN_NARROW, EC_BEGUN_UNIVERSAL } ec_begun;

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
    double cpu_seconds;           /* processor time of this process meanwhile and in looks at the scene before, all threads; on a CPU device the kernels' too */
    double accel_seconds, pack_seconds, kernel_seconds, guide_seconds; /* set-up: BVH, buffers, kernel build or cache look-up, --guiding */
    ec_begun begun;               /* of the only device: the kernels that it began with */
    bool keeps_kernels;           /* the only device's never change, since it does not say that it rounds as others do */
    double fast_after_seconds;    /* from ec_render's start until the fast ones took over; 0: never, or from the beginning */
    double first_pixel_seconds;   /* from ec_render's start to the first finished wave */
    uint64_t samples_per_pixel, samples, rays; /* samples: in the film; rays: those of a batch that was given up too */
    double samples_per_second, rays_per_second;
    ec_film_error film;           /* the error, its bound, or why there is none */
    ec_error_sums sums;           /* what that is made of; zeros: it is of no one film */
    ec_forecast forecast;         /* the pilot's */
    bool is_clean;                /* film->clean is of all its samples: the last look at its error */
    double clamp_luminance;       /* most of a sample's indirect light; 0: no limit */
    double light_paths;           /* for each camera path: the options', or what was chosen */
    bool is_guided;               /* directions by what light paths found: the option, or what was chosen */
    double far_share;             /* of light samples, that lights at infinity were chosen to have; 0: there are not both, these and lamps */
    double allotment_gain;        /* adaptive: error^2 over uniform sampling's, foretold; 1 where there was nothing to gain */
    uint64_t invalid_generate, invalid_intersect, invalid_shade, invalid_connect, invalid_accumulate;
    uint64_t invalid_samples;     /* their sum: non-finite contributions dropped, still counted in N */
    uint32_t lanes, wave, replicates;
    uint32_t strips;              /* in which the picture was rendered: 1, the whole, where it fitted into memory */
    uint32_t instances;           /* of meshes that are kept once; 0: none, or they were written out */
    uint64_t triangles, stored_triangles; /* that rays can meet, and that take memory */
    uint64_t device_bytes;        /* peak of all buffers, on all devices */
    uint64_t launches, pieces;    /* of kernels on devices whose launches are bounded (cl/pace.h), and into how many these were cut; 0: on no device */
    double longest_piece;         /* seconds */
    uint64_t scene_bytes;         /* of what goes to each device, made of the scene */
    ec_render_share shares[EC_DEVICES_MOST]; /* by device, where there are several */
    uint32_t share_count;
    uint32_t peers;              /* other processes that took part … */
    double peer_samples;        /* … what they took, samples a pixel in the mean … */
    uint64_t peer_bytes;        /* … and what came of it to this process */
    ec_render_effects effects;    /* which were called for, why, and what came of it */
    ec_content content;           /* with options.identify */
    char stopped_by[16];          /* "spp", "time", "error", "user"; "device" or "failure" where ec_render failed */
    uint32_t cache_hits, cache_misses;
    double trace_seconds;         /* of rays through structures: what clocked launches took, for all rays; else an upper bound, `seconds` */
    ec_follow_report followed;    /* with options.followed: what became of the structures */
    uint32_t programs_found, programs_built; /* kept by the device since the one before; made or read from the cache */
    uint64_t bytes_found, bytes_uploaded;    /* likewise of the scene's buffers */
} ec_render_stats;

#endif

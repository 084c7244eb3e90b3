/* Everything a render fixes once, in one constant buffer. */
#ifndef EC_SHARED_PARAMS_H
#define EC_SHARED_PARAMS_H

#include "types.h"

/* How a path finds area lights and the environment. All converge to the same picture. Punctual lights are joined to in every
 * one: no direction that is sampled ever meets a point. */
typedef enum ec_sample {
    EC_SAMPLE_MIS,       /* light and BSDF sampling, weighted by the power heuristic */
    EC_SAMPLE_LIGHT,     /* a point on a light; BSDF sampling leads the path on and counts no light found again */
    EC_SAMPLE_BSDF,      /* only what directions sampled by the BSDF meet */
    EC_SAMPLE_HEMISPHERE, /* only what directions meet that are uniform over the hemisphere about ns */
    EC_SAMPLE_LIGHT_PATHS /* only what light paths bring, and light that the camera sees itself: --integrator light */
} ec_sample;

#define EC_CASTERS_MOST 8

/* The layers beside radiance of which a picture has one each; light groups come after these. */
enum ec_layer_kind { EC_LAYER_DIRECT, EC_LAYER_INDIRECT, EC_LAYER_POSITION, EC_LAYER_UV, EC_LAYER_MOTION, EC_LAYER_KINDS };
#define EC_GROUPS_MOST 16
#define EC_GROUP_NAME 64

typedef struct ec_params {
    /* Camera, recentred frame: d = forward + x * right + y * up with x, y in [-1, 1]; right and up hold the field of view.
     * Orthographic: o = origin + x * right + y * up, d = forward. A screen window (screen, below) reaches beyond [-1, 1] or not so far. */
    ec_float camera_origin[4];
    ec_float camera_right[4];
    ec_float camera_up[4];
    ec_float camera_forward[4];
    ec_float lens_right[4];       /* the aperture's radius along the camera's axes; 0: a pinhole */
    ec_float lens_up[4];
    ec_float environment[4];      /* constant radiance, or factor of the map */
    ec_float environment_mean[4]; /* over all directions */
    ec_float environment_turn[12]; /* three rows of four: directions of the map to those of the scene */
    ec_uint orthographic;
    ec_uint width, height;        /* pixels */
    ec_uint batch;                /* m: samples a pixel in a batch */
    ec_uint first_sample;         /* number of the first of them within its replicate */
    ec_uint wave;                 /* N: capacity of the queues = stride of their fields = EC_PARTS * part */
    ec_uint part;                 /* entries in one part of a queue, a multiple of LANES */
    ec_uint max_depth;            /* path segments */
    ec_uint sample;               /* ec_sample */
    ec_uint light_count;          /* 0: nothing to join a surface to */
    ec_uint environment_width, environment_height;
    ec_float environment_pmf;     /* probability that light sampling chooses the environment */
    ec_float scene_radius;        /* of a sphere around the recentred origin that holds the scene */
    ec_float scene_max;           /* largest |coordinate| of the scene */
    ec_float scene_centre[3];     /* of the world, where the recentred frame has its origin */
    ec_uint first_roulette;       /* path segments that are never cut short (lib/roulette.h) */
    ec_float survival;            /* of roulette: a constant probability; 0: by throughput */
    ec_float cutoff;              /* of Whitted's integrator: branches of less weight are not followed */
    ec_float lens_nearness;       /* 1 / distance of the plane in focus */
    ec_uint environment_turned;   /* 0: environment_turn is not looked at */
    ec_uint light_tree_numbers;   /* how many of 2^31 random numbers choose the light tree */
    ec_uint panes_count;          /* panes that shadow rays pass count as vertices for max_depth; not in Whitted's integrator */
    ec_float fog[3];              /* around bodies, in the ball about the scene: extinction, 1/m, of every channel, 0: none; albedo; mean cosine */
    ec_uint nested;               /* bodies may lie in one another: media are sets (lib/medium.h) */
    ec_uint camera_medium;        /* medium that the camera is in */
    ec_uint film_row;             /* the picture's row that the films begin with */
    ec_uint terminator;           /* rays leave from the smooth surface (lib/terminator.h) */
    ec_uint multiple;             /* facets scatter more than once (lib/multiscatter.h) */
    ec_uint light_choices;        /* entries of the table by which a light is chosen */
    ec_uint environment_stretch[2]; /* floor(2^64 / numbers that choose the environment), the high word first (lib/choice.h) */
    ec_uint far_numbers;          /* how many of 2^32 random numbers choose lights at infinity; 0: there are none, or no others */
    ec_uint far_stretch[2], lamp_stretch[2]; /* floor(2^64 / numbers of these and of the others), the high word first */
    ec_float far_scale, lamp_scale; /* probability of each kind over that of the table */
    ec_uint apart;                /* slots keep indirect light apart (radiance_of), so that it can be limited */
    ec_float limit;               /* of the luminance of a sample's indirect light; 0: none */
    ec_uint backdrop;             /* the environment is hidden from camera rays; a background takes its place */
    ec_float screen[4];           /* x and y of the picture's top left corner; what they grow by from pixel to pixel */
    /* Light paths (lib/light_path.h). */
    ec_float light_paths;         /* for each camera path; 0: none */
    ec_uint light_apart;          /* what they bring is no part of batches */
    ec_float film_area;           /* of the picture: in the plane at distance 1, or, for an orthographic camera, in the scene */
    ec_float splat_unit;          /* radiance of one step of the splats' sums, a power of two */
    ec_uint film_rows;            /* rows that the films hold, from film_row on */
    ec_uint caster_count;
    ec_float casters[EC_CASTERS_MOST][4]; /* spheres about what bends light: centre, radius */
    ec_float caster_share[EC_CASTERS_MOST]; /* probability that a light path is aimed at one */
    /* Layers of the picture (lib/slot_layers.h), from 1 on; 0: there is none. */
    ec_uint layer_count;
    ec_uint layer_of[EC_LAYER_KINDS];
    ec_uint layer_groups;         /* the first light group's; the others follow */
    ec_uint layer_ids;            /* behind them: which node and material a sample meets (lib/features.h) */
    ec_uint edge_numbers;         /* pixel numbers from this one on belong to rays to lamps' edges (stages/lamp_edges.cl); 0: there are none */
} ec_params;
EC_ASSERT_SIZE(ec_params, 596);

#define EC_EDGE_RAYS 8u /* for each sample of a pixel that a lamp's edge goes through */

/* Light is indirect where its path has more segments. */
#define EC_DIRECT_SEGMENTS 2u

#define EC_ROULETTE_FIRST 3u /* first_roulette of --rr auto */

/* The result of a batch for a pixel, in floats: mean radiance R, G, B of its samples; the largest luminance of a sample; and the sums of the squares and
 * fourth powers of the samples' luminance, in units of the largest (1 to m, 0 where all are black). Where there is a limit, these two sums are of the
 * luminance that it cuts off and of its squares, in units of largest^2 / limit, so that they add up by the same rule (film/clamp.h). */
#define EC_BATCH_FIELDS 6
enum ec_batch_field { EC_BATCH_R, EC_BATCH_G, EC_BATCH_B, EC_BATCH_LARGEST, EC_BATCH_SQUARES, EC_BATCH_FOURTHS };

/* An entry of a pixel list: the pixel's number (kernels/lib/film.h), and how many samples it has. */
#define EC_LIST_WORDS 2

/* The light that light paths bring to a pixel in a batch, in words: R, G, B as 64-bit sums in splat units, the low word first, and the largest luminance of a
 * single contribution, a float. */
#define EC_SPLAT_WORDS 8
enum ec_splat_word { EC_SPLAT_R = 0, EC_SPLAT_G = 2, EC_SPLAT_B = 4, EC_SPLAT_LARGEST = 6 };

/* Bounces of light paths are told from those of camera paths by this bit. */
#define EC_LIGHT_BOUNCE 0x40000000u

/* Invalid (non-finite) contributions, counted by stage in ec_counters.invalid. */
enum ec_stage {
    EC_STAGE_GENERATE,
    EC_STAGE_INTERSECT,
    EC_STAGE_SHADE,
    EC_STAGE_CONNECT,
    EC_STAGE_ACCUMULATE,
    EC_STAGE_COUNT
};

#define EC_SEGMENT 32 /* most bounces between two looks of the host at the queues */

/* A queue is cut in parts with a counter each, on a cache line of its own: entries stay in their part from bounce to bounce,
 * so that work-items far apart do not fight for one counter (a fifth of the shading time on two cores). */
#define EC_PARTS 32
#define EC_PART_STRIDE 16
typedef struct ec_bounce_counters {
    ec_uint rays[EC_PARTS * EC_PART_STRIDE];    /* paths alive */
    ec_uint shadows[EC_PARTS * EC_PART_STRIDE]; /* shadow rays asked for */
} ec_bounce_counters;
typedef struct ec_counters {
    ec_bounce_counters at[EC_SEGMENT + 1]; /* bounces of the segment, and the first one after it */
} ec_counters;

#endif

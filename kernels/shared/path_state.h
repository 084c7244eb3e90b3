/* Fields of the queues: structures of arrays, field f of entry i stands at word f * wave + i. */
#ifndef EC_SHARED_PATH_STATE_H
#define EC_SHARED_PATH_STATE_H

/* EC_PATH_PDF of camera rays is -1, or one of these where a lamp's edge goes through the pixel (stages/lamp_edges.cl). */
#define EC_PDF_BESIDE (-2.0f) /* a path that leaves out what it sees of lamps at first sight … */
#define EC_PDF_ENDS (-3.0f)   /* … and a ray that adds that, and nothing else */

enum ec_path_field {
    EC_PATH_OX, EC_PATH_OY, EC_PATH_OZ,    /* ray origin, recentred frame */
    EC_PATH_DX, EC_PATH_DY, EC_PATH_DZ,    /* ray direction, unit */
    EC_PATH_BR, EC_PATH_BG, EC_PATH_BB,    /* beta: product of f cos / pdf and 1 / survival so far */
    EC_PATH_PDF,                           /* solid-angle density of this direction; < 0: light sampling cannot find it */
    EC_PATH_DEPTH = EC_PATH_PDF,           /* of Whitted's integrator: segments before this one, less 1 */
    EC_PATH_SLOT,                          /* uint: where in the wave the sample's radiance is kept */
    EC_PATH_PRIM,                          /* uint: triangle the ray leaves; EC_NO_ID for camera rays */
    EC_PATH_FIELDS,
    EC_PATH_MEDIUM = EC_PATH_FIELDS,       /* with ABSORPTION, NESTED or FOG only: uint, medium of the ray (lib/medium.h) */
    EC_PATH_MEDIUM_FIELDS,
    EC_PATH_SX = EC_PATH_MEDIUM_FIELDS,    /* with PANES only: where light was last sampled; EC_PATH_PDF is the density there */
    EC_PATH_SY, EC_PATH_SZ,
    EC_PATH_PANE_FIELDS,
    EC_PATH_K = EC_PATH_PANE_FIELDS,       /* with LIGHT_PATHS only: see lib/light_path.h */
    EC_PATH_LIGHT_FIELDS,
    EC_PATH_ROULETTE = EC_PATH_LIGHT_FIELDS, /* with GUIDING only: product of density over the BSDF's (lib/guide.h) */
    EC_PATH_GUIDED_FIELDS
};

/* State of a light path, by slot; with LIGHT_PATHS only. */
enum ec_light_slot_field {
    EC_LIGHT_SLOT_PIXEL,                   /* uint: place in the films that its shadow ray's light goes to */
    EC_LIGHT_SLOT_LIGHT,                   /* uint: its light */
    EC_LIGHT_SLOT_B1, EC_LIGHT_SLOT_B2,    /* where on it, if it is a triangle */
    EC_LIGHT_SLOT_FIELDS
};

enum ec_hit_field {
    EC_HIT_PRIM,                           /* uint: EC_NO_ID on a miss */
    EC_HIT_B1, EC_HIT_B2,                  /* barycentrics of v1, v2 */
    EC_HIT_FIELDS,
    EC_HIT_T = EC_HIT_FIELDS,              /* written by kernels built with PROBE only (lib/tally.h): distance, and */
    EC_HIT_NODES, EC_HIT_TESTS,            /* uint: nodes or cells visited, triangles tested */
    EC_HIT_PROBE_FIELDS
};

enum ec_shadow_field {
    EC_SHADOW_OX, EC_SHADOW_OY, EC_SHADOW_OZ, /* from here */
    EC_SHADOW_DX, EC_SHADOW_DY, EC_SHADOW_DZ, /* to o + d: unnormalised, t in (0, 1) */
    EC_SHADOW_LR, EC_SHADOW_LG, EC_SHADOW_LB, /* what arrives if nothing is in the way: beta f cos Le w / pdf */
    EC_SHADOW_SLOT,                        /* uint */
    EC_SHADOW_PRIM,                        /* uint: triangle the ray leaves */
    EC_SHADOW_TARGET,                      /* uint: triangle it ends on, or EC_NO_ID */
    EC_SHADOW_FIELDS,
    EC_SHADOW_MEDIUM = EC_SHADOW_FIELDS,   /* with MATCHED and media only: uint, medium that the ray starts in (lib/medium.h) */
    EC_SHADOW_TR, EC_SHADOW_TG, EC_SHADOW_TB, /* what that leaves if it fills all of the way; L does not include it then */
    EC_SHADOW_FAR,                         /* 1 where it ends infinitely far away, else 0 */
    EC_SHADOW_MEDIUM_FIELDS
};

/* Waiting branches of Whitted's ray trees: a stack for each slot. Field f of branch k of slot s stands at word (1 + k * EC_BRANCH_FIELDS + f) * wave
 * + s; word s says how many there are. One branch of a tree is under way and leaves at most one other behind in each of its segments, so max_depth -
 * 1 are enough. */
enum ec_branch_field {
    EC_BRANCH_OX, EC_BRANCH_OY, EC_BRANCH_OZ,
    EC_BRANCH_DX, EC_BRANCH_DY, EC_BRANCH_DZ,
    EC_BRANCH_BR, EC_BRANCH_BG, EC_BRANCH_BB,
    EC_BRANCH_DEPTH, EC_BRANCH_PRIM, EC_BRANCH_MEDIUM,
    EC_BRANCH_FIELDS
};

/* First-hit features per slot: albedo RGB, normal XYZ, depth, coverage. */
#define EC_AOV_FIELDS 8

#endif

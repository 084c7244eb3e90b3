/* A first look at a picture's paths: where they leave in a direction that light sampling could not have chosen as well. */
#ifndef EC_RARE_CHAINS_H
#define EC_RARE_CHAINS_H

#include "device/pipeline.h"
#include "rare/joined.h"
#include "rare/lights.h"

enum { EC_CHAIN_PATHS = 1 << 13, EC_JOINED_PATHS = 1 << 16, EC_CHAIN_BOUNCES = 12, EC_CHAIN_VERTICES = 4 };
#define EC_CHAIN_SHARP 32.0f /* 1/sr: directions of less density are no narrower than light sampling copes with */

/* A path's segment. */
typedef struct ec_chain {
    float origin[3], direction[3]; /* recentred frame; unit */
    float beta;                    /* luminance of the path's throughput */
    float pdf;                     /* solid-angle density of the direction; INFINITY: a mirror's, glass's or the camera's */
    float reach;                   /* where it ends: INFINITY on a miss, NAN not known */
    uint32_t prim;                 /* that it leaves: EC_NO_ID for the camera's */
    uint32_t hit;                  /* that it meets: EC_NO_ID on a miss */
    uint32_t place;                /* its pixel, in row order */
    uint32_t segment;              /* of its path: 0 is the camera's */
    bool is_direct;                /* no segment before it left in a wider direction: the pixel sees through it as by way of mirrors */
    bool is_caustic;               /* it leaves what light paths are aimed at, and light paths can be joined to what the pixel sees by its light */
} ec_chain;

typedef struct ec_chains {
    uint32_t paths, count;
    ec_chain *chains;              /* bounce by bounce, by path; owned, as the next two */
    uint32_t *visits;              /* by material: how often a path met it */
    ec_chain *vertices;            /* of the first EC_CHAIN_VERTICES bounces, segments that left a surface whose light is sampled; owned */
    uint32_t vertex_count;
    uint32_t misses;               /* how often a path that had met something left the scene */
    bool may_join;                 /* light paths may pay; false where the lights' flux is not known */
} ec_chains;

/* Traces EC_CHAIN_PATHS paths, or EC_LOOK_PIXEL a pixel where that is less, spread over the picture, with random numbers of their own: the same
 * whatever the wave. Nothing else on the device changes; no film is touched. has_vertices: asks for vertices. */
ec_result ec_chains_trace(ec_pipeline *pipeline, const ec_rare_lights *lights, bool has_vertices, ec_chains *chains, ec_error *err);

/* Finds how many light paths pay, by so many more paths that a few strong ones do not decide. */
ec_result ec_chains_join(ec_pipeline *pipeline, const ec_rare_lights *lights, ec_joined_choice *joined, ec_error *err);
void ec_chains_free(ec_chains *chains);

/* Sets the hit of each ray, which has origin, direction and prim, to what it meets first. */
ec_result ec_chains_meet(ec_pipeline *pipeline, ec_chain *rays, uint32_t count, ec_error *err);

#endif

/* Follows rays to what they meet, straight on through panes. Inside host/rare only. */
#ifndef EC_RARE_FOLLOW_H
#define EC_RARE_FOLLOW_H

#include "rare/chains.h"

typedef struct ec_rare_follower {
    const ec_rare_lights *lights;
    ec_pipeline *p;
    ec_prim **pages;  /* of stored triangles, each read when one of its triangles is asked for */
    ec_chain *on;     /* rays that have met panes */
    uint32_t *which;  /* of the rays followed, by ray of `on` */
    uint32_t room;    /* for so many of these */
    bool has_panes;
} ec_rare_follower;

ec_result ec_rare_follower_open(const ec_rare_lights *lights, ec_pipeline *pipeline, ec_rare_follower *follower, ec_error *err);
void ec_rare_follower_close(ec_rare_follower *follower); /* zero-initialised or closed is fine */

/* Sets a ray along a direction, or against it (sign), from a point that is moved back by `back`. */
void ec_rare_ray(const float point[3], const float direction[3], double sign, double back, ec_chain *ray);

/* Sets the hit of each ray to what it meets first that is no pane, its beta to the share of light that these let by, its origin to where it left the
 * last one. */
ec_result ec_rare_follow(ec_rare_follower *follower, ec_chain *rays, uint32_t count, ec_error *err);

/* Sets the reach of rays that have been followed, from their origins as these are now. */
ec_result ec_rare_reach(ec_rare_follower *follower, ec_chain *rays, uint32_t count, ec_error *err);

/* Returns whether a ray that was aimed at a source, and followed, has met it. A point or spot light's ray needs its reach. */
bool ec_rare_meets(const ec_rare_follower *follower, const ec_rare_source *source, const ec_chain *ray);

/* The place where a ray ends. */
typedef struct ec_rare_landing {
    float point[3], normal[3]; /* the normal, unit, is on the ray's side */
    double cosine;             /* between the two; 0 where that cannot be told */
    double distance;           /* from the ray's origin */
} ec_rare_landing;

/* Finds where a ray that has met something ends. */
ec_result ec_rare_land(ec_rare_follower *follower, const ec_chain *ray, ec_rare_landing *at, ec_error *err);

/* Sets the unit normal of a triangle, by the id that hits have. */
ec_result ec_rare_normal_of(ec_rare_follower *follower, uint32_t id, double normal[3], ec_error *err);

#endif

/* A look at a picture's paths, apart from those that render it: what the host sees of them between two kernels. */
#ifndef EC_RARE_LOOK_H
#define EC_RARE_LOOK_H

#include "device/pipeline.h"

enum { EC_LOOK_PIXEL = 64 /* paths of a pixel, in pictures of few, at most */ };

typedef struct ec_look {
    ec_pipeline *p;
    uint32_t paths;
    uint32_t each;         /* samples of a pixel that come one after another, paths being a multiple of so many times … */
    uint32_t replicates;   /* … so many, of which they are in turn */
    uint32_t bounces;      /* at most */
    bool samples_light;    /* are shadow rays traced too? */
    uint32_t first, count; /* paths of the wave under way */
    uint32_t stride;       /* entries of the queue that they can be in */
    ec_result (*met)(void *user, uint32_t bounce, ec_error *err);    /* segments have met what they meet; in bounce 0 a wave begins. NULL: no matter, as the next ones */
    ec_result (*shaded)(void *user, uint32_t bounce, ec_error *err); /* surfaces have light that segments found … */
    ec_result (*lit)(void *user, uint32_t bounce, ec_error *err);    /* … and that which was sampled */
    void *user;
    uint32_t *list;        /* pixel and sample of each path: EC_LIST_WORDS */
    cl_mem pixels;
} ec_look;

/* How many paths to take of a picture, at most. */
uint32_t ec_look_paths(const ec_pipeline *p, uint32_t most);

/* Traces look->paths, spread over the picture, with random numbers of their own: the same whatever the wave. Nothing else on the device changes; no
 * film is touched. */
ec_result ec_look_trace(ec_look *look, ec_error *err);

/* The luminance that the wave's paths have brought to their slots so far, indirect light too where it is kept apart. rgb: room for 6 floats a path. */
ec_result ec_look_luminance(const ec_look *look, float *rgb, float *luminance, ec_error *err);

/* The one acceleration structure that the pipeline traces by, or the last of them, which suits rays that go anywhere. */
uint32_t ec_look_accel(const ec_pipeline *p);

#endif

/* Traces some of a picture's paths apart from those that render it, and lets the host see them between two kernels. */
#ifndef EC_RARE_LOOK_H
#define EC_RARE_LOOK_H

#include "device/pipeline.h"

enum { EC_LOOK_PIXEL = 64 /* paths of a pixel, in pictures of few, at most */ };

typedef struct ec_look {
    ec_pipeline *p;
    uint32_t paths;
    uint32_t each;         /* samples of a pixel that come one after another; `paths` is a multiple of so many times … */
    uint32_t replicates;   /* … so many, which take turns */
    uint32_t bounces;      /* at most */
    bool samples_light;    /* shadow rays are traced, too */
    uint32_t first, count; /* paths of the wave under way */
    uint32_t stride;       /* entries of the queue that they can be in */
    ec_result (*met)(void *user, uint32_t bounce, ec_error *err);    /* called when segments have met surfaces; in bounce 0 a wave begins. NULL: not
                                                                      * called, as the next ones */
    ec_result (*shaded)(void *user, uint32_t bounce, ec_error *err); /* called when surfaces have the light that segments found … */
    ec_result (*lit)(void *user, uint32_t bounce, ec_error *err);    /* … and when they have that which was sampled */
    void *user;
    uint32_t *list;        /* pixel and sample of each path: EC_LIST_WORDS */
    cl_mem pixels;
} ec_look;

/* Returns how many paths to take of a picture, `most` at most. */
uint32_t ec_look_paths(const ec_pipeline *p, uint32_t most);

/* Traces look->paths, spread over the picture, with random numbers of their own: the same whatever the wave. Nothing else on the device changes; no
 * film is touched. */
ec_result ec_look_trace(ec_look *look, ec_error *err);

/* Reads the luminance that the wave's paths have brought to their slots so far, indirect light too where it is kept apart. rgb: room for 6 floats a
 * path. */
ec_result ec_look_luminance(const ec_look *look, float *rgb, float *luminance, ec_error *err);

/* Returns the acceleration structure to trace by: the pipeline's only one, or the last of them, which suits rays that go anywhere. */
uint32_t ec_look_accel(const ec_pipeline *p);

#endif

/* One sampler of an animation. Inside host/gltf/ only. */
#ifndef EC_GLTF_GLTF_KEYFRAMES_H
#define EC_GLTF_GLTF_KEYFRAMES_H

#include "gltf/gltf.h"

typedef enum ec_interpolation { EC_LINEAR, EC_STEP, EC_CUBICSPLINE } ec_interpolation;

typedef struct ec_gltf_keyframes {
    int32_t input, output; /* accessors: times in seconds, and values */
    ec_interpolation interpolation;
} ec_gltf_keyframes;

typedef struct ec_gltf_numbers {
    double *values; /* owned by the caller, also after a failure */
    uint32_t count;
} ec_gltf_numbers;

/* Computes the sampler's value at time `at` in seconds; before the first and after the last key, the value of that key. `where` is for messages,
 * which do not name the file. */
ec_result ec_gltf_keyframes_sample(ec_gltf *gltf, const ec_gltf_keyframes *keyframes, bool rotation, double at, const char *where,
                                   ec_gltf_numbers *numbers, ec_error *err);

/* Counts the keys strictly between two times. The sampler must have been sampled before. */
uint32_t ec_gltf_keyframes_between(const ec_gltf *gltf, const ec_gltf_keyframes *keyframes, double from, double to);

#endif

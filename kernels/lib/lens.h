/* A thin lens in the pinhole's place: depth of field. The camera's axis and its field of view stay those of the pinhole. */
#ifndef EC_LIB_LENS_H
#define EC_LIB_LENS_H

#include "../shared/params.h"
#include "sampler.h"
#include "camera_axes.h"

/* Returns a uniform point of the round aperture, relative to its centre. */
EC_FN v3 lens_point(const camera_axes *v, lane_f u1, lane_f u2)
{
    lane_f cosine, radius = sqrt(u1), sine = sincos_2pi(u2, &cosine);
    return v3_fma(v->lens_right, radius * cosine, v3_scale(v->lens_up, radius * sine));
}

/* Turns a ray through the pinhole, whose d is 1 long along the axis, into one from a uniform point of the aperture that meets it in the plane of
 * focus. d is not normalised, so that rays stay those of the pinhole, bit for bit, where there is no aperture. */
EC_FN void lens_shift(const camera_axes *v, float nearness, sampler random, v3 *o, v3 *d)
{
    lane_f u1, u2;
    sample_pair(random, EC_PAIR_LENS, &u1, &u2);
    v3 at = lens_point(v, u1, u2);
    *o = v3_add(*o, at);
    *d = v3_fma(at, F(-nearness), *d);
}

#endif

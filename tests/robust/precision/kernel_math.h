/* lib/elementary.h, math.h, fresnel.h */
#ifndef EC_PRECISION_KERNEL_MATH_H
#define EC_PRECISION_KERNEL_MATH_H

#include "lib/fresnel.h"
#include "kernel.h"

PRECISION(sincos_2pi)
{
    lane_f cosine, sine = sincos_2pi(X(0), &cosine);
    PUT(0, sine);
    PUT(1, cosine);
}
PRECISION(exp_negative) { PUT(0, exp_negative(X(0))); }
PRECISION(log_unit) { PUT(0, log_unit(X(0), X(1))); }
PRECISION(atan2_over_2pi) { PUT(0, atan2_over_2pi(X(0), X(1))); }
PRECISION(v3_dot) { PUT(0, v3_dot(V(0), V(3))); }
PRECISION(v3_cross) { PUT_V(0, v3_cross(V(0), V(3))); }
PRECISION(v3_normalize) { PUT_V(0, v3_normalize(V(0))); }
PRECISION(luminance) { PUT(0, luminance(V(0))); }
PRECISION(v3_frame)
{
    v3 s, t;
    v3_frame(V(0), &s, &t);
    PUT_V(0, s);
    PUT_V(3, t);
}
PRECISION(mis_weight) { PUT(0, mis_weight(X(0), X(1))); }

PRECISION(pow5) { PUT(0, pow5(X(0))); }
PRECISION(refracted_cosine2) { PUT(0, refracted_cosine2(X(0), X(1))); }
PRECISION(fresnel_dielectric) { PUT(0, fresnel_dielectric(X(0), X(1))); }
PRECISION(refract) { PUT_V(0, refract(V(0), V(3), X(6))); }

#endif

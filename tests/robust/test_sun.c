/* tier: full */
/* Environment maps whose light comes from a tiny part of them. */
#include <math.h>

#include "robust/cases.h"
#include "selftest/sun.h"

static const double pi = 3.14159265358979323846;

/* The irradiance divided by pi, since the floor is white. */
static ec_result sun_case(ec_selftest *t, ec_error *err)
{
    const uint32_t width = 4096, height = width / 2, y = height / 5;
    double one = ec_sun_irradiance(width, height, y) / pi;
    EC_TRY(ec_sun_row(t, "one texel of 1e6, the rest 1", &(ec_sun_map){width, height, height, 1, 1e6f, y}, 1 + (1e6 - 1) * one, err));
    EC_TRY(ec_sun_row(t, "one texel of 1e6, the rest 0", &(ec_sun_map){width, height, 0, 0, 1e6f, y}, 1e6 * one, err));
    /* Rows down to 60 degrees are 1, others 0. Interpolation between two rows turns the edge into a ramp about the texels' border. Its
     * cosine integral is that of an edge at the border, except for the square of a row's height. */
    uint32_t dark = height / 3;
    double edge = pi * dark / height, rows = pi / height, cut = 0;
    for (int i = 0; i < 2; i++) { /* Simpson's rule over the ramp, from 1 to 0 around the border */
        double a = edge + (i - 1) * 0.5 * rows, b = a + 0.5 * rows, middle = 0.5 * (a + b);
        double f[3] = {a, middle, b};
        for (int k = 0; k < 3; k++) cut += (k == 1 ? 4 : 1) / 6.0 * 0.5 * rows * (0.5 - (f[k] - edge) / rows) * sin(2 * f[k]);
    }
    double lit = 0.5 * (1 - cos(2 * (edge - 0.5 * rows)));
    return ec_sun_row(t, "rows of zeros", &(ec_sun_map){width, height, dark, 1, 1, 0}, lit + cut, err);
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"environment/sun", false, sun_case, "float tables lose dim texels, 0/0 in black rows (pbrt, Mitsuba)"},
    };
    return RUN_CASES(cases);
}

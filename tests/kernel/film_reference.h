/* KHR_materials_iridescence in double precision, by the extension's text, except for Fresnel's formula at the outer face. */
#ifndef EC_TESTS_KERNEL_FILM_REFERENCE_H
#define EC_TESTS_KERNEL_FILM_REFERENCE_H

#include <math.h>

static inline double film_schlick(double f0, double cosine) { return f0 + (1 - f0) * pow(1 - cosine, 5); }
/* Reflectance of both polarisations, from air into the index n. */
static inline double film_fresnel(double cosine, double inside, double n)
{
    return (pow((cosine - n * inside) / (cosine + n * inside), 2) + pow((n * cosine - inside) / (n * cosine + inside), 2)) / 2;
}

/* Response of X, Y and Z to light with a path difference of `way` metres, each with a phase shift of its own. */
static inline void film_sensed(double way, const double shift[3], double xyz[3])
{
    const double turn = 6.283185307179586, phase = turn * way;
    static const double value[4] = {5.4856e-13, 4.4201e-13, 5.2481e-13, 9.7470e-14}, position[4] = {1.6810e6, 1.7953e6, 2.2084e6, 2.2399e6};
    static const double variance[4] = {4.3278e9, 9.3046e9, 6.6121e9, 4.5282e9};
    for (int i = 0; i < 4; i++) {
        double part = value[i] * sqrt(turn * variance[i]) * cos(position[i] * phase + shift[i % 3]) * exp(-phase * phase * variance[i]) / 1.0685e-7;
        xyz[i % 3] = i < 3 ? part : xyz[0] + part;
    }
}

/* Reflectance in red, green, blue of a film in air over surfaces of reflectance f0 head-on; limited to [0, 1]. */
static inline void film_reference(double cosine, double film, double nanometres, const double f0[3], double out[3])
{
    static const double rec709[3][3] = {{3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}};
    double half_turn = 3.14159265358979324, x = fmin(nanometres / 0.03, 1), ior = 1 + (film - 1) * x * x * (3 - 2 * x);
    double inside = sqrt(1 - (1 - cosine * cosine) / (ior * ior)), outer = film_fresnel(cosine, inside, ior), inner[3], shift[2][3], late[2][3];
    for (int k = 0; k < 3; k++) {
        double root = sqrt(fmin(f0[k], 0.9999)), base = (1 + root) / (1 - root);
        inner[k] = film_schlick(pow((base - ior) / (base + ior), 2), inside);
        shift[0][k] = half_turn + (base < ior ? half_turn : 0);
        shift[1][k] = 2 * shift[0][k];
    }
    for (int m = 0; m < 2; m++) film_sensed((m + 1) * 2e-9 * ior * nanometres * inside, shift[m], late[m]);
    for (int k = 0; k < 3; k++) {
        double both = fmin(outer * inner[k], 0.9999), settled = pow(1 - outer, 2) * inner[k] / (1 - both), c = settled - (1 - outer), sum = outer + settled;
        for (int m = 0; m < 2; m++) {
            c *= sqrt(both);
            for (int j = 0; j < 3; j++) sum += 2 * c * rec709[k][j] * late[m][j];
        }
        out[k] = fmin(fmax(sum, 0), 1);
    }
}

#endif

/* Quantiles of Fisher's F, for the bound of the image error. */
#include <math.h>

#include "film/statistics.h"

static double lower_tail(double x, double d1, double d2)
{
    double s = d1 * x + d2; /* DLMF 8.17: P(F <= x) = I_{d1 x / s}(d1/2, d2/2) */
    return ec_incomplete_beta(0.5 * d1, 0.5 * d2, d1 * x / s, d2 / s);
}

/* Paulson's approximation (Ann. Math. Stat. 13, 1942): cube roots of chi-square variables are nearly normal. With
 * thousands of degrees of freedom it is exact to 1e-7, and it saves the continued fraction's thousands of steps. */
static double paulson(double p, double d1, double d2)
{
    double z = p > 0.5 ? ec_normal_upper_quantile(1 - p) : -ec_normal_upper_quantile(p);
    double a = 2 / (9 * d1), b = 2 / (9 * d2);
    double A = (1 - b) * (1 - b) - b * z * z, B = (1 - a) * (1 - b), C = (1 - a) * (1 - a) - a * z * z;
    double root = (B + copysign(sqrt(B * B - A * C), z)) / A;
    return root * root * root;
}

double ec_f_quantile(double p, double d1, double d2)
{
    if (d1 > 5000 && d2 > 5000) return paulson(p, d1, d2);
    double low = -700, high = 700; /* ln x */
    for (int i = 0; i < 100 && high - low > 1e-14; i++) {
        double middle = 0.5 * (low + high);
        *(lower_tail(exp(middle), d1, d2) < p ? &low : &high) = middle;
    }
    return exp(0.5 * (low + high));
}

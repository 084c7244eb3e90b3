/* Student's t and the normal distribution: tails and quantiles. */
#include <math.h>

#include "film/film.h"
#include "film/statistics.h"

double ec_normal_upper_quantile(double q)
{
    if (q > 0.5) return -ec_normal_upper_quantile(1 - q);
    if (!(q > 0)) return INFINITY;
    /* Start: Abramowitz & Stegun 26.2.22, good to 3e-3; then Newton on ln P(Z > z), which is nearly quadratic in z. */
    double t = sqrt(-2 * log(q)), z = t - (2.30753 + 0.27061 * t) / (1 + t * (0.99229 + t * 0.04481));
    for (int i = 0; i < 6; i++) {
        double tail = 0.5 * erfc(z * M_SQRT1_2), density = exp(-0.5 * z * z) / sqrt(2 * M_PI);
        if (!(tail > 0) || !(density > 0)) break;
        z += log(tail / q) * tail / density;
    }
    return z;
}

double ec_student_t_upper_tail(double t, double nu)
{
    if (isinf(nu)) return 0.5 * erfc(t * M_SQRT1_2);
    double square = t * t;
    if (isinf(square)) return t > 0 ? 0 : 1;
    /* DLMF 8.17: P(|T| > t) = I_x(nu/2, 1/2) with x = nu / (nu + t^2). */
    double tail = 0.5 * ec_incomplete_beta(0.5 * nu, 0.5, nu / (nu + square), square / (nu + square));
    return t < 0 ? 1 - tail : tail;
}

/* t with P(T > t) = q <= 1/2. The expansion in 1/nu (Abramowitz & Stegun 26.7.5) is good to 1e-12 where it is used;
 * below that bisection, which needs no derivative and cannot fail. */
static double upper_quantile(double q, double nu)
{
    double z = ec_normal_upper_quantile(q);
    if (nu > 1e5) {
        double z2 = z * z, inverse = 1 / nu;
        return z + inverse * z * ((z2 + 1) / 4 + inverse * ((5 * z2 + 16) * z2 + 3) / 96);
    }
    double low = 0, high = fmax(z, 1);
    while (ec_student_t_upper_tail(high, nu) > q && high < 1e150) low = high, high *= 2;
    for (int i = 0; i < 200 && high - low > 1e-15 * high; i++) {
        double middle = 0.5 * (low + high);
        *(ec_student_t_upper_tail(middle, nu) > q ? &low : &high) = middle;
    }
    return 0.5 * (low + high);
}

double ec_student_t_quantile(double p, double nu)
{
    if (!(p >= 0 && p <= 1) || !(nu > 0)) return NAN;
    if (p == 0.5) return 0;
    if (p == 0 || p == 1) return p == 1 ? INFINITY : -INFINITY;
    return p > 0.5 ? upper_quantile(1 - p, nu) : -upper_quantile(p, nu);
}

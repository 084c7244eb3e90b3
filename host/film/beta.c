/* The incomplete beta function, from which Student's and Fisher's distributions follow. */
#include <float.h>
#include <math.h>

#include "film/statistics.h"

/* ln Gamma(a) - [(a - 1/2) ln a - a + ln(2 pi)/2], Stirling's remainder (DLMF 5.11.1). Taken apart because the leading
 * terms cancel in ln B(a, b), where lgamma's rounding error would grow with a. */
static double stirling_remainder(double a)
{
    if (a < 12) return lgamma(a) - ((a - 0.5) * log(a) - a + 0.91893853320467274178);
    double r = 1 / (a * a);
    return (1.0 / 12 - r * (1.0 / 360 - r * (1.0 / 1260 - r * (1.0 / 1680 - r * (1.0 / 1188))))) / a;
}

/* ln of x^a y^b / B(a, b). With s = a + b it is a ln(x s / a) + b ln(y s / b) + ln(a b / (2 pi s)) / 2 + remainders; the
 * first two are near 0 where it matters, so log1p keeps their digits for a or b in the millions. */
static double log_power_term(double a, double b, double x, double y)
{
    double s = a + b, d = x * b - y * a; /* x s = a + d, y s = b - d */
    double u = fabs(d) < 0.5 * a ? log1p(d / a) : log(x * s / a);
    double v = fabs(d) < 0.5 * b ? log1p(-d / b) : log(y * s / b);
    return a * u + b * v + 0.5 * log(a * b / (2 * M_PI * s)) + stirling_remainder(s) - stirling_remainder(a) -
           stirling_remainder(b);
}

/* Continued fraction DLMF 8.17.22 by Lentz's method: converges fast for x < (a + 1) / (a + b + 2). */
static double continued_fraction(double a, double b, double x)
{
    const double tiny = 1e-300;
    double c = 1, d = 1 - (a + b) * x / (a + 1);
    d = 1 / (fabs(d) < tiny ? tiny : d);
    double value = d;
    for (int m = 1; m < 100000; m++) {
        double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        double factor = 1;
        for (int step = 0; step < 2; step++) {
            double term = step ? odd : even;
            d = 1 + term * d;
            d = 1 / (fabs(d) < tiny ? tiny : d);
            c = 1 + term / c;
            if (fabs(c) < tiny) c = tiny;
            factor *= c * d;
        }
        value *= factor;
        if (fabs(factor - 1) < 4 * DBL_EPSILON) break;
    }
    return value;
}

double ec_incomplete_beta(double a, double b, double x, double y)
{
    if (!(x > 0)) return 0;
    if (!(y > 0)) return 1;
    double power_term = exp(log_power_term(a, b, x, y));
    if (x < (a + 1) / (a + b + 2)) return power_term * continued_fraction(a, b, x) / a;
    return 1 - power_term * continued_fraction(b, a, y) / b;
}

/* Many tests, one verdict. */
#include <math.h>

#include "film/statistics.h"

double ec_p_of_least(double least, double n)
{
    return least < 1 ? -expm1(n * log1p(-least)) : 1;
}

/* Cauchy combination: Liu & Xie, J. Am. Statist. Assoc. 115, 2020. cot(pi p) is a Cauchy variable; so is every weighted mean of
 * them, whether they are independent or all the same, and in between its tail is nearly that. A p-value of 1, whose cotangent
 * is minus infinity, would drown the others, so none counts as more than 0.9: tests that err towards no alarm are often there. */
static const double p_most = 0.9;

double ec_p_combined(const double *p, const double *weight, int count)
{
    double sum = 0, weights = 0;
    for (int i = 0; i < count; i++) {
        if (p[i] <= 0) return 0;
        sum += weight[i] / tan(M_PI * fmin(p[i], p_most));
        weights += weight[i];
    }
    return atan2(1, sum / weights) / M_PI;
}

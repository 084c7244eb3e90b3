/* Distributions by Boost.Math, in double as on every machine: NaN outside their domain, infinity where a quantile has no bound. */
#include "film/statistics.h"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <cmath>

using namespace boost::math;
namespace on = boost::math::policies;

typedef on::policy<on::domain_error<on::ignore_error>, on::pole_error<on::ignore_error>, on::overflow_error<on::ignore_error>,
                   on::evaluation_error<on::ignore_error>, on::rounding_error<on::ignore_error>, on::promote_double<false>>
    quiet;
typedef students_t_distribution<double, quiet> student;

/* Boost 1.74 searches for roots by a policy of its own, which throws; C cannot catch that. */
template <typename function> static double guarded(function f)
{
    try {
        return f();
    } catch (const std::exception &) {
        return NAN;
    }
}

double ec_normal_upper_quantile(double q)
{
    return guarded([=] { return quantile(complement(normal_distribution<double, quiet>(), q)); });
}

double ec_student_t_upper_tail(double t, double nu)
{
    return guarded([=] { return cdf(complement(student(nu), t)); });
}

double ec_student_t_quantile(double p, double nu)
{
    return guarded([=] { return quantile(student(nu), p); });
}

double ec_trigamma(double x)
{
    return guarded([=] { return trigamma(x, quiet()); });
}

double ec_f_quantile(double p, double d1, double d2)
{
    return guarded([=] { return quantile(fisher_f_distribution<double, quiet>(d1, d2), p); });
}

double ec_poisson_upper_mean(double p, double count)
{
    return guarded([=] { return gamma_p_inv(count + 1, p, quiet()); });
}

double ec_binomial_upper_tail(double k, double n, double p)
{
    if (k <= 0) return 1;
    return k > n ? 0 : guarded([=] { return ibeta(k, n - k + 1, p, quiet()); }); /* DLMF 8.17.5 */
}

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
        sum += weight[i] / tan(M_PI * std::fmin(p[i], p_most));
        weights += weight[i];
    }
    return atan2(1, sum / weights) / M_PI;
}

/* Distributions by Boost.Math, in double as on every machine: NaN outside their domain, infinity where a quantile has no bound. */
#include "film/statistics.h"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
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

double ec_f_quantile(double p, double d1, double d2)
{
    return guarded([=] { return quantile(fisher_f_distribution<double, quiet>(d1, d2), p); });
}

double ec_binomial_upper_tail(double k, double n, double p)
{
    if (k <= 0) return 1;
    return k > n ? 0 : guarded([=] { return ibeta(k, n - k + 1, p, quiet()); }); /* DLMF 8.17.5 */
}

/* tier: quick */
/* Student's t, Fisher's F and the binomial distribution against closed forms and values of other programs. */
#include "film/statistics.h"
#include "support/test.h"

#define CHECK_RELATIVE(a, b, tolerance) CHECK_NEAR((a) / (b), 1.0, tolerance)

/* nu = 1 is Cauchy's distribution, t = tan(pi (p - 1/2)); nu = 2 and 4 have closed forms too (Shaw 2006, eqs. 35-37). */
static void student_closed_forms(void)
{
    const double ps[] = {0.5000001, 0.51, 0.6, 0.75, 0.9, 0.95, 0.975, 0.995, 0.9999, 0.9999999};
    for (size_t i = 0; i < sizeof ps / sizeof *ps; i++) {
        double p = ps[i], a = 4 * p * (1 - p);
        double four = cos(acos(sqrt(a)) / 3) / sqrt(a);
        CHECK_RELATIVE(ec_student_t_quantile(p, 1), tan(M_PI * (p - 0.5)), 1e-9);
        CHECK_RELATIVE(ec_student_t_quantile(p, 2), (2 * p - 1) * sqrt(2 / a), 1e-8);
        CHECK_NEAR(ec_student_t_quantile(p, 4), 2 * sqrt(four - 1), 2e-8 * (1 + 2 * sqrt(four)));
        CHECK_NEAR(ec_student_t_quantile(1 - p, 3), -ec_student_t_quantile(p, 3), 1e-7);
    }
    CHECK(ec_student_t_quantile(0.5, 7) == 0);
    CHECK(isinf(ec_student_t_quantile(1, 7)) && isinf(ec_student_t_quantile(0, 7)));
    CHECK(isnan(ec_student_t_quantile(0.9, 0)) && isnan(ec_student_t_quantile(1.1, 5)));
}

/* Computed with mpmath at 40 digits. */
static void student_table(void)
{
    static const struct { double p, nu, t; } rows[] = {
        {0.975, 3, 3.1824463052837096}, {0.975, 5, 2.5705818356363155}, {0.95, 7, 1.8945786050900074}, {0.975, 15, 2.1314495455597757},
        {0.995, 30, 2.7499956535672253}, {0.975, 63, 1.9983405425207416}, {0.975, 100, 1.9839715185235523},
        {0.975, 1000, 1.9623390808264085}, {0.975, INFINITY, 1.9599639845400543}, {0.9999, INFINITY, 3.7190164854556807},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        CHECK_RELATIVE(ec_student_t_quantile(rows[i].p, rows[i].nu), rows[i].t, 1e-12);
}

/* mpmath, 30 digits. */
static void student_tails(void)
{
    static const struct { double t, nu, tail; } rows[] = {
        {2, 30, 0.027312522481491552}, {6, 1e5, 9.8996472780088128e-10}, {10.5, 15, 1.3099831887349855e-8},
        {3, 63, 0.0019319192380495784}, {1, 2.5, 0.20203051363913673},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        CHECK_RELATIVE(ec_student_t_upper_tail(rows[i].t, rows[i].nu), rows[i].tail, 1e-12);
        CHECK_RELATIVE(ec_student_t_upper_tail(-rows[i].t, rows[i].nu), 1 - rows[i].tail, 1e-14);
    }
}

static void student_inverts_its_tail(void)
{
    const double nus[] = {1, 1.5, 2, 3, 7, 15, 63, 1000, 99999, 200000, INFINITY};
    for (size_t i = 0; i < sizeof nus / sizeof *nus; i++)
        for (double q = 0.4; q > 1e-9; q /= 7)
            CHECK_RELATIVE(ec_student_t_upper_tail(-ec_student_t_quantile(q, nus[i]), nus[i]), q, 1e-8);
    CHECK_RELATIVE(ec_normal_upper_quantile(1e-300), 37.0470964, 1e-8);
    CHECK(isinf(ec_normal_upper_quantile(0)));
}

/* mpmath, 40 digits; the last two by SciPy 1.17. */
static void fisher(void)
{
    static const struct { double p, d1, d2, f; } rows[] = {
        {0.95, 1, 1, 161.4476387975885}, {0.95, 5, 10, 3.325834530413012}, {0.95, 10, 5, 4.735063069693421},
        {0.99, 2.5, 17.5, 5.5208164426736713}, {0.99, 100, 700, 1.3942111550725753}, {0.99, 4000, 28000, 1.0566340709811103},
        {0.99, 6000, 42000, 1.0460872931312295}, {0.99, 1e6, 63e6, 1.003319026947937},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        CHECK_RELATIVE(ec_f_quantile(rows[i].p, rows[i].d1, rows[i].d2), rows[i].f, 1e-11);
    double t = ec_student_t_quantile(0.975, 12); /* F(1, nu) = t(nu)^2 */
    CHECK_RELATIVE(ec_f_quantile(0.95, 1, 12), t * t, 1e-12);
    CHECK_RELATIVE(ec_f_quantile(0.5, 2, 2), 1, 1e-12); /* P(F <= x) = x / (1 + x) */
    CHECK_RELATIVE(ec_poisson_upper_mean(0.99, 0), log(100), 1e-12); /* none comes with probability exp(-mean) */
    const double two = ec_poisson_upper_mean(0.95, 2);
    CHECK_RELATIVE(exp(-two) * (1 + two + two * two / 2), 0.05, 1e-12);
}

/* SciPy 1.17. */
static void binomial(void)
{
    static const struct { double k, n, p, tail; } rows[] = {
        {3, 20, 0.1, 0.32307319481053404}, {150, 10000, 0.01, 1.6570601962380474e-06}, {10300, 1000000, 0.01, 0.0013631150395316599},
        {1000, 2000, 0.5, 0.5089195055729272},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        CHECK_RELATIVE(ec_binomial_upper_tail(rows[i].k, rows[i].n, rows[i].p), rows[i].tail, 1e-11);
    CHECK(ec_binomial_upper_tail(0, 5, 0.3) == 1 && ec_binomial_upper_tail(6, 5, 0.3) == 0);
}

/* No exception leaves into C. */
static void out_of_domain(void)
{
    CHECK(isnan(ec_f_quantile(0.99, NAN, 3)) && isnan(ec_f_quantile(0.99, 3, -1)));
    CHECK(isnan(ec_student_t_upper_tail(NAN, 3)) && isnan(ec_student_t_upper_tail(3, 0)));
    CHECK(ec_student_t_upper_tail(INFINITY, 3) == 0 && isnan(ec_normal_upper_quantile(2)));
}

int main(void)
{
    student_closed_forms();
    student_table();
    student_tails();
    student_inverts_its_tail();
    fisher();
    binomial();
    out_of_domain();
    TEST_END();
}

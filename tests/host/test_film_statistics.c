/* tier: quick */
/* Student's t, Fisher's F and the incomplete beta function against values in closed form and from printed tables. */
#include "film/film.h"
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
        CHECK_RELATIVE(ec_student_t_quantile(p, 1), tan(M_PI * (p - 0.5)), 1e-8);
        CHECK_RELATIVE(ec_student_t_quantile(p, 2), (2 * p - 1) * sqrt(2 / a), 1e-8);
        CHECK_NEAR(ec_student_t_quantile(p, 4), 2 * sqrt(four - 1), 2e-8 * (1 + 2 * sqrt(four)));
        CHECK_NEAR(ec_student_t_quantile(1 - p, 3), -ec_student_t_quantile(p, 3), 1e-7);
    }
    CHECK(ec_student_t_quantile(0.5, 7) == 0);
    CHECK(isinf(ec_student_t_quantile(1, 7)) && isinf(ec_student_t_quantile(0, 7)));
    CHECK(isnan(ec_student_t_quantile(0.9, 0)) && isnan(ec_student_t_quantile(1.1, 5)));
}

/* Computed with mpmath at 30 digits. */
static void student_table(void)
{
    static const struct { double p, nu, t; } rows[] = {
        {0.975, 3, 3.18244630528}, {0.975, 5, 2.57058183564}, {0.95, 7, 1.89457860509}, {0.975, 15, 2.13144954556},
        {0.995, 30, 2.74999565357}, {0.975, 63, 1.99834054252}, {0.975, 100, 1.98397151852},
        {0.975, 1000, 1.96233908083}, {0.975, INFINITY, 1.95996398454}, {0.9999, INFINITY, 3.71901648546},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        CHECK_NEAR(ec_student_t_quantile(rows[i].p, rows[i].nu), rows[i].t, 1e-8);
    /* The two methods meet at nu = 1e5. */
    for (double p = 0.51; p < 0.9999999; p += (1 - p) / 3)
        CHECK_NEAR(ec_student_t_quantile(p, 100000 * (1 - 1e-12)), ec_student_t_quantile(p, 100000 * (1 + 1e-12)), 1e-8);
}

/* mpmath, 30 digits. */
static void student_tails(void)
{
    static const struct { double t, nu, tail; } rows[] = {
        {2, 30, 0.0273125224814916}, {6, 1e5, 9.89964727800881e-10}, {10.5, 15, 1.30998318873499e-8},
        {3, 63, 0.00193191923804958}, {1, 2.5, 0.202030513639137},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        CHECK_RELATIVE(ec_student_t_upper_tail(rows[i].t, rows[i].nu), rows[i].tail, 1e-11);
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

static void fisher(void)
{
    CHECK_RELATIVE(ec_f_quantile(0.95, 1, 1), 161.447638797, 1e-8);
    CHECK_RELATIVE(ec_f_quantile(0.95, 5, 10), 3.32583453, 1e-8);
    CHECK_RELATIVE(ec_f_quantile(0.95, 10, 5), 4.73506307, 1e-8);
    double t = ec_student_t_quantile(0.975, 12); /* F(1, nu) = t(nu)^2 */
    CHECK_RELATIVE(ec_f_quantile(0.95, 1, 12), t * t, 1e-8);
    CHECK_RELATIVE(ec_f_quantile(0.5, 2, 2), 1, 1e-8); /* P(F <= x) = x / (1 + x) */
    CHECK_RELATIVE(ec_f_quantile(0.95, 4999.99, 14999.97), ec_f_quantile(0.95, 5000.01, 15000.03), 1e-6);
    CHECK_NEAR(ec_f_quantile(0.95, 1e6, 63e6), 1 + 1.6448536 * sqrt(2e-6 * 64 / 63), 1e-5);
}

static void incomplete_beta(void)
{
    CHECK_NEAR(ec_incomplete_beta(1, 1, 0.3, 0.7), 0.3, 1e-15);
    CHECK_NEAR(ec_incomplete_beta(2, 3, 0.4, 0.6), 0.5248, 1e-14); /* sum of binomials: 1 - .6^4 - 4 .4 .6^3 */
    CHECK_NEAR(ec_incomplete_beta(0.5, 0.5, 0.25, 0.75), 1.0 / 3, 1e-14); /* arcsine law: 2/pi asin sqrt x */
    CHECK_NEAR(ec_incomplete_beta(1e6, 1e6, 0.5, 0.5), 0.5, 1e-10);
    CHECK(ec_incomplete_beta(3, 4, 0, 1) == 0 && ec_incomplete_beta(3, 4, 1, 0) == 1);
}

int main(void)
{
    student_closed_forms();
    student_table();
    student_tails();
    student_inverts_its_tail();
    fisher();
    incomplete_beta();
    TEST_END();
}

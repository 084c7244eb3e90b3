/* Distributions that the film and the tests need. */
#ifndef EC_FILM_STATISTICS_H
#define EC_FILM_STATISTICS_H

/* The confidence that the image's 95 % bound aims at, so that it also holds in 95 of 100 renders where heavy tails make its own estimate come
 * out low: tests/stat/test_error_bound.c. Aimed at 0.95 it held in 185 to 193 of 200,
 * at 0.98 still in 189 of one case. */
#define EC_BOUND_CONFIDENCE 0.99

#ifdef __cplusplus
extern "C" {
#endif

/* Standard normal: z with P(Z > z) = q, 0 < q < 1. */
double ec_normal_upper_quantile(double q);

/* Student's t with nu degrees of freedom, INFINITY too: P(T > t), precise in the tail; t with P(T <= t) = p. */
double ec_student_t_upper_tail(double t, double nu);
double ec_student_t_quantile(double p, double nu);

/* The second derivative of ln Gamma: the variance of the logarithm of a chi-square variable with 2 x degrees of freedom. */
double ec_trigamma(double x);

/* Fisher's F with d1 and d2 degrees of freedom (any positive reals): x with P(F <= x) = p. */
double ec_f_quantile(double p, double d1, double d2);

/* Poisson: the mean under which so few events as `count` (any real from 0 on), or fewer, come with probability 1 - p. */
double ec_poisson_upper_mean(double p, double count);

/* Binomial: P(K >= k) of n trials that succeed with probability p. */
double ec_binomial_upper_tail(double k, double n, double p);

/* The p-value of the least of n independent p-values (Sidak 1967). */
double ec_p_of_least(double least, double n);

/* One p-value of several tests on the same data, each with a weight: right for small values however the tests depend on each
 * other, where Bonferroni's is too large for tests that depend. */
double ec_p_combined(const double *p, const double *weight, int count);

#ifdef __cplusplus
}
#endif

#endif

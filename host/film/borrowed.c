/* Empirical Bayes (Smyth, Statistical Applications in Genetics and Molecular Biology 3, 2004; there of genes). The SE^2 of a pixel has
 * d = R - 1 degrees of freedom, few where replicates are few. Those of its neighbours tell what is to be expected: true variances around
 * follow a scaled inverse chi-square, s0^2 d0 / chi^2(d0). Then the logarithms of the estimates have
 *     variance psi'(d / 2) + psi'(d0 / 2),   mean ln s0^2 + (psi(d / 2) - ln(d / 2)) - (psi(d0 / 2) - ln(d0 / 2)),
 * from which d0 and s0^2 are found, and (d0 s0^2 + d SE^2) / (d0 + d) has d0 + d degrees of freedom. Where neighbours differ, at edges and
 * where single samples make the noise, d0 is small and the pixel goes by its own. */
#include "film/borrowed.h"

#include <math.h>

#include "film/statistics.h"

#define FEWEST 8   /* neighbours needed to tell how they differ */
#define ALIKE 1e-6 /* the least of psi'(d0 / 2) */

/* psi(y) - ln y: to 5 % from y = 1/2 on */
static double log_bias(double y) { return -1 / (2 * y) - 1 / (12 * y * y); }

/* y with psi'(y) = v, by psi'(y) = 1 / y + 1 / (2 y^2): too small, so that too little is borrowed, by 7 % at 1 and 10 % at 1/2 */
static double inverse_trigamma(double v) { return (1 + sqrt(1 + 2 * v)) / (2 * v); }

ec_borrower ec_borrower_of(uint32_t replicates)
{
    const double d = replicates - 1.0;
    ec_borrower b = {.replicates = replicates, .spread = ec_trigamma(d / 2), .bias = log_bias(d / 2)};
    for (int i = 0; i < EC_BORROWED_MOST * EC_BORROWED_STEPS + 2; i++) b.t[i] = ec_student_t_quantile(0.975, d + (double)i / EC_BORROWED_STEPS);
    return b;
}

static double quantile(const ec_borrower *b, double borrowed)
{
    const double at = borrowed * EC_BORROWED_STEPS;
    const int i = (int)at;
    return b->t[i] + (at - i) * (b->t[i + 1] - b->t[i]);
}

/* d0 / 2; 0 where nothing is known */
static double half_freedom(const ec_borrower *b, const ec_neighbours *n)
{
    const double mean = n->sum / n->count, apart = (n->squares - n->sum * mean) / (n->count - 1) - b->spread;
    return n->count >= FEWEST && isfinite(apart) ? inverse_trigamma(fmax(apart, ALIKE)) : 0;
}

double ec_borrowed_freedom(const ec_borrower *b, const ec_neighbours *n)
{
    return b->replicates - 1.0 + fmin(2 * half_freedom(b, n), EC_BORROWED_MOST);
}

ec_reach ec_borrowed_reach(const ec_borrower *b, double se2, const ec_neighbours *n)
{
    const double y = half_freedom(b, n), d = b->replicates - 1.0, d0 = fmin(2 * y, EC_BORROWED_MOST);
    if (!(y > 0)) return (ec_reach){b->t[0], sqrt(se2)};
    return (ec_reach){quantile(b, d0), sqrt((d0 * exp(n->sum / n->count - b->bias + log_bias(y)) + d * se2) / (d0 + d))};
}

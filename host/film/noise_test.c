/* Four tests, combined into one p-value (ec_p_combined; channels first, then tests with the weights below):
 *
 *   mean    of the picture, each channel: Student's t with the degrees of freedom of Satterthwaite (Biometrics 2, 1946). A
 *           firefly brings its own standard error with it, so heavy tails do not raise alarms here.
 *   blocks  the worst of all 8 x 8 blocks, by Sidak: a difference in one place that the mean of the picture hides.
 *   pixels  the worst value, by Sidak.
 *   share   of values beyond the limit that noise passes 1 time in 100, against the binomial distribution.
 *
 * In pixels and blocks a standard error is far less certain than its degrees of freedom say: a pixel that missed the rare bright
 * path looks exact (a caustic "differs" from its own long render in 100 of 100 cases then). So its
 * variance there is the larger of its own and of the mean of 5 x 5 pixels, with the more degrees of freedom the more these
 * are alike (borrowed.h: beside a lamp's edge they tell nothing of it); and where both pictures' samples are counted, the
 * one with fewer is believed to be no less noisy per sample than the other, which has seen the rare paths. All this errs
 * towards no alarm, so these tests have less than their share of false ones; the mean, exact, has most of the weight.
 *
 * A value whose neighbourhood has no noise in either picture is exact and has to be equal but for rounding and slack. Slack may lie in one
 * direction all over a picture, as rounding to 8 bits does where it is flat: a sum of differences loses the sum of the slacks.
 *
 * tests/stat/test_false_alarms.c counts: of 750 pairs that differ in their seeds 0.7 % have p < 0.01, 2.1 % p < 0.05. */
#include "film/noise_test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/freed.h"
#include "film/borrowed.h"
#include "film/neighbourhood.h"
#include "film/statistics.h"

enum { TESTS = 4, RADIUS = 2 };
#define MANY 1000 /* degrees of freedom: with more, an error is as good as known */
static const double weights[TESTS] = {0.45, 0.45, 0.05, 0.05};
static const double outlying_p = 0.01, certainly_within = 2.5; /* P(|T| > 2.5) > 0.01 for any degrees of freedom */

typedef struct pair {
    const ec_measured *a, *b;
    double dof_a, dof_b;
    double *judged_a, *judged_b; /* 3 a pixel: the variances by which pixels and blocks are judged, … */
    double *doubt_a, *doubt_b;   /* … and 1 over their degrees of freedom */
} pair;

/* The sums that t-tests need: the difference and its slack, its variance, and sum (variance^2 / degrees of freedom). */
typedef struct t_sums {
    double difference, slack, variance, spread;
} t_sums;

static double own_variance(const ec_measured *image, uint64_t i)
{
    return image->se ? (double)image->se[i] * image->se[i] : 0;
}

/* Variance by which a single value is judged: a curve bends the tails of its noise. */
static double single_variance(const ec_measured *image, uint64_t i)
{
    return image->tail_se ? (double)image->tail_se[i] * image->tail_se[i] : own_variance(image, i);
}

/* Variances of one channel in 5 x 5 pixels: their sum and number, and the logarithms of all but the middle one. */
typedef struct surroundings {
    double sum, count;
    ec_neighbours others;
} surroundings;

/* logs: logarithms of all variances. */
static surroundings look_around(const ec_measured *image, const double *logs, uint32_t x, uint32_t y, uint64_t c)
{
    const ec_neighbourhood around = ec_neighbourhood_of(x, y, RADIUS, image->width, image->height);
    const uint64_t middle = 3 * ((uint64_t)y * image->width + x) + c;
    surroundings s = {0};
    for (uint32_t j = around.y0; image->se && j < around.y1; j++)
        for (uint32_t i = around.x0; i < around.x1; i++) {
            const uint64_t beside = 3 * ((uint64_t)j * image->width + i) + c;
            if (!ec_counts(image, image, beside / 3)) continue;
            s.sum += single_variance(image, beside);
            s.count++;
            if (beside == middle) continue;
            s.others.count++;
            s.others.sum += logs[beside];
            s.others.squares += logs[beside] * logs[beside];
        }
    return s;
}

/* room: as many values as `judged`. */
static void judge(const ec_measured *image, double dof, double *judged, double *doubt, double *room)
{
    const bool is_counted = dof >= 1 && dof < MANY;
    const ec_borrower borrower = is_counted ? ec_borrower_of((uint32_t)dof + 1) : (ec_borrower){0};
    const uint64_t values = 3ull * image->width * image->height;
    for (uint64_t i = 0; i < values; i++) room[i] = is_counted ? log(single_variance(image, i)) : 0;
    for (uint64_t i = 0; i < values; i++) {
        const surroundings s = look_around(image, room, (uint32_t)(i / 3 % image->width), (uint32_t)(i / 3 / image->width), i % 3);
        judged[i] = fmax(single_variance(image, i), s.count > 0 ? s.sum / s.count : 0);
        doubt[i] = 1 / (is_counted ? ec_borrowed_freedom(&borrower, &s.others) : dof);
    }
}

static void lend_value(double lent, double doubt, double *judged, double *own_doubt)
{
    if (lent > *judged) *judged = lent, *own_doubt = doubt;
}

/* The picture with more samples lends its variance per sample. */
static void lend(const pair *q)
{
    if (!q->a->se || !q->b->se || !(q->a->samples > 0) || !(q->b->samples > 0)) return;
    const double ratio = q->b->samples / q->a->samples;
    for (uint64_t i = 0; i < 3ull * q->a->width * q->a->height; i++)
        if (ratio > 1) lend_value(q->judged_b[i] * ratio, q->doubt_b[i], &q->judged_a[i], &q->doubt_a[i]);
        else if (ratio < 1) lend_value(q->judged_a[i] / ratio, q->doubt_a[i], &q->judged_b[i], &q->doubt_b[i]);
}

static double difference_of(const pair *q, uint64_t i)
{
    return (double)q->a->rgb[i] - q->b->rgb[i];
}

static double rounding_of(const pair *q, uint64_t i)
{
    return ec_rounding(q->a, q->b, q->a->rgb[i], q->b->rgb[i]);
}

/* Adds a value by its own noise, for the mean of the picture. */
static void add_own(const pair *q, uint64_t i, t_sums *s)
{
    double va = own_variance(q->a, i), vb = own_variance(q->b, i);
    s->difference += difference_of(q, i);
    s->slack += ec_slack(q->a, q->b, i);
    s->variance += va + vb;
    s->spread += va * va / q->dof_a + vb * vb / q->dof_b;
}

/* Adds a value by the variances that pixels and blocks are judged by. */
static void add_judged(const pair *q, uint64_t i, t_sums *s)
{
    double wa = q->judged_a[i], wb = q->judged_b[i], rounding = rounding_of(q, i);
    s->difference += difference_of(q, i);
    s->slack += ec_slack(q->a, q->b, i);
    s->variance += wa + wb + rounding * rounding;
    s->spread += wa * wa * q->doubt_a[i] + wb * wb * q->doubt_b[i];
}

static double t_of(const t_sums *s)
{
    double beyond = fmax(fabs(s->difference) - s->slack, 0);
    return s->variance > 0 ? copysign(beyond, s->difference) / sqrt(s->variance) + 0.0 : 0; /* no -0 */
}

/* Returns the two-sided p-value. Without any noise of its own, t has as few degrees of freedom as either picture. */
static double p_of(const pair *q, const t_sums *s, double most)
{
    double dof = s->spread > 0 ? s->variance * s->variance / s->spread : fmin(q->dof_a, q->dof_b);
    dof = fmin(dof, most);
    return 2 * ec_student_t_upper_tail(fabs(t_of(s)), dof);
}

/* Returns the most degrees of freedom of a single value. Noise that a curve has bent is not normal, however many neighbours tell of it: its tails are
 * those of few degrees of freedom. */
static double most_of_single(const pair *q)
{
    return q->a->tail_se || q->b->tail_se ? fmin(q->dof_a, q->dof_b) : INFINITY;
}

static int is_exact(const pair *q, uint64_t i)
{
    return q->judged_a[i] + q->judged_b[i] == 0;
}

static void keep_worst(ec_noise_place *worst, double t, uint32_t x, uint32_t y, uint32_t c)
{
    if (fabs(t) > fabs(worst->t)) *worst = (ec_noise_place){x, y, c, t};
}

static double test_mean(const pair *q, uint32_t c, ec_noise_test *test)
{
    uint64_t pixels = (uint64_t)q->a->width * q->a->height, count = 0;
    t_sums s = {0};
    for (uint64_t p = 0; p < pixels; p++)
        if (ec_counts(q->a, q->b, p)) add_own(q, 3 * p + c, &s), count++;
    test->mean_difference[c] = s.difference / (double)count;
    test->mean_t[c] = t_of(&s);
    return s.variance > 0 ? p_of(q, &s, INFINITY) : 1;
}

static double test_blocks(const pair *q, uint32_t c, ec_noise_test *test)
{
    double least = 1, count = 0;
    for (uint32_t y0 = 0; y0 < q->a->height; y0 += EC_NOISE_BLOCK)
        for (uint32_t x0 = 0; x0 < q->a->width; x0 += EC_NOISE_BLOCK) {
            t_sums s = {0};
            int noisy = 0;
            for (uint32_t y = y0; y < y0 + EC_NOISE_BLOCK && y < q->a->height; y++)
                for (uint32_t x = x0; x < x0 + EC_NOISE_BLOCK && x < q->a->width; x++) {
                    uint64_t i = 3 * ((uint64_t)y * q->a->width + x) + c;
                    if (!ec_counts(q->a, q->b, i / 3) || is_exact(q, i)) continue;
                    noisy = 1;
                    add_judged(q, i, &s);
                }
            if (!noisy) continue;
            count++;
            least = fmin(least, p_of(q, &s, most_of_single(q)));
            keep_worst(&test->block, t_of(&s), x0, y0, c);
        }
    return ec_p_of_least(least, count);
}

static void note_exact(const pair *q, uint64_t i, ec_noise_test *test)
{
    if (fabs(difference_of(q, i)) <= rounding_of(q, i) + ec_slack(q->a, q->b, i)) return;
    if (test->exact_unequal++ > 0) return;
    test->exact_x = (uint32_t)(i / 3 % q->a->width);
    test->exact_y = (uint32_t)(i / 3 / q->a->width);
}

/* Tests the worst value, and the share of outlying ones. */
static double test_pixels(const pair *q, uint32_t c, double *p_share, ec_noise_test *test)
{
    double least = 1, count = 0, outlying = 0;
    uint64_t values = 3ull * q->a->width * q->a->height;
    for (uint64_t i = c; i < values; i += 3) {
        if (!ec_counts(q->a, q->b, i / 3)) continue;
        if (is_exact(q, i)) {
            note_exact(q, i, test);
            continue;
        }
        t_sums s = {0};
        add_judged(q, i, &s);
        count++;
        keep_worst(&test->pixel, t_of(&s), (uint32_t)(i / 3 % q->a->width), (uint32_t)(i / 3 / q->a->width), c);
        if (fabs(t_of(&s)) < certainly_within) continue;
        double p = p_of(q, &s, most_of_single(q));
        least = fmin(least, p);
        outlying += p < outlying_p;
    }
    test->judged += (uint64_t)count;
    test->outlying += (uint64_t)outlying;
    *p_share = ec_binomial_upper_tail(outlying, count, outlying_p);
    return ec_p_of_least(least, count);
}

static void run_tests(const pair *q, ec_noise_test *test)
{
    static const double alike[3] = {1, 1, 1};
    double p[TESTS][3];
    for (uint32_t c = 0; c < 3; c++) {
        p[0][c] = test_mean(q, c, test);
        p[1][c] = test_blocks(q, c, test);
        p[2][c] = test_pixels(q, c, &p[3][c], test);
    }
    test->p_mean = ec_p_combined(p[0], alike, 3);
    test->p_blocks = ec_p_combined(p[1], alike, 3);
    test->p_pixels = ec_p_combined(p[2], alike, 3);
    test->p_share = ec_p_combined(p[3], alike, 3);
    const double parts[TESTS] = {test->p_mean, test->p_blocks, test->p_pixels, test->p_share};
    test->p = test->exact_unequal ? 0 : ec_p_combined(parts, weights, TESTS);
}

ec_result ec_test_noise(const ec_measured *a, const ec_measured *b, ec_noise_test *test, ec_error *err)
{
    uint64_t values = 3ull * a->width * a->height;
    EC_FREED double *room = malloc(5 * values * sizeof *room);
    const pair q = {a, b, a->se ? a->replicates - 1 : INFINITY, b->se ? b->replicates - 1 : INFINITY, /* a picture without noise sets no limit */
                    room, room + values, room + 2 * values, room + 3 * values};
    *test = (ec_noise_test){0};
    if (!room) return ec_fail(err, "out of memory for the comparison of two images of %ux%u pixels", a->width, a->height);
    judge(a, q.dof_a, q.judged_a, q.doubt_a, room + 4 * values);
    judge(b, q.dof_b, q.judged_b, q.doubt_b, room + 4 * values);
    lend(&q);
    run_tests(&q, test);
    return EC_OK;
}

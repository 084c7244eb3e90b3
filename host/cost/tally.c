/* Pictures of a rung against the reference.
 *
 * With x a pixel of one picture of n samples and Y the reference's, independent, E[(x - Y)^2] = bias^2 + var x + var Y, and var Y is
 * known from the reference's own batches: so mean (x - Y)^2 - var Y estimates a picture's squared error without bias, whatever the
 * distribution. Pixels and pictures are independent but for Y; their spread and what Y adds make the figure's standard error (a little
 * too large, since pixels also differ in what is expected of them).
 *
 * Of all samples together, X with estimated variance v, d = (X - Y)^2 - v - var Y estimates bias^2. Given the bias b,
 * Var d = 2 w^2 + 4 w b^2 with w = v + var Y (normal pixels); d stands in for b^2, and w^2, which comes out too large on average,
 * makes the standard error rather wide than narrow. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cost/cost_internal.h"

ec_result ec_cost_tally_create(const ec_cost_reference *reference, uint64_t pixels, ec_cost_tally *t, ec_error *err)
{
    *t = (ec_cost_tally){.pixels = pixels, .reference = reference};
    double **planes[] = {&t->mean, &t->m2, &t->sum, &t->sum_variance};
    for (int i = 0; i < 4; i++)
        if (!(*planes[i] = calloc(pixels, sizeof(double))))
            return ec_fail(err, "out of memory for the study of %llu pixels; ask for a smaller --size",
                           (unsigned long long)pixels);
    return EC_OK;
}

void ec_cost_tally_free(ec_cost_tally *t)
{
    free(t->mean);
    free(t->m2);
    free(t->sum);
    free(t->sum_variance);
    *t = (ec_cost_tally){0};
}

void ec_cost_tally_begin(ec_cost_tally *t, uint32_t samples)
{
    t->level_samples = samples;
    t->level_batches = 0;
    t->mse = t->relmse = (ec_cost_sum){0};
    memset(t->mean, 0, t->pixels * sizeof *t->mean);
    memset(t->m2, 0, t->pixels * sizeof *t->m2);
}

static void add(ec_cost_sum *s, double d)
{
    s->sum += d;
    s->square += d * d;
}

/* Returns the weight of a pixel's difference in relmse; in mse it is 1. */
static double own_weight(double reference)
{
    double floored = reference + EC_RELMSE_FLOOR;
    return 1 / (floored * floored);
}

void ec_cost_tally_add(ec_cost_tally *t, const float *rgb)
{
    const ec_cost_reference *r = t->reference;
    double n = ++t->level_batches, scale = 1 / (r->mean_luminance * r->mean_luminance);
    for (uint64_t p = 0; p < t->pixels; p++) {
        double x = ec_luminance((double[3]){rgb[3 * p], rgb[3 * p + 1], rgb[3 * p + 2]});
        double delta = x - t->mean[p], error = x - r->luminance[p], d = error * error - r->variance[p];
        t->mean[p] += delta / n;
        t->m2[p] += delta * (x - t->mean[p]);
        add(&t->mse, d * scale);
        add(&t->relmse, d * own_weight(r->luminance[p]));
    }
}

/* Returns the squared standard error of the mean over all pixels of all pictures, as if pictures were independent. */
static double own_se2(const ec_cost_sum *s, double count) { return fmax(s->square - s->sum * s->sum / count, 0) / (count * count); }

/* Adds the reference's error, which all pictures share and more of them do not reduce: Var (b - e)^2 = 2 var Y^2 + 4 b^2 var Y. */
static void add_common(const ec_cost_tally *t, double *mse, double *relmse)
{
    const ec_cost_reference *r = t->reference;
    double n = t->level_batches, scale = 1 / (r->mean_luminance * r->mean_luminance),
           pixels2 = (double)t->pixels * (double)t->pixels;
    for (uint64_t p = 0; n >= 2 && p < t->pixels; p++) {
        double error = t->mean[p] - r->luminance[p], v = r->variance[p], weight = own_weight(r->luminance[p]);
        double bias2 = fmax(error * error - t->m2[p] / (n * (n - 1)) - v, 0), common = (2 * v + 4 * bias2) * v;
        *mse += common * scale * scale / pixels2;
        *relmse += common * weight * weight / pixels2;
    }
}

static ec_cost_point point_of(const ec_cost_tally *t)
{
    double count = (double)t->pixels * t->level_batches, mse_se2 = own_se2(&t->mse, count), relmse_se2 = own_se2(&t->relmse, count);
    add_common(t, &mse_se2, &relmse_se2);
    return (ec_cost_point){.samples = t->level_samples, .batches = t->level_batches, .mse = t->mse.sum / count, .mse_se = sqrt(mse_se2),
                           .relmse = t->relmse.sum / count, .relmse_se = sqrt(relmse_se2)};
}

void ec_cost_tally_end(ec_cost_tally *t, ec_cost_row *row)
{
    double n = t->level_samples, batches = t->level_batches, variance = 0;
    if (t->level_batches == 0 || row->point_count == EC_COST_LEVELS_MOST) return;
    row->points[row->point_count++] = point_of(t);
    if (t->level_batches < 2) return;
    for (uint64_t p = 0; p < t->pixels; p++) {
        double s2 = t->m2[p] / (batches - 1);
        variance += s2;
        t->sum[p] += n * batches * t->mean[p];
        t->sum_variance[p] += n * n * batches * s2;
    }
    t->samples += n * batches;
    if (t->level_samples > EC_COST_UNIT) return;
    row->variance = n * variance / (double)t->pixels / (t->reference->mean_luminance * t->reference->mean_luminance);
    row->unit = t->level_samples;
}

void ec_cost_tally_bias(const ec_cost_tally *t, ec_cost_row *row)
{
    const ec_cost_reference *r = t->reference;
    double sum = 0, spread = 0, least = 0, pixels = (double)t->pixels, scale = 1 / (r->mean_luminance * r->mean_luminance);
    row->bias2 = row->bias2_se = NAN;
    if (t->samples == 0) return;
    for (uint64_t p = 0; p < t->pixels; p++) {
        double w = t->sum_variance[p] / (t->samples * t->samples) + r->variance[p];
        double difference = t->sum[p] / t->samples - r->luminance[p], d = difference * difference - w;
        sum += d;
        spread += 2 * w * w + 4 * w * d;
        least += 2 * w * w;
    }
    row->bias2 = sum / pixels * scale;
    row->bias2_se = sqrt(fmax(spread, least)) / pixels * scale;
    row->biased = !row->rung.unbiased && !row->rung.fades && row->bias2 > 3 * row->bias2_se;
    row->lacks_light = row->rung.unbiased && row->bias2 > 4 * row->bias2_se;
}

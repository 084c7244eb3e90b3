/* Pictures of a rung against the reference.
 *
 * With x a pixel of one picture of n samples and Y the reference's, independent, E[(x - Y)^2] = bias^2 + var x + var Y, and var Y is
 * known from the reference's own batches: so mean (x - Y)^2 - var Y estimates a picture's squared error without bias, whatever the
 * distribution. Pixels are independent; their spread gives the figure's standard error (a little too large, since pixels also differ
 * in what is expected of them).
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
        if (!(*planes[i] = calloc(pixels, sizeof(double)))) return ec_fail(err, "out of memory for the study of %llu pixels; ask for a smaller --size", (unsigned long long)pixels);
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
    t->level_mse.mean = t->level_mse.se2 = t->level_relmse.mean = t->level_relmse.se2 = 0;
    memset(t->mean, 0, t->pixels * sizeof *t->mean);
    memset(t->m2, 0, t->pixels * sizeof *t->m2);
}

void ec_cost_tally_add(ec_cost_tally *t, const float *rgb)
{
    const ec_cost_reference *r = t->reference;
    double n = ++t->level_batches, pixels = (double)t->pixels, scale = 1 / (r->mean_luminance * r->mean_luminance);
    double sum = 0, sum2 = 0, relative_sum = 0, relative_sum2 = 0;
    for (uint64_t p = 0; p < t->pixels; p++) {
        double x = ec_luminance((double[3]){rgb[3 * p], rgb[3 * p + 1], rgb[3 * p + 2]});
        double delta = x - t->mean[p], error = x - r->luminance[p], d = error * error - r->variance[p];
        t->mean[p] += delta / n;
        t->m2[p] += delta * (x - t->mean[p]);
        double own = r->luminance[p] + EC_RELMSE_FLOOR, relative = d / (own * own);
        sum += d * scale;
        sum2 += d * d * scale * scale;
        relative_sum += relative;
        relative_sum2 += relative * relative;
    }
    t->level_mse.mean += (sum / pixels - t->level_mse.mean) / n;
    t->level_mse.se2 += fmax(sum2 - sum * sum / pixels, 0) / pixels / pixels;
    t->level_relmse.mean += (relative_sum / pixels - t->level_relmse.mean) / n;
    t->level_relmse.se2 += fmax(relative_sum2 - relative_sum * relative_sum / pixels, 0) / pixels / pixels;
}

void ec_cost_tally_end(ec_cost_tally *t, ec_cost_row *row)
{
    double n = t->level_samples, batches = t->level_batches, scale = 1 / (t->reference->mean_luminance * t->reference->mean_luminance);
    if (t->level_batches == 0 || row->point_count == EC_COST_LEVELS_MOST) return;
    row->points[row->point_count++] = (ec_cost_point){.samples = t->level_samples, .batches = t->level_batches,
                                                      .mse = t->level_mse.mean, .mse_se = sqrt(t->level_mse.se2) / batches,
                                                      .relmse = t->level_relmse.mean, .relmse_se = sqrt(t->level_relmse.se2) / batches};
    if (t->level_batches < 2) return;
    double variance = 0;
    for (uint64_t p = 0; p < t->pixels; p++) {
        double s2 = t->m2[p] / (batches - 1);
        variance += s2;
        t->sum[p] += n * batches * t->mean[p];
        t->sum_variance[p] += n * n * batches * s2;
    }
    t->samples += n * batches;
    if (t->level_samples > EC_COST_UNIT) return;
    row->variance = n * variance / (double)t->pixels * scale;
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
    row->biased = !row->rung.unbiased && row->bias2 > 3 * row->bias2_se;
    row->unmet = row->rung.unbiased && row->bias2 > 4 * row->bias2_se;
}

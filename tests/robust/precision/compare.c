/* Compares one function's results from the device with double precision, and with the error that rounding its inputs explains. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "robust/precision/precision.h"
#include "robust/precision/internal.h"

#define ULP_HALF 0x1p-24 /* u */
#define MOST_CONDITION 0.01

/* Results of one input; for each word also the change by half an ulp in every input. */
typedef struct exact {
    double value[EC_PRECISION_RESULTS], condition[EC_PRECISION_RESULTS];
} exact;

/* Inputs move both ways as far as the function's roundings might have moved them, so that a kink or a jump within that distance counts. The
 * change is then scaled to half an ulp. */
static exact reference_of(const ec_precision_case *c, const ec_precision_reference *reference,
                          const ec_precision_data *data, const float *in)
{
    exact e = {{0}, {0}};
    float x[EC_PRECISION_WORDS];
    memcpy(x, in, sizeof x);
    reference->run(x, e.value, data->memory, data->params);
    int steps = (int)ceil(c->roundings / 2);
    for (uint32_t i = 0; i < c->words; i++) {
        if (c->exact >> i & 1) continue;
        double most[EC_PRECISION_RESULTS] = {0};
        for (int side = 0; side < 2; side++) {
            double moved[EC_PRECISION_RESULTS] = {0};
            for (int step = 0; step < steps; step++) x[i] = nextafterf(x[i], side ? INFINITY : -INFINITY);
            if (c->turns >> i & 1) x[i] = in[i] + (side ? 1.0f : -1.0f) * (float)steps * 0x1p-24f;
            reference->run(x, moved, data->memory, data->params);
            for (int k = 0; k < EC_PRECISION_RESULTS; k++) most[k] = fmax(most[k], fabs(moved[k] - e.value[k])); /* NaN: there is no neighbour */
            x[i] = in[i];
        }
        for (int k = 0; k < EC_PRECISION_RESULTS; k++) e.condition[k] += most[k] / (2 * steps);
    }
    return e;
}

/* Words [first, end) as one value: largest error, size and condition. */
typedef struct judged {
    double error, size, condition;
    uint32_t word; /* the word with the largest error */
} judged;

static judged judge(const exact *e, const float *out, uint32_t first, uint32_t end, double scale)
{
    judged j = {0, scale, 0, first};
    for (uint32_t k = first; k < end; k++) {
        double error = fabs(out[k] - e->value[k]);
        if (!(error <= j.error)) {
            j.error = isnan(error) ? INFINITY : error;
            j.word = k;
        }
        j.size = fmax(j.size, fabs(e->value[k]));
        j.condition = fmax(j.condition, e->condition[k]);
    }
    return j;
}

static double digits_of(double error, double size)
{
    if (error == 0) return -log10(ULP_HALF);
    return size > 0 ? fmin(fmax(-log10(error / size), 0), -log10(ULP_HALF)) : 0;
}

static void take(ec_precision_row *row, const judged *j, const exact *e, const float *in, const float *out, double *digits)
{
    /* If rounding the inputs leaves no digit, the sum of single changes bounds nothing, and the input is left out. An infinite result or
     * NaN is always wrong. */
    if (j->error > 0 && j->condition > MOST_CONDITION * j->size && isfinite(j->error)) {
        row->hopeless++;
        return;
    }
    /* Results below the smallest normal number may be flushed to 0. */
    double explained = ULP_HALF * j->size + j->condition + FLT_MIN, times = j->error / explained;
    double kept = j->error <= FLT_MIN ? digits_of(0, 1) : digits_of(j->error, j->size);
    digits[row->inputs++] = kept;
    if (kept < row->digits) {
        row->digits = kept;
        row->explained = digits_of(ULP_HALF * j->size + j->condition, j->size);
    }
    if (times < row->times) return;
    row->times = times;
    memcpy(row->worst, in, sizeof row->worst);
    row->expected = e->value[j->word];
    row->measured = out[j->word];
}

/* Values outside float's range are not judged. */
static bool representable(const exact *e, uint32_t first, uint32_t end)
{
    for (uint32_t k = first; k < end; k++)
        if (!(fabs(e->value[k]) <= FLT_MAX)) return false;
    return true;
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void ec_precision_compare(const ec_precision_case *c, const ec_precision_reference *reference, const ec_precision_data *data,
                          ec_precision_row *rows)
{
    double *digits[EC_PRECISION_MOST_RESULTS];
    uint32_t results = 0;
    for (; results < EC_PRECISION_MOST_RESULTS && c->results[results].name; results++) {
        const ec_precision_result *r = &c->results[results];
        rows[results] = (ec_precision_row){.function = c->name, .result = r->name, .file = c->file, .digits = digits_of(0, 1),
                                           .explained = digits_of(0, 1), .roundings = c->roundings, .words = c->words};
        digits[results] = calloc((size_t)data->count * r->words, sizeof *digits[results]);
    }
    for (uint32_t i = 0; i < data->count; i++) {
        const float *in = data->in + (size_t)i * EC_PRECISION_WORDS, *out = data->out + (size_t)i * EC_PRECISION_RESULTS;
        exact e = reference_of(c, reference, data, in);
        for (uint32_t k = 0; k < results; k++) {
            const ec_precision_result *r = &c->results[k];
            uint32_t end = r->first + r->words,
                     step = r->kind == EC_PRECISION_EACH || r->kind == EC_PRECISION_STATED ? 1 : r->words;
            if (!digits[k] || !representable(&e, r->first, end)) continue;
            double scale = r->kind == EC_PRECISION_SCALED ? fabs(e.value[end]) : 0;
            double stated = r->kind == EC_PRECISION_STATED ? ULP_HALF * fabs(e.value[end]) : 0;
            for (uint32_t first = r->first; first < end; first += step) {
                judged j = judge(&e, out, first, first + step, scale);
                j.condition += stated;
                take(&rows[k], &j, &e, in, out, digits[k]);
            }
        }
    }
    for (uint32_t k = 0; k < results; k++) {
        ec_precision_row *row = &rows[k];
        if (digits[k]) qsort(digits[k], row->inputs, sizeof *digits[k], by_size);
        row->median = digits[k] && row->inputs ? digits[k][row->inputs / 2] : 0;
        row->pass = row->inputs && row->times <= row->roundings;
        row->lost = fmax(log10(row->times), 0);
        free(digits[k]);
    }
}

#include "film/tail.h"

#include <math.h>

void ec_tail_add(ec_tail *t, double value)
{
    if (!(value > 0) || (t->count == EC_TAIL_KEPT && value <= t->largest[EC_TAIL_KEPT - 1])) return;
    uint32_t i = t->count < EC_TAIL_KEPT ? t->count++ : EC_TAIL_KEPT - 1;
    for (; i > 0 && t->largest[i - 1] < value; i--) t->largest[i] = t->largest[i - 1];
    t->largest[i] = value;
}

void ec_tail_join(ec_tail *into, const ec_tail *next)
{
    for (uint32_t i = 0; i < next->count; i++) ec_tail_add(into, next->largest[i]);
}

/* Mean of ln(1 - b x): minus the shape that goes with b. */
static double mean_log(const double *x, uint32_t n, double b)
{
    double sum = 0;
    for (uint32_t i = 0; i < n; i++) sum += log1p(-b * x[i]);
    return sum / n;
}

double ec_tail_shape(const ec_tail *t)
{
    enum { N = EC_TAIL_KEPT - 1, CANDIDATES = 30 + 7 }; /* 30 + sqrt(N) */
    if (t->count < EC_TAIL_KEPT) return 0;
    double x[N], b[CANDIDATES], likelihood[CANDIDATES], sum = 0, mean = 0;
    for (uint32_t i = 0; i < N; i++) x[i] = t->largest[i] - t->largest[N];
    const double most = x[0], quarter = x[N - 1 - N / 4];
    if (!(quarter > 0)) return most > 0 ? INFINITY : 0;
    for (int i = 0; i < CANDIDATES; i++) {
        b[i] = 1 / most + (1 - sqrt(CANDIDATES / (i + 0.5))) / (3 * quarter);
        const double k = mean_log(x, N, b[i]);
        likelihood[i] = N * (log(-b[i] / k) - k - 1);
    }
    for (int i = 0; i < CANDIDATES; i++) {
        double others = 0;
        for (int j = 0; j < CANDIDATES; j++) others += exp(likelihood[j] - likelihood[i]);
        if (!(others > 0) || !isfinite(others)) continue;
        sum += 1 / others;
        mean += b[i] / others;
    }
    const double k = mean_log(x, N, mean / sum);
    return (k * N + 0.5 * 10) / (N + 10.0);
}

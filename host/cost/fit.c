/* Draws conclusions from points: slope, efficiency, time to an accuracy. */
#include <math.h>

#include "cost/cost_internal.h"

/* Tells whether the figure exceeds its own noise. */
static bool is_known(const ec_cost_point *p) { return p->mse > 0 && p->mse > 2 * p->mse_se; }

/* Weighted least squares of log error over log samples. Points come from different pictures, so they are independent except for the reference. No
 * point counts as more precise than 1 %, as the reference's error is common to all. */
static ec_cost_fit fit_slope(const ec_cost_point *points, uint32_t count)
{
    double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
    uint32_t used = 0;
    for (uint32_t i = 0; i < count; i++) {
        const ec_cost_point *p = &points[i];
        if (!is_known(p)) continue;
        double x = log(p->samples), y = 0.5 * log(p->mse), se = 0.5 * p->mse_se / p->mse;
        double weight = 1 / (se * se + 1e-4);
        w += weight, wx += weight * x, wy += weight * y, wxx += weight * x * x, wxy += weight * x * y;
        used++;
    }
    double determinant = w * wxx - wx * wx;
    if (used < 3 || !(determinant > 0)) return (ec_cost_fit){NAN, NAN};
    return (ec_cost_fit){(w * wxy - wx * wy) / determinant, sqrt(w / determinant)};
}

/* Returns how fast mse falls with samples beyond the largest picture: as over the last two octaves; 1 for independent samples. */
static double last_slope(const ec_cost_row *row)
{
    const uint32_t n = row->point_count;
    if (n < 3 || !is_known(&row->points[n - 1]) || !is_known(&row->points[n - 3])) return 1;
    const ec_cost_point *from = &row->points[n - 3], *to = &row->points[n - 1];
    return fmin(fmax(log(from->mse / to->mse) / log((double)to->samples / from->samples), row->rung.fades ? 0.2 : 1), 2);
}

/* Returns the samples per pixel until the error is below `target`; INFINITY: never. Interpolates between points in the log-log chart, and
 * extrapolates beyond the last one. */
static double samples_to(const ec_cost_row *row, double target, bool *extrapolated)
{
    const ec_cost_point *p = row->points, *last = &p[row->point_count - 1];
    double wanted = target * target, floor = row->biased ? row->bias2 : 0;
    *extrapolated = false;
    bool may_be_lower = row->rung.unbiased || row->rung.fades || wanted > row->bias2 + 2 * row->bias2_se;
    if (!may_be_lower) return row->biased ? INFINITY : NAN;
    if (is_known(&p[0]) && p[0].mse <= wanted) return p[0].samples;
    for (uint32_t i = 1; i < row->point_count; i++) {
        if (!is_known(&p[i]) || !is_known(&p[i - 1])) return NAN;
        if (p[i].mse > wanted) continue;
        double part = log(p[i - 1].mse / wanted) / log(p[i - 1].mse / p[i].mse);
        return p[i - 1].samples * pow((double)p[i].samples / p[i - 1].samples, part);
    }
    *extrapolated = true;
    if (row->biased) return row->variance / (wanted - floor);
    return is_known(last) ? last->samples * pow(last->mse / wanted, 1 / last_slope(row)) : NAN;
}

double ec_cost_seconds_to(const ec_cost_row *row, double target, bool *extrapolated)
{
    const ec_cost_point *last = row->point_count ? &row->points[row->point_count - 1] : NULL;
    *extrapolated = false;
    if (!last) return NAN;
    return samples_to(row, target, extrapolated) * (last->seconds - row->picture_seconds) / last->samples + row->picture_seconds;
}

void ec_cost_conclude(ec_cost_row *row)
{
    row->fit = fit_slope(row->points, row->point_count);
    row->efficiency = row->relative_efficiency = NAN;
    for (uint32_t i = 0; i < row->point_count; i++) {
        const ec_cost_point *p = &row->points[i];
        if (p->samples != row->unit) continue;
        if (is_known(p)) row->efficiency = 1 / (p->mse * p->seconds);
        if (p->relmse > 2 * p->relmse_se) row->relative_efficiency = 1 / (p->relmse * p->seconds);
    }
    for (int i = 0; i < EC_COST_TARGETS; i++) row->seconds_to[i] = ec_cost_seconds_to(row, ec_cost_targets[i], &row->extrapolated[i]);
}

uint32_t ec_cost_pareto(const ec_cost_study *study, ec_cost_place *places, uint32_t most)
{
    uint32_t count = 0;
    double fastest = 0, best = INFINITY;
    while (count < most) { /* finds the next in time that beats all before it */
        const ec_cost_point *next = NULL;
        for (uint32_t r = 0; r < study->row_count; r++)
            for (uint32_t i = 0; study->rows[r].state == EC_COST_MEASURED && i < study->rows[r].point_count; i++) {
                const ec_cost_point *p = &study->rows[r].points[i];
                if (study->rows[r].rung.is_effect || !is_known(p) || p->mse >= best || p->seconds < fastest) continue;
                if (next && (p->seconds > next->seconds || (p->seconds == next->seconds && p->mse >= next->mse))) continue;
                next = p;
                places[count] = (ec_cost_place){r, i};
            }
        if (!next) break;
        count++;
        fastest = next->seconds;
        best = next->mse;
    }
    return count;
}

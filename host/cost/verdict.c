/* Says in words what a study shows, and no more than there is evidence for. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "cost/cost.h"
#include "report/format.h"

enum { SIGMAS = 3, NAMED_MOST = 3 };

void ec_cost_label(const ec_cost_rung *rung, char *text, size_t size)
{
    static const char *const before[][2] = {{"sampling", "sample "}, {"roulette", "rr "}, {"scattering", "scattering "}, {"clamp", "clamp "}, {"lanes", "lanes "},
                                            {"effect", "without "}, {"lights", "without "}};
    const char *prefix = "";
    for (size_t i = 0; i < sizeof before / sizeof *before; i++)
        if (!strcmp(rung->group, before[i][0])) prefix = before[i][1];
    snprintf(text, size, "%s%s", prefix, rung->is_base ? "the default" : rung->name);
}

/* Tells whether a rung competes: it must converge to the picture. */
static bool competes(const ec_cost_row *row)
{
    const ec_cost_rung *r = &row->rung;
    return row->state == EC_COST_MEASURED && !r->is_effect && !row->lacks_light && (r->unbiased || r->fades) && (!r->speed_only || row->same_bits);
}

static double square(double x) { return x * x; }

/* Returns the relative noise of the time to an error: that of the squared error at the first picture below it; beyond the last picture also that of
 * the extrapolated slope, times the logarithm of the distance. */
static double noise_near(const ec_cost_row *row, double error)
{
    const ec_cost_point *p = row->points;
    for (uint32_t i = 0; i + 1 < row->point_count && p->mse > error * error; i++) p++;
    if (!row->point_count || !(p->mse > 0)) return NAN;
    const double own = p->mse_se / p->mse, way = log(p->mse / (error * error));
    return way <= 0 ? own : sqrt(square(own) + square(way * row->fit.se / (2 * square(row->fit.slope))));
}

ec_cost_figure ec_cost_figure_of(const ec_cost_study *study, const ec_cost_row *row, ec_cost_column column)
{
    const ec_cost_figure none = {NAN, NAN};
    const double time_se = row->rung.is_base ? 0 : row->relative_time_se / row->relative_time;
    if (!competes(row)) return none;
    if (column == EC_COST_TIME) return row->rung.fades ? none : (ec_cost_figure){row->relative_time, time_se * row->relative_time};
    if (row->rung.speed_only && column == EC_COST_VARIANCE) return none;
    if (column == EC_COST_VARIANCE) {
        if (row->rung.fades) return none;
        for (uint32_t i = 0; i < row->point_count; i++)
            if (row->points[i].samples == row->unit) return (ec_cost_figure){row->variance, row->variance * row->points[i].mse_se / row->points[i].mse};
        return none;
    }
    const int target = (int)column - EC_COST_TO_FIRST;
    const ec_cost_row *base = &study->rows[0], *curve = row->rung.speed_only ? base : row; /* the same bits have the same errors */
    const double factor = row->rung.speed_only ? row->relative_time : 1, seconds = factor * curve->seconds_to[target];
    if (!isfinite(seconds)) return none;
    const double noise = row->rung.speed_only ? 0 : noise_near(curve, ec_cost_targets[target]); /* it cancels */
    return (ec_cost_figure){seconds, seconds * sqrt(square(noise) + square(time_se))};
}

uint32_t ec_cost_best(const ec_cost_study *study, ec_cost_column column)
{
    const ec_cost_figure base = study->row_count ? ec_cost_figure_of(study, &study->rows[0], column) : (ec_cost_figure){NAN, NAN};
    uint32_t best = 0;
    double least = base.value;
    if (!isfinite(base.value)) return UINT32_MAX;
    for (uint32_t i = 1; i < study->row_count; i++) {
        const ec_cost_figure f = ec_cost_figure_of(study, &study->rows[i], column);
        const double se = study->rows[i].rung.speed_only ? f.se : sqrt(square(f.se) + square(base.se));
        if (f.value < least && base.value - f.value > SIGMAS * se) best = i, least = f.value;
    }
    return best;
}

/* Returns the smallest error that the default has reached, or else the largest for which its time is predicted; -1: none. */
static int find_goal(const ec_cost_row *base)
{
    int goal = -1;
    for (int i = 0; i < EC_COST_TARGETS; i++) {
        if (!isfinite(base->seconds_to[i])) break;
        if (goal < 0 || !base->extrapolated[i]) goal = i;
    }
    return goal;
}

static __attribute__((format(printf, 3, 4))) void say(char *text, size_t size, const char *format, ...)
{
    const size_t used = strlen(text);
    va_list args;
    va_start(args, format);
    vsnprintf(text + used, size - used, format, args);
    va_end(args);
}

static void say_winner(const ec_cost_study *study, ec_cost_column column, char *text, size_t size)
{
    const uint32_t best = ec_cost_best(study, column);
    const ec_cost_row *row = &study->rows[best];
    uint32_t count = 0;
    char label[160];
    for (uint32_t i = 0; i < study->row_count; i++) count += isfinite(ec_cost_figure_of(study, &study->rows[i], column).value);
    if (count < 2) return;
    if (best == 0) {
        say(text, size, " It is the best of %u ways to render whose time is known: none is faster by more than noise.", count);
        return;
    }
    const ec_cost_figure f = ec_cost_figure_of(study, row, column), base = ec_cost_figure_of(study, study->rows, column);
    const double gain = base.value / f.value, base_noise = row->rung.speed_only ? 0 : base.se / base.value;
    ec_cost_label(&row->rung, label, sizeof label);
    say(text, size, " With %s it takes %.2f ± %.2f times as long, the least of %u ways to render whose time is known.", label, 1 / gain,
        sqrt(square(f.se / f.value) + square(base_noise)) / gain, count);
}

/* Names effects whose loss is certain, the largest first. */
static void say_effects(const ec_cost_study *study, char *text, size_t size)
{
    bool said[128] = {false};
    for (int n = 0; n < NAMED_MOST; n++) {
        uint32_t most = UINT32_MAX;
        for (uint32_t i = 0; i < study->row_count && i < 128; i++) {
            const ec_cost_row *row = &study->rows[i];
            if (said[i] || !row->rung.is_effect || row->state != EC_COST_MEASURED || !row->biased) continue;
            if (most == UINT32_MAX || row->bias2 > study->rows[most].bias2) most = i;
        }
        if (most == UINT32_MAX) break;
        said[most] = true;
        say(text, size, "%s %.*s %s", n ? "," : " Leaving an effect out makes an error: without", EC_CUT(study->rows[most].rung.name, 60), ec_percent(sqrt(study->rows[most].bias2)).text);
        if (n == NAMED_MOST - 1) break;
    }
    if (memchr(said, true, sizeof said)) say(text, size, ".");
}

static void say_floors(const ec_cost_study *study, char *text, size_t size)
{
    int named = 0;
    char label[160];
    for (uint32_t i = 0; i < study->row_count && named < NAMED_MOST; i++) {
        const ec_cost_row *row = &study->rows[i];
        if (row->state != EC_COST_MEASURED || row->rung.is_effect || !row->biased) continue;
        ec_cost_label(&row->rung, label, sizeof label);
        say(text, size, "%s %s under %s", named++ ? "," : " No time takes", label, ec_percent(sqrt(row->bias2)).text);
    }
    if (named) say(text, size, ".");
}

void ec_cost_words(const ec_cost_study *study, char *text, size_t size)
{
    const ec_cost_row *base = study->rows;
    uint32_t left = 0;
    *text = 0;
    if (!study->row_count || base->state != EC_COST_MEASURED) {
        say(text, size, "What accuracy costs is not known: the default was not measured.");
        return;
    }
    const int goal = find_goal(base);
    if (base->lacks_light) say(text, size, "What accuracy costs is not known: the default has not met all light of the scene yet.");
    else if (goal < 0) say(text, size, "What accuracy costs is not known: the budget was too small to tell an error of %g %%.", 100 * ec_cost_targets[0]);
    else
        say(text, size, "An error of %g %% at %ux%u pixels takes %s%s with the default of eclat render.", 100 * ec_cost_targets[goal], study->options.width,
            study->options.height, base->extrapolated[goal] ? "about " : "", ec_seconds(base->seconds_to[goal]).text);
    if (goal >= 0 && !base->lacks_light) say_winner(study, (ec_cost_column)(EC_COST_TO_FIRST + goal), text, size);
    say_effects(study, text, size);
    say_floors(study, text, size);
    for (uint32_t i = 0; i < study->row_count; i++) left += study->rows[i].state != EC_COST_MEASURED;
    if (left) say(text, size, " %u of %u rungs were not measured; the table says why.", left, study->row_count);
}

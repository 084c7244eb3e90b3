#include <math.h>
#include <stdio.h>

#include "cost/cost.h"
#include "report/format.h"

/* Returns the first error, from large to small, from which on samples alone are faster. Skips errors for which either time is unknown. */
static double find_crossing(const ec_cost_row *noisy, const ec_cost_row *clean, bool *ever_pays)
{
    enum { STEPS = 120 };
    *ever_pays = false;
    for (int i = 0; i < STEPS; i++) {
        const double error = 0.5 * pow(0.002, (double)i / (STEPS - 1)); /* 50 % to 0.1 % */
        bool beyond;
        const double as_it_is = ec_cost_seconds_to(noisy, error, &beyond), denoised = ec_cost_seconds_to(clean, error, &beyond);
        if (!isfinite(as_it_is) || !isfinite(denoised)) continue;
        if (denoised < as_it_is) *ever_pays = true;
        else if (*ever_pays) return error;
    }
    return 0;
}

void ec_cost_denoise_words(const ec_cost_study *study, char *text, size_t size)
{
    const ec_cost_row *noisy = study->row_count ? &study->rows[0] : NULL, *clean = NULL;
    bool ever_pays, beyond;
    *text = 0;
    for (uint32_t i = 0; i < study->row_count; i++)
        if (study->rows[i].rung.options.denoise) clean = &study->rows[i];
    if (!clean || clean->state != EC_COST_MEASURED || noisy->state != EC_COST_MEASURED || !(clean->picture_seconds > 0)) return;
    const double crossing = find_crossing(noisy, clean, &ever_pays);
    if (!ever_pays) snprintf(text, size, "does not pay on this scene: samples alone reach any error as soon; it takes %s a picture", ec_seconds(clean->picture_seconds).text);
    else if (!(crossing > 0)) snprintf(text, size, "pays at every error down to 0.1 %%; it takes %s a picture", ec_seconds(clean->picture_seconds).text);
    else snprintf(text, size, "pays down to an error of %s, which takes %s; samples alone reach a smaller error sooner", ec_percent(crossing).text,
                  ec_seconds(ec_cost_seconds_to(noisy, crossing, &beyond)).text);
}

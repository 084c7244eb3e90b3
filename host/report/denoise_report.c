#include "report/denoise_report.h"

#include <math.h>

#include "report/format.h"

/* "1.10 % (95 % interval 1.02 % to 1.18 %)" */
typedef struct stated { char text[128]; } stated;
static stated in_words(const ec_stated_error *e)
{
    stated s;
    if (isfinite(e->high95)) snprintf(s.text, sizeof s.text, "%s (95 %% interval %s to %s)", ec_percent(e->error).text, ec_percent(e->low95).text, ec_percent(e->high95).text);
    else snprintf(s.text, sizeof s.text, "at least %s: no bound, as of the picture itself", ec_percent(e->low95).text);
    return s;
}

/* Prints the best picture's error, and where the denoiser does not help. */
static void print_best(const ec_denoised *d, FILE *to)
{
    fprintf(to, "best     error %s", in_words(&d->best).text);
    if (d->off == d->tiles) fprintf(to, ": the denoiser is off everywhere\n");
    else if (d->off) fprintf(to, "; the denoiser is off in %u of %u tiles, where the noisy picture is nearer to the truth, most so around pixel %u, %u\n",
                             d->off, d->tiles, d->off_x, d->off_y);
    else fprintf(to, "; a blend by tiles of both\n");
}

void ec_denoised_text(const ec_denoised *d, FILE *to)
{
    if (!d) return;
    if (d->why_not) {
        fprintf(to, "denoised no: %s\n", d->why_not);
        return;
    }
    const double times = d->noisy / d->clean.error, worth = times * times;
    fprintf(to, "denoised error %s, bias %s, noise %s; ", in_words(&d->clean).text, ec_percent(d->bias).text, ec_percent(d->noise).text);
    if (d->clean.low95 > d->noisy) fprintf(to, "the noisy picture is nearer to the truth, with %s", ec_percent(d->noisy).text);
    else if (d->clean.high95 < d->noisy) fprintf(to, "as good as %s times the samples", ec_count(worth).text);
    else fprintf(to, "whether it is nearer to the truth than the noisy picture is not known");
    fprintf(to, "; nearer to the truth in %u of %u tiles; took %s\n", d->nearer, d->tiles, ec_seconds(d->seconds).text);
    print_best(d, to);
}

static void add_stated(cJSON *object, const ec_stated_error *e)
{
    EC_JSON(object, EC_REAL("error", e->error), EC_REAL("low95", e->low95), EC_REAL("high95", e->high95));
}

void ec_denoised_json(cJSON *root, const ec_denoised *d)
{
    if (!d) {
        cJSON_AddNullToObject(root, "denoised");
        cJSON_AddNullToObject(root, "best");
        return;
    }
    cJSON *clean = ec_json_object(root, "denoised"), *best = ec_json_object(root, "best");
    if (d->why_not) {
        EC_JSON(clean, EC_REAL("error", NAN), EC_STRING("why_not", d->why_not));
        EC_JSON(best, EC_REAL("error", NAN));
        return;
    }
    add_stated(clean, &d->clean);
    EC_JSON(clean, EC_REAL("bias", d->bias), EC_REAL("noise", d->noise), EC_WHOLE("tiles", d->tiles), EC_WHOLE("tiles_nearer", d->nearer),
            EC_REAL("seconds", d->seconds), EC_STRING("library", d->library));
    add_stated(best, &d->best);
    EC_JSON(best, EC_WHOLE("tiles_off", d->off));
    if (d->off) EC_JSON(best, EC_WHOLE("off_x", d->off_x), EC_WHOLE("off_y", d->off_y));
}

void ec_denoised_attributes(ec_report_attributes *to, const ec_denoised *d)
{
    if (!d || d->why_not) return;
    EC_ATTRIBUTES(to, EC_REAL("eclat.denoised.error", d->clean.error), EC_REAL("eclat.denoised.low95", d->clean.low95),
                  EC_REAL("eclat.denoised.high95", d->clean.high95), EC_REAL("eclat.denoised.bias", d->bias), EC_REAL("eclat.denoised.noise", d->noise),
                  EC_STRING("eclat.denoised.library", d->library), EC_REAL("eclat.best.error", d->best.error), EC_REAL("eclat.best.low95", d->best.low95),
                  EC_REAL("eclat.best.high95", d->best.high95), EC_WHOLE("eclat.best.tilesOff", d->off));
}

#include "report/error_text.h"

#include <math.h>
#include <stdio.h>

#include "report/format.h"

const char *ec_error_grade(const ec_film_error *e, const ec_clamp_error *clamp)
{
    static const struct {
        double bound;
        const char *name;
    } grades[] = {{0.01, "good as a reference"}, {0.03, "good for a print"}, {0.10, "good for a screen"}, {0.30, "a preview"}};
    if (!isfinite(e->error)) return "not known yet";
    if (e->is_open) return "not to be relied on";
    const double bound = clamp && isfinite(clamp->error) ? hypot(e->error_bound, ec_clamp_bias(clamp)) : e->error_bound;
    for (size_t i = 0; i < sizeof grades / sizeof *grades; i++)
        if (bound <= grades[i].bound) return grades[i].name;
    return "a rough preview";
}

void ec_error_why(const ec_film_error *e, char *text, size_t size)
{
    char way[EC_RARE_WAY];
    *text = 0;
    if (!e->is_open) return;
    ec_rare_way(e->through, e->light, way, sizeof way);
    snprintf(text, size, "rare bright paths decide (%d samples hold %s of the noise; paths %s are hardly met yet: while their light is missing the error is some %s)",
             EC_TAIL_FEW, ec_percent(e->tail_share).text, way, ec_percent(e->missing_light).text);
}

void ec_error_help(const ec_film_error *e, char *text, size_t size)
{
    char samples[64] = "more samples";
    *text = 0;
    if (!e->is_open) return;
    if (e->missing_light_samples > 0) snprintf(samples, sizeof samples, "some %s samples a pixel", ec_count(ceil(e->missing_light_samples)).text);
    if (*e->through)
        snprintf(text, size, "%s; or a rougher \"%s\", a larger light, --without specular; or --clamp 10, which reports what it removes", samples,
                 e->through);
    else snprintf(text, size, "%s; or a larger light; or --clamp 10, which reports what it removes", samples);
}

void ec_error_text(const ec_film_error *e, char *text, size_t size)
{
    char why[EC_ERROR_TEXT - 64];
    ec_error_why(e, why, sizeof why);
    if (!isfinite(e->error) && e->mean_luminance == 0) snprintf(text, size, "error unknown, since no sample has met any light");
    else if (!isfinite(e->error)) snprintf(text, size, "error unknown");
    else if (*why) snprintf(text, size, "error at least %s: no bound, since %s", ec_percent(e->error).text, why);
    else snprintf(text, size, "error %s (95 %% bound %s)", ec_percent(e->error).text, ec_percent(e->error_bound).text);
}

void ec_error_json(cJSON *root, const ec_film_error *e, const ec_clamp_error *clamp)
{
    char why[EC_ERROR_TEXT];
    ec_error_why(e, why, sizeof why);
    EC_JSON(root, EC_STRING("error_bound_why", *why ? why : NULL), EC_STRING("quality", ec_error_grade(e, clamp)), EC_REAL("error_unmet", e->missing_light),
            EC_REAL("tail_share", e->tail_share));
}

void ec_clamp_text(const ec_clamp_error *c, bool is_open, char *text, size_t size)
{
    if (!isfinite(c->error)) {
        snprintf(text, size, "how much light is missing is not known");
        return;
    }
    const double bias = ec_clamp_bias(c);
    const char *up_to = bias > c->bias ? "up to " : "";
    snprintf(text, size, "%s%s of the light is missing (standard error %s); noise %s, bias %s%s, together %s%s", is_open ? "at least " : "",
             ec_percent(c->missing).text, ec_percent(c->missing_stderr).text, ec_percent(c->noise).text, up_to,
             ec_percent(bias).text, up_to, ec_percent(hypot(c->noise, bias)).text);
}

void ec_clamp_json(cJSON *root, double limit, double luminance, const ec_clamp_error *c)
{
    if (!(limit > 0)) {
        cJSON_AddNullToObject(root, "clamp");
        return;
    }
    EC_JSON(ec_json_object(root, "clamp"), EC_REAL("limit", limit), EC_REAL("luminance", luminance), EC_REAL("missing", c->missing),
            EC_REAL("missing_stderr", c->missing_stderr), EC_REAL("noise", c->noise), EC_REAL("bias", c->bias),
            EC_REAL("bias_most", c->bias_most), EC_REAL("error", c->error));
}

void ec_clamp_attributes(ec_report_attributes *to, double limit, double luminance, const ec_clamp_error *c)
{
    EC_ATTRIBUTES(to, EC_REAL("eclat.clamp.limit", limit), EC_REAL("eclat.clamp.luminance", luminance), EC_REAL("eclat.clamp.missing", c->missing),
                  EC_REAL("eclat.clamp.missingStderr", c->missing_stderr), EC_REAL("eclat.clamp.noise", c->noise),
                  EC_REAL("eclat.clamp.bias", c->bias), EC_REAL("eclat.clamp.biasMost", c->bias_most), EC_REAL("eclat.clamp.error", c->error));
}

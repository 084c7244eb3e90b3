#include "report/clamp_report.h"

#include <math.h>
#include <stdio.h>

#include "report/format.h"

void ec_clamp_text(const ec_clamp_error *c, bool is_open, char *text, size_t size)
{
    if (!isfinite(c->error)) {
        snprintf(text, size, "how much light is missing is not known");
        return;
    }
    snprintf(text, size, "%s%s of the light is missing (standard error %s); noise %s, bias %s, together %s", is_open ? "at least " : "",
             ec_percent(c->missing).text, ec_percent(c->missing_stderr).text, ec_percent(c->noise).text,
             ec_percent(c->bias).text, ec_percent(c->error).text);
}

void ec_clamp_json(cJSON *root, double limit, double luminance, const ec_clamp_error *c)
{
    if (!(limit > 0)) {
        cJSON_AddNullToObject(root, "clamp");
        return;
    }
    cJSON *clamp = cJSON_AddObjectToObject(root, "clamp");
    ec_json_real(clamp, "limit", limit);
    ec_json_real(clamp, "luminance", luminance);
    ec_json_real(clamp, "missing", c->missing);
    ec_json_real(clamp, "missing_stderr", c->missing_stderr);
    ec_json_real(clamp, "noise", c->noise);
    ec_json_real(clamp, "bias", c->bias);
    ec_json_real(clamp, "error", c->error);
}

#include "report/merge_report.h"

#include <math.h>

#include "base/text.h"
#include "report/denoise_report.h"
#include "report/error_text.h"
#include "report/json.h"

void ec_merge_report_text(const ec_merge_report *r, FILE *to)
{
    char error[EC_ERROR_TEXT], help[EC_ERROR_TEXT], clamped[256];
    fprintf(to, "%d %s, %llu samples a pixel in %llu replicates\n", r->files, r->files == 1 ? "file" : "files",
            (unsigned long long)r->samples_per_pixel, (unsigned long long)r->replicates);
    if (isfinite(r->error.error)) {
        ec_error_text(&r->error, error, sizeof error);
        ec_error_help(&r->error, help, sizeof help);
        fprintf(to, "%s\n%s%s%s", error, *help ? "helps: " : "", help, *help ? "\n" : "");
    }
    if (r->limit > 0) {
        ec_clamp_text(&r->clamp, r->error.is_open, clamped, sizeof clamped);
        fprintf(to, "clamped: %s\n", clamped);
    }
    ec_denoised_text(r->denoised, to);
    if (r->is_exposure_auto) fprintf(to, "exposure: %+.2f stops, by auto\n", r->exposure);
    for (int i = 0; i < r->output_count; i++) ec_text_print(to, "", r->outputs[i], "\n");
}

ec_result ec_merge_report_json(const ec_merge_report *r, FILE *to, ec_error *err)
{
    cJSON *object = cJSON_CreateObject();
    EC_JSON(object, EC_STRING("version", ECLAT_VERSION), EC_WHOLE("files", (uint64_t)r->files), EC_WHOLE("samples_per_pixel", r->samples_per_pixel),
            EC_WHOLE("replicates", r->replicates), EC_REAL("error", r->error.error), EC_REAL("error_bound", r->error.error_bound));
    ec_error_json(object, &r->error, r->limit > 0 ? &r->clamp : NULL);
    EC_JSON(object, EC_REAL("relmse", r->error.relmse), EC_REAL("mean_luminance", r->error.mean_luminance), EC_WHOLE("heavy_pixels", r->heavy_pixels));
    ec_clamp_json(object, r->limit, r->luminance, &r->clamp);
    ec_denoised_json(object, r->denoised);
    EC_JSON(object, EC_REAL("exposure", r->exposure), EC_FLAG("exposure_auto", r->is_exposure_auto));
    ec_json_text(object, "image_sha256", r->image_sha256);
    ec_json_texts(object, "outputs", r->outputs, (size_t)r->output_count);
    return ec_json_print(object, to, err);
}

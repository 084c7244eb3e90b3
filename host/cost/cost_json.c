#include <math.h>

#include "cost/report.h"
#include "report/device_report.h"
#include "report/format.h"
#include "report/json.h"
#include "report/names.h"

static const char *state_name(const ec_cost_study *study, ec_cost_state state)
{
    static const char *const names[] =
        {[EC_COST_MEASURED] = "measured", [EC_COST_TOO_SMALL] = "budget too small", [EC_COST_REFUSED] = "refused"};
    return state != EC_COST_PENDING ? names[state] : study->interrupted ? "interrupted" : "pending";
}

static void add_settings(cJSON *to, const ec_render_options *o)
{
    cJSON *settings = ec_json_object(to, "settings");
    EC_JSON(settings, EC_STRING("integrator", ec_integrator_names[o->integrator]), EC_STRING("sample", ec_sample_names[o->sample]),
            EC_STRING("sampler", ec_sampler_names[o->sampler]), EC_STRING("rr", ec_roulette(o->survival).text),
            EC_REAL("max_depth", o->max_depth ? o->max_depth : NAN), EC_REAL("clamp", o->clamp > 0 ? o->clamp : NAN),
            EC_STRING("scattering", ec_scattering_names[o->scattering]), EC_STRING("accel", o->accel ? o->accel : "auto"));
    if (o->lanes) ec_json_whole(settings, "lanes", o->lanes);
    else ec_json_text(settings, "lanes", "auto");
    ec_json_text(settings, "arithmetic", o->fast_math ? "fast" : "exact");
}

static void add_points(cJSON *to, const ec_cost_row *row)
{
    cJSON *points = cJSON_AddArrayToObject(to, "curve");
    for (uint32_t i = 0; i < row->point_count; i++) {
        const ec_cost_point *p = &row->points[i];
        EC_JSON(ec_json_object(points, NULL), EC_WHOLE("samples_per_pixel", p->samples), EC_WHOLE("pictures", p->batches), EC_REAL("seconds", p->seconds),
                EC_REAL("error", p->mse > 0 ? sqrt(p->mse) : NAN), EC_REAL("error_se", p->mse > 0 ? 0.5 * p->mse_se / sqrt(p->mse) : NAN),
                EC_REAL("mse", p->mse), EC_REAL("mse_se", p->mse_se), EC_REAL("relmse", p->relmse), EC_REAL("relmse_se", p->relmse_se));
    }
}

static void add_targets(cJSON *to, const ec_cost_row *row)
{
    cJSON *targets = cJSON_AddArrayToObject(to, "time_to");
    for (int i = 0; i < EC_COST_TARGETS; i++)
        EC_JSON(ec_json_object(targets, NULL), EC_REAL("error", ec_cost_targets[i]), EC_REAL("seconds", row->seconds_to[i]),
                EC_FLAG("never", isinf(row->seconds_to[i]) != 0), EC_FLAG("extrapolated", row->extrapolated[i]));
}

static void add_errors(cJSON *to, const ec_cost_row *row)
{
    EC_JSON(to, EC_WHOLE("unit_samples_per_pixel", row->unit), EC_REAL("variance", row->variance), EC_REAL("bias_squared", row->bias2),
            EC_REAL("bias_squared_se", row->bias2_se), EC_FLAG("unbiased_by_design", row->rung.unbiased), EC_FLAG("biased", row->biased),
            EC_FLAG("light_not_met", row->lacks_light), EC_REAL("error_floor", row->biased ? sqrt(row->bias2) : NAN), EC_REAL("slope", row->fit.slope),
            EC_REAL("slope_se", row->fit.se), EC_REAL("efficiency", row->efficiency), EC_REAL("efficiency_relmse", row->relative_efficiency));
    add_targets(to, row);
    add_points(to, row);
}

static void add_rung(cJSON *rungs, const ec_cost_study *study, const ec_cost_row *row)
{
    cJSON *to = ec_json_object(rungs, NULL);
    char label[160];
    ec_cost_label(&row->rung, label, sizeof label);
    EC_JSON(to, EC_STRING("id", row->rung.id), EC_STRING("label", label), EC_STRING("group", row->rung.group), EC_STRING("group_title", row->rung.title),
            EC_STRING("name", row->rung.name));
    add_settings(to, &row->rung.options);
    EC_JSON(to, EC_FLAG("scene_changed", row->rung.options.without != 0), EC_STRING("state", state_name(study, row->state)),
            EC_STRING("note", *row->note ? row->note : NULL));
    if (row->state != EC_COST_MEASURED) return;
    EC_JSON(to, EC_REAL("setup_seconds", row->setup_seconds), EC_REAL("seconds_per_sample", row->seconds_per_sample),
            EC_REAL("relative_time", row->relative_time), EC_REAL("relative_time_se", row->relative_time_se),
            EC_WHOLE("samples_per_pixel", row->samples_per_pixel), EC_WHOLE("device_bytes", row->device_bytes),
            EC_WHOLE("invalid_values", row->invalid));
    if (row->rung.options.denoise) ec_json_real(to, "denoise_seconds", row->picture_seconds);
    if (row->rung.speed_only) cJSON_AddBoolToObject(to, "same_bits", row->same_bits);
    else add_errors(to, row);
}

static void add_reference(cJSON *root, const ec_cost_reference *r)
{
    EC_JSON(ec_json_object(root, "reference"), EC_STRING("file", r->source),
            EC_REAL("samples_per_pixel", r->samples_per_pixel ? (double)r->samples_per_pixel : NAN),
            EC_REAL("error", r->has_variance ? sqrt(r->noise) : NAN), EC_REAL("mean_luminance", r->mean_luminance),
            EC_REAL("seconds", r->seconds), EC_REAL("setup_seconds", r->setup_seconds));
}

/* Adds the ids of the rungs that are best in a column, as far as there is evidence. */
static void add_best(cJSON *to, const ec_cost_study *study)
{
    static const char *const names[EC_COST_COLUMNS] = {"time", "variance", "to 5 %", "to 2 %", "to 1 %", "to 0.5 %"};
    cJSON *best = ec_json_object(to, "best");
    for (int c = 0; c < EC_COST_COLUMNS; c++) {
        const uint32_t row = ec_cost_best(study, (ec_cost_column)c);
        ec_json_text(best, names[c], row == UINT32_MAX ? NULL : study->rows[row].rung.id);
    }
}

static void add_pareto(cJSON *to, const ec_cost_study *study)
{
    ec_cost_place places[128];
    uint32_t count = ec_cost_pareto(study, places, 128);
    cJSON *front = cJSON_AddArrayToObject(to, "pareto_front");
    for (uint32_t i = 0; i < count; i++) {
        const ec_cost_row *row = &study->rows[places[i].row];
        const ec_cost_point *p = &row->points[places[i].point];
        EC_JSON(ec_json_object(front, NULL), EC_STRING("id", row->rung.id), EC_WHOLE("samples_per_pixel", p->samples),
                EC_REAL("seconds", p->seconds), EC_REAL("error", sqrt(p->mse)));
    }
}

cJSON *ec_cost_json(const ec_cost_report *report)
{
    const ec_cost_study *study = report->study;
    cJSON *root = cJSON_CreateObject();
    EC_JSON(root, EC_STRING("version", ECLAT_VERSION), EC_STRING("command", report->command), EC_STRING("scene", report->scene),
            EC_STRING("camera", report->camera), EC_STRING("environment", report->environment), EC_WHOLE("width", study->options.width),
            EC_WHOLE("height", study->options.height), EC_WHOLE("seed", study->options.seed), EC_REAL("budget_seconds", study->budget),
            EC_REAL("total_seconds", study->seconds), EC_FLAG("interrupted", study->interrupted));
    cJSON *device = ec_device_json(report->device, report->device_index);
    ec_json_text(device, "why", report->device_why);
    cJSON_AddItemToObject(root, "device", device);
    if (study->reference.mean_luminance > 0) add_reference(root, &study->reference);
    else cJSON_AddNullToObject(root, "reference");
    cJSON *rungs = cJSON_AddArrayToObject(root, "rungs");
    for (uint32_t i = 0; i < study->row_count; i++) add_rung(rungs, study, &study->rows[i]);
    add_pareto(root, study);
    char words[EC_COST_WORDS];
    add_best(root, study);
    ec_cost_words(study, words, sizeof words);
    ec_json_text(root, "result", words);
    ec_cost_denoise_words(study, words, sizeof words);
    ec_json_text(root, "denoiser", *words ? words : NULL);
    return root;
}

static void put_line(FILE *to, const void *text) { fprintf(to, "%s\n", (const char *)text); }

ec_result ec_cost_write_json(const ec_cost_report *report, const char *path, ec_error *err)
{
    cJSON *root = ec_cost_json(report);
    char *text = cJSON_Print(root);
    cJSON_Delete(root);
    if (!text) return ec_fail(err, "out of memory while writing '%s'", path);
    ec_result result = ec_cost_write(path, put_line, text, err);
    cJSON_free(text);
    return result;
}

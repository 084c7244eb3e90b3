#include <math.h>
#include <string.h>

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
    cJSON *settings = cJSON_AddObjectToObject(to, "settings");
    ec_json_text(settings, "integrator", ec_integrator_names[o->integrator]);
    ec_json_text(settings, "sample", ec_sample_names[o->sample]);
    ec_json_text(settings, "sampler", ec_sampler_names[o->sampler]);
    ec_json_text(settings, "rr", ec_roulette(o->survival).text);
    ec_json_real(settings, "max_depth", o->max_depth ? o->max_depth : NAN);
    ec_json_real(settings, "clamp", o->clamp > 0 ? o->clamp : NAN);
    ec_json_text(settings, "scattering", ec_scattering_names[o->scattering]);
    ec_json_text(settings, "accel", o->accel ? o->accel : "auto");
    if (o->lanes)
        ec_json_whole(settings, "lanes", o->lanes);
    else
        ec_json_text(settings, "lanes", "auto");
    ec_json_text(settings, "arithmetic", o->fast_math ? "fast" : "exact");
}

static void add_points(cJSON *to, const ec_cost_row *row)
{
    cJSON *points = cJSON_AddArrayToObject(to, "curve");
    for (uint32_t i = 0; i < row->point_count; i++) {
        const ec_cost_point *p = &row->points[i];
        cJSON *point = cJSON_CreateObject();
        ec_json_whole(point, "samples_per_pixel", p->samples);
        ec_json_whole(point, "pictures", p->batches);
        ec_json_real(point, "seconds", p->seconds);
        ec_json_real(point, "error", p->mse > 0 ? sqrt(p->mse) : NAN);
        ec_json_real(point, "error_se", p->mse > 0 ? 0.5 * p->mse_se / sqrt(p->mse) : NAN);
        ec_json_real(point, "mse", p->mse);
        ec_json_real(point, "mse_se", p->mse_se);
        ec_json_real(point, "relmse", p->relmse);
        ec_json_real(point, "relmse_se", p->relmse_se);
        cJSON_AddItemToArray(points, point);
    }
}

static void add_targets(cJSON *to, const ec_cost_row *row)
{
    cJSON *targets = cJSON_AddArrayToObject(to, "time_to");
    for (int i = 0; i < EC_COST_TARGETS; i++) {
        cJSON *target = cJSON_CreateObject();
        ec_json_real(target, "error", ec_cost_targets[i]);
        ec_json_real(target, "seconds", row->seconds_to[i]);
        cJSON_AddBoolToObject(target, "never", isinf(row->seconds_to[i]));
        cJSON_AddBoolToObject(target, "extrapolated", row->extrapolated[i]);
        cJSON_AddItemToArray(targets, target);
    }
}

static void add_errors(cJSON *to, const ec_cost_row *row)
{
    ec_json_whole(to, "unit_samples_per_pixel", row->unit);
    ec_json_real(to, "variance", row->variance);
    ec_json_real(to, "bias_squared", row->bias2);
    ec_json_real(to, "bias_squared_se", row->bias2_se);
    cJSON_AddBoolToObject(to, "unbiased_by_design", row->rung.unbiased);
    cJSON_AddBoolToObject(to, "biased", row->biased);
    cJSON_AddBoolToObject(to, "light_not_met", row->unmet);
    ec_json_real(to, "error_floor", row->biased ? sqrt(row->bias2) : NAN);
    ec_json_real(to, "slope", row->fit.slope);
    ec_json_real(to, "slope_se", row->fit.se);
    ec_json_real(to, "efficiency", row->efficiency);
    ec_json_real(to, "efficiency_relmse", row->relative_efficiency);
    add_targets(to, row);
    add_points(to, row);
}

static cJSON *rung_json(const ec_cost_study *study, const ec_cost_row *row)
{
    cJSON *to = cJSON_CreateObject();
    ec_json_text(to, "id", row->rung.id);
    ec_json_text(to, "group", row->rung.group);
    ec_json_text(to, "group_title", row->rung.title);
    ec_json_text(to, "name", row->rung.name);
    add_settings(to, &row->rung.options);
    cJSON_AddBoolToObject(to, "scene_changed", row->rung.options.without != 0);
    ec_json_text(to, "state", state_name(study, row->state));
    ec_json_text(to, "note", *row->note ? row->note : NULL);
    if (row->state != EC_COST_MEASURED) return to;
    ec_json_real(to, "setup_seconds", row->setup_seconds);
    ec_json_real(to, "seconds_per_sample", row->seconds_per_sample);
    ec_json_real(to, "relative_time", row->relative_time);
    ec_json_real(to, "relative_time_se", row->relative_time_se);
    ec_json_whole(to, "samples_per_pixel", row->samples_per_pixel);
    ec_json_whole(to, "device_bytes", row->device_bytes);
    ec_json_whole(to, "invalid_values", row->invalid);
    if (row->rung.speed_only)
        cJSON_AddBoolToObject(to, "same_bits", row->same_bits);
    else
        add_errors(to, row);
    return to;
}

static void add_reference(cJSON *to, const ec_cost_report *report)
{
    const ec_cost_reference *r = &report->study->reference;
    cJSON *reference = cJSON_AddObjectToObject(to, "reference");
    ec_json_text(reference, "file", r->source);
    ec_json_real(reference, "samples_per_pixel", r->samples_per_pixel ? (double)r->samples_per_pixel : NAN);
    ec_json_real(reference, "error", r->has_variance ? sqrt(r->noise) : NAN);
    ec_json_real(reference, "mean_luminance", r->mean_luminance);
    ec_json_real(reference, "seconds", r->seconds);
    ec_json_real(reference, "setup_seconds", r->setup_seconds);
}

static void add_pareto(cJSON *to, const ec_cost_study *study)
{
    ec_cost_place places[128];
    uint32_t count = ec_cost_pareto(study, places, 128);
    cJSON *front = cJSON_AddArrayToObject(to, "pareto_front");
    for (uint32_t i = 0; i < count; i++) {
        const ec_cost_row *row = &study->rows[places[i].row];
        const ec_cost_point *p = &row->points[places[i].point];
        cJSON *place = cJSON_CreateObject();
        ec_json_text(place, "id", row->rung.id);
        ec_json_whole(place, "samples_per_pixel", p->samples);
        ec_json_real(place, "seconds", p->seconds);
        ec_json_real(place, "error", sqrt(p->mse));
        cJSON_AddItemToArray(front, place);
    }
}

cJSON *ec_cost_json(const ec_cost_report *report)
{
    const ec_cost_study *study = report->study;
    cJSON *root = cJSON_CreateObject();
    ec_json_text(root, "version", ECLAT_VERSION);
    ec_json_text(root, "command", report->command);
    ec_json_text(root, "scene", report->scene);
    ec_json_text(root, "camera", report->camera);
    ec_json_text(root, "environment", report->environment);
    ec_json_whole(root, "width", study->options.width);
    ec_json_whole(root, "height", study->options.height);
    ec_json_whole(root, "seed", study->options.seed);
    ec_json_real(root, "budget_seconds", study->budget);
    ec_json_real(root, "total_seconds", study->seconds);
    cJSON_AddBoolToObject(root, "interrupted", study->interrupted);
    cJSON *device = ec_device_json(report->device, report->device_index);
    ec_json_text(device, "why", report->device_why);
    cJSON_AddItemToObject(root, "device", device);
    if (study->reference.mean_luminance > 0)
        add_reference(root, report);
    else
        cJSON_AddNullToObject(root, "reference");
    cJSON *rungs = cJSON_AddArrayToObject(root, "rungs");
    for (uint32_t i = 0; i < study->row_count; i++) cJSON_AddItemToArray(rungs, rung_json(study, &study->rows[i]));
    add_pareto(root, study);
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

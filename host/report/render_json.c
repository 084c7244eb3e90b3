#include <math.h>

#include "report/device_report.h"
#include "report/denoise_report.h"
#include "report/effects_report.h"
#include "report/error_text.h"
#include "report/json.h"
#include "report/names.h"
#include "report/render_report.h"
#include "report/settings.h"

/* Adds what a frame takes over from earlier ones. */
static void add_shared(cJSON *root, const ec_render_stats *stats)
{
    const ec_follow_report *f = &stats->followed;
    EC_JSON(ec_json_object(root, "shared"), EC_STRING("structures", ec_follow_names[f->what]), EC_REAL("structure_seconds", f->seconds),
            EC_REAL("refit_seconds", f->refit_seconds), EC_REAL("build_seconds", f->build_seconds), EC_REAL("expense", f->expense),
            EC_REAL("refit_expense", f->refit_expense), EC_REAL("trace_seconds", stats->trace_seconds), EC_WHOLE("meshes_kept", f->meshes_kept),
            EC_WHOLE("meshes_built", f->meshes_built), EC_WHOLE("programs_kept", stats->programs_found),
            EC_WHOLE("programs_built", stats->programs_built), EC_WHOLE("bytes_kept", stats->bytes_found),
            EC_WHOLE("bytes_uploaded", stats->bytes_uploaded));
}

static void add_option(cJSON *root, const ec_setting *setting, const ec_render_options *options)
{
    ec_setting_value value;
    ec_setting_get(setting, options, &value);
    value.field.key = setting->json;
    if (setting->json && !value.is_unsaid) ec_json_add(root, (const ec_field[]){value.field, {0}});
}

static void add_setting(cJSON *root, const ec_render_report *report)
{
    const ec_frame_facts *frame = report->frame;
    if (frame && frame->name) EC_JSON(root, EC_STRING("name", frame->name), EC_STRING("state", "rendered"));
    else if (frame) EC_JSON(root, EC_WHOLE("frame", frame->number), EC_REAL("frame_seconds", frame->seconds), EC_STRING("state", "rendered"));
    if (frame && frame->turns) EC_JSON(root, EC_REAL("frame_degrees", frame->degrees));
    if (frame) add_shared(root, report->stats);
    EC_JSON(root, EC_STRING("version", ECLAT_VERSION), EC_STRING("command", report->command), EC_STRING("scene", report->scene),
            EC_STRING("camera", report->camera), EC_STRING("environment", report->environment), EC_WHOLE("width", report->options->width),
            EC_WHOLE("height", report->options->height));
    for (int i = 0; i < ec_setting_count; i++) add_option(root, &ec_settings[i], report->options);
    EC_JSON(root, EC_REAL("exposure", report->exposure), EC_FLAG("exposure_auto", report->is_exposure_auto), EC_STRING("background", ec_background_name(&report->background).text),
            EC_STRING("tonemap", report->ocio ? NULL : ec_tonemap_names[report->tonemap]), EC_STRING("ocio", report->ocio ? report->view->config : NULL));
    if (report->has_shadow) ec_json_real(root, "shadow_stderr", report->shadow_error);
}

static void add_result(cJSON *root, const ec_render_report *report)
{
    const ec_render_stats *stats = report->stats;
    EC_JSON(root, EC_WHOLE("samples_per_pixel", stats->samples_per_pixel), EC_WHOLE("samples", stats->samples), EC_WHOLE("rays", stats->rays),
            EC_REAL("samples_per_second", stats->samples_per_second), EC_REAL("rays_per_second", stats->rays_per_second),
            EC_REAL("error", stats->film.error), EC_REAL("error_bound", stats->film.error_bound));
    ec_error_json(root, &stats->film, ec_render_report_clamp(report));
    EC_JSON(root, EC_REAL("relmse", stats->film.relmse), EC_REAL("heavy_pixels", report->replicates >= 2 ? (double)report->heavy_pixels : NAN),
            EC_REAL("mean_luminance", report->mean_luminance), EC_STRING("stopped_by", stats->stopped_by),
            EC_STRING("image_sha256", report->image_sha256), EC_WHOLE("invalid_samples", stats->invalid_samples));
    EC_JSON(ec_json_object(root, "invalid_samples_by_stage"), EC_WHOLE("generate", stats->invalid_generate),
            EC_WHOLE("intersect", stats->invalid_intersect), EC_WHOLE("shade", stats->invalid_shade), EC_WHOLE("connect", stats->invalid_connect),
            EC_WHOLE("accumulate", stats->invalid_accumulate));
}

static void add_forecast(cJSON *root, const ec_forecast *f)
{
    if (!(f->pilot_samples > 0)) {
        cJSON_AddNullToObject(root, "forecast");
        return;
    }
    EC_JSON(ec_json_object(root, "forecast"), EC_REAL("pilot_samples_per_pixel", f->pilot_samples), EC_REAL("slope", f->slope),
            EC_REAL("pilot_seconds", f->pilot_seconds), EC_REAL("samples_per_pixel", f->samples), EC_REAL("samples_per_pixel_low", f->samples_low),
            EC_REAL("samples_per_pixel_high", f->samples_high), EC_REAL("seconds", f->seconds), EC_REAL("seconds_low", f->seconds_low),
            EC_REAL("seconds_high", f->seconds_high), EC_REAL("error_bound", f->error_bound), EC_REAL("spread", f->spread));
}

/* Adds launches, if these are bounded in time. */
static void add_launches(cJSON *root, const ec_render_stats *stats)
{
    if (!stats->launches) return;
    EC_JSON(ec_json_object(root, "launches"), EC_WHOLE("count", stats->launches), EC_WHOLE("pieces", stats->pieces),
            EC_REAL("longest_seconds", stats->longest_piece > 0 ? stats->longest_piece : NAN));
}

static void add_cost(cJSON *root, const ec_render_report *report)
{
    const ec_render_stats *stats = report->stats;
    EC_JSON(root, EC_REAL("seconds", stats->seconds), EC_REAL("cpu_seconds", stats->cpu_seconds), EC_REAL("load_seconds", report->load_seconds),
            EC_REAL("accel_seconds", stats->accel_seconds), EC_REAL("pack_seconds", stats->pack_seconds),
            EC_REAL("kernel_seconds", stats->kernel_seconds), EC_REAL("guide_seconds", stats->guide_seconds), EC_REAL("first_pixel_seconds", stats->first_pixel_seconds),
            EC_STRING("first_kernels", ec_begun_names[stats->begun]),
            EC_REAL("fast_kernels_after_seconds", stats->fast_after_seconds > 0 ? stats->fast_after_seconds : NAN),
            EC_REAL("write_seconds", report->write_seconds), EC_REAL("total_seconds", report->total_seconds),
            EC_WHOLE("kernel_cache_hits", stats->cache_hits), EC_WHOLE("kernel_cache_misses", stats->cache_misses),
            EC_WHOLE("peak_memory_bytes", report->peak_memory_bytes), EC_WHOLE("device_bytes", stats->device_bytes));
}

/* Adds the share of each device, if there are several. */
static void add_shares(cJSON *root, const ec_render_report *report)
{
    const ec_render_stats *stats = report->stats;
    cJSON *list = stats->share_count ? cJSON_AddArrayToObject(root, "devices") : NULL;
    for (uint32_t i = 0; i < stats->share_count; i++) {
        const ec_render_share *share = &stats->shares[i];
        cJSON *one = ec_device_json(&report->device[i], report->device_index[i]);
        EC_JSON(one, EC_REAL("samples_per_pixel", share->samples), EC_WHOLE("lanes", share->lanes), EC_WHOLE("wave", share->wave),
                EC_WHOLE("device_bytes", share->device_bytes), EC_FLAG("failed", share->has_failed));
        cJSON_AddItemToArray(list, one);
    }
}

ec_result ec_render_report_json(const ec_render_report *report, FILE *to, ec_error *err)
{
    const ec_render_stats *stats = report->stats;
    cJSON *root = cJSON_CreateObject();
    add_setting(root, report);
    add_result(root, report);
    ec_clamp_json(root, report->options->clamp, stats->clamp_luminance, &report->clamp);
    ec_denoised_json(root, report->denoised);
    add_forecast(root, &stats->forecast);
    if (stats->far_share > 0) ec_json_real(root, "environment_share", stats->far_share);
    ec_json_real(root, "allotment_gain", stats->allotment_gain);
    add_cost(root, report);
    add_launches(root, stats);
    EC_JSON(root, EC_WHOLE("lanes", stats->lanes), EC_WHOLE("instances", stats->instances), EC_WHOLE("triangles", stats->triangles),
            EC_WHOLE("stored_triangles", stats->stored_triangles), EC_WHOLE("wave", stats->wave), EC_WHOLE("replicates", report->replicates),
            EC_WHOLE("strips", stats->strips));
    ec_effects_json(root, &stats->effects);
    cJSON *device = ec_device_json(report->device, *report->device_index);
    ec_json_text(device, "why", report->device_why);
    cJSON_AddItemToObject(root, "device", device);
    add_shares(root, report);
    EC_JSON(root, EC_WHOLE("ranks", stats->peers + 1), EC_REAL("other_ranks_samples_per_pixel", stats->peer_samples),
            EC_WHOLE("received_bytes", stats->peer_bytes));
    ec_json_texts(root, "outputs", report->outputs, (size_t)report->output_count);
    return ec_json_print(root, to, err);
}

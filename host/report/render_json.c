#include <math.h>

#include "report/device_report.h"
#include "report/effects_report.h"
#include "report/error_text.h"
#include "report/json.h"
#include "report/names.h"
#include "report/render_report.h"
#include "report/settings.h"

/* What a frame has from those before it. */
static void add_shared(cJSON *root, const ec_render_stats *stats)
{
    const ec_follow_report *f = &stats->followed;
    cJSON *shared = cJSON_AddObjectToObject(root, "shared");
    ec_json_text(shared, "structures", ec_follow_names[f->what]);
    ec_json_real(shared, "structure_seconds", f->seconds);
    ec_json_real(shared, "refit_seconds", f->refit_seconds);
    ec_json_real(shared, "build_seconds", f->build_seconds);
    ec_json_real(shared, "expense", f->expense);
    ec_json_real(shared, "refit_expense", f->refit_expense);
    ec_json_real(shared, "trace_seconds", stats->trace_seconds);
    ec_json_whole(shared, "meshes_kept", f->meshes_kept);
    ec_json_whole(shared, "meshes_built", f->meshes_built);
    ec_json_whole(shared, "programs_kept", stats->programs_found);
    ec_json_whole(shared, "programs_built", stats->programs_built);
    ec_json_whole(shared, "bytes_kept", stats->bytes_found);
    ec_json_whole(shared, "bytes_uploaded", stats->bytes_uploaded);
}

static void add_option(cJSON *root, const ec_setting *setting, const ec_render_options *options)
{
    ec_setting_value value;
    ec_setting_get(setting, options, &value);
    if (!setting->json || value.is_unsaid) return;
    switch (value.kind) {
    case EC_SETTING_TEXT: ec_json_text(root, setting->json, value.text); break;
    case EC_SETTING_WHOLE: ec_json_whole(root, setting->json, value.whole); break;
    case EC_SETTING_REAL: ec_json_real(root, setting->json, value.real); break;
    case EC_SETTING_SWITCH: cJSON_AddBoolToObject(root, setting->json, value.on); break;
    case EC_SETTING_NONE: cJSON_AddNullToObject(root, setting->json); break;
    }
}

static void add_setting(cJSON *root, const ec_render_report *report)
{
    if (report->frame) {
        ec_json_whole(root, "frame", report->frame->number);
        ec_json_real(root, "frame_seconds", report->frame->seconds);
        ec_json_text(root, "state", "rendered");
        add_shared(root, report->stats);
    }
    ec_json_text(root, "version", ECLAT_VERSION);
    ec_json_text(root, "command", report->command);
    ec_json_text(root, "scene", report->scene);
    ec_json_text(root, "camera", report->camera);
    ec_json_text(root, "environment", report->environment);
    ec_json_whole(root, "width", report->options->width);
    ec_json_whole(root, "height", report->options->height);
    for (int i = 0; i < ec_setting_count; i++) add_option(root, &ec_settings[i], report->options);
    ec_json_real(root, "exposure", report->exposure);
    ec_json_text(root, "tonemap", ec_tonemap_names[report->tonemap]);
}

static void add_result(cJSON *root, const ec_render_report *report)
{
    const ec_render_stats *stats = report->stats;
    ec_json_whole(root, "samples_per_pixel", stats->samples_per_pixel);
    ec_json_whole(root, "samples", stats->samples);
    ec_json_whole(root, "rays", stats->rays);
    ec_json_real(root, "samples_per_second", stats->samples_per_second);
    ec_json_real(root, "rays_per_second", stats->rays_per_second);
    ec_json_real(root, "error", stats->film.error);
    ec_json_real(root, "error_bound", stats->film.error_bound);
    ec_error_json(root, &stats->film);
    ec_json_real(root, "relmse", stats->film.relmse);
    ec_json_real(root, "heavy_pixels", report->replicates >= 2 ? (double)report->heavy_pixels : NAN);
    ec_json_real(root, "mean_luminance", report->mean_luminance);
    ec_json_text(root, "stopped_by", stats->stopped_by);
    ec_json_text(root, "image_sha256", report->image_sha256);
    ec_json_whole(root, "invalid_samples", stats->invalid_samples);
    cJSON *stages = cJSON_AddObjectToObject(root, "invalid_samples_by_stage");
    ec_json_whole(stages, "generate", stats->invalid_generate);
    ec_json_whole(stages, "intersect", stats->invalid_intersect);
    ec_json_whole(stages, "shade", stats->invalid_shade);
    ec_json_whole(stages, "connect", stats->invalid_connect);
    ec_json_whole(stages, "accumulate", stats->invalid_accumulate);
}

static void add_forecast(cJSON *root, const ec_forecast *f)
{
    if (!(f->pilot_samples > 0)) {
        cJSON_AddNullToObject(root, "forecast");
        return;
    }
    cJSON *forecast = cJSON_AddObjectToObject(root, "forecast");
    ec_json_real(forecast, "pilot_samples_per_pixel", f->pilot_samples);
    ec_json_real(forecast, "slope", f->slope);
    ec_json_real(forecast, "pilot_seconds", f->pilot_seconds);
    ec_json_real(forecast, "samples_per_pixel", f->samples);
    ec_json_real(forecast, "samples_per_pixel_low", f->samples_low);
    ec_json_real(forecast, "samples_per_pixel_high", f->samples_high);
    ec_json_real(forecast, "seconds", f->seconds);
    ec_json_real(forecast, "seconds_low", f->seconds_low);
    ec_json_real(forecast, "seconds_high", f->seconds_high);
    ec_json_real(forecast, "error_bound", f->error_bound);
    ec_json_real(forecast, "spread", f->spread);
}

static void add_cost(cJSON *root, const ec_render_report *report)
{
    const ec_render_stats *stats = report->stats;
    ec_json_real(root, "seconds", stats->seconds);
    ec_json_real(root, "cpu_seconds", stats->cpu_seconds);
    ec_json_real(root, "load_seconds", report->load_seconds);
    ec_json_real(root, "accel_seconds", stats->accel_seconds);
    ec_json_real(root, "pack_seconds", stats->pack_seconds);
    ec_json_real(root, "kernel_seconds", stats->kernel_seconds);
    ec_json_real(root, "first_pixel_seconds", stats->first_pixel_seconds);
    ec_json_text(root, "first_kernels", ec_begun_names[stats->begun]);
    if (stats->fast_after_seconds > 0) ec_json_real(root, "fast_kernels_after_seconds", stats->fast_after_seconds);
    else cJSON_AddNullToObject(root, "fast_kernels_after_seconds");
    ec_json_real(root, "write_seconds", report->write_seconds);
    ec_json_real(root, "total_seconds", report->total_seconds);
    ec_json_whole(root, "kernel_cache_hits", stats->cache_hits);
    ec_json_whole(root, "kernel_cache_misses", stats->cache_misses);
    ec_json_whole(root, "peak_memory_bytes", report->peak_memory_bytes);
    ec_json_whole(root, "device_bytes", stats->device_bytes);
}

/* What each of several devices has done. */
static void add_shares(cJSON *root, const ec_render_report *report)
{
    const ec_render_stats *stats = report->stats;
    cJSON *list = stats->share_count ? cJSON_AddArrayToObject(root, "devices") : NULL;
    for (uint32_t i = 0; i < stats->share_count; i++) {
        const ec_render_share *share = &stats->shares[i];
        cJSON *one = ec_device_json(&report->device[i], report->device_index[i]);
        ec_json_real(one, "samples_per_pixel", share->samples);
        ec_json_whole(one, "lanes", share->lanes);
        ec_json_whole(one, "wave", share->wave);
        ec_json_whole(one, "device_bytes", share->device_bytes);
        cJSON_AddBoolToObject(one, "failed", share->has_failed);
        cJSON_AddItemToArray(list, one);
    }
}

ec_result ec_render_report_json(const ec_render_report *report, FILE *to, ec_error *err)
{
    cJSON *root = cJSON_CreateObject();
    add_setting(root, report);
    add_result(root, report);
    ec_clamp_json(root, report->options->clamp, report->stats->clamp_luminance, &report->clamp);
    add_forecast(root, &report->stats->forecast);
    ec_json_real(root, "allotment_gain", report->stats->allotment_gain);
    add_cost(root, report);
    ec_json_whole(root, "lanes", report->stats->lanes);
    ec_json_whole(root, "instances", report->stats->instances);
    ec_json_whole(root, "triangles", report->stats->triangles);
    ec_json_whole(root, "stored_triangles", report->stats->stored_triangles);
    ec_json_whole(root, "wave", report->stats->wave);
    ec_json_whole(root, "replicates", report->replicates);
    ec_json_whole(root, "strips", report->stats->strips);
    ec_effects_json(root, &report->stats->effects);
    cJSON *device = ec_device_json(report->device, *report->device_index);
    ec_json_text(device, "why", report->device_why);
    cJSON_AddItemToObject(root, "device", device);
    add_shares(root, report);
    ec_json_whole(root, "ranks", report->stats->peers + 1);
    ec_json_real(root, "other_ranks_samples_per_pixel", report->stats->peer_samples);
    ec_json_whole(root, "received_bytes", report->stats->peer_bytes);
    ec_json_texts(root, "outputs", report->outputs, (size_t)report->output_count);
    return ec_json_print(root, to, err);
}

#include <inttypes.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "report/denoise_report.h"
#include "report/effects_report.h"
#include "report/error_text.h"
#include "report/names.h"
#include "report/render_report.h"
#include "report/settings.h"

/* In the form of --eye, --look-at, --up and --fov or --parallel. */
static void add_viewpoint(ec_report_attributes *attributes, const ec_viewpoint *v)
{
    ec_attributes_made(attributes, "eclat.camera.eye", "%.9g,%.9g,%.9g", v->eye[0], v->eye[1], v->eye[2]);
    ec_attributes_made(attributes, "eclat.camera.lookAt", "%.9g,%.9g,%.9g", v->target[0], v->target[1], v->target[2]);
    ec_attributes_made(attributes, "eclat.camera.up", "%.9g,%.9g,%.9g", v->up[0], v->up[1], v->up[2]);
    if (v->fov > 0) ec_attributes_made(attributes, "eclat.camera.fov", "%.9g", v->fov);
    else ec_attributes_made(attributes, "eclat.camera.parallel", "%.9g", v->tall);
}

/* Writes whole numbers as texts, since a seed may not fit an int. */
static void add_option(ec_report_attributes *attributes, const ec_setting *setting, const ec_render_options *options)
{
    ec_setting_value value;
    ec_setting_get(setting, options, &value);
    const ec_field *f = &value.field;
    if (!setting->exr || value.is_unsaid) return;
    if (f->kind == EC_FIELD_REAL) EC_ATTRIBUTES(attributes, EC_REAL(setting->exr, f->real));
    else if (f->kind == EC_FIELD_WHOLE) ec_attributes_made(attributes, setting->exr, "%" PRIu64, f->whole);
    else ec_attributes_made(attributes, setting->exr, "%s", f->kind == EC_FIELD_FLAG ? f->whole ? "yes" : "no" : f->text);
}

static void add_setting(ec_report_attributes *attributes, const ec_render_report *report)
{
    const ec_frame_facts *frame = report->frame;
    EC_ATTRIBUTES(attributes, EC_STRING("eclat.command", report->command), EC_STRING("eclat.version", ECLAT_VERSION),
                  EC_STRING("eclat.scene", report->scene));
    if (frame && !frame->name) EC_ATTRIBUTES(attributes, EC_WHOLE("eclat.frame", frame->number), EC_REAL("eclat.frame.seconds", frame->seconds));
    if (frame && frame->turns) EC_ATTRIBUTES(attributes, EC_REAL("eclat.frame.degrees", frame->degrees));
    if (frame) EC_ATTRIBUTES(attributes, EC_STRING("eclat.frame.job", frame->job));
    EC_ATTRIBUTES(attributes, EC_STRING("eclat.camera", report->camera));
    add_viewpoint(attributes, &report->viewpoint);
    EC_ATTRIBUTES(attributes, EC_STRING("eclat.environment", report->environment));
    for (int i = 0; i < ec_setting_count; i++) add_option(attributes, &ec_settings[i], report->options);
    ec_attributes_made(attributes, "eclat.background", "%s", ec_background_name(&report->background).text);
    EC_ATTRIBUTES(attributes, EC_REAL("eclat.png.exposure", report->exposure));
    if (report->ocio) ec_attributes_made(attributes, "eclat.png.ocio", "%s", report->view->config);
    else EC_ATTRIBUTES(attributes, EC_STRING("eclat.png.tonemap", ec_tonemap_names[report->tonemap]));
}

/* Lists lines like "sheen; in shade; texels, 4 KB". */
static void add_built(ec_report_attributes *attributes, const ec_render_effects *effects)
{
    char text[EC_EFFECT_BITS * (EC_EFFECT_MADE + 64)];
    size_t used = 0;
    text[0] = 0;
    for (uint32_t i = 0; i < ec_feature_count && used < sizeof text; i++) {
        char made[EC_EFFECT_MADE];
        ec_effect_row row = ec_effect_describe(effects, i);
        ec_effect_made(&row, made, sizeof made);
        if (row.built || row.left_out)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s%s%s", used ? "\n" : "", row.name, row.left_out ? "; left out" : "", made);
    }
    ec_attributes_made(attributes, "eclat.effects.built", "%s", text);
}

/* Lists lines like "sheen: material 1 "Velvet" has sheen". */
static void add_effects(ec_report_attributes *attributes, const ec_render_effects *effects)
{
    char text[EC_EFFECT_BITS * (EC_EFFECT_WHY + 64)];
    size_t used = 0;
    ec_feature_names(effects->built, text, sizeof text);
    ec_attributes_made(attributes, "eclat.effects", "%s", text);
    text[0] = 0;
    for (uint32_t i = 0; i < ec_feature_count; i++) {
        ec_effect_row row = ec_effect_describe(effects, i);
        if (row.called && used < sizeof text)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s: %s", used ? "\n" : "", row.name, row.why);
    }
    ec_attributes_made(attributes, "eclat.effects.why", "%s", text);
    add_built(attributes, effects);
    ec_effects_kernels(effects, text, sizeof text);
    ec_attributes_made(attributes, "eclat.kernels", "%s", text);
}

static void add_result(ec_report_attributes *attributes, const ec_render_report *report)
{
    const ec_render_stats *stats = report->stats;
    EC_ATTRIBUTES(attributes, EC_WHOLE("eclat.samplesPerPixel", stats->samples_per_pixel), EC_WHOLE("eclat.replicates", report->replicates),
                  EC_WHOLE("eclat.lanes", stats->lanes), EC_WHOLE("eclat.instances", stats->instances), EC_WHOLE("eclat.triangles", stats->triangles),
                  EC_WHOLE("eclat.storedTriangles", stats->stored_triangles), EC_WHOLE("eclat.wave", stats->wave));
    if (stats->strips > 1) EC_ATTRIBUTES(attributes, EC_WHOLE("eclat.strips", stats->strips));
    add_effects(attributes, &stats->effects);
    EC_ATTRIBUTES(attributes, EC_REAL("eclat.seconds", stats->seconds), EC_REAL("eclat.error", stats->film.error));
    if (!stats->film.is_open) EC_ATTRIBUTES(attributes, EC_REAL("eclat.errorBound", stats->film.error_bound));
    char why[EC_ERROR_TEXT];
    ec_error_why(&stats->film, why, sizeof why);
    if (*why) ec_attributes_made(attributes, "eclat.errorBoundWhy", "%s", why);
    EC_ATTRIBUTES(attributes, EC_REAL("eclat.relMSE", stats->film.relmse));
    if (report->replicates >= 2) EC_ATTRIBUTES(attributes, EC_WHOLE("eclat.heavyPixels", report->heavy_pixels));
    EC_ATTRIBUTES(attributes, EC_STRING("eclat.stoppedBy", stats->stopped_by), EC_WHOLE("eclat.invalid", stats->invalid_samples),
                  EC_WHOLE("eclat.invalid.generate", stats->invalid_generate), EC_WHOLE("eclat.invalid.intersect", stats->invalid_intersect),
                  EC_WHOLE("eclat.invalid.shade", stats->invalid_shade), EC_WHOLE("eclat.invalid.connect", stats->invalid_connect),
                  EC_WHOLE("eclat.invalid.accumulate", stats->invalid_accumulate));
}

/* Records what computed the picture, but not the name of the machine. */
static void add_machine(ec_report_attributes *attributes, const ec_device_info *device)
{
    struct utsname host;
    EC_ATTRIBUTES(attributes, EC_STRING("eclat.device", device->name), EC_STRING("eclat.device.version", device->version),
                  EC_STRING("eclat.device.driver", device->driver));
    ec_attributes_made(attributes, "eclat.device.platform", "%s, %s", device->platform_name, device->platform_version);
    if (uname(&host) == 0)
        ec_attributes_made(attributes, "eclat.host", "%s %s %s, %ld processors", host.sysname, host.release, host.machine,
                 sysconf(_SC_NPROCESSORS_ONLN));
}

/* Records shares of several devices, as mean samples per pixel: "0 NAME: 75 samples, 1 NAME: 85 samples". */
static void add_shares(ec_report_attributes *attributes, const ec_render_report *report)
{
    char text[2048] = "";
    for (uint32_t i = 0; i < report->stats->share_count; i++) {
        const ec_render_share *share = &report->stats->shares[i];
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%s%u %s: %.4g samples%s", used ? ", " : "", report->device_index[i],
                 report->device[i].name, share->samples, share->has_failed ? " (failed)" : "");
    }
    if (*text) ec_attributes_made(attributes, "eclat.devices", "%s", text);
}

/* Adds the attributes named by the Cryptomatte specification. */
static void add_mattes(ec_report_attributes *attributes, const ec_matte_names *mattes)
{
    for (uint32_t k = 0; mattes && k < EC_MATTE_KINDS; k++) {
        const char (*keys)[EC_MATTE_FIELD] = mattes->keys[k];
        if (!mattes->manifests[k]) continue;
        EC_ATTRIBUTES(attributes, EC_STRING(keys[0], ec_matte_kind_names[k]), EC_STRING(keys[1], "MurmurHash3_32"), EC_STRING(keys[2], "uint32_to_float32"),
                      EC_STRING(keys[3], mattes->manifests[k]));
    }
}

void ec_render_report_attributes(const ec_render_report *report, ec_report_attributes *attributes)
{
    attributes->count = 0;
    attributes->text_used = 0;
    add_setting(attributes, report);
    add_result(attributes, report);
    if (report->options->clamp > 0) ec_clamp_attributes(attributes, report->options->clamp, report->stats->clamp_luminance, &report->clamp);
    ec_denoised_attributes(attributes, report->denoised);
    EC_ATTRIBUTES(attributes, EC_STRING("eclat.imageSha256", report->image_sha256));
    add_machine(attributes, report->device);
    add_shares(attributes, report);
    add_mattes(attributes, report->mattes);
    if (report->stats->peers)
        ec_attributes_made(attributes, "eclat.ranks", "%u, the first of which has the devices named here",
                 report->stats->peers + 1);
}

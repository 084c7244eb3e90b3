#include <inttypes.h>
#include <stdarg.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "report/effects_report.h"
#include "report/error_text.h"
#include "report/names.h"
#include "report/render_report.h"
#include "report/settings.h"

static void add(ec_report_attributes *attributes, ec_attribute attribute)
{
    if (attributes->count < EC_REPORT_ATTRIBUTES_MAX) attributes->list[attributes->count++] = attribute;
}

static void add_text(ec_report_attributes *attributes, const char *name, const char *text)
{
    add(attributes, (ec_attribute){.name = name, .type = EC_ATTR_STRING, .string = text});
}

__attribute__((format(printf, 3, 4))) static void add_made(ec_report_attributes *attributes, const char *name,
                                                           const char *format, ...)
{
    char *text = attributes->text + attributes->text_used;
    size_t room = sizeof attributes->text - attributes->text_used;
    va_list args;
    va_start(args, format);
    int size = vsnprintf(text, room, format, args);
    va_end(args);
    if (size < 0 || (size_t)size >= room) return;
    attributes->text_used += (size_t)size + 1;
    add_text(attributes, name, text);
}

static void add_real(ec_report_attributes *attributes, const char *name, double number)
{
    add(attributes, (ec_attribute){.name = name, .type = EC_ATTR_DOUBLE, .number = number});
}

/* Counts that fit an int are ints; the few that may not are texts. */
static void add_whole(ec_report_attributes *attributes, const char *name, uint64_t number)
{
    if (number > INT32_MAX) add_made(attributes, name, "%" PRIu64, number);
    else add(attributes, (ec_attribute){.name = name, .type = EC_ATTR_INT, .number = (double)number});
}

/* As --eye, --look-at, --up and --fov or --parallel take them. */
static void add_viewpoint(ec_report_attributes *attributes, const ec_viewpoint *v)
{
    add_made(attributes, "eclat.camera.eye", "%.9g,%.9g,%.9g", v->eye[0], v->eye[1], v->eye[2]);
    add_made(attributes, "eclat.camera.lookAt", "%.9g,%.9g,%.9g", v->target[0], v->target[1], v->target[2]);
    add_made(attributes, "eclat.camera.up", "%.9g,%.9g,%.9g", v->up[0], v->up[1], v->up[2]);
    if (v->fov > 0) add_made(attributes, "eclat.camera.fov", "%.9g", v->fov);
    else add_made(attributes, "eclat.camera.parallel", "%.9g", v->tall);
}

/* Whole numbers are texts: those of a seed fit no int. */
static void add_option(ec_report_attributes *attributes, const ec_setting *setting, const ec_render_options *options)
{
    ec_setting_value value;
    ec_setting_get(setting, options, &value);
    if (!setting->exr || value.is_unsaid) return;
    if (value.kind == EC_SETTING_REAL) add_real(attributes, setting->exr, value.real);
    else if (value.kind == EC_SETTING_WHOLE) add_made(attributes, setting->exr, "%" PRIu64, value.whole);
    else if (value.kind == EC_SETTING_SWITCH) add_text(attributes, setting->exr, value.on ? "yes" : "no");
    else add_made(attributes, setting->exr, "%s", value.text);
}

static void add_setting(ec_report_attributes *attributes, const ec_render_report *report)
{
    add_text(attributes, "eclat.command", report->command);
    add_text(attributes, "eclat.version", ECLAT_VERSION);
    add_text(attributes, "eclat.scene", report->scene);
    if (report->frame) {
        add_whole(attributes, "eclat.frame", report->frame->number);
        add_real(attributes, "eclat.frame.seconds", report->frame->seconds);
        add_text(attributes, "eclat.frame.job", report->frame->job);
    }
    add_text(attributes, "eclat.camera", report->camera);
    add_viewpoint(attributes, &report->viewpoint);
    add_text(attributes, "eclat.environment", report->environment);
    for (int i = 0; i < ec_setting_count; i++) add_option(attributes, &ec_settings[i], report->options);
    add_real(attributes, "eclat.png.exposure", report->exposure);
    add_text(attributes, "eclat.png.tonemap", ec_tonemap_names[report->tonemap]);
}

/* "sheen; in shade; texels, 4 KB" in lines. */
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
    add_made(attributes, "eclat.effects.built", "%s", text);
}

/* "sheen: material 1 "Velvet" has sheen" in lines. */
static void add_effects(ec_report_attributes *attributes, const ec_render_effects *effects)
{
    char text[EC_EFFECT_BITS * (EC_EFFECT_WHY + 64)];
    size_t used = 0;
    ec_feature_names(effects->built, text, sizeof text);
    add_made(attributes, "eclat.effects", "%s", text);
    text[0] = 0;
    for (uint32_t i = 0; i < ec_feature_count; i++) {
        ec_effect_row row = ec_effect_describe(effects, i);
        if (row.called && used < sizeof text)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s: %s", used ? "\n" : "", row.name, row.why);
    }
    add_made(attributes, "eclat.effects.why", "%s", text);
    add_built(attributes, effects);
    ec_effects_kernels(effects, text, sizeof text);
    add_made(attributes, "eclat.kernels", "%s", text);
}

static void add_clamp(ec_report_attributes *attributes, const ec_render_report *report)
{
    if (!(report->options->clamp > 0)) return;
    add_real(attributes, "eclat.clamp.limit", report->options->clamp);
    add_real(attributes, "eclat.clamp.luminance", report->stats->clamp_luminance);
    add_real(attributes, "eclat.clamp.missing", report->clamp.missing);
    add_real(attributes, "eclat.clamp.missingStderr", report->clamp.missing_stderr);
    add_real(attributes, "eclat.clamp.noise", report->clamp.noise);
    add_real(attributes, "eclat.clamp.bias", report->clamp.bias);
    add_real(attributes, "eclat.clamp.error", report->clamp.error);
}

static void add_result(ec_report_attributes *attributes, const ec_render_report *report)
{
    const ec_render_stats *stats = report->stats;
    add_whole(attributes, "eclat.samplesPerPixel", stats->samples_per_pixel);
    add_whole(attributes, "eclat.replicates", report->replicates);
    add_whole(attributes, "eclat.lanes", stats->lanes);
    add_whole(attributes, "eclat.instances", stats->instances);
    add_whole(attributes, "eclat.triangles", stats->triangles);
    add_whole(attributes, "eclat.storedTriangles", stats->stored_triangles);
    add_whole(attributes, "eclat.wave", stats->wave);
    if (stats->strips > 1) add_whole(attributes, "eclat.strips", stats->strips);
    add_effects(attributes, &stats->effects);
    add_real(attributes, "eclat.seconds", stats->seconds);
    add_real(attributes, "eclat.error", stats->film.error);
    if (!stats->film.is_open) add_real(attributes, "eclat.errorBound", stats->film.error_bound);
    char why[EC_ERROR_TEXT];
    ec_error_why(&stats->film, why, sizeof why);
    if (*why) add_made(attributes, "eclat.errorBoundWhy", "%s", why);
    add_real(attributes, "eclat.relMSE", stats->film.relmse);
    if (report->replicates >= 2) add_whole(attributes, "eclat.heavyPixels", report->heavy_pixels);
    add_text(attributes, "eclat.stoppedBy", stats->stopped_by);
    add_whole(attributes, "eclat.invalid", stats->invalid_samples);
    add_whole(attributes, "eclat.invalid.generate", stats->invalid_generate);
    add_whole(attributes, "eclat.invalid.intersect", stats->invalid_intersect);
    add_whole(attributes, "eclat.invalid.shade", stats->invalid_shade);
    add_whole(attributes, "eclat.invalid.connect", stats->invalid_connect);
    add_whole(attributes, "eclat.invalid.accumulate", stats->invalid_accumulate);
}

/* What computed it; the machine's name is nobody's business. */
static void add_machine(ec_report_attributes *attributes, const ec_device_info *device)
{
    struct utsname host;
    add_text(attributes, "eclat.device", device->name);
    add_text(attributes, "eclat.device.version", device->version);
    add_text(attributes, "eclat.device.driver", device->driver);
    add_made(attributes, "eclat.device.platform", "%s, %s", device->platform_name, device->platform_version);
    if (uname(&host) == 0)
        add_made(attributes, "eclat.host", "%s %s %s, %ld processors", host.sysname, host.release, host.machine,
                 sysconf(_SC_NPROCESSORS_ONLN));
}

/* "0 NAME: 75 samples, 1 NAME: 85 samples": of several devices, a pixel in the mean. */
static void add_shares(ec_report_attributes *attributes, const ec_render_report *report)
{
    char text[2048] = "";
    for (uint32_t i = 0; i < report->stats->share_count; i++) {
        const ec_render_share *share = &report->stats->shares[i];
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%s%u %s: %.4g samples%s", used ? ", " : "", report->device_index[i],
                 report->device[i].name, share->samples, share->has_failed ? " (failed)" : "");
    }
    if (*text) add_made(attributes, "eclat.devices", "%s", text);
}

void ec_render_report_attributes(const ec_render_report *report, ec_report_attributes *attributes)
{
    attributes->count = 0;
    attributes->text_used = 0;
    add_setting(attributes, report);
    add_result(attributes, report);
    add_clamp(attributes, report);
    add_text(attributes, "eclat.imageSha256", report->image_sha256);
    add_machine(attributes, report->device);
    add_shares(attributes, report);
    if (report->stats->peers)
        add_made(attributes, "eclat.ranks", "%u, the first of which has the devices named here",
                 report->stats->peers + 1);
}

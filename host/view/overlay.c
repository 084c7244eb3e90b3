#include "view/overlay.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "pack/called_effects.h"
#include "report/format.h"
#include "report/names.h"
#include "view/block.h"
#include "view/lists.h"

static const float white[3] = {1, 1, 1}, grey[3] = {0.78f, 0.82f, 0.86f}, yellow[3] = {1, 0.85f, 0.4f}, red[3] = {1, 0.5f, 0.45f};

static void format_seconds(double seconds, char *text, size_t size)
{
    if (!isfinite(seconds)) snprintf(text, size, "?");
    else if (seconds < 120) snprintf(text, size, "%.1f s", seconds);
    else snprintf(text, size, "%d:%02d min", (int)seconds / 60, (int)seconds % 60);
}

/* "38.2 s left to 1 % error" */
static void format_prediction(const ec_view_overlay *o, char *text, size_t size)
{
    const ec_view_status *s = o->status;
    char target[96] = "", left[32];
    if (s->error_limit > 0) snprintf(target, sizeof target, "error %.3g %%", 100 * s->error_limit);
    size_t used = strlen(target);
    if (s->spp_limit > 0) snprintf(target + used, sizeof target - used, "%s%.0f spp", used ? " or " : "", s->spp_limit);
    used = strlen(target);
    if (s->time_limit > 0) snprintf(target + used, sizeof target - used, "%s%.3g s", used ? " or " : "", s->time_limit);
    format_seconds(fmax(s->forecast.seconds - s->seconds, 0), left, sizeof left);
    if (s->done) snprintf(text, size, "done by %s (M: more)", s->stopped_by);
    else if (s->forecast.pilot_samples) snprintf(text, size, "%s left to %s", left, target);
    else snprintf(text, size, "until %s", target);
}

static void format_state(const ec_view_overlay *o, char *text, size_t size)
{
    const ec_view_status *s = o->status;
    char bound[48] = "bound unknown", seconds[32], prediction[160];
    const ec_figure error = isfinite(s->error) ? ec_percent(s->error) : (ec_figure){"?"};
    if (isfinite(s->error_bound)) snprintf(bound, sizeof bound, "95 %% bound %s", ec_percent(s->error_bound).text);
    else if (isfinite(s->error)) snprintf(bound, sizeof bound, "or more: rare bright paths decide");
    format_seconds(s->seconds, seconds, sizeof seconds);
    format_prediction(o, prediction, sizeof prediction);
    if (s->pictures == 0) snprintf(text, size, "no picture yet");
    else if (s->preview)
        snprintf(text, size, "%s, preview: a sample for %ux%u pixels", ec_integrator_names[s->integrator], s->preview,
                 s->preview);
    else
        snprintf(text, size, "%s  %" PRIu64 " spp  error %s (%s)  %s  %s",
                 ec_integrator_names[s->integrator], s->samples, error.text, bound, seconds, prediction);
}

static void format_probe(const ec_view_overlay *o, char *text, size_t size)
{
    const ec_view_probe *p = &o->status->probe;
    size_t used = (size_t)snprintf(text, size, "(%u, %u)", p->x, p->y);
    if (p->has_film)
        used +=
            (size_t)snprintf(text + used, size - used, "  radiance %.4g %.4g %.4g", p->rgb[0], p->rgb[1], p->rgb[2]);
    if (p->has_error) used += (size_t)snprintf(text + used, size - used, "  +- %.2g %.2g %.2g", p->se[0], p->se[1], p->se[2]);
    if (p->has_surface)
        snprintf(text + used, size - used, "  depth %.5g m  material %lld %s", p->depth, (long long)p->material,
                 p->name);
    else snprintf(text + used, size - used, "  no surface");
}

static void format_settings(const ec_view_overlay *o, char *text, size_t size)
{
    const ec_view_wish *w = o->wish;
    char turned[48] = "", without[300] = "", camera[32] = "moved";
    if (w->env_degrees != 0) snprintf(turned, sizeof turned, "  environment %g deg", w->env_degrees);
    ec_feature_names(w->without & o->facts->optional, without, sizeof without);
    if (!w->moved) snprintf(camera, sizeof camera, "%u", w->camera);
    snprintf(text, size, "H: help  %s  camera %s  exposure %+.2f  %s%s%s%s", o->request->device.name, camera, w->exposure,
             ec_tonemap_names[w->tonemap], turned, *without ? "  without " : "", without);
}

/* Under the top of the window, and above the foot: what needs to be read now. */
static void draw_messages(const ec_view_overlay *o, const ec_view_text *text, double width, double height, double foot)
{
    const ec_view_status *s = o->status;
    char line[80];
    ec_view_block b;
    ec_block_start(&b, text, width, height - foot);
    for (int i = 0; i < EC_TROUBLE_COUNT; i++) ec_block_add(&b, s->trouble[i], 2, red);
    if (*s->loading) snprintf(line, sizeof line, "%s ...", s->loading), ec_block_add(&b, line, 2, yellow);
    if (o->message) ec_block_add(&b, s->told, 2, yellow);
    ec_block_draw(&b, 0, height, width);
}

/* At the foot; no more than half of the window. What is under the cursor comes and goes above the rest, which stays in its place.
 * Its height. */
static double draw_foot(const ec_view_overlay *o, const ec_view_text *text, double width, double height)
{
    char state[400], settings[1000], effects[1200], probe[400];
    bool selected = o->selected->node >= 0;
    ec_view_block b;
    format_state(o, state, sizeof state);
    format_settings(o, settings, sizeof settings);
    format_probe(o, probe, sizeof probe);
    snprintf(effects, sizeof effects, "effects: %s%s%s", o->status->effects, selected ? "  selected: " : "", selected ? o->selected->node_name : "");
    for (int with_probe = o->status->probe.is_inside && o->lines == EC_LINES_ALL; with_probe >= 0; with_probe--) {
        ec_block_start(&b, text, width, 0.5 * height);
        bool fits = !with_probe || ec_block_add(&b, probe, 2, grey);
        fits = ec_block_add(&b, state, 2, white) && fits;
        if (o->lines == EC_LINES_ALL) fits = ec_block_add(&b, settings, 2, grey) && ec_block_add(&b, effects, 2, grey) && fits;
        if (fits) break;
    }
    ec_block_draw(&b, 0, ec_block_height(&b), width);
    return ec_block_height(&b);
}

/* What the second picture is, in its upper right corner. */
static void draw_label(const ec_view_overlay *o, const ec_view_text *text, double width, double height)
{
    const ec_view_wish *w = o->wish;
    char line[300];
    ec_view_block b;
    switch (w->second) {
    case EC_SECOND_ERROR: snprintf(line, sizeof line, "standard error: black 0.1 %%, yellow 100 %%"); break;
    case EC_SECOND_SAMPLES: snprintf(line, sizeof line, "samples: black 0, yellow %" PRIu64, o->status->samples); break;
    case EC_SECOND_RUNG: snprintf(line, sizeof line, "%s", ec_integrator_names[w->rung]); break;
    default: snprintf(line, sizeof line, "%.*s", EC_CUT(o->request->against ? o->request->against : "", 250)); break;
    }
    ec_block_start(&b, text, 0.5 * width, height);
    ec_block_add(&b, line, 2, white);
    if (!o->has_second) ec_block_add(&b, "not there yet", 2, yellow);
    ec_block_draw(&b, width - ec_block_width(&b), height, width);
}

void ec_view_overlay_draw(const ec_view_overlay *o, const ec_view_text *text, double width, double height)
{
    if (o->help) {
        ec_view_help_draw(o->small, width, height);
        return;
    }
    double foot = o->lines != EC_LINES_NONE ? draw_foot(o, text, width, height) : 0;
    if (o->layout != EC_LAYOUT_ONE && o->lines != EC_LINES_NONE)
        draw_label(o, text, width, o->layout == EC_LAYOUT_BESIDE ? 0.75 * height : height);
    if (o->effects) ec_view_effects_draw(o->facts, o->effects_page, o->wish->without, text, width, height);
    else draw_messages(o, text, width, height, foot);
}

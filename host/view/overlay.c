#include "view/window.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "view/block.h"
#include "view/lists.h"

static const float white[3] = {1, 1, 1}, grey[3] = {0.78f, 0.82f, 0.86f}, yellow[3] = {1, 0.85f, 0.4f}, red[3] = {1, 0.5f, 0.45f};

static const char *const integrators[] = {"path", "whitted", "raster", "light"};

static const char *tonemap_name(eclat_tonemap tonemap)
{
    eclat_option option;
    for (size_t i = 0; strcmp((option = eclat_option_at("render", i)).name, "tonemap"); i++) {}
    return option.choices[tonemap];
}

/* Formats three digits. */
static void format_percent(double fraction, char *text, size_t size)
{
    int decimals = 0;
    for (double limit = 99.95; 100 * fraction < limit && decimals < 6; limit /= 10) decimals++;
    snprintf(text, size, "%.*f %%", decimals, 100 * fraction);
}

static void format_seconds(double seconds, char *text, size_t size)
{
    if (!isfinite(seconds)) snprintf(text, size, "?");
    else if (seconds < 120) snprintf(text, size, "%.1f s", seconds);
    else snprintf(text, size, "%d:%02d min", (int)seconds / 60, (int)seconds % 60);
}

/* Formats e.g. "38.2 s left to 1 % error". */
static void format_prediction(const ec_window *w, char *text, size_t size)
{
    const eclat_status *s = &w->status;
    char target[96] = "", left[32];
    if (s->error_limit > 0) snprintf(target, sizeof target, "error %.3g %%", 100 * s->error_limit);
    size_t used = strlen(target);
    if (s->spp_limit > 0) snprintf(target + used, sizeof target - used, "%s%.0f spp", used ? " or " : "", s->spp_limit);
    used = strlen(target);
    if (s->time_limit > 0) snprintf(target + used, sizeof target - used, "%s%.3g s", used ? " or " : "", s->time_limit);
    format_seconds(s->seconds_left, left, sizeof left);
    if (s->is_complete) snprintf(text, size, "done by %s (M: more)", s->stopped_by);
    else if (s->seconds_left >= 0) snprintf(text, size, "%s left to %s", left, target);
    else snprintf(text, size, "until %s", target);
}

/* Formats ", best of both 1.2 % (under 1.3 %)", or why there is none. */
static void format_best(const ec_window *w, char *text, size_t size)
{
    const eclat_status *s = &w->status;
    char error[32], bound[32];
    *text = 0;
    if (*s->undenoised) snprintf(text, size, "  not denoised: %.100s", s->undenoised);
    if (!s->is_denoised) return;
    format_percent(s->best.error, error, sizeof error);
    format_percent(s->best.high95, bound, sizeof bound);
    snprintf(text, size, isfinite(s->best.high95) ? "  best of both %s (under %s)" : "  best of both %s", error, bound);
}

static void format_state(const ec_window *w, char *text, size_t size)
{
    const eclat_status *s = &w->status;
    char error[32] = "?", bound[48] = "bound unknown", seconds[32], prediction[160], best[128];
    if (isfinite(s->error)) format_percent(s->error, error, sizeof error);
    if (isfinite(s->error_bound)) {
        char percent[32];
        format_percent(s->error_bound, percent, sizeof percent);
        snprintf(bound, sizeof bound, "95 %% bound %s", percent);
    } else if (isfinite(s->error)) {
        snprintf(bound, sizeof bound, "or more: rare bright paths decide");
    }
    format_seconds(s->seconds, seconds, sizeof seconds);
    format_prediction(w, prediction, sizeof prediction);
    format_best(w, best, sizeof best);
    if (s->pictures == 0) snprintf(text, size, "no picture yet");
    else if (s->preview)
        snprintf(text, size, "%s, preview: a sample for %ux%u pixels", integrators[s->integrator], s->preview, s->preview);
    else
        snprintf(text, size, "%s  %" PRIu64 " spp  error %s (%s)%s  %s  %s", integrators[s->integrator], s->samples, error, bound, best, seconds, prediction);
}

static void format_probe(const ec_window *w, char *text, size_t size)
{
    const eclat_probe *p = &w->status.under;
    size_t used = (size_t)snprintf(text, size, "(%u, %u)", p->x, p->y);
    if (p->has_value) used += (size_t)snprintf(text + used, size - used, "  radiance %.4g %.4g %.4g", p->rgb[0], p->rgb[1], p->rgb[2]);
    if (p->has_error) used += (size_t)snprintf(text + used, size - used, "  +- %.2g %.2g %.2g", p->se[0], p->se[1], p->se[2]);
    if (p->has_surface)
        snprintf(text + used, size - used, "  depth %.5g m  material %" PRId64 " %s", p->depth, p->material, p->material_name);
    else snprintf(text + used, size - used, "  no surface");
}

static void format_settings(const ec_window *w, char *text, size_t size)
{
    const eclat_view_request *view = &w->input.view;
    const eclat_facts *f = &w->input.facts;
    char turned[48] = "", without[300] = "", camera[32] = "moved";
    size_t used = 0;
    if (view->env_degrees != 0) snprintf(turned, sizeof turned, "  environment %g deg", view->env_degrees);
    for (uint32_t i = 0; i < f->effect_count && used < sizeof without; i++)
        if (view->without & f->effects[i].bit) used += (size_t)snprintf(without + used, sizeof without - used, " %s", f->effects[i].name);
    if (!view->is_moved) snprintf(camera, sizeof camera, "%u", view->camera < 0 ? f->camera : (uint32_t)view->camera);
    snprintf(text, size, "H: help  %s  camera %s  exposure %+.2f  %s%s%s%s", f->device, camera, view->exposure, tonemap_name(view->tonemap), turned,
             used ? "  without" : "", without);
}

/* Draws messages that need to be read now, between the top of the window and the foot. */
static void draw_messages(const ec_window *w, const ec_view_text *text, double width, double height, double foot)
{
    const eclat_status *s = &w->status;
    char line[80];
    ec_view_block b;
    ec_block_start(&b, text, width, height - foot);
    for (int i = 0; i < ECLAT_TROUBLE_COUNT; i++) ec_block_add(&b, s->trouble[i], 2, red);
    if (*s->loading) snprintf(line, sizeof line, "%s ...", s->loading), ec_block_add(&b, line, 2, yellow);
    if (w->telling) ec_block_add(&b, s->told, 2, yellow);
    ec_block_draw(&b, 0, height, width);
}

/* Draws the lines at the foot, over at most half of the window, and returns their height. The line of the pixel under the cursor comes and goes above
 * the others, which stay in their place. */
static double draw_foot(const ec_window *w, const ec_view_text *text, double width, double height)
{
    char state[512], settings[1000], effects[1200], probe[400];
    const eclat_probe *selected = &w->input.selected;
    const bool is_selected = selected->node >= 0, has_all = w->input.lines == EC_LINES_ALL;
    ec_view_block b;
    format_state(w, state, sizeof state);
    format_settings(w, settings, sizeof settings);
    format_probe(w, probe, sizeof probe);
    snprintf(effects, sizeof effects, "effects: %s%s%s", w->status.effects, is_selected ? "  selected: " : "",
             is_selected ? selected->node_name : "");
    for (int with_probe = w->status.under.is_inside && has_all; with_probe >= 0; with_probe--) {
        ec_block_start(&b, text, width, 0.5 * height);
        bool fits = !with_probe || ec_block_add(&b, probe, 2, grey);
        fits = ec_block_add(&b, state, 2, white) && fits;
        if (has_all) fits = ec_block_add(&b, settings, 2, grey) && ec_block_add(&b, effects, 2, grey) && fits;
        if (fits) break;
    }
    ec_block_draw(&b, 0, ec_block_height(&b), width);
    return ec_block_height(&b);
}

/* Draws the name of the second picture in its upper right corner. */
static void draw_label(const ec_window *w, const ec_view_text *text, double width, double height)
{
    const eclat_view_request *view = &w->input.view;
    char line[300];
    ec_view_block b;
    switch (view->second) {
    case ECLAT_SECOND_ERROR: snprintf(line, sizeof line, "standard error: black 0.1 %%, yellow 100 %%"); break;
    case ECLAT_SECOND_SAMPLES: snprintf(line, sizeof line, "samples: black 0, yellow %" PRIu64, w->status.samples); break;
    case ECLAT_SECOND_INTEGRATOR: snprintf(line, sizeof line, "%s", integrators[view->second_integrator]); break;
    default: snprintf(line, sizeof line, "%.250s", w->request->against ? w->request->against : ""); break;
    }
    ec_block_start(&b, text, 0.5 * width, height);
    ec_block_add(&b, line, 2, white);
    if (!w->has_second) ec_block_add(&b, "not there yet", 2, yellow);
    ec_block_draw(&b, width - ec_block_width(&b), height, width);
}

void ec_view_overlay_draw(const ec_window *w, double width, double height)
{
    const ec_view_input *in = &w->input;
    const ec_view_text *text = &w->text;
    if (in->help) {
        ec_view_help_draw(&w->small, width, height);
        return;
    }
    double foot = in->lines != EC_LINES_NONE ? draw_foot(w, text, width, height) : 0;
    if (in->layout != EC_LAYOUT_ONE && in->lines != EC_LINES_NONE)
        draw_label(w, text, width, in->layout == EC_LAYOUT_BESIDE ? 0.75 * height : height);
    if (in->effects) ec_view_effects_draw(&in->facts, in->effects_page, in->view.without, text, width, height);
    else draw_messages(w, text, width, height, foot);
}

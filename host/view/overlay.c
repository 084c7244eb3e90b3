#include "view/overlay.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "pack/effects.h"
#include "report/format.h"
#include "report/names.h"
#include "view/keys.h"

static const float white[3] = {1, 1, 1}, grey[3] = {0.7f, 0.75f, 0.8f}, yellow[3] = {1, 0.85f, 0.4f}, red[3] = {1, 0.5f, 0.45f};

typedef struct pen {
    const ec_view_text *text;
    double x, y, right;
} pen;

static void write_line(pen *p, const char *line, const float rgb[3])
{
    ec_view_text_draw(p->text, p->x, p->y, p->right, line, rgb);
    p->y -= p->text->line;
}

/* Long lines go on in the next; *rows: how many there are room for. */
static void write_wrapped(pen *p, const char *line, const float rgb[3])
{
    size_t columns = (size_t)fmax((p->right - p->x) / p->text->advance, 8);
    char part[512];
    if (columns >= sizeof part) columns = sizeof part - 1;
    for (const char *at = line; *at;) {
        size_t take = strnlen(at, columns);
        if (at[take])
            for (size_t k = take; k > columns / 2; k--)
                if (at[k] == ' ') {
                    take = k;
                    break;
                }
        memcpy(part, at, take);
        part[take] = 0;
        write_line(p, part, rgb);
        at += take;
        at += strspn(at, " ");
    }
}

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
    const ec_render_options *limits = &o->request->options;
    char target[96] = "", left[32];
    double factor = ldexp(1, -(int)o->wish->more);
    if (limits->error_target > 0) snprintf(target, sizeof target, "error %.3g %%", 100 * limits->error_target * factor);
    size_t used = strlen(target);
    if (limits->spp) snprintf(target + used, sizeof target - used, "%s%.0f spp", used ? " or " : "", limits->spp / factor / factor);
    used = strlen(target);
    if (limits->time_limit > 0) snprintf(target + used, sizeof target - used, "%s%.3g s", used ? " or " : "", limits->time_limit / factor / factor);
    format_seconds(fmax(s->forecast.seconds - s->seconds, 0), left, sizeof left);
    if (s->done) snprintf(text, size, "done by %s (M: more)", s->stopped_by);
    else if (s->forecast.pilot_samples) snprintf(text, size, "%s left to %s", left, target);
    else snprintf(text, size, "until %s", target);
}

static void format_state(const ec_view_overlay *o, char *text, size_t size)
{
    const ec_view_status *s = o->status;
    char error[32] = "?", bound[32] = "?", seconds[32], prediction[160];
    if (isfinite(s->error)) ec_format_percent(s->error, error, sizeof error);
    if (isfinite(s->error_bound)) ec_format_percent(s->error_bound, bound, sizeof bound);
    format_seconds(s->seconds, seconds, sizeof seconds);
    format_prediction(o, prediction, sizeof prediction);
    if (s->pictures == 0) snprintf(text, size, "no picture yet");
    else if (s->preview) snprintf(text, size, "%s, preview: a sample for %ux%u pixels", ec_integrator_names[s->integrator], s->preview, s->preview);
    else snprintf(text, size, "%s  %" PRIu64 " spp  error %s (95 %% bound %s)  %s  %s", ec_integrator_names[s->integrator], s->samples, error, bound,
                  seconds, prediction);
}

static void format_probe(const ec_view_overlay *o, char *text, size_t size)
{
    const ec_view_probe *p = &o->status->probe;
    size_t used = (size_t)snprintf(text, size, "(%u, %u)", p->x, p->y);
    if (p->has_film) used += (size_t)snprintf(text + used, size - used, "  radiance %.4g %.4g %.4g", p->rgb[0], p->rgb[1], p->rgb[2]);
    if (p->has_error) used += (size_t)snprintf(text + used, size - used, "  +- %.2g %.2g %.2g", p->se[0], p->se[1], p->se[2]);
    if (p->has_surface) snprintf(text + used, size - used, "  depth %.5g m  material %lld %s", p->depth, (long long)p->material, p->name);
    else snprintf(text + used, size - used, "  no surface");
}

static void format_settings(const ec_view_overlay *o, char *text, size_t size)
{
    static const char *const seconds[] = {"error: black 0.1 %, pale yellow 100 %", "samples", "", "--against"};
    const ec_view_wish *w = o->wish;
    char turned[48] = "", beside[96] = "", without[300] = "", camera[32] = "moved";
    if (w->env_degrees != 0) snprintf(turned, sizeof turned, "  environment %g deg", w->env_degrees);
    if (o->layout) snprintf(beside, sizeof beside, "  | %s", w->second == EC_SECOND_RUNG ? ec_integrator_names[w->rung] : seconds[w->second]);
    if (w->without) ec_feature_names(w->without, without, sizeof without);
    if (!w->moved) snprintf(camera, sizeof camera, "%u", w->camera);
    snprintf(text, size, "H: help  %s  camera %s  exposure %+.2f  %s%s%s%s%s", o->request->device.name, camera, w->exposure,
             ec_tonemap_names[w->tonemap], turned, *without ? "  without " : "", without, beside);
}

static void draw_help(const ec_view_text *text, double width, double height)
{
    double columns = 0;
    char line[160];
    for (size_t i = 0; i < ec_view_key_count; i++) columns = fmax(columns, 31 + strlen(ec_view_keys[i].help));
    pen p = {text, text->size, height - text->size, width};
    ec_view_veil(0, height - (ec_view_key_count + 2) * text->line, fmin(width, (columns + 3) * text->advance), height);
    for (size_t i = 0; i < ec_view_key_count; i++) {
        snprintf(line, sizeof line, "%-29s %s", ec_view_keys[i].shown, ec_view_keys[i].help);
        write_line(&p, line, white);
    }
}

uint64_t ec_view_effect_of_digit(const ec_view_facts *facts, int digit)
{
    for (uint32_t i = 0, n = 1; i < ec_feature_count; i++)
        if ((facts->optional & ec_features[i].bit) && (int)n++ == digit) return ec_features[i].bit;
    return 0;
}

static void draw_effects(const ec_view_overlay *o, const ec_view_text *text, double width, double height)
{
    pen p = {text, text->size, height - text->size, width};
    char line[128];
    ec_view_veil(0, height - 12 * text->line, fmin(width, 48 * text->advance), height);
    write_line(&p, "Effects: a digit switches one off or on, X closes", white);
    if (!o->facts->optional) write_line(&p, "the scene calls for none that can be left out", grey);
    for (int digit = 1; digit <= 9; digit++) {
        uint64_t bit = ec_view_effect_of_digit(o->facts, digit);
        char name[300];
        if (!bit) break;
        ec_feature_names(bit, name, sizeof name);
        snprintf(line, sizeof line, "%d  %-3s  %.100s", digit, o->wish->without & bit ? "off" : "on", name);
        write_line(&p, line, o->wish->without & bit ? grey : white);
    }
}

/* Under the top of the window: what needs to be read now. */
static void draw_messages(const ec_view_overlay *o, const ec_view_text *text, double width, double height)
{
    const ec_view_status *s = o->status;
    char line[2400];
    pen p = {text, text->size, height - text->size, width - text->size};
    size_t columns = (size_t)fmax((p.right - p.x) / text->advance, 8);
    size_t rows = (*s->failure ? strlen(s->failure) / columns + 2 : 0) + (*s->loading ? 1 : 0) + (o->message && *s->told ? strlen(s->told) / columns + 2 : 0);
    if (!rows) return;
    ec_view_veil(0, height - ((double)rows + 1) * text->line, width, height);
    if (*s->failure) write_wrapped(&p, s->failure, red);
    if (*s->loading) snprintf(line, sizeof line, "%s ...", s->loading), write_line(&p, line, yellow);
    if (o->message && *s->told) write_wrapped(&p, s->told, yellow);
}

/* At the foot; no more than a quarter of the window, the most important first. */
static void draw_foot(const ec_view_overlay *o, const ec_view_text *text, double width, double height)
{
    char line[1200];
    pen p = {text, text->size, 0, width - text->size};
    size_t columns = (size_t)fmax((p.right - p.x) / text->advance - 10, 8), effects = strlen(o->status->effects) + 40;
    double room = fmax(floor(height / text->line / 4), 1), rows = fmin(o->lines == EC_LINES_ALL ? 4 + (double)(effects / columns) : 1, room);
    p.y = (rows + 0.4) * text->line;
    ec_view_veil(0, 0, width, (rows + 0.6) * text->line);
    format_state(o, line, sizeof line);
    write_line(&p, line, white);
    if (rows < 2) return;
    format_probe(o, line, sizeof line);
    write_line(&p, line, grey);
    if (rows < 3) return;
    format_settings(o, line, sizeof line);
    write_line(&p, line, grey);
    snprintf(line, sizeof line, "effects: %s%s%s", o->status->effects, o->selected ? "  selected: " : "", o->selected ? o->selected : "");
    if (rows > 3) write_wrapped(&p, line, grey);
}

void ec_view_overlay_draw(const ec_view_overlay *o, const ec_view_text *text, double width, double height)
{
    if (o->lines != EC_LINES_NONE) draw_foot(o, text, width, height);
    if (o->help) draw_help(text, width, height);
    else if (o->effects) draw_effects(o, text, width, height);
    else draw_messages(o, text, width, height);
}

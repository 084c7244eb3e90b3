/* The error of a mix. Layers share paths, so their noise is correlated in a way that standard errors do not tell. But for any number b, the mix is b
 * times the picture plus (g - b) times each layer, and a standard error is a norm: that of the sum is at most |b| times the picture's plus |g - b|
 * times each layer's. This bound is convex and piecewise linear in b, so its minimum is at one of the gains or at 0. If all gains are 1, it is the
 * picture's own error. */
#include "jobs/mix_job.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/luminance.h"
#include "image/exr_header.h"
#include "jobs/option.h"

#define GAIN_MOST 1e6

static int compare_names(const void *a, const void *b) { return strcmp(a, b); }

/* Finds the light groups of a file. */
static ec_result find_groups(const ec_exr *exr, const char *path, ec_layers *layers, ec_error *err)
{
    for (uint32_t i = 0; i < exr->channel_count; i++) {
        const char *name = exr->names[i], *end = strrchr(name, '.');
        const size_t size = end ? (size_t)(end - name) : 0;
        if (strncmp(name, "light.", 6) || size <= 6 || strcmp(end, ".R") || (size > 7 && !strncmp(end - 7, ".stderr", 7))) continue;
        if (layers->group_count == EC_GROUPS_MOST || size - 6 >= EC_GROUP_NAME) return ec_fail(err, "'%s' has light groups that eclat render does not make", path);
        memcpy(layers->groups[layers->group_count++], name + 6, size - 6);
    }
    qsort(layers->groups, layers->group_count, EC_GROUP_NAME, compare_names);
    return EC_OK;
}

static bool is_of(const char *text, const char *name) { return !strncmp(text, name, strlen(name)) && text[strlen(name)] == '='; }

/* Chooses the layers to weight: direct and indirect light if either is named, otherwise light groups. */
static ec_result choose_layers(const ec_exr *exr, const char *path, char **gains, int count, ec_layers *layers, ec_error *err)
{
    bool halves = false;
    for (int i = 0; i < count; i++) halves |= is_of(gains[i], "direct") || is_of(gains[i], "indirect");
    *layers = (ec_layers){.count = 0};
    if (halves && (!ec_exr_plane(exr, "direct.R") || !ec_exr_plane(exr, "indirect.R")))
        return ec_fail(err, "'%s' has no direct and indirect light; render it with --channels default,direct,indirect", path);
    if (halves) layers->kinds = 1u << EC_LAYER_DIRECT | 1u << EC_LAYER_INDIRECT;
    else EC_TRY(find_groups(exr, path, layers, err));
    layers->count = (uint32_t)__builtin_popcount(layers->kinds) + layers->group_count;
    return layers->count ? EC_OK : ec_fail(err, "'%s' has no light groups; render it with --light-groups", path);
}

static const char *name_of(const ec_layers *layers, uint32_t k)
{
    return layers->kinds ? k ? "indirect" : "direct" : layers->groups[k];
}

/* Parses GAIN or R,G,B. */
static ec_result read_gain(const char *text, const char *value, double gain[3], ec_error *err)
{
    int c = 0;
    for (char *end; c < 3 && !strpbrk(value, "xX"); value = end + 1) {
        gain[c] = strtod(value, &end);
        if (end == value || !(gain[c] >= 0 && gain[c] <= GAIN_MOST)) break;
        c++;
        if (*end != ',') {
            if (*end) c = 0;
            break;
        }
    }
    if (c == 1) gain[1] = gain[2] = gain[0];
    return c == 1 || c == 3 ? EC_OK : ec_usage(err, "'%.200s': a gain is a number from 0 to %g, or three separated by commas, as in lamp=0.5 or lamp=1,0.8,0.6", text, GAIN_MOST);
}

static ec_result read_gains(const ec_layers *layers, char **gains, int count, ec_mix *mix, ec_error *err)
{
    char all[1400] = "";
    for (uint32_t k = 0; k < layers->count; k++) {
        mix->gains[k][0] = mix->gains[k][1] = mix->gains[k][2] = 1;
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s", k ? ", " : "", name_of(layers, k));
    }
    for (int i = 0; i < count; i++) {
        uint32_t k = 0;
        while (k < layers->count && !is_of(gains[i], name_of(layers, k))) k++;
        if (k == layers->count) return ec_usage(err, "'%.200s' names no layer of the picture; give NAME=GAIN, where NAME is one of %s", gains[i], all);
        for (int before = 0; before < i; before++)
            if (is_of(gains[before], name_of(layers, k))) return ec_usage(err, "'%.200s' and '%.200s': give one gain for each layer", gains[before], gains[i]);
        EC_TRY(read_gain(gains[i], gains[i] + strlen(name_of(layers, k)) + 1, mix->gains[k], err));
    }
    return EC_OK;
}

static ec_result take_plane(const ec_exr *exr, const char *path, const char *name, float *to, uint32_t stride, ec_error *err)
{
    const float *from = ec_exr_plane(exr, name);
    const uint64_t pixels = (uint64_t)exr->width * exr->height;
    if (!from) return ec_fail(err, "'%s' has no channel %s", path, name);
    for (uint64_t i = 0; i < pixels; i++) to[stride * i] = from[i];
    return EC_OK;
}

/* Reads values and errors of the picture and its layers; a file without standard errors has neither's. */
static ec_result take_picture(const ec_exr *exr, const char *path, ec_picture *p, ec_error *err)
{
    ec_channel_list channels;
    ec_picture_channels(p, &channels);
    for (uint32_t i = 0; i < channels.count; i++) {
        const ec_channel *c = &channels.list[i];
        const bool may_lack = channels.rows[i]->plane == EC_PLANE_SAMPLES || channels.rows[i]->plane == EC_PLANE_FEATURES;
        if (!may_lack || ec_exr_plane(exr, c->name)) EC_TRY(take_plane(exr, path, c->name, (float *)c->data, c->stride, err));
    }
    return EC_OK;
}

/* Returns the bound above for one b and channel c; c = 3 is luminance. */
static double bound_with(const ec_mix *mix, const float *layers, double whole, int c, double b)
{
    double sum = fabs(b) * whole;
    for (uint32_t k = 0; k < mix->picture.layers.count; k++) {
        const double *gain = mix->gains[k];
        const float *error = layers + EC_LAYER_PLANES * k + 3;
        const bool is_grey = gain[0] == gain[1] && gain[1] == gain[2];
        double part[3];
        for (int i = 0; i < 3; i++) part[i] = fabs(gain[i] - b) * (double)error[i];
        sum += c < 3 ? part[c] : is_grey ? fabs(gain[0] - b) * (double)error[3] : ec_luminance(part);
    }
    return sum;
}

/* Returns the least bound. If all gains are equal, b is that gain, so that rounding of the file's errors cannot make it smaller. */
static float bound(const ec_mix *mix, const float *layers, double whole, int c)
{
    double least = mix->is_even ? INFINITY : bound_with(mix, layers, whole, c, 0);
    for (uint32_t k = 0; k < mix->picture.layers.count; k++)
        for (int i = 0; i < 3; i++) least = fmin(least, bound_with(mix, layers, whole, c, mix->gains[k][i]));
    return (float)least;
}

static void weigh_pixel(const ec_mix *mix, uint64_t i)
{
    const ec_picture *p = &mix->picture;
    float *layers = p->layer_values + EC_LAYER_PLANES * p->layers.count * i, *rgb = p->rgb + 3 * i;
    for (int c = 0; c < 3 && p->stderr_rgb; c++) p->stderr_rgb[3 * i + (uint64_t)c] = bound(mix, layers, p->stderr_rgb[3 * i + (uint64_t)c], c);
    if (p->stderr_y) p->stderr_y[i] = bound(mix, layers, p->stderr_y[i], 3);
    for (uint32_t k = 0; k < p->layers.count; k++) {
        float *own = layers + EC_LAYER_PLANES * k;
        own[6] = (float)(fmax(mix->gains[k][0], fmax(mix->gains[k][1], mix->gains[k][2])) * own[6]);
        for (int c = 0; c < 3; c++) {
            own[c] = (float)(mix->gains[k][c] * own[c]);
            own[3 + c] = (float)(mix->gains[k][c] * own[3 + c]);
            rgb[c] = k ? rgb[c] + own[c] : own[c];
        }
    }
}

static void weigh(ec_mix *mix)
{
    const ec_picture *p = &mix->picture;
    const uint64_t pixels = (uint64_t)p->width * p->height;
    double luminance = 0, square = 0;
    mix->is_even = true;
    for (uint32_t k = 0; k < p->layers.count; k++)
        for (int c = 0; c < 3; c++) mix->is_even &= mix->gains[k][c] == mix->gains[0][0];
    for (uint64_t i = 0; i < pixels; i++) {
        weigh_pixel(mix, i);
        luminance += ec_luminance_of_floats(p->rgb + 3 * i) / (double)pixels;
        if (p->stderr_y) square += (double)p->stderr_y[i] * p->stderr_y[i] / (double)pixels;
    }
    mix->mean_luminance = luminance;
    mix->error = p->stderr_y && luminance > 0 ? sqrt(square) / luminance : INFINITY;
    ec_hash_rgb(p->rgb, pixels, mix->sha256);
}

static ec_result mix_file(const ec_exr *exr, const char *path, char **gains, int count, ec_mix *mix, ec_error *err)
{
    ec_layers layers;
    ec_picture *p = &mix->picture;
    EC_TRY(choose_layers(exr, path, gains, count, &layers, err));
    EC_TRY(read_gains(&layers, gains, count, mix, err));
    const bool with_error = ec_exr_plane(exr, "stderr.Y") != NULL && ec_exr_number(path, "eclat.replicates", &mix->replicates) && mix->replicates >= 2;
    const ec_film like = {.width = exr->width, .height = exr->height, .layers = layers};
    EC_TRY(ec_picture_create(p, &like, exr->height, with_error, false, false, err));
    const uint64_t pixels = (uint64_t)exr->width * exr->height;
    for (uint64_t i = 0; i < pixels; i++) p->constants[2 * i] = 0, p->constants[2 * i + 1] = 1;
    if (with_error) memset(p->heavy, 0, pixels * sizeof *p->heavy);
    else memset(p->layer_values, 0, pixels * EC_LAYER_PLANES * layers.count * sizeof(float));
    EC_TRY(take_picture(exr, path, p, err));
    weigh(mix);
    return EC_OK;
}

ec_result ec_mix_make(const char *path, char **gains, int count, const char *command, ec_mix *mix, ec_error *err)
{
    ec_exr exr;
    *mix = (ec_mix){.command = command};
    EC_TRY(ec_exr_read(path, &exr, err));
    ec_result result = mix_file(&exr, path, gains, count, mix, err);
    ec_exr_free(&exr);
    return result;
}

void ec_mix_attributes(const ec_mix *mix, ec_report_attributes *attributes)
{
    attributes->count = 0;
    attributes->text_used = 0;
    EC_ATTRIBUTES(attributes, EC_STRING("eclat.command", mix->command), EC_STRING("eclat.version", ECLAT_VERSION), EC_STRING("eclat.imageSha256", mix->sha256));
    if (isfinite(mix->error))
        EC_ATTRIBUTES(attributes, EC_WHOLE("eclat.replicates", (uint64_t)mix->replicates), EC_REAL("eclat.error", mix->error), EC_STRING("eclat.errorBoundWhy", EC_MIX_WHY));
}

ec_result ec_mix_write(const ec_mix *mix, ec_outputs *outputs, double exposure, ec_tonemap tonemap, ec_error *err)
{
    ec_report_attributes attributes;
    ec_mix_attributes(mix, &attributes);
    const ec_picture_style style = {.screen = {.exposure = (float)exposure, .tonemap = tonemap}, .attributes = attributes.list, .attribute_count = attributes.count};
    return ec_outputs_write(outputs, &mix->picture, &style, err);
}

void ec_mix_free(ec_mix *mix) { ec_picture_free(&mix->picture); }

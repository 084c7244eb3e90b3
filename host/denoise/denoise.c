#include "denoise/denoise.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "denoise/atrous.h"
#include "denoise/clean.h"
#include "denoise/oidn.h"
#include "denoise/oidn_find.h"
#include "film/pixel.h"
#include "film/threads.h"

enum { SCALE_MOST = 120 }; /* as a power of two, in floats */
enum { CLEAN_GUIDES = 64 }; /* samples a pixel from which on features are better than smoothed ones */

/* How much effort filters take: the larger a picture, the quicker its filter; whichever it is, the picture is judged. Smoothing the guides takes
 * longer than FAST, for 1 % of the error at most. */
static const struct effort {
    uint64_t pixels; /* at most */
    ec_oidn_quality quality;
    bool smooths;
} efforts[] = {{1 << 18, EC_OIDN_HIGH, true}, {1 << 20, EC_OIDN_BALANCED, false}, {UINT64_MAX, EC_OIDN_FAST, false}};

typedef struct work {
    const ec_film *film;
    float *half[2], *albedo, *normal; /* 3 a pixel; owned */
    float scale;                      /* gives what is filtered a mean near 1 */
    ec_film_clean clean;              /* owned until it is the film's */
} work;

static uint64_t pixels_of(const work *w) { return (uint64_t)w->film->width * w->film->height; }

/* Opens the library; *oidn stays NULL if eclat's own filter takes its place. */
static ec_result open_oidn(ec_denoiser asked, ec_oidn **oidn, ec_error *err)
{
    const bool is_named = asked == EC_DENOISER_OIDN || ec_oidn_is_named();
    *oidn = NULL;
    if (asked == EC_DENOISER_ATROUS) return EC_OK;
    return ec_oidn_open(oidn, is_named ? err : NULL) == EC_OK || !is_named ? EC_OK : EC_FAILED;
}

ec_result ec_denoiser_find(ec_denoiser asked, ec_denoiser *found, ec_error *err)
{
    ec_oidn *oidn;
    EC_TRY(open_oidn(asked, &oidn, err));
    *found = oidn ? EC_DENOISER_OIDN : EC_DENOISER_ATROUS;
    ec_oidn_close(oidn);
    return EC_OK;
}

static const char *why_not(const ec_film *film, const ec_film_error *noisy)
{
    if (ec_film_replicates(film) < EC_JUDGE_REPLICATES) return "it needs 4 samples a pixel, and --replicates 4 or more, so that one half can judge the other";
    if (!(ec_film_feature_samples(film) > 0)) return "a denoiser needs first hits, which only the slice that begins with sample 0 has, and that slice is missing";
    if (!(noisy->mean_luminance > 0)) return "the picture is black";
    return NULL;
}

static ec_result make_room(work *w, ec_error *err)
{
    float **const planes[] = {&w->half[0], &w->half[1], &w->albedo, &w->normal, &w->clean.denoised, &w->clean.best, &w->clean.error};
    for (size_t i = 0; i < sizeof planes / sizeof *planes; i++) {
        *planes[i] = malloc(pixels_of(w) * (planes[i] == &w->clean.error ? 1 : 3) * sizeof(float));
        if (!*planes[i]) return ec_fail(err, "out of memory for denoising %u x %u pixels; leave --denoise out, or give a smaller --size", w->film->width, w->film->height);
    }
    return EC_OK;
}

static void free_all(work *w)
{
    free(w->half[0]);
    free(w->half[1]);
    free(w->albedo);
    free(w->normal);
    free(w->clean.denoised);
    free(w->clean.best);
    free(w->clean.error);
}

static void take_guides(work *w, uint32_t half)
{
#pragma omp parallel for if (ec_film_is_many(pixels_of(w)))
    for (uint64_t first = 0; first < pixels_of(w); first += EC_PIXELS) {
        float features[EC_FILM_FEATURES * EC_PIXELS];
        const uint64_t count = pixels_of(w) - first < EC_PIXELS ? pixels_of(w) - first : EC_PIXELS;
        ec_film_features_of(w->film, half, first, count, features);
        for (uint64_t i = 0; i < 3 * count; i++) {
            const float *from = features + EC_FILM_FEATURES * (i / 3) + i % 3;
            w->albedo[3 * first + i] = from[0];
            w->normal[3 * first + i] = from[3];
        }
    }
}

/* `color` filters half[0] in place. `albedo` and `normal` smooth the guides, each alone; they are NULL where guides are used as they are. */
typedef struct filters {
    ec_oidn_filter *color, *albedo, *normal;
} filters;

static ec_result make_filters(work *w, ec_oidn *oidn, filters *f, ec_error *err)
{
    const ec_film *film = w->film;
    const struct effort *effort = efforts;
    while (pixels_of(w) > effort->pixels) effort++;
    const bool is_smoothed = effort->smooths && ec_film_feature_samples(film) < CLEAN_GUIDES;
    const ec_oidn_image none = {.width = film->width, .height = film->height, .has_clean_guides = true, .quality = effort->quality};
    ec_oidn_image color = none, albedo = none, normal = none;
    color.color = w->half[0], color.albedo = albedo.albedo = w->albedo, color.normal = normal.normal = w->normal;
    if (is_smoothed) EC_TRY(ec_oidn_filter_create(oidn, &albedo, &f->albedo, err));
    if (is_smoothed) EC_TRY(ec_oidn_filter_create(oidn, &normal, &f->normal, err));
    return ec_oidn_filter_create(oidn, &color, &f->color, err);
}

/* Filters a half, and leaves the result in half[0]. A half has guides of its own: they have to be as independent of the other half, by which it is
 * judged, as its colours. */
static ec_result filter_half(work *w, ec_oidn *oidn, const filters *f, uint32_t half, bool wants_guides, ec_error *err)
{
    if (wants_guides) {
        take_guides(w, half);
        if (f->albedo) EC_TRY(ec_oidn_filter_run(oidn, f->albedo, err));
        if (f->normal) EC_TRY(ec_oidn_filter_run(oidn, f->normal, err));
    }
    ec_half(w->film, half, w->scale, 3, w->half[0]);
    return ec_oidn_filter_run(oidn, f->color, err);
}

static ec_result filter_by_oidn(work *w, ec_oidn *oidn, ec_error *err)
{
    filters f = {0};
    ec_result result = make_filters(w, oidn, &f, err);
    if (result == EC_OK) result = filter_half(w, oidn, &f, 1, true, err);
    if (result == EC_OK) memcpy(w->half[1], w->half[0], 3 * pixels_of(w) * sizeof(float));
    if (result == EC_OK) result = filter_half(w, oidn, &f, 0, w->film->feature_sets == 2, err);
    ec_oidn_filter_free(oidn, f.color);
    ec_oidn_filter_free(oidn, f.albedo);
    ec_oidn_filter_free(oidn, f.normal);
    return result;
}

static ec_result filter(work *w, ec_denoiser denoiser, const ec_device_info *device, ec_denoised *out, ec_error *err)
{
    ec_oidn *oidn;
    EC_TRY(open_oidn(denoiser, &oidn, err));
    if (!oidn) {
        snprintf(out->library, sizeof out->library, "a-trous filter");
        return ec_atrous(device, w->film, w->scale, w->half, err);
    }
    snprintf(out->library, sizeof out->library, "Open Image Denoise %s", ec_oidn_version(oidn));
    const ec_result result = filter_by_oidn(w, oidn, err);
    ec_oidn_close(oidn);
    return result;
}

/* Takes the scale off. It is a power of two, so that no bits change. */
static void unscale(work *w)
{
#pragma omp parallel for if (ec_film_is_many(pixels_of(w)))
    for (uint64_t i = 0; i < 3 * pixels_of(w); i++) w->half[0][i] /= w->scale, w->half[1][i] /= w->scale;
}

ec_result ec_denoise(ec_film *film, ec_denoiser denoiser, const ec_device_info *device, ec_denoised *out, ec_error *err)
{
    const double start = ec_now();
    const ec_film_error noisy = ec_film_estimate_error(film);
    work w = {.film = film};
    ec_film_set_clean(film, (ec_film_clean){0});
    *out = (ec_denoised){.why_not = why_not(film, &noisy)};
    if (out->why_not) return EC_OK;
    w.scale = (float)exp2(fmin(fmax(-round(log2(noisy.mean_luminance)), -SCALE_MOST), SCALE_MOST));
    ec_result result = make_room(&w, err);
    if (result == EC_OK) result = filter(&w, denoiser, device, out, err);
    if (result == EC_OK) unscale(&w);
    if (result == EC_OK) result = ec_clean_make(film, (const float *const *)w.half, &noisy, &w.clean, out, err);
    if (result == EC_OK) {
        ec_film_set_clean(film, w.clean);
        w.clean = (ec_film_clean){0};
    }
    free_all(&w);
    out->seconds = ec_now() - start;
    return result;
}

#include "denoise/denoise.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "denoise/atrous.h"
#include "denoise/clean.h"
#include "denoise/oidn.h"
#include "denoise/oidn_find.h"
#include "film/pixel.h"

enum { SCALE_MOST = 120 }; /* as a power of two, in floats */
enum { CLEAN_GUIDES = 64 }; /* samples a pixel of the features from which on they are better than smoothed ones */

/* The larger a picture, the quicker its filter; whichever it is, the picture is judged. Smoothing the guides takes longer than FAST, for 1 % of the
 * error at most. */
static const struct effort {
    uint64_t pixels; /* at most */
    ec_oidn_quality quality;
    bool smooths;
} efforts[] = {{1 << 18, EC_OIDN_HIGH, true}, {1 << 20, EC_OIDN_BALANCED, false}, {UINT64_MAX, EC_OIDN_FAST, false}};

typedef struct work {
    const ec_film *film;
    float *half[2], *albedo, *normal; /* 3 a pixel; owned */
    float scale;                      /* what the filter is given has a mean near 1 */
    ec_film_clean clean;              /* owned until it is the film's */
} work;

static uint64_t pixels_of(const work *w) { return (uint64_t)w->film->width * w->film->height; }

/* The library, or NULL where the filter of eclat's own takes its place. */
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
    if (ec_film_replicates(film) < EC_JUDGE_REPLICATES) return "it takes 4 samples a pixel, and --replicates 4 or more, of which one half judges the other";
    if (!film->aov) return "first hits, by which a denoiser goes, are of the slice that begins with sample 0, which is not here";
    if (!(noisy->mean_luminance > 0)) return "the picture is black";
    return NULL;
}

static ec_result make_room(work *w, ec_error *err)
{
    float **const planes[] = {&w->half[0], &w->half[1], &w->albedo, &w->normal, &w->clean.denoised, &w->clean.best, &w->clean.error};
    for (size_t i = 0; i < sizeof planes / sizeof *planes; i++) {
        *planes[i] = malloc(pixels_of(w) * (planes[i] == &w->clean.error ? 1 : 3) * sizeof(float));
        if (!*planes[i]) return ec_fail(err, "out of memory for denoising %u x %u pixels; leave --denoise out or render fewer", w->film->width, w->film->height);
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
    float features[EC_FILM_FEATURES * EC_PIXELS];
    for (uint64_t first = 0; first < pixels_of(w); first += EC_PIXELS) {
        const uint64_t count = pixels_of(w) - first < EC_PIXELS ? pixels_of(w) - first : EC_PIXELS;
        ec_film_features_of(w->film, half, first, count, features);
        for (uint64_t i = 0; i < 3 * count; i++) {
            const float *from = features + EC_FILM_FEATURES * (i / 3) + i % 3;
            w->albedo[3 * first + i] = from[0];
            w->normal[3 * first + i] = from[3];
        }
    }
}

/* Each by itself. */
static ec_result smooth_guides(work *w, ec_oidn *oidn, ec_oidn_image image, ec_error *err)
{
    image.color = image.normal = NULL, image.albedo = w->albedo;
    EC_TRY(ec_oidn_filter(oidn, &image, err));
    image.albedo = NULL, image.normal = w->normal;
    return ec_oidn_filter(oidn, &image, err);
}

/* Each half by its own guides: they have to be as independent of the other half, by which it is judged, as its colours are. */
static ec_result filter_by_oidn(work *w, ec_oidn *oidn, ec_error *err)
{
    const ec_film *film = w->film;
    const struct effort *effort = efforts;
    while (pixels_of(w) > effort->pixels) effort++;
    const bool is_smoothed = effort->smooths && ec_schedule_samples(film->replicates, film->aov_batches) < CLEAN_GUIDES;
    ec_oidn_image image = {.width = film->width, .height = film->height, .has_clean_guides = true, .quality = effort->quality};
    for (uint32_t h = 0; h < 2; h++) {
        if (h == 0 || film->aov_even) {
            take_guides(w, h);
            if (is_smoothed) EC_TRY(smooth_guides(w, oidn, image, err));
        }
        ec_half(film, h, w->scale, 3, w->half[h]);
        image.color = w->half[h], image.albedo = w->albedo, image.normal = w->normal;
        EC_TRY(ec_oidn_filter(oidn, &image, err));
    }
    return EC_OK;
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

/* The scale is a power of two: it changes no bits. */
static void unscale(work *w)
{
    for (uint32_t h = 0; h < 2; h++)
        for (uint64_t i = 0; i < 3 * pixels_of(w); i++) w->half[h][i] /= w->scale;
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

/* tier: quick */
/* A render that is stopped within its first batch ends after the wave that is under way. Pixels reached so far have the bits of the whole
 * render, first-hit features too; the rest is marked and black. */
#include "support/render_case.h"

enum { W = 203, H = 117, PIXELS = W * H }; /* narrow and low tiles at the edges; waves end within rows of tiles */

static bool is_same(const float *a, const float *b, uint32_t count) { return !memcmp(a, b, count * sizeof *a); }

static bool is_black(const float *values, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (values[i] != 0.0f) return false;
    return true;
}

static void check_pixels(const case_image *some, const case_image *all)
{
    uint32_t reached = 0, alike = 0, dark = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const float *rgb = some->rgb + 3 * i, *features = ec_film_features_at(&some->film, i);
        const bool has_sample = !some->film.unsampled[i];
        reached += has_sample;
        alike += has_sample && is_same(rgb, all->rgb + 3 * i, 3) && is_same(features, ec_film_features_at(&all->film, i), EC_FILM_FEATURES);
        dark += !has_sample && is_black(rgb, 3) && is_black(features, EC_FILM_FEATURES);
    }
    CHECK_MSG(alike == reached && dark == PIXELS - reached, "%u pixels reached, of which %u alike; of the others %u black", reached, alike, dark);
    CHECK_MSG(reached == some->stats.samples && reached > 0 && reached < PIXELS, "%u pixels reached, %llu samples", reached,
              (unsigned long long)some->stats.samples);
}

/* If the wave allows it, all pixels are in flight at once, and there is nothing to stop. */
static void after_a_wave(const ec_scene *scene, uint32_t wave, uint32_t spp)
{
    ec_render_options o = case_options(W, H, 1);
    o.wave = wave;
    case_image all = case_render(scene, &o);
    o.spp = spp;
    o.time_limit = 1e-9;
    case_image some = case_render(scene, &o);
    CHECK(!all.film.unsampled && some.film.unsampled && some.film.batch_count == 1);
    CHECK_MSG(!strcmp(some.stats.stopped_by, "time"), "stopped by %s", some.stats.stopped_by);
    CHECK_MSG(some.stats.samples <= some.stats.wave, "%llu samples after the stop, in waves of %u", (unsigned long long)some.stats.samples, some.stats.wave);
    CHECK(isinf(some.stats.film.error) && isinf(some.stats.film.error_bound)); /* one replicate gives no error */
    if (some.film.unsampled) check_pixels(&some, &all);
    case_free(&some);
    case_free(&all);
}

int main(void)
{
    ec_scene *scene = case_load(OWN_SCENE("cornell-box/cornell-box.gltf"), NULL);
    after_a_wave(scene, 2048, 1);
    after_a_wave(scene, 5000, 9);
    after_a_wave(scene, 16384, 64);
    ec_scene_free(scene);
    TEST_END();
}

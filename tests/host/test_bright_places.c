/* tier: quick */
/* Bounds of pictures whose noise is in a few places, most of which a render may miss. Films of synthetic pixels with known means are filled
 * over and over; the real error must be below the bound in 95 of 100. See host/film/image_error.c.
 *
 *   rims    60 pixels contain a bright rim that one sample in 16 meets, of Pareto-distributed sizes: a third of renders miss the largest.
 *   mirror  one pixel sees a lamp's edge. Its samples are so regular that its replicates often agree, and are all wrong. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "film/pixel.h"
#include "support/test.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE, REPLICATES = 8, REPEATS = 400 };

typedef struct place {
    double value; /* of a sample that meets the rim */
    double chance;
} place;

static uint64_t state;

/* Nearly normal: the sum of twelve numbers. */
static double normal(void)
{
    double sum = -6;
    for (int i = 0; i < 12; i++) sum += ec_random_unit(&state);
    return sum;
}

/* A batch with so many samples of one value, and so many of another. */
static void set_batch(double value, uint32_t count, double bright, uint32_t bright_count, float *batch)
{
    const double most = bright_count ? bright : value, least = bright_count ? value / bright : 1, samples = count + bright_count;
    for (int c = 0; c < 3; c++) batch[c] = (float)((value * count + bright * bright_count) / samples);
    batch[EC_BATCH_LARGEST] = (float)most;
    batch[EC_BATCH_SQUARES] = (float)(count * least * least + bright_count);
    batch[EC_BATCH_FOURTHS] = (float)(count * pow(least, 4) + bright_count);
}

/* Pixel p of 60: its rim. */
static place rim_of(uint32_t p) { return p < 60 ? (place){6 * pow(60 / (p + 0.5), 0.7), 1.0 / 16} : (place){0, 0}; }

static double true_rim(uint32_t p) { return 1 + rim_of(p).value * rim_of(p).chance; }

static void draw_rims(uint32_t p, uint32_t samples, float *batch)
{
    const place rim = rim_of(p);
    uint32_t hits = 0;
    for (uint32_t s = 0; s < samples; s++) hits += ec_random_unit(&state) < rim.chance;
    const double even = 1 + 0.1 * normal();
    set_batch(even, samples - hits, even + rim.value, hits, batch);
}

enum { LAMP = 9 };
static double true_mirror(uint32_t p) { return p == 5 ? LAMP * 6 / 32.0 : 0.04; }

/* 4 to 8 of 32 samples meet the lamp; independent ones would give 2 to 11. */
static void draw_mirror(uint32_t p, uint32_t samples, float *batch)
{
    static const double below[] = {0.06, 0.30, 0.70, 0.94, 1};
    const double u = ec_random_unit(&state), even = 0.04 + 0.012 * normal();
    uint32_t hits = 4;
    while (u > below[hits - 4]) hits++;
    if (p == 5) set_batch(0, samples - hits, LAMP, hits, batch);
    else set_batch(0.5 * even, samples / 2, 1.5 * even, samples / 2, batch);
}

typedef struct picture {
    const char *name;
    uint32_t samples; /* a pixel */
    void (*draw)(uint32_t pixel, uint32_t samples, float *batch);
    double (*truth)(uint32_t pixel);
} picture;

static ec_film render(const picture *of)
{
    static float batch[PIXELS * EC_BATCH_FIELDS];
    ec_error err = {0};
    ec_film film;
    uint32_t before;
    ec_film_part part = {.count = ec_schedule_find(REPLICATES, of->samples, &before)};
    CHECK_OK(ec_film_create(&film, SIDE, SIDE, REPLICATES, &err), err);
    if (before || !ec_sums_create(&part.sums, REPLICATES, 0, PIXELS)) exit(1);
    for (uint32_t r = 0; r < REPLICATES; r++) {
        memset(batch, 0, sizeof batch);
        for (uint32_t p = 0; p < PIXELS; p++) of->draw(p, of->samples / REPLICATES, batch + EC_BATCH_FIELDS * p);
        ec_sums_add(&part.sums, batch, r, 1, PIXELS);
    }
    CHECK_OK(ec_film_insert(&film, &part, &err), err);
    return film;
}

static double true_error(const ec_film *film, const picture *of)
{
    double squares = 0, mean = 0;
    ec_pixel pixels[PIXELS];
    ec_film_look(film, 0, PIXELS, pixels);
    for (uint32_t p = 0; p < PIXELS; p++) {
        const double off = ec_luminance(pixels[p].mean) - of->truth(p);
        squares += off * off / PIXELS;
        mean += of->truth(p) / PIXELS;
    }
    return sqrt(squares) / mean;
}

static void check(const picture *of)
{
    int held = 0;
    double wide = 0;
    state = 1;
    for (int i = 0; i < REPEATS; i++) {
        ec_film film = render(of);
        const ec_film_error e = ec_film_estimate_error(&film);
        const double error = true_error(&film, of);
        held += error <= e.error_bound;
        wide += e.error_bound / e.error / REPEATS;
        ec_film_destroy(&film);
    }
    printf("%s: bounds held in %d of %d renders, on average %.2f times the error\n", of->name, held, REPEATS, wide);
    CHECK_MSG(held >= 0.95 * REPEATS, "%s: %d of %d", of->name, held, REPEATS);
    CHECK_MSG(wide < 4, "%s: bounds %.2f times the error say nothing", of->name, wide);
}

int main(void)
{
    static const picture rims = {"rims", 16, draw_rims, true_rim}, mirror = {"mirror", 256, draw_mirror, true_mirror};
    check(&rims);
    check(&mirror);
    TEST_END();
}

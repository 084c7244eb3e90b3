/* tiers: quick, long */
/* Checks the stated distance of a denoised picture from the truth. Synthetic films of known truth, with smooth areas, an edge and a
 * texture, are "denoised" by a box filter, which helps in one part and harms in another. Over many films the estimates must be unbiased,
 * the intervals must contain the real error in about 95 of 100, and the blend must not be worse than the better of both. See
 * host/denoise/judge.c. */
#include "denoise/blend.h"
#include "denoise/clean.h"
#include "film/resolve.h"
#include "support/films.h"
#include "support/random.h"
#include "support/test.h"

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT };

static test_random dice = {1};

/* A dark and a bright area, and stripes one pixel wide in the lower half. */
static float truth(uint32_t x, uint32_t y)
{
    if (y >= HEIGHT / 2 && x > 16) return x % 2 ? 1.5f : 0.5f;
    return x < WIDTH / 2 ? 0.6f : 1.4f;
}

/* Replicates' means with a relative standard deviation of `size`, and mean 1. */
typedef double draw(double size);
static double draw_normal(double size) { return 1 + size * test_normal(&dice); }
static double draw_exponential(double size) { return 1 + size * (-log(test_uniform(&dice)) - 1); }
/* A lamp in few pixels that one of ten replicates samples. */
static uint32_t place;
static double draw_lamp(double size) { return place % 613 ? 1 + 0.1 * test_normal(&dice) : 1 + size * ((test_uniform(&dice) < 0.1 ? 1 : 0) - 0.1); }
static double draw_fireflies(double size) { return 0.9 + 0.1 * size * test_normal(&dice) + (test_uniform(&dice) < 0.01 ? 10 : 0); }

static void fill(ec_film *film, uint32_t replicates, draw *noise, double size)
{
    static float rgb[3 * PIXELS];
    ec_error err;
    CHECK_OK(ec_film_create(film, WIDTH, HEIGHT, replicates, &err), err);
    for (uint32_t r = 0; r < replicates; r++) {
        for (uint32_t p = place = 0; p < PIXELS; p++, place++) rgb[3 * p] = rgb[3 * p + 1] = rgb[3 * p + 2] = truth(p % WIDTH, p / WIDTH) * (float)noise(size);
        CHECK_OK(films_add(film, r, rgb, &err), err);
    }
}

static void smooth(float *rgb, int radius)
{
    static float from[3 * PIXELS];
    memcpy(from, rgb, sizeof from);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int c = 0; c < 3; c++) {
                double sum = 0, count = 0;
                for (int v = y - radius; v <= y + radius; v++)
                    for (int u = x - radius; u <= x + radius; u++)
                        if (u >= 0 && v >= 0 && u < WIDTH && v < HEIGHT) sum += from[3 * (v * WIDTH + u) + c], count++;
                rgb[3 * (y * WIDTH + x) + c] = (float)(sum / count);
            }
}

/* Relative to the truth's mean. */
static double real_error(const float *rgb)
{
    double sum = 0, mean = 0;
    for (uint32_t p = 0; p < PIXELS; p++) {
        const double y = (double)truth(p % WIDTH, p / WIDTH);
        sum += pow(ec_luminance_of_floats(rgb + 3 * p) - y, 2);
        mean += y / PIXELS;
    }
    return sqrt(sum / PIXELS) / mean;
}

static float halves[2][3 * PIXELS], denoised[3 * PIXELS], best[3 * PIXELS], local[PIXELS];

static ec_denoised clean(const ec_film *film, int radius)
{
    const float *const half[2] = {halves[0], halves[1]};
    const ec_film_clean into = {denoised, best, local};
    const ec_film_error noisy = ec_film_estimate_error(film);
    ec_denoised out = {0};
    ec_error err;
    for (uint32_t h = 0; h < 2; h++) {
        ec_half(film, h, 1, 3, halves[h]);
        if (radius) smooth(halves[h], radius);
    }
    CHECK_OK(ec_clean_make(film, half, &noisy, &into, &out, &err), err);
    return out;
}

/* Sums of real and stated errors over films. */
typedef struct tally {
    double excess, excess2, held, real2, stated2;
} tally;

static void add(tally *t, const ec_stated_error *stated, double real)
{
    const double excess = stated->error * stated->error - real * real;
    t->excess += excess;
    t->excess2 += excess * excess;
    t->held += stated->low95 <= real && real <= stated->high95;
    t->real2 += real * real;
    t->stated2 += stated->error * stated->error;
}

/* In standard errors. */
static double drift(const tally *t, int films)
{
    const double mean = t->excess / films, variance = t->excess2 / films - mean * mean;
    return mean / sqrt(variance / films);
}

static void check_stated(const char *name, draw *noise, double size, uint32_t replicates, int radius, int films, double least, double most, bool has_many)
{
    tally of_clean = {0}, of_best = {0};
    double noisy2 = 0;
    for (int k = 0; k < films; k++) {
        ec_film film;
        fill(&film, replicates, noise, size);
        const ec_denoised d = clean(&film, radius);
        static float rgb[3 * PIXELS];
        ec_film_resolve(&film, rgb, NULL);
        noisy2 += pow(real_error(rgb), 2);
        add(&of_clean, &d.clean, real_error(denoised));
        add(&of_best, &d.best, real_error(best));
        ec_film_destroy(&film);
    }
    const double held = 100 * of_clean.held / films, best_held = 100 * of_best.held / films, better = fmin(noisy2, of_clean.real2);
    printf("%-12s %2u replicates: noisy %.4f, denoised %.4f stated %.4f, held %.1f %%; best %.4f stated %.4f, held %.1f %%; drift %.1f, %.1f\n", name, replicates,
           sqrt(noisy2 / films), sqrt(of_clean.real2 / films), sqrt(of_clean.stated2 / films), held, sqrt(of_best.real2 / films),
           sqrt(of_best.stated2 / films), best_held, drift(&of_clean, films), drift(&of_best, films));
    CHECK_MSG(fabs(drift(&of_clean, films)) < 4, "%s: drift of %g standard errors", name, drift(&of_clean, films));
    CHECK_MSG(held >= least && held <= most, "%s: held %g %%", name, held);
    CHECK_MSG(best_held >= least, "%s: of best, held %g %%", name, best_held);
    if (has_many) CHECK_MSG(fabs(drift(&of_best, films)) < 4, "%s: of best, drift of %g standard errors", name, drift(&of_best, films));
    CHECK_MSG(of_best.real2 <= 1.02 * 1.02 * better, "%s: best %g, the better of both %g", name, sqrt(of_best.real2 / films), sqrt(better / films));
}

/* A denoiser that does nothing has the noisy picture's error, and no bias anywhere. */
static void check_idle(void)
{
    ec_film film;
    fill(&film, 8, draw_exponential, 0.5);
    const ec_denoised d = clean(&film, 0);
    const double noisy = ec_film_estimate_error(&film).error;
    CHECK_NEAR(d.clean.error, noisy, 0.1 * noisy);
    CHECK(d.clean.low95 < noisy && noisy < d.clean.high95);
    CHECK_NEAR(d.best.error, noisy, 0.1 * noisy);
    CHECK_NEAR(d.noise, noisy, 0.1 * noisy);
    ec_film_destroy(&film);
}

/* Pictures without noise are known exactly. */
static void check_exact(void)
{
    ec_film film;
    fill(&film, 8, draw_normal, 0);
    const ec_denoised d = clean(&film, 1);
    const double real = real_error(denoised);
    CHECK_NEAR(d.clean.error, real, 1e-5 * real);
    CHECK_NEAR(d.clean.low95, real, 1e-5 * real);
    CHECK_NEAR(d.clean.high95, real, 1e-5 * real);
    CHECK(d.best.error < 1e-6 && real_error(best) < 1e-6);
    CHECK(d.off > 0 && d.nearer == 0); /* the denoiser errs where the stripes are; elsewhere both are alike */
    CHECK(d.off_x > 16 && d.off_x < WIDTH && d.off_y >= HEIGHT / 2 && d.off_y < HEIGHT);
    ec_film_destroy(&film);
}

/* An interval is symmetric in the error itself. If little is known it begins at 0, and part of the plain variance counts. */
static void check_reach(void)
{
    const ec_film_error noisy = {.mean_luminance = 1, .bound_if_met = 0};
    const double pixels = 1000, reach = 1.959964 * sqrt(1000) / pixels, far = 1.959964 * 4;
    const ec_judged_sum many = {.square = 1000, .variance = 1000}, few = {.square = 1000, .variance = -1e6, .plain = 16e6 / 0.2};
    const ec_stated_error of_many = ec_judged_state(&many, pixels, &noisy), of_few = ec_judged_state(&few, pixels, &noisy);
    CHECK_NEAR(of_many.error, 1, 1e-9);
    CHECK_NEAR(of_many.low95, 1 - reach / 2, 1e-6);
    CHECK_NEAR(of_many.high95, 1 + reach / 2, 1e-6);
    CHECK(of_few.low95 == 0);
    CHECK_NEAR(pow(of_few.high95, 2) - 1, 1.5 * far, 1e-6);
}

/* The noisy picture causes half of this error. Its bound is three times its error, and the upper end rises by half of the difference. */
static void check_noisy_bound(void)
{
    const ec_film_error noisy = {.mean_luminance = 1, .error = 1, .bound_if_met = 3};
    const ec_judged_sum best = {.square = 1000, .variance = 1000, .noisy = 500};
    CHECK_NEAR(pow(ec_judged_state(&best, 1000, &noisy).high95, 2) - 1, 0.5 * (3 * 3 - 1), 0.01);
}

/* Light in one replicate of eight is in no pair, so that the unbiased variance is 0. The plain variance is not. */
static void check_single(void)
{
    static float rgb[3 * PIXELS];
    static const float black[3 * PIXELS] = {0};
    const float *const half[2] = {black, black};
    static ec_judged row[WIDTH];
    ec_film film;
    ec_error err;
    CHECK_OK(ec_film_create(&film, WIDTH, HEIGHT, 8, &err), err);
    for (uint32_t r = 0; r < 8; r++) {
        rgb[0] = rgb[1] = rgb[2] = r == 3 ? 2 : 0;
        CHECK_OK(films_add(&film, r, rgb, &err), err);
    }
    ec_judge_row(&film, 0, half, row);
    CHECK_NEAR(row[0].clean, 0, 1e-9);
    CHECK_NEAR(row[0].clean_variance, 0, 1e-9);
    CHECK_NEAR(row[0].clean_plain, 16.0 / 768, 1e-6);
    ec_film_destroy(&film);
}

/* Blends with a noisy picture whose pixels have noise 1. */
static void create_blend(ec_blend *blend, uint32_t width, uint32_t height)
{
    const ec_film_error noisy = {.mean_luminance = 1, .error = 1, .noisy_pixels = width * height};
    ec_error err;
    CHECK_OK(ec_blend_create(blend, width, height, &noisy, &err), err);
    CHECK_NEAR(blend->pixel_noise, 1, 1e-9);
}

/* Pictures of 32 pixels and mean 2: in one, 4 pixels have an error of half the mean; the other has no noise. */
static void check_pixel_noise(void)
{
    const ec_film_error noisy = {.mean_luminance = 2, .error = 0.5, .noisy_pixels = 4}, steady = {.mean_luminance = 2};
    ec_blend blend;
    ec_error err;
    CHECK_OK(ec_blend_create(&blend, 8, 4, &noisy, &err), err);
    CHECK_NEAR(blend.pixel_noise, 8, 1e-9);
    ec_blend_free(&blend);
    CHECK_OK(ec_blend_create(&blend, 8, 4, &steady, &err), err);
    CHECK(blend.pixel_noise == 0);
    ec_blend_free(&blend);
}

/* Weights change between tiles without a step; in the middle of a tile they are the tile's own. */
static void check_seams(void)
{
    ec_blend blend;
    create_blend(&blend, 40, 33);
    CHECK(blend.columns == 3 && blend.rows == 3);
    for (uint32_t i = 0; i < 9; i++) blend.tiles[i] = (ec_blend_tile){.half[0].pixels = 256, .weight = i % 2 ? 1 : 0};
    for (uint32_t y = 0; y < 33; y++)
        for (uint32_t x = 0; x + 1 < 40; x++) {
            const ec_blend_at here = ec_blend_look(&blend, x, y), next = ec_blend_look(&blend, x + 1, y);
            CHECK(here.weight >= 0 && here.weight <= 1);
            CHECK_MSG(fabs(here.weight - next.weight) <= 1.0 / EC_BLEND_TILE + 1e-12, "a step of %g at %u, %u", next.weight - here.weight, x, y);
        }
    CHECK_NEAR(0.5 * (ec_blend_look(&blend, 23, 7).weight + ec_blend_look(&blend, 24, 7).weight), 1, 1.0 / 16);
    ec_blend_free(&blend);
}

/* If one picture is clearly nearer to the truth, the best picture is that one; if nothing is known, it is the denoised one. */
static void check_weights(void)
{
    enum { TILES = 9, ACROSS = TILES * EC_BLEND_TILE };
    static ec_judged row[ACROSS];
    ec_blend blend;
    create_blend(&blend, ACROSS, 16);
    for (uint32_t x = 0; x < ACROSS; x++) {
        const bool is_known = x < 6 * EC_BLEND_TILE, is_left = x < 3 * EC_BLEND_TILE;
        row[x] = (ec_judged){.noisy = is_known ? (is_left ? 9 : 1) : 4, .gain = is_known ? (is_left ? 8 : 0) : 4, .apart = 8, .gain_variance = is_known ? 0 : 1e9};
    }
    for (uint32_t y = 0; y < 16; y++) ec_blend_add_row(&blend, y, row, ACROSS);
    ec_blend_choose(&blend);
    CHECK_NEAR(blend.tiles[0].weight, 1, 1e-3);
    CHECK_NEAR(blend.tiles[4].weight, 0, 1e-3);
    CHECK_NEAR(blend.tiles[8].weight, 1, 1e-3);
    CHECK(blend.tiles[4].slope == 0 && blend.tiles[8].slope > 0);
    ec_blend_free(&blend);
}

/* The weight of a picture with these pixels among uninformative ones. */
static double weigh_two(uint32_t ones, ec_judged one, uint32_t others, ec_judged other)
{
    static ec_judged row[EC_BLEND_TILE];
    ec_blend blend;
    create_blend(&blend, EC_BLEND_TILE, 1);
    for (uint32_t x = 0; x < EC_BLEND_TILE; x++) row[x] = x < ones ? one : x < ones + others ? other : (ec_judged){0};
    ec_blend_add_row(&blend, 0, row, EC_BLEND_TILE);
    ec_blend_choose(&blend);
    const double weight = blend.tiles[0].weight;
    ec_blend_free(&blend);
    return weight;
}

static double weigh_like(uint32_t count, ec_judged pixel) { return weigh_two(count, pixel, 0, pixel); }

/* Squared distances between both pictures in pixels of noise 1, when the denoised picture's error is unknown. */
static double weigh(uint32_t count, double apart) { return weigh_like(count, (ec_judged){.noisy = 1, .apart = apart, .gain_variance = 1e9}); }

/* The two pictures differ by 4 in each of p equal pixels of noise 1. The weight is (p - 2) / p of a quarter, and at least 0. */
static void check_few(void)
{
    const ec_judged pixel = {.noisy = 1, .gain = 1, .apart = 4, .gain_apart = 2 * 4};
    CHECK_NEAR(weigh_like(1, pixel), 0, 1e-9);
    CHECK_NEAR(weigh_like(4, pixel), 0.125, 1e-9);
    CHECK_NEAR(weigh_like(16, pixel), 0.25 * 14 / 16, 1e-9);
}

/* Pictures that differ by more than twice the noise: in few pixels that happens by chance, in many it means that the denoised picture is
 * worse. */
static void check_whole(void)
{
    CHECK_NEAR(weigh(1, 1), 1, 1e-3);
    CHECK_NEAR(weigh(1, 3), 1 - 2 / sqrt(7), 1e-3);
    CHECK_NEAR(weigh(16, 3), 0, 1e-3);
    CHECK_NEAR(weigh(1, 8), 0, 1e-3);
}

/* One outlier among five noisy pixels does not prove that the denoised picture is worse. Five outliers do, and so do fifteen pixels of a
 * smoothed texture, which have little noise of their own. */
static void check_outliers(void)
{
    const ec_judged far = {.noisy = 1, .apart = 50, .gain_variance = 1e9}, near = {.noisy = 1, .apart = 1, .gain_variance = 1e9};
    const ec_judged steady = {.noisy = 0.01, .apart = 3, .gain_variance = 1e9};
    CHECK_NEAR(weigh_two(1, far, 4, near), 1, 1e-3);
    CHECK_NEAR(weigh_two(1, near, 15, steady), 0, 1e-3);
    CHECK_NEAR(weigh_two(5, far, 0, near), 0, 1e-3);
}

/* The two pictures differ in one pixel, by no more than chance explains: half of the difference's variance moves the weight towards the
 * denoised one. */
static void check_chance(void)
{
    const double draw = 0.5 * 8 / (2 * 0.09);
    CHECK_NEAR(weigh_like(1, (ec_judged){.noisy = 1, .gain = 1, .apart = 2, .apart_variance = 8}), (1 + draw) / (2 + draw), 1e-3);
}

/* The estimated gain of a blend has an error of 0.2 in a tile's weight, which is one half everywhere: four fifths of its square must be
 * ignored. */
static void check_alike(void)
{
    enum { TILES = 64, ACROSS = TILES * EC_BLEND_TILE };
    static ec_judged row[ACROSS];
    ec_blend blend;
    const double spread = 0.2 * 8 * EC_BLEND_TILE; /* error of a pixel's estimate */
    double square = 0;
    create_blend(&blend, ACROSS, 16);
    for (uint32_t y = 0; y < 16; y++) {
        for (uint32_t x = 0; x < ACROSS; x++)
            row[x] = (ec_judged){.noisy = 4, .gain = 4 + spread * test_normal(&dice), .apart = 8, .gain_variance = spread * spread};
        ec_blend_add_row(&blend, y, row, ACROSS);
    }
    ec_blend_choose(&blend);
    for (int i = 0; i < TILES; i++) square += pow(blend.tiles[i].weight - 0.5, 2) / TILES;
    printf("weights stray by %.3f\n", sqrt(square));
    CHECK(square < 0.2 * 0.2 * 0.2);
    ec_blend_free(&blend);
}

int main(void)
{
    const bool is_long = test_tier("long");
    const int films = is_long ? 300 : 60;
    const double least = is_long ? 91 : 85, most = is_long ? 98.7 : 100; /* 95 % of 300 has a standard deviation of 1.3 %, of 60 2.8 % */
    check_idle();
    check_exact();
    check_seams();
    check_reach();
    check_noisy_bound();
    check_single();
    check_weights();
    check_whole();
    check_outliers();
    check_pixel_noise();
    check_chance();
    check_few();
    check_alike();
    check_stated("normal", draw_normal, 0.5, 8, 1, films, least, most, true);
    check_stated("wide filter", draw_normal, 1.5, 8, 2, films, least, most, true);
    check_stated("exponential", draw_exponential, 1, 8, 1, films, least, most, true);
    check_stated("fireflies", draw_fireflies, 1, 8, 1, films, least, 100, false); /* few replicates have the noise: the interval is wide */
    check_stated("lamp", draw_lamp, 50, 8, 1, 300, 91, 98.7, false);
    check_stated("16", draw_exponential, 1, 16, 1, films, least, most, true);
    check_stated("4", draw_exponential, 1, 4, 1, films, least, 100, true);
    TEST_END();
}

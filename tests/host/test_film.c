/* tier: quick */
/* Statistics of a film's pixels against two-pass formulas, its resolved values, and special cases of its error. */
#include "film/resolve.h"
#include "support/films.h"
#include "support/test.h"

enum { W = 5, H = 3, P = W * H, B = 11, R = 16 };

static float value(int batch, int pixel, int channel)
{
    unsigned h = (unsigned)(batch * 7919 + pixel * 104729 + channel * 1299709) * 2654435761u;
    return (float)(h >> 8) * 0x1p-24f * (float)(1 + pixel % 4) + (float)channel;
}

static const float *batch_of(int batch, float (*f)(int, int, int))
{
    static float rgb[3 * P];
    for (int i = 0; i < 3 * P; i++) rgb[i] = f(batch, i / 3, i % 3);
    return rgb;
}

static ec_film filled_by(uint32_t replicates, int batches, float (*f)(int, int, int))
{
    ec_film film;
    ec_error err;
    CHECK_OK(ec_film_create(&film, W, H, replicates, &err), err);
    for (int b = 0; b < batches; b++) CHECK_OK(films_add(&film, (uint32_t)b, batch_of(b, f), &err), err);
    return film;
}

/* Up to 16 batches are as many independent values. */
static ec_film filled(int batches, float (*f)(int, int, int)) { return filled_by(R, batches, f); }

static void pixels_equal_two_passes(void)
{
    ec_film film = filled(B, value);
    CHECK(film.batch_count == B && film.invalid_count == 0 && ec_film_replicates(&film) == B);
    for (int p = 0; p < P; p++) {
        const ec_pixel pixel = films_pixel(&film, (uint64_t)p);
        CHECK(pixel.n == B && pixel.samples == B);
        for (int c = 0; c < 4; c++) {
            double x[B], mean = 0, power[5] = {0}, largest = 0, raw[5] = {0};
            for (int b = 0; b < B; b++) {
                double rgb[3] = {value(b, p, 0), value(b, p, 1), value(b, p, 2)};
                x[b] = c < 3 ? rgb[c] : ec_luminance(rgb);
                mean += x[b] / B;
                largest = fmax(largest, x[b]);
            }
            for (int b = 0; b < B; b++)
                for (int k = 2; k <= 4; k++) power[k] += pow(x[b] - mean, k), raw[k] += pow(x[b] / largest, k);
            if (c < 3) CHECK_NEAR(pixel.mean[c], mean, 1e-13);
            CHECK_NEAR(pixel.m2[c], power[2], 1e-12);
            if (c < 3) continue;
            CHECK_NEAR(pixel.m3, power[3], 1e-12 * (1 + power[4]));
            CHECK_NEAR(pixel.m4, power[4], 1e-12 * (1 + power[4]));
            CHECK(pixel.tail[0] == (float)largest);
            CHECK_NEAR(pixel.tail[1], raw[2], 1e-5); /* floats, 10 additions */
            CHECK_NEAR(pixel.tail[2], raw[4], 1e-5);
        }
    }
    ec_film_destroy(&film);
}

/* Replicates of 2, 3 and 4 samples in one film: the mean is that of all samples, and a replicate's deviation is weighted by its share of
 * them. */
static void check_uneven(const ec_film *film, const double samples[4], double (*mean_of)(int replicate, int pixel, int channel))
{
    double all = 0;
    for (int r = 0; r < 4; r++) all += samples[r];
    CHECK(ec_film_samples(film, 0) == all && ec_film_samples_of_all(film) == all);
    for (int p = 0; p < P; p++) {
        const ec_pixel pixel = films_pixel(film, (uint64_t)p);
        CHECK(pixel.n == 4 && pixel.samples == all);
        for (int c = 0; c < 3; c++) {
            double mean = 0, squares = 0;
            for (int r = 0; r < 4; r++) mean += samples[r] / all * mean_of(r, p, c);
            for (int r = 0; r < 4; r++) squares += 4 * samples[r] / all * pow(mean_of(r, p, c) - mean, 2);
            CHECK_NEAR(pixel.mean[c], mean, 1e-6 * mean);
            CHECK_NEAR(ec_pixel_se2(&pixel, c), squares / (4 * 3), 1e-5 * squares / (4 * 3) + 1e-12);
        }
    }
}

/* Strides of 4 replicates: batches 0 to 3 have one sample each, 4 to 7 too, 8 to 11 two. */
static double two_or_four(int r, int p, int c)
{
    const double two = 0.5 * (value(r, p, c) + (double)value(4 + r, p, c));
    return r < 2 ? 0.5 * (two + (double)value(8 + r, p, c)) : two;
}

static double two_three_or_four(int r, int p, int c)
{
    if (r != 2) return two_or_four(r, p, c);
    return (value(2, p, c) + (double)value(6, p, c) + (double)value(10, p, c)) / 3;
}

static void replicates_may_be_uneven(void)
{
    ec_film film = filled_by(4, 10, value);
    check_uneven(&film, (double[4]){4, 4, 2, 2}, two_or_four);
    ec_film_destroy(&film);
}

/* Batch 10 has only one of its two samples. */
static void the_last_batch_may_be_cut(void)
{
    ec_film film = filled_by(4, 10, value);
    ec_error err;
    CHECK_OK(films_add_with(&film, 10, 1, batch_of(10, value), NULL, &err), err);
    CHECK(film.cut == 1 && film.batch_count == 11 && ec_film_end(&film) == 11);
    check_uneven(&film, (double[4]){4, 4, 3, 2}, two_three_or_four);
    const ec_pixel before = films_pixel(&film, 3);
    CHECK(films_add(&film, 11, batch_of(11, value), &err) == EC_FAILED && strstr(err.text, "ended within batch 10"));
    CHECK(films_add(&film, 10, batch_of(10, value), &err) == EC_FAILED && strstr(err.text, "batches 10 to 10 occur twice"));
    const ec_pixel after = films_pixel(&film, 3);
    CHECK(before.mean[0] == after.mean[0] && before.m2[3] == after.m2[3] && film.batch_count == 11 && film.cut == 1);
    ec_film_destroy(&film);

    film = filled_by(4, 11, value); /* in the order of a file: all parts, then the cut */
    ec_film_set_cut(&film, 1);
    CHECK(film.cut == 1 && ec_film_samples_of_all(&film) == 13 && film.samples[2] == 3);
    ec_film_destroy(&film);
}

/* Two batches of one pixel give the same in one pass and in two. */
static void pixels_go_on_twice(void)
{
    ec_film once = filled_by(2, 4, value), twice = filled_by(2, 4, value);
    ec_error err;
    const uint32_t places[6] = {3, 3, 3, 3, 7, 7};
    float rgb[18], batch[6 * EC_BATCH_FIELDS];
    for (int i = 0; i < 18; i++) rgb[i] = (float)(i + 1);
    films_lay_out(rgb, 6, batch);
    CHECK_OK(ec_film_add_some(&once, batch, NULL, places, 6, 2, &err), err);
    for (uint32_t i = 0; i < 6; i += 2) CHECK_OK(ec_film_add_some(&twice, batch + EC_BATCH_FIELDS * i, NULL, places + i, 2, 2, &err), err);
    CHECK(ec_film_samples(&once, 3) == 12 && ec_film_samples(&once, 7) == 8);
    for (uint64_t p = 0; p < P; p++) {
        const ec_pixel a = films_pixel(&once, p), b = films_pixel(&twice, p);
        CHECK(memcmp(&a, &b, sizeof a) == 0);
    }
    ec_film_destroy(&once);
    ec_film_destroy(&twice);
}

/* Pixels 1 and 7 get 2 more samples in each of 2 replicates, and pixel 7 gets 4 more. */
static void some_pixels_go_on(void)
{
    ec_film film = filled_by(2, 4, value); /* 2 samples a replicate */
    ec_error err;
    const uint32_t places[4] = {1, 1, 7, 7}, again[2] = {7, 7};
    float rgb[12], batch[4 * EC_BATCH_FIELDS];
    for (int i = 0; i < 12; i++) rgb[i] = (float)(i + 1);
    films_lay_out(rgb, 4, batch);
    CHECK_OK(ec_film_add_some(&film, batch, NULL, places, 4, 2, &err), err);
    CHECK_OK(ec_film_add_some(&film, batch, NULL, again, 2, 4, &err), err);
    CHECK(ec_film_samples(&film, 0) == 4 && ec_film_samples(&film, 1) == 8 && ec_film_samples(&film, 7) == 16);
    for (int p = 0; p < P; p++) {
        const ec_pixel pixel = films_pixel(&film, (uint64_t)p);
        double mean[2];
        for (int r = 0; r < 2; r++) {
            mean[r] = 0.5 * (value(r, p, 1) + (double)value(2 + r, p, 1));
            if (p == 1) mean[r] = 0.5 * mean[r] + 0.5 * rgb[3 * r + 1];
            if (p == 7) mean[r] = 0.25 * mean[r] + 0.25 * rgb[6 + 3 * r + 1] + 0.5 * rgb[3 * r + 1];
        }
        CHECK_NEAR(pixel.mean[1], 0.5 * (mean[0] + mean[1]), 1e-6 * mean[0]);
        CHECK_NEAR(sqrt(ec_pixel_se2(&pixel, 1)), 0.5 * fabs(mean[0] - mean[1]), 1e-6 * mean[0]);
        CHECK(pixel.samples == ec_film_samples(&film, (uint64_t)p));
    }
    ec_film_destroy(&film);
    film = filled_by(2, 5, value);
    CHECK(ec_film_add_some(&film, batch, NULL, places, 4, 2, &err) == EC_FAILED && strstr(err.text, "whole round"));
    ec_film_destroy(&film);
}

/* Mean 100, standard deviation 0.1: sums of squares in float gave a negative variance here. */
static float steady(int batch, int pixel, int channel)
{
    (void)pixel, (void)channel;
    return batch % 2 ? 100.1f : 99.9f;
}

static void variance_survives_a_large_mean(void)
{
    for (int batches = 16; batches <= 1600; batches *= 10) { /* with an even number of replicates, each has one value only */
        ec_film film = filled(batches, steady);
        CHECK_NEAR(films_pixel(&film, 0).m2[3] / R, 0.01, 1e-6);
        ec_film_error error = ec_film_estimate_error(&film);
        CHECK_NEAR(error.mean_luminance, 100, 1e-5);
        CHECK_NEAR(error.error, 0.1 / sqrt(R - 1) / 100, 1e-8);
        ec_film_destroy(&film);
    }
}

static void resolves_mean_and_standard_error(void)
{
    ec_film film = filled(B, value);
    float rgb[3 * P], se[3 * P], again[3 * P], se_y[P], samples[2 * P];
    ec_pixel room[W * (H + 2 * EC_INTERVAL_REACH)];
    ec_film_resolve(&film, rgb, se);
    CHECK(ec_resolve_room(W, H) <= sizeof room / sizeof *room);
    ec_film_resolve_rows(&film, 0, H, &(ec_planes){.rgb = again, .stderr_y = se_y, .samples = samples, .samples_stride = 2}, room);
    for (int p = 0; p < P; p++) {
        const ec_pixel pixel = films_pixel(&film, (uint64_t)p);
        for (int c = 0; c < 3; c++) {
            CHECK(rgb[3 * p + c] == (float)pixel.mean[c] && again[3 * p + c] == rgb[3 * p + c]);
            CHECK_NEAR(se[3 * p + c], sqrt(pixel.m2[c] / (B * (B - 1))), 1e-6);
        }
        CHECK_NEAR(se_y[p], sqrt(pixel.m2[3] / (B * (B - 1))), 1e-6);
        CHECK(samples[2 * p] == B);
    }
    ec_film_resolve(&film, rgb, NULL);
    ec_film_resolve(&film, NULL, se);
    ec_film_destroy(&film);

    film = filled(1, value);
    ec_film_resolve(&film, NULL, se);
    for (int i = 0; i < 3 * P; i++) CHECK(se[i] == 0);
    ec_film_destroy(&film);
}

static float black(int batch, int pixel, int channel) { return (void)batch, (void)pixel, (void)channel, 0.0f; }
static float grey(int batch, int pixel, int channel) { return (void)batch, (void)pixel, (void)channel, 0.5f; }
static float tenth(int batch, int pixel, int channel) { return (void)batch, 0.1f * (float)(1 + pixel + channel); }
static float one_noisy(int batch, int pixel, int channel) { return (void)channel, pixel == 7 ? (float)(batch % 3) : 1; }
static float broken(int batch, int pixel, int channel)
{
    return pixel == 3 ? (batch % 2 ? NAN : -INFINITY) : value(batch, pixel, channel);
}
static float huge(int batch, int pixel, int channel) { return (void)channel, (batch + pixel) % 2 ? 3e38f : 1e38f; }
static float tiny(int batch, int pixel, int channel) { return value(batch, pixel, channel) * 1e-30f; }

static void error_never_lies_about_corner_cases(void)
{
    struct { float (*f)(int, int, int); int batches, infinite, zero; } cases[] = {
        {value, 0, 1, 0}, {value, 1, 1, 0}, {value, 2, 0, 0}, {value, 3, 0, 0}, {value, 4, 0, 0}, {value, B, 0, 0},
        {value, 61, 0, 0}, {black, 1, 1, 0}, {black, B, 1, 0}, {grey, 1, 1, 0}, {grey, B, 0, 1}, {grey, 77, 0, 1},
        {one_noisy, 2, 0, 0}, {one_noisy, 3, 0, 0}, {one_noisy, B, 0, 0}, {broken, B, 0, 0},
        {huge, 2, 0, 0}, {huge, B, 0, 0}, {huge, 300, 0, 0}, {tiny, 2, 0, 0}, {tiny, B, 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ec_film film = filled(cases[i].batches, cases[i].f);
        ec_film_error error = ec_film_estimate_error(&film);
        double mean = 0;
        for (int pixel = 0; pixel < P; pixel++) mean += ec_luminance(films_pixel(&film, (uint64_t)pixel).mean) / P;
        CHECK_MSG(fabs(error.mean_luminance - mean) <= 1e-12 * mean, "case %zu: %g, not %g", i, error.mean_luminance, mean);
        CHECK_MSG(!isnan(error.error) && !isnan(error.error_bound), "case %zu", i);
        CHECK_MSG(isinf(error.error) == cases[i].infinite && isinf(error.error_bound) == cases[i].infinite,
                  "case %zu: %g %g", i, error.error, error.error_bound);
        CHECK_MSG((error.error == 0) == cases[i].zero && (error.error_bound == 0) == cases[i].zero, "case %zu", i);
        CHECK_MSG(cases[i].zero || isinf(error.error) || error.error_bound > error.error, "case %zu: %g %g", i,
                  error.error, error.error_bound);
        ec_film_destroy(&film);
    }
}

/* Averages of equal floats do not change with the number of batches, nor with how they are joined. */
static void constant_pixels_have_no_error(void)
{
    for (uint32_t replicates = 3; replicates <= 8; replicates += 5) {
        ec_film film = filled_by(replicates, 0, tenth);
        ec_error err;
        for (uint32_t b = 0; b < 400; b++) {
            CHECK_OK(films_add(&film, b, batch_of(0, tenth), &err), err);
            const ec_film_error error = ec_film_estimate_error(&film);
            CHECK_MSG(b == 0 ? isinf(error.error) : error.error == 0, "%u batches of %u replicates: %g", b + 1, replicates, error.error);
        }
        for (int i = 0; i < 3 * P; i++) CHECK(films_pixel(&film, (uint64_t)i / 3).mean[i % 3] == (double)tenth(0, i / 3, i % 3));
        ec_film_destroy(&film);
    }
}

/* Batches of a single replicate tell nothing about the error. */
static void one_replicate_tells_nothing(void)
{
    ec_film film = filled_by(4, 1, value);
    ec_error err;
    CHECK_OK(films_add(&film, 4, batch_of(4, value), &err), err);
    CHECK(film.batch_count == 2 && films_pixel(&film, 0).n == 1 && ec_film_replicates(&film) == 1);
    CHECK(isinf(ec_film_estimate_error(&film).error) && isinf(ec_film_estimate_error(&film).error_bound));
    ec_film_destroy(&film);
}

/* One pixel calculated by hand: SE^2 / (x + 0.01)^2 is 0.25 / 4.01^2 in one channel of three, and 0 in the others. */
static float one_in_red(int batch, int pixel, int channel) { return pixel == 7 && channel == 0 ? 3.5f + (float)(batch % 2) : 0; }

static void relmse_is_that_of_the_definition(void)
{
    ec_film film = filled(2, one_in_red);
    CHECK_NEAR(ec_film_estimate_error(&film).relmse, 0.25 / (4.01 * 4.01) / (3 * P), 1e-12);
    ec_film_destroy(&film);
    film = filled(1, one_in_red);
    CHECK(isinf(ec_film_estimate_error(&film).relmse));
    ec_film_destroy(&film);
    film = filled(4, black);
    CHECK(ec_film_estimate_error(&film).relmse == 0);
    ec_film_destroy(&film);
}

static void invalid_values_are_counted(void)
{
    ec_film film = filled(4, broken);
    const ec_pixel pixel = films_pixel(&film, 3);
    CHECK(film.invalid_count == 4 * 3);
    for (int c = 0; c < 3; c++) CHECK(pixel.mean[c] == 0 && pixel.m2[c] == 0 && pixel.tail[c] == 0);
    ec_film_destroy(&film);
}

static void creation_fails_clearly(void)
{
    ec_film film;
    ec_error err;
    CHECK(ec_film_create(&film, 0, 5, 16, &err) == EC_FAILED && strstr(err.text, "0 x 5"));
    ec_film_destroy(&film);
    ec_film_destroy(&film);
}

int main(void)
{
    pixels_equal_two_passes();
    replicates_may_be_uneven();
    the_last_batch_may_be_cut();
    some_pixels_go_on();
    pixels_go_on_twice();
    variance_survives_a_large_mean();
    resolves_mean_and_standard_error();
    error_never_lies_about_corner_cases();
    constant_pixels_have_no_error();
    one_replicate_tells_nothing();
    relmse_is_that_of_the_definition();
    invalid_values_are_counted();
    creation_fails_clearly();
    TEST_END();
}

/* The film's sums against the two-pass formulas, what it resolves to, and the error's corner cases. */
#include "film/film.h"
#include "support/test.h"

enum { W = 5, H = 3, P = W * H, B = 11 };

static float value(int batch, int pixel, int channel)
{
    unsigned h = (unsigned)(batch * 7919 + pixel * 104729 + channel * 1299709) * 2654435761u;
    return (float)(h >> 8) * 0x1p-24f * (float)(1 + pixel % 4) + (float)channel;
}

static ec_film filled(int batches, float (*f)(int, int, int))
{
    ec_film film;
    ec_error err;
    CHECK_OK(ec_film_create(&film, W, H, 16, &err), err);
    for (int b = 0; b < batches; b++) {
        float batch[3 * P];
        for (int i = 0; i < 3 * P; i++) batch[i] = f(b, i / 3, i % 3);
        CHECK_OK(ec_film_add_batch(&film, batch, &err), err);
    }
    return film;
}

static void sums_equal_two_passes(void)
{
    ec_film film = filled(B, value);
    CHECK(film.batch_count == B && film.samples_per_batch == 16 && film.invalid_count == 0);
    for (int p = 0; p < P; p++)
        for (int c = 0; c < 4; c++) {
            double x[B], mean = 0, power[5] = {0}, largest = 0;
            for (int b = 0; b < B; b++) {
                double rgb[3] = {value(b, p, 0), value(b, p, 1), value(b, p, 2)};
                x[b] = c < 3 ? rgb[c] : ec_luminance(rgb);
                mean += x[b] / B;
                largest = fmax(largest, x[b]);
            }
            for (int b = 0; b < B; b++)
                for (int k = 2; k <= 4; k++) power[k] += pow(x[b] - mean, k);
            if (c < 3) CHECK_NEAR(film.mean[3 * p + c], mean, 1e-13);
            CHECK_NEAR(film.m2[4 * p + c], power[2], 1e-12);
            if (c == 3) CHECK(film.largest[p] == (float)largest);
            if (c == 3) CHECK_NEAR(film.m34[2 * p], power[3], 1e-5 * (1 + power[4]));
            if (c == 3) CHECK_NEAR(film.m34[2 * p + 1], power[4], 1e-5 * (1 + power[4]));
        }
    ec_film_destroy(&film);
}

/* NUMERICS A4: mean 100, standard deviation 0.1; sums of squares in float gave a negative variance here. */
static float steady(int batch, int pixel, int channel)
{
    (void)pixel, (void)channel;
    return batch % 2 ? 100.1f : 99.9f;
}

static void variance_survives_a_large_mean(void)
{
    ec_film film = filled(1000, steady);
    CHECK_NEAR(film.m2[3] / 1000, 0.01, 1e-4);
    ec_film_error error = ec_film_estimate_error(&film);
    CHECK_NEAR(error.mean_luminance, 100, 1e-4);
    CHECK_NEAR(error.error, 0.1 / sqrt(999) / 100, 1e-8);
    ec_film_destroy(&film);
}

static void resolves_mean_and_standard_error(void)
{
    ec_film film = filled(B, value);
    float rgb[3 * P], se[3 * P];
    ec_film_resolve(&film, rgb, se);
    for (int i = 0; i < 3 * P; i++) {
        CHECK(rgb[i] == (float)film.mean[i]);
        CHECK_NEAR(se[i], sqrt(film.m2[i / 3 * 4 + i % 3] / (B * (B - 1))), 1e-6);
    }
    float se_y[P];
    ec_film_resolve_luminance_error(&film, se_y);
    for (int p = 0; p < P; p++) CHECK_NEAR(se_y[p], sqrt(film.m2[p * 4 + 3] / (B * (B - 1))), 1e-6);
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
        {black, 1, 1, 0}, {black, B, 1, 0}, {grey, 1, 1, 0}, {grey, B, 0, 1},
        {one_noisy, 2, 0, 0}, {one_noisy, 3, 0, 0}, {one_noisy, B, 0, 0}, {broken, B, 0, 0},
        {huge, 2, 0, 0}, {huge, B, 0, 0}, {tiny, 2, 0, 0}, {tiny, B, 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ec_film film = filled(cases[i].batches, cases[i].f);
        ec_film_error error = ec_film_estimate_error(&film);
        CHECK_MSG(!isnan(error.error) && !isnan(error.error_bound), "case %zu", i);
        CHECK_MSG(isinf(error.error) == cases[i].infinite && isinf(error.error_bound) == cases[i].infinite,
                  "case %zu: %g %g", i, error.error, error.error_bound);
        CHECK_MSG((error.error == 0) == cases[i].zero && (error.error_bound == 0) == cases[i].zero, "case %zu", i);
        CHECK_MSG(cases[i].zero || isinf(error.error) || error.error_bound > error.error, "case %zu: %g %g", i,
                  error.error, error.error_bound);
        ec_film_destroy(&film);
    }
}

/* Two pixels known by hand: SE^2 / (x + 0.01)^2 is 0.25 / 4.01^2 in one and 0 in the others, in one channel of three. */
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
    CHECK(film.invalid_count == 4 * 3);
    for (int c = 0; c < 3; c++) CHECK(film.mean[3 * 3 + c] == 0 && film.m2[4 * 3 + c] == 0);
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
    sums_equal_two_passes();
    variance_survives_a_large_mean();
    resolves_mean_and_standard_error();
    error_never_lies_about_corner_cases();
    relmse_is_that_of_the_definition();
    invalid_values_are_counted();
    creation_fails_clearly();
    TEST_END();
}

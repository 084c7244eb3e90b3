/* tier: quick */
/* Indirect light limited by the accumulate stage, against sums in double; and the removed light in a film of several batches with different
 * units. A luminance is rounded five times, the scaled light three times more, and sums of up to 64 once for each sample. */
#include "film/clamp.h"
#include "film/pixel.h"
#include "kernel/kernel_run.h"

enum { PIXELS = 60, BATCH = 16, BATCHES = 3, WAVE = PIXELS * BATCH, SETS = 6 };

static float radiance[SETS * WAVE], film_of[EC_BATCH_FIELDS * PIXELS];

typedef struct sums {
    double rgb[3], cut, squares;
} sums;

/* Kinds of pixels: black, direct light only, indirect light only, both, an outlier of each, and one near float's maximum. */
static float sample_of(uint32_t pixel, bool indirect)
{
    const double u = test_random();
    switch (pixel % 6) {
    case 0: return 0;
    case 1: return indirect ? 0 : (float)u;
    case 2: return indirect ? (float)(0.1 / (0.001 + u)) : 0;
    case 3: return (float)(indirect ? 2 * u : u);
    case 4: return (float)(u < 0.1 ? 1e4 : u);
    default: return indirect && u < 0.1 ? 1e12f : (float)u;
    }
}

static void add_sample(const float *first, float limit, sums *s)
{
    double indirect[3], y = 0;
    static const double weights[] = {0.2126, 0.7152, 0.0722};
    for (int c = 0; c < 3; c++) y += weights[c] * (indirect[c] = (double)first[(3 + c) * WAVE]);
    const double cut = limit > 0 && y > (double)limit ? y - (double)limit : 0;
    for (int c = 0; c < 3; c++) s->rgb[c] += (double)first[c * WAVE] + indirect[c] * (cut > 0 ? (double)limit / y : 1);
    s->cut += cut;
    s->squares += cut * cut;
}

static bool run_batch(ec_cl *cl, cl_program program, float limit, sums *expected)
{
    const ec_params params = {.width = PIXELS, .height = 1, .batch = BATCH, .wave = WAVE, .part = WAVE, .apart = 1, .limit = limit};
    const uint32_t first = 0, count = PIXELS;
    static uint32_t list[EC_LIST_WORDS * PIXELS];
    for (uint32_t i = 0; i < SETS * WAVE; i++) radiance[i] = sample_of(i % WAVE / BATCH, i / WAVE >= 3);
    for (uint32_t i = 0; i < WAVE; i++) add_sample(radiance + i, limit, &expected[i / BATCH]);
    const kernel_array arrays[] = {IN(&params, 1), SCALAR(first), IN(list, EC_LIST_WORDS * PIXELS), SCALAR(count), IN(radiance, SETS * WAVE),
                                   OUT(film_of, EC_BATCH_FIELDS * PIXELS), IN((uint32_t *)NULL, 1)};
    return kernel_call(cl, program, "ec_accumulate", 64, 64, arrays, sizeof arrays / sizeof *arrays);
}

static void check_pixel(const ec_film *film, uint32_t p, const sums *s)
{
    const double n = BATCH * BATCHES, variance = fmax(s->squares - s->cut * s->cut / n, 0) / (n * (n - 1)), tolerance = 128 * 0x1p-24;
    const ec_cut cut = ec_film_cut(film, p);
    ec_pixel pixel;
    ec_film_look(film, p, 1, &pixel);
    for (int c = 0; c < 3; c++) CHECK_NEAR(pixel.mean[c], s->rgb[c] / n, tolerance * (s->rgb[c] + s->cut * 1e-3) / n);
    CHECK_NEAR(cut.mean, s->cut / n, tolerance * s->cut / n);
    CHECK_NEAR(cut.se2, variance, tolerance * s->squares / (n * (n - 1)));
}

static void check_limit(ec_cl *cl, cl_program program, float limit)
{
    static sums expected[PIXELS];
    ec_film film;
    ec_error err;
    memset(expected, 0, sizeof expected);
    CHECK_OK(ec_film_create(&film, PIXELS, 1, BATCHES, &err), err); /* replicates: all have the same weight */
    film.limit = limit;
    for (uint32_t k = 0; k < BATCHES && run_batch(cl, program, limit, expected); k++) CHECK_OK(ec_film_add(&film, k, film_of, &err), err);
    for (uint32_t r = 0; r < BATCHES; r++) film.samples[r] = BATCH; /* as the stage took them: the schedule's first batches have one sample */
    for (uint32_t p = 0; p < PIXELS; p++) check_pixel(&film, p, &expected[p]);
    ec_film_destroy(&film);
}

int main(void)
{
    ec_cl cl;
    const int opened = kernel_open(&cl);
    if (opened) return opened;
    cl_program program = kernel_build(&cl, "accumulate", 1, NULL);
    const float limits[] = {0, 1e-3f, 0.5f, 1, 1e6f};
    for (size_t i = 0; program && i < sizeof limits / sizeof *limits; i++) check_limit(&cl, program, limits[i]);
    if (program) clReleaseProgram(program);
    ec_cl_close(&cl);
    TEST_END();
}

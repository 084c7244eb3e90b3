/* tiers: quick, long */
/* A batch's fields of a pixel against sums in double: mean radiance, the samples' largest luminance, and sums of powers of luminance in
 * units of it.
 *
 * Means add floats one by one, 64 at a time: 64 roundings of half an ulp, in sums of numbers that are not negative. A luminance is rounded
 * five times, a ratio twice more; a fourth power has four times that error. */
#include "kernel/kernel_run.h"
#include "shared/params.h"

enum { WIDTH = 11, HEIGHT = 9, PIXELS = WIDTH * HEIGHT, MOST = 200, WAVE = PIXELS * MOST + 13 };

static float radiance[3 * WAVE], film[EC_BATCH_FIELDS * PIXELS];

/* Kinds of pixels, by their place in the wave: black, one lit sample, uniform, heavy-tailed, so bright that sums exceed float's range,
 * tiny, the brightest possible. */
static float sample_of(uint32_t pixel, uint32_t sample)
{
    switch (pixel % 7) {
    case 0: return 0;
    case 1: return sample == 0 ? 5 : 0;
    case 2: return 0.1f;
    case 3: return (float)(0.01 / (0.0001 + test_random()));
    case 4: return (float)(1e38 * (1 + test_random()));
    case 5: return (float)(1e-36 * (1 + test_random()));
    default: return 3.4e38f;
    }
}

static void check_pixel(const float *out, uint32_t wave, uint32_t at, uint32_t batch, uint32_t kind)
{
    double mean[3] = {0}, largest = 0, squares = 0, fourths = 0;
    for (uint32_t s = 0; s < batch; s++)
        for (uint32_t c = 0; c < 3; c++) mean[c] += (double)radiance[c * wave + at + s] / batch;
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t s = 0; s < batch; s++) {
            const double y = 0.2126 * radiance[at + s] + 0.7152 * radiance[wave + at + s] + 0.0722 * radiance[2 * wave + at + s];
            if (pass == 0) largest = fmax(largest, y);
            else if (largest > 0) squares += pow(y / largest, 2), fourths += pow(y / largest, 4);
        }
    for (int c = 0; c < 3; c++) CHECK_NEAR(out[c], mean[c], (64 + 4) * 0x1p-24 * mean[c]);
    CHECK_NEAR(out[EC_BATCH_LARGEST], largest, 8 * 0x1p-24 * largest);
    CHECK_NEAR(out[EC_BATCH_SQUARES], squares, (batch + 32) * 0x1p-24 * squares);
    CHECK_NEAR(out[EC_BATCH_FOURTHS], fourths, (batch + 64) * 0x1p-24 * fourths);
    for (int k = 0; k < EC_BATCH_FIELDS; k++) CHECK(isfinite(out[k]) && (kind || out[k] == 0));
    if (kind == 1) CHECK(out[EC_BATCH_SQUARES] == 1 && out[EC_BATCH_FOURTHS] == 1);
}

/* Index in row order of pixel `number`. Tiles are 8 x 8, in rows of tiles, and smaller at the right and bottom edges. */
static uint32_t place_of(uint32_t number)
{
    const uint32_t tile_row = number / (8 * WIDTH), in_row = number % (8 * WIDTH), rows = HEIGHT - 8 * tile_row < 8 ? HEIGHT - 8 * tile_row : 8;
    const uint32_t tile = in_row / (8 * rows), in_tile = in_row % (8 * rows), columns = WIDTH - 8 * tile < 8 ? WIDTH - 8 * tile : 8;
    return (8 * tile_row + in_tile / columns) * WIDTH + 8 * tile + in_tile % columns;
}

/* Takes a wave of `count` pixels of the picture from number `first` on, or of entries of a list, whose batch film is by entry. Other pixels
 * stay as they are. */
static void check_wave(ec_cl *cl, cl_program program, uint32_t batch, uint32_t first, uint32_t count, bool has_list)
{
    static uint32_t list[EC_LIST_WORDS * PIXELS];
    static bool is_of_wave[PIXELS];
    const uint32_t wave = count * batch + 13; /* more room than needed */
    const ec_params params = {.width = WIDTH, .height = HEIGHT, .batch = batch, .wave = wave, .part = wave};
    for (uint32_t i = 0; i < count * batch; i++) {
        const float x = sample_of(i / batch, i % batch);
        for (uint32_t c = 0; c < 3; c++) radiance[c * wave + i] = (c && i / batch % 7 != 6 ? 0.5f : 1) * x;
    }
    for (int i = 0; i < EC_BATCH_FIELDS * PIXELS; i++) film[i] = -7;
    const kernel_array arrays[] = {IN(&params, 1), SCALAR(first), IN(has_list ? list : NULL, EC_LIST_WORDS * PIXELS), SCALAR(count),
                                   IN(radiance, 3 * wave), OUT(film, EC_BATCH_FIELDS * PIXELS), IN((uint32_t *)NULL, 1)};
    if (!kernel_call(cl, program, "ec_accumulate", (count + 63) / 64 * 64, 64, arrays, sizeof arrays / sizeof *arrays)) return;
    memset(is_of_wave, 0, sizeof is_of_wave);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t place = has_list ? first + i : place_of(first + i);
        check_pixel(film + EC_BATCH_FIELDS * place, wave, i * batch, batch, i % 7);
        is_of_wave[place] = true;
    }
    for (uint32_t i = 0; i < PIXELS; i++)
        for (uint32_t k = 0; k < EC_BATCH_FIELDS && !is_of_wave[i]; k++) CHECK(film[EC_BATCH_FIELDS * i + k] == -7);
}

static void check_width(ec_cl *cl, int lanes)
{
    cl_program program = kernel_build(cl, "accumulate", lanes, NULL);
    const uint32_t batches[] = {1, 2, 4, 64, 65, MOST};
    for (size_t i = 0; program && i < sizeof batches / sizeof *batches; i++) {
        check_wave(cl, program, batches[i], 0, PIXELS, false);
        check_wave(cl, program, batches[i], 30, 41, false);
        check_wave(cl, program, batches[i], 7, 50, true);
    }
    if (program) clReleaseProgram(program);
}

int main(void)
{
    ec_cl cl;
    const int opened = kernel_open(&cl);
    if (opened) return opened;
    for (int i = 0; i < kernel_widths(&cl); i++) check_width(&cl, lane_widths[i]);
    ec_cl_close(&cl);
    TEST_END();
}

/* tiers: quick, long */
/* Light of light paths in the pixels that it reaches, against sums in double. Amounts below one step are rounded up with a probability of
 * their size; sums over 32 bits carry; bits do not depend on order or width; slots are empty afterwards; slots after the last path are left
 * out. */
#include "kernel/kernel_run.h"
#include "shared/params.h"
#include "shared/path_state.h"

enum { PATHS = 1 << 15, PIXELS = 5 };
static const float unit = 0x1p-20f;

static float radiance[3 * PATHS], slots[EC_LIGHT_SLOT_FIELDS * PATHS];
static uint32_t splats[EC_SPLAT_WORDS * PIXELS], again[EC_SPLAT_WORDS * PIXELS];

/* Steps from a path to a pixel: a fraction of one, some, more than a word holds, none, from a few to all of 2^24. */
static float steps_of(uint32_t path)
{
    switch (path % PIXELS) {
    case 0: return 0.125f;
    case 1: return (float)(100 * test_random());
    case 2: return 0x1p31f + 0x1p20f * (float)(path % 7);
    case 3: return 0;
    default: return floorf((float)exp2(24 * test_random()));
    }
}

static void fill(double sums[PIXELS], float largest[PIXELS])
{
    for (uint32_t i = 0; i < PATHS; i++) {
        const uint32_t pixel = i % PIXELS;
        const float value = steps_of(i) * unit;
        memcpy(&slots[EC_LIGHT_SLOT_PIXEL * PATHS + i], &pixel, sizeof pixel);
        for (int c = 0; c < 3; c++) radiance[c * PATHS + i] = value;
        sums[pixel] += (double)value / unit;
        largest[pixel] = fmaxf(largest[pixel], 0.2126f * value + 0.7152f * value + 0.0722f * value);
    }
}

static bool run(ec_cl *cl, cl_program program, uint32_t lanes, uint32_t count, uint32_t *out)
{
    const ec_params params = {.batch = 4, .wave = PATHS, .part = PATHS, .splat_unit = unit};
    const uint32_t seed = 7, first = 0, bounce = EC_LIGHT_BOUNCE;
    memset(out, 0, sizeof splats);
    const kernel_array arrays[] = {IN(&params, 1), SCALAR(seed), SCALAR(first), SCALAR(bounce), SCALAR(count), OUT(radiance, 3 * PATHS),
                                   IN(slots, EC_LIGHT_SLOT_FIELDS * PATHS), OUT(out, EC_SPLAT_WORDS * PIXELS)};
    return kernel_call(cl, program, "ec_splat", PATHS / lanes, 64, arrays, sizeof arrays / sizeof *arrays);
}

/* Three paths fewer than there are slots with light: as if these three had no light. */
static void widths_agree(ec_cl *cl, cl_program one, const float *light)
{
    enum { COUNT = PATHS - 3 };
    static uint32_t wide[EC_SPLAT_WORDS * PIXELS];
    memcpy(radiance, light, sizeof radiance);
    for (int c = 0; c < 3; c++) memset(radiance + c * PATHS + COUNT, 0, 3 * sizeof *radiance);
    if (!run(cl, one, 1, PATHS, again)) return;
    const int widths = kernel_widths(cl);
    for (int w = 0; w < widths; w++) {
        const int lanes = lane_widths[w];
        cl_program program = kernel_build(cl, "splat", lanes, NULL);
        memcpy(radiance, light, sizeof radiance);
        if (program && run(cl, program, (uint32_t)lanes, COUNT, wide)) {
            CHECK_MSG(!memcmp(wide, again, sizeof wide), "%d lanes", lanes);
            for (uint32_t i = 0; i < 3 * PATHS; i++) CHECK(i % PATHS >= COUNT || radiance[i] == 0);
        }
        if (program) clReleaseProgram(program);
    }
}

int main(void)
{
    ec_cl cl;
    const int opened = kernel_open(&cl);
    if (opened) return opened;
    cl_program program = kernel_build(&cl, "splat", 1, NULL);
    double sums[PIXELS] = {0};
    float largest[PIXELS] = {0};
    fill(sums, largest);
    static float before[3 * PATHS];
    memcpy(before, radiance, sizeof before);
    if (program && run(&cl, program, 1, PATHS, splats)) {
        for (int i = 0; i < 3 * PATHS; i++) CHECK(radiance[i] == 0);
        for (int p = 0; p < PIXELS; p++) {
            const uint32_t *w = splats + EC_SPLAT_WORDS * p;
            float most;
            memcpy(&most, &w[EC_SPLAT_LARGEST], sizeof most);
            CHECK_NEAR(most, largest[p], 4 * 0x1p-24 * largest[p]);
            for (int c = 0; c < 3; c++) { /* five standard deviations of so many roundings: at most half a step each */
                const double sum = w[2 * c] + 0x1p32 * w[2 * c + 1];
                CHECK_NEAR(sum, sums[p], p == 3 ? 0 : 5 * 0.5 * sqrt(PATHS / PIXELS));
            }
        }
        CHECK(splats[EC_SPLAT_WORDS * 2 + 1] > 1000); /* some sums did carry */
        memcpy(radiance, before, sizeof before);
        if (run(&cl, program, 1, PATHS, again)) CHECK(!memcmp(splats, again, sizeof splats));
        widths_agree(&cl, program, before);
    }
    if (program) clReleaseProgram(program);
    ec_cl_close(&cl);
    TEST_END();
}

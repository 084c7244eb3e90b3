/* tiers: quick, long */
/* Directions of light scattered inside a body, against the Henyey-Greenstein distribution by chi-square. Cells of equal probability come
 * from its closed form in double precision, which also gives each sample's density. */
#include "kernel/chi2.h"

enum { RINGS = 40, SECTORS = 12, CELLS = RINGS * SECTORS };

/* Squared third side of a triangle of 1 and g, with an angle between them whose cosine is 1 - fall and rise - 1. */
static double far2(double g, double fall, double rise)
{
    return g < 0 ? (1 + g) * (1 + g) - 2 * g * rise : (1 - g) * (1 - g) + 2 * g * fall;
}

/* Probability of a cosine at least as large. */
static double above(double g, double fall, double rise)
{
    return g == 0 ? fall / 2 : 1 - (1 - g * g) / (2 * g) * (1 / sqrt(far2(g, fall, rise)) - 1 / (1 + g));
}

static void check_phase(cl_program program, int lanes, double g, const double d[3])
{
    const float along[3] = {(float)d[0], (float)d[1], (float)d[2]}, one = (float)g;
    double s[3] = {d[1], -d[0], 0}, length = hypot(s[0], s[1]), expected[CELLS];
    uint32_t count[CELLS] = {0}, wrong = 0;
    char name[80];
    snprintf(name, sizeof name, "g %g about (%g, %g, %g), LANES %d", g, d[0], d[1], d[2], lanes);
    if (!KERNEL_CALL(&cl, program, "phase_samples", samples / (uint32_t)lanes, SCALAR(samples), SCALAR(seed), SCALAR(one), IN(along, 3),
                     OUT(out, 4 * SAMPLES)))
        return;
    if (length == 0) s[0] = length = 1;
    const double t[3] = {d[1] * s[2] - d[2] * s[1], d[2] * s[0] - d[0] * s[2], d[0] * s[1] - d[1] * s[0]};
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double fall = 0, rise = 0, x = 0, y = 0;
        for (int k = 0; k < 3; k++) {
            const double w = out[(uint32_t)k * SAMPLES + i];
            fall += (w - (double)along[k]) * (w - (double)along[k]) / 2;
            rise += (w + (double)along[k]) * (w + (double)along[k]) / 2;
            x += w * s[k] / length;
            y += w * t[k] / length;
        }
        const double ring = above(g, fall, rise), sector = atan2(y, x) / (2 * pi) + 0.5;
        wrong += fabs(out[3 * SAMPLES + i] * 4 * pi * pow(far2(g, fall, rise), 1.5) / (1 - g * g) - 1) > 1e-3;
        count[(uint32_t)fmin(fmax(ring, 0) * RINGS, RINGS - 1) * SECTORS + (uint32_t)fmin(sector * SECTORS, SECTORS - 1)]++;
    }
    for (int i = 0; i < CELLS; i++) expected[i] = (double)SAMPLES / CELLS;
    check_chi2(name, expected, count, CELLS);
    CHECK_MSG(wrong == 0, "%s: %u samples have another density", name, wrong);
}

int main(void)
{
    static const double along[2][3] = {{0, 0, 1}, {0.48, -0.6, -0.64}}, forward[] = {-0.99, -0.4, 1e-4, 0, 0.85, 0.999};
    static cl_program programs[LANE_WIDTHS];
    int open = kernel_open(&cl);
    if (open) return open;
    chi2_build(programs, NULL);
    const int last = kernel_widths(&cl) - 1;
    for (size_t i = 0; i < sizeof forward / sizeof *forward; i++) check_phase(programs[last], lane_widths[last], forward[i], along[i % 2]);
    for (int i = 0; i < last; i++) check_phase(programs[i], lane_widths[i], 0.7, along[1]);
    CHECK(tests <= TESTS);
    chi2_release(programs);
    ec_cl_close(&cl);
    TEST_END();
}

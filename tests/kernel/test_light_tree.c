/* tiers: quick, long */
/* The light tree's probabilities, for each lamp and point: they add up to the share of all lamps, are those of the samples, are equal when
 * found from the lamp's trail, and are never 0 for a lamp that shines on the point. A ball and a panel among the lamps are bulbs. Numbers
 * are uniform after they have chosen. */
#include "kernel/chi2.h"
#include "pack/light_tree.h"

#define LAMPS 1024
#define POINTS 48

static ec_light_data lamps[LAMPS];
static ec_light_bounds bounds[LAMPS];
static ec_light_node nodes[3 * LAMPS];
static const ec_bulb bulbs[] = {{301, 151}, {600, 64}};
static uint32_t trails[LAMPS], ids[LAMPS], chosen[SAMPLES];
static float points[3 * POINTS], pmf[LAMPS], first_pmf[POINTS][LAMPS];

/* Triangles of all sizes and powers in clusters, some two-sided, some equal; with points and spots among them. */
static void make_lamps(void)
{
    for (int i = 0; i < LAMPS; i++) {
        ec_light_data *l = &lamps[i];
        double cluster[3] = {i % 7, i % 3, i % 5}, size = pow(10, test_random_in(-4, 0));
        l->kind = i % 11 == 0 ? EC_KIND_POINT : i % 13 == 0 ? EC_KIND_SPOT : EC_KIND_TRIANGLE | (i % 4 == 0 ? EC_LIGHT_TWO_SIDED : 0);
        for (int k = 0; k < 3; k++) {
            l->a[k] = (float)(cluster[k] + test_random_in(-0.4, 0.4));
            l->b[k] = (float)(l->a[k] + size * test_random_in(-1, 1));
            l->c[k] = (float)(l->a[k] + size * test_random_in(-1, 1));
        }
        if (i > 900) *l = lamps[900]; /* lamps that no split can separate */
        if (l->kind == EC_KIND_SPOT) {
            double length = sqrt(pow(l->b[0], 2) + pow(l->b[1], 2) + pow(l->b[2], 2));
            for (int k = 0; k < 3; k++) l->b[k] = (float)(l->b[k] / length);
            l->c[1] = (float)test_random_in(0, 0.99);
        }
        bounds[i] = ec_light_bounds_of(l, pow(10, test_random_in(-6, 2)));
        ids[i] = (uint32_t)i;
    }
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            points[3 * i + k] = i == 9 ? 3 : i == 10 ? 3.3f : i < 4 ? lamps[i * 30].a[k] : i < 8 ? (float)test_random_in(-1e4, 1e4) : (float)test_random_in(-1, 7);
}

/* A ball of pairs, and one lamp more; a panel of equal ones. Sizes differ by a factor of a thousand. */
static void make_bulbs(void)
{
    for (uint32_t i = 0; i < 151; i++) {
        ec_light_data *l = &lamps[301 + i];
        const ec_light_data *other = l - 1;
        const double size = pow(10, test_random_in(-3, 0)), towards[3] = {test_random_in(-1, 1), test_random_in(-1, 1), test_random_in(-1, 1)};
        double n[3], length = 0;
        for (int k = 0; k < 3; k++) length += towards[k] * towards[k];
        for (int k = 0; k < 3; k++) n[k] = towards[k] / sqrt(length);
        *l = (ec_light_data){.kind = EC_KIND_TRIANGLE | (i == 150 ? 0 : i % 2 ? EC_LIGHT_PAIR_SECOND : EC_LIGHT_PAIR_FIRST)};
        for (int k = 0; k < 3; k++) { /* corners at n and beside it, so that it faces outwards; the partner is on the other side */
            const double u = n[(k + 1) % 3] * 0.3 - n[(k + 2) % 3] * 0.5, at = 3 + 0.2 * n[k];
            l->a[k] = (float)at;
            l->b[k] = (float)(at + 0.1 * size * u);
            l->c[k] = (float)(at + 0.1 * size * (n[(k + 2) % 3] * n[(k + 1) % 3] - u));
            if (i % 2) l->a[k] = 6 - other->a[k], l->b[k] = 6 - other->c[k], l->c[k] = 6 - other->b[k];
        }
        bounds[301 + i] = ec_light_bounds_of(l, i % 2 ? bounds[300 + i].power : size * size);
    }
    for (uint32_t i = 0; i < 64; i++) {
        ec_light_data *l = &lamps[600 + i];
        *l = (ec_light_data){.kind = EC_KIND_TRIANGLE, .a = {i % 8 * 0.1f, i / 8 * 0.1f, 5}};
        for (int k = 0; k < 3; k++) l->b[k] = l->a[k] + (k == 1) * 0.1f, l->c[k] = l->a[k] + (k == 0) * 0.1f; /* faces most points */
        bounds[600 + i] = ec_light_bounds_of(l, 10);
    }
}

/* Tells whether it shines on p, with a cosine above rounding error. */
static bool shines_on(const ec_light_data *l, const float *p)
{
    double e[3], f[3], w[3], n[3], d2 = 0, along = 0, n2 = 0;
    uint32_t kind = l->kind & EC_LIGHT_KIND_MASK;
    for (int k = 0; k < 3; k++) e[k] = (double)l->b[k] - l->a[k], f[k] = (double)l->c[k] - l->a[k], w[k] = (double)p[k] - l->a[k];
    for (int k = 0; k < 3; k++) {
        n[k] = kind == EC_KIND_SPOT ? (double)l->b[k] : e[(k + 1) % 3] * f[(k + 2) % 3] - e[(k + 2) % 3] * f[(k + 1) % 3];
        along += n[k] * w[k], d2 += w[k] * w[k], n2 += n[k] * n[k];
    }
    double cosine = along / sqrt(d2 * n2);
    if (kind == EC_KIND_POINT) return d2 > 0;
    if (kind == EC_KIND_SPOT) return cosine > (double)l->c[1];
    return (l->kind & EC_LIGHT_TWO_SIDED ? fabs(cosine) : cosine) > 1e-6;
}

static void check_point(cl_program program, int lanes, uint32_t which, uint32_t *unlit)
{
    static double expected[LAMPS];
    static uint32_t count[LAMPS];
    /* All of 2^31 numbers, or a subset of odd size. */
    uint32_t width = (uint32_t)lane_widths[lanes], n = LAMPS, other = 0, numbers = which % 4 ? 1u << 31 : 1234567891;
    const double whole = numbers * 0x1p-31;
    if (!KERNEL_CALL(&cl, program, "probabilities", LAMPS / width, SCALAR(n), IN((float *)lamps, EC_LIGHT_WORDS * LAMPS), IN((float *)nodes, sizeof nodes / 4), IN(trails, LAMPS),
                     IN(points, 3 * POINTS), SCALAR(which), SCALAR(numbers), OUT(pmf, LAMPS)))
        return;
    if (!lanes) memcpy(first_pmf[which], pmf, sizeof pmf);
    CHECK_MSG(!memcmp(first_pmf[which], pmf, sizeof pmf), "point %u: other bits with %u lanes", which, width);
    double sum = 0;
    for (int i = 0; i < LAMPS; i++) {
        sum += pmf[i];
        expected[i] = (double)pmf[i] / whole * SAMPLES;
        count[i] = 0;
        *unlit += pmf[i] == 0;
        CHECK_MSG(pmf[i] > 0 || !shines_on(&lamps[i], points + 3 * which), "lamp %d shines on point %u and is never chosen", i, which);
    }
    CHECK_MSG(fabs(sum / whole - 1) < 1e-6, "point %u: probabilities add up to 1 %+.2g", which, sum / whole - 1);
    if (which % 6 || !KERNEL_CALL(&cl, program, "choices", samples / width, SCALAR(samples), SCALAR(seed), IN((float *)lamps, EC_LIGHT_WORDS * LAMPS), IN((float *)nodes, sizeof nodes / 4),
                                  IN(trails, LAMPS), IN(points, 3 * POINTS), SCALAR(which), SCALAR(numbers), OUT(chosen, SAMPLES), OUT(out, 3 * SAMPLES)))
        return;
    uint32_t tenths[10] = {0};
    const double even[10] = {SAMPLES / 10.0, SAMPLES / 10.0, SAMPLES / 10.0, SAMPLES / 10.0, SAMPLES / 10.0,
                             SAMPLES / 10.0, SAMPLES / 10.0, SAMPLES / 10.0, SAMPLES / 10.0, SAMPLES / 10.0};
    for (uint32_t i = 0; i < SAMPLES; i++) {
        const float left = out[2 * SAMPLES + i];
        CHECK(chosen[i] < LAMPS && left >= 0 && left < 1);
        if (chosen[i] >= LAMPS || !(left >= 0 && left < 1)) return;
        count[chosen[i]]++;
        tenths[(int)(left * 10)]++;
        other += out[i] != out[SAMPLES + i] || out[i] != pmf[chosen[i]];
    }
    CHECK_MSG(!other, "point %u: %u samples of another probability than their trail's", which, other);
    char name[64];
    snprintf(name, sizeof name, "light tree, point %u, %u lanes", which, width);
    check_chi2(name, expected, count, LAMPS);
    check_chi2("what is left of the numbers", even, tenths, 10);
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    ec_error err = {0};
    make_lamps();
    make_bulbs();
    const ec_light_set set = {LAMPS, bounds, ids, 2, bulbs};
    CHECK(ec_light_tree_nodes(&set) == 2 * LAMPS - 1 + 26 + 11 && 2 * LAMPS + 36 < sizeof nodes / sizeof *nodes);
    CHECK_OK(ec_light_tree_build(&set, nodes, trails, &err), err);
    int widths = kernel_widths(&cl);
    uint32_t unlit = 0;
    for (int i = 0; i < widths; i++) {
        cl_program program = kernel_build(&cl, "light_tree", lane_widths[i], NULL);
        for (uint32_t p = 0; program && p < POINTS; p++) check_point(program, i, p, &unlit);
        if (program) clReleaseProgram(program);
    }
    printf("%d chi-square tests; %.1f %% of lamps are known to be dark\n", tests, 100.0 * unlit / (LAMPS * POINTS * widths));
    CHECK(unlit > LAMPS * POINTS / 20); /* dark lamps are reported */
    ec_cl_close(&cl);
    TEST_END();
}

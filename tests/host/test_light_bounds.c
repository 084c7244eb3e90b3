/* tier: quick */
/* Cones of lamps: the narrowest cone about two, which contains both; the cost of a cluster by the paper's formula. */
#include "base/random.h"
#include "base/vec3.h"
#include "pack/light_bounds.h"
#include "support/test.h"

static const double pi = 3.14159265358979323846;
enum { PAIRS = 20000, CLUSTERS = 200, LAMPS = 100 };
#define ROUNDING 1e-7 /* radians: a cosine near 1 gives an angle to the square root of 2^-53 */

static double angle_between(const double a[3], const double b[3])
{
    double c[3];
    ec_cross(a, b, c);
    return atan2(sqrt(ec_dot(c, c)), ec_dot(a, b));
}

/* A direction at this angle from the z axis; any direction for angles over pi. */
static ec_light_bounds lamp_at(double angle, double spread, uint64_t *random)
{
    const double z = angle > pi ? 2 * ec_random_unit(random) - 1 : cos(angle), r = angle > pi ? sqrt(1 - z * z) : sin(angle), phi = 2 * pi * ec_random_unit(random);
    return (ec_light_bounds){.axis = {r * cos(phi), r * sin(phi), z}, .cos_spread = spread >= pi ? -1 : cos(spread), .power = 1};
}

static double spread_of(const ec_light_bounds *b) { return acos(fmax(b->cos_spread, -1)); }

static bool holds(const ec_light_bounds *all, const ec_light_bounds *one)
{
    return all->cos_spread <= -1 || angle_between(all->axis, one->axis) + spread_of(one) <= spread_of(all) + 3 * ROUNDING;
}

static double some_spread(uint64_t *random)
{
    const double u = ec_random_unit(random);
    return u < 0.25 ? 0 : u < 0.5 ? 1e-3 * ec_random_unit(random) : u < 0.95 ? pi * ec_random_unit(random) : pi;
}

static void pairs_are_as_narrow_as_can_be(void)
{
    uint64_t random = 3;
    int wide = 0, within = 0, all_ways = 0;
    for (int i = 0; i < PAIRS; i++) {
        const double away = i % 4 == 0 ? 1e-4 * ec_random_unit(&random) : i % 4 == 1 ? pi - 1e-4 * ec_random_unit(&random) : 4;
        const ec_light_bounds a = lamp_at(0, some_spread(&random), &random), b = lamp_at(away, some_spread(&random), &random);
        const double sa = spread_of(&a), sb = spread_of(&b), angle = angle_between(a.axis, b.axis), larger = fmax(sa, sb);
        const double expected = angle + fmin(sa, sb) <= larger ? larger : fmin(0.5 * (sa + angle + sb), pi);
        ec_light_bounds both = a;
        ec_light_bounds_add(&both, &b);
        CHECK_MSG(fabs(both.cos_spread - cos(expected)) <= ROUNDING, "%g and %g, %g apart: %.9g, not %.9g", sa, sb, angle, spread_of(&both), expected);
        CHECK_MSG(holds(&both, &a) && holds(&both, &b), "%g and %g, %g apart: one is left out", sa, sb, angle);
        wide += expected > 0.5 * pi && expected < pi, within += expected == larger, all_ways += expected == pi;
    }
    CHECK(wide > 1000 && within > 1000 && all_ways > 500); /* every kind occurs */
}

static void clusters_hold_their_lamps(void)
{
    uint64_t random = 5;
    for (int i = 0; i < CLUSTERS; i++) {
        ec_light_bounds lamps[LAMPS], all = {.power = 0};
        const double reach = (i + 1) * pi / CLUSTERS;
        for (int k = 0; k < LAMPS; k++) {
            lamps[k] = lamp_at(reach * ec_random_unit(&random), k % 3 ? 0 : 0.1 * reach * ec_random_unit(&random), &random);
            ec_light_bounds_add(&all, &lamps[k]);
        }
        for (int k = 0; k < LAMPS; k++) CHECK_MSG(holds(&all, &lamps[k]), "%d lamps within %g: the one at %g is out", LAMPS, reach, acos(lamps[k].axis[2]));
    }
}

/* Conty Estevez and Kulla 2018, equation 1, with lamps that emit by the cosine; the size is the squared diagonal. */
static void costs_are_the_papers(void)
{
    for (int i = 0; i <= 1000; i++) {
        const double o = pi * i / 1000, w = fmin(o + 0.5 * pi, pi);
        const double measure = 2 * pi * (1 - cos(o)) + 0.5 * pi * (2 * w * sin(o) - cos(o - 2 * w) - 2 * o * sin(o) + cos(o));
        const ec_light_bounds b = {.high = {1, 2, 3}, .axis = {0, 0, 1}, .cos_spread = cos(o), .power = 0.5};
        CHECK_MSG(fabs(ec_light_bounds_cost(&b) - 7 * measure) <= 1e-6 * measure, "spread %g: %.9g, not %.9g", o, ec_light_bounds_cost(&b), 7 * measure);
    }
}

int main(void)
{
    pairs_are_as_narrow_as_can_be();
    clusters_hold_their_lamps();
    costs_are_the_papers();
    TEST_END();
}

#include "pack/light_bounds.h"

#include <math.h>
#include <string.h>

#include "base/vec3.h"

#define PI 3.14159265358979323846

static void take_point(ec_light_bounds *b, const float p[3])
{
    for (int k = 0; k < 3; k++) {
        b->low[k] = ec_lesser(b->low[k], (double)p[k]);
        b->high[k] = ec_greater(b->high[k], (double)p[k]);
    }
}

static void set_axis(ec_light_bounds *b, const double axis[3], double cos_spread)
{
    double length = sqrt(ec_dot(axis, axis));
    bool usable = length > 0 && isfinite(length);
    for (int k = 0; k < 3; k++) b->axis[k] = usable ? axis[k] / length : k == 2;
    b->cos_spread = usable ? cos_spread : -1;
}

ec_light_bounds ec_light_bounds_of(const ec_light_data *light, double power)
{
    ec_light_bounds b = {.power = power};
    uint32_t kind = light->kind & EC_LIGHT_KIND_MASK;
    for (int k = 0; k < 3; k++) b.low[k] = b.high[k] = light->a[k];
    set_axis(&b, (double[3]){0, 0, 1}, -1);
    if (kind == EC_KIND_SPOT) set_axis(&b, (double[3]){light->b[0], light->b[1], light->b[2]}, light->c[1]); /* the outer cone */
    if (kind != EC_KIND_TRIANGLE) return b;
    double normal[3];
    take_point(&b, light->b);
    take_point(&b, light->c);
    ec_triangle_normal(light->a, light->b, light->c, normal);
    set_axis(&b, normal, 1);
    b.two_sided = light->kind & EC_LIGHT_TWO_SIDED;
    return b;
}

static double sine_of(double cosine) { return sqrt(ec_greater(1 - cosine * cosine, 0)); }

/* Finds the narrowest cone around two: half the sum of their spreads and the angle between them. Uses cosines and sines, as angles would take most of
 * the time of building a tree. */
static void join_cones(ec_light_bounds *a, const ec_light_bounds *b)
{
    if (a->cos_spread <= -1) return; /* already all directions, as in large clusters */
    const double between = ec_lesser(ec_greater(ec_dot(a->axis, b->axis), -1), 1), ca = a->cos_spread, cb = b->cos_spread;
    if (cb >= 1 && between >= ca) return; /* b is a single direction within a */
    const double sa = sine_of(ca), sb = sine_of(cb);
    if (cb <= -1 || between >= ca * cb + sa * sb) { /* one contains the other */
        if (cb >= ca) return;
        memcpy(a->axis, b->axis, sizeof a->axis);
        a->cos_spread = cb;
        return;
    }
    double aside[3], axis[3]; /* from a's axis towards b's, as long as the sine of their angle, which the cosine tells badly if they are nearly opposite */
    for (int k = 0; k < 3; k++) aside[k] = b->axis[k] - between * a->axis[k];
    const double apart = sqrt(ec_dot(aside, aside));
    const double cos_both = ca * cb - sa * sb, sin_both = sa * cb + ca * sb, cosine = cos_both * between - sin_both * apart, sine = sin_both * between + cos_both * apart;
    const bool is_all = sin_both <= 0 && cos_both < 1 && between <= cos_both; /* both spreads and the angle add up to two pi */
    const double half = sqrt(ec_greater(0.5 * (1 + cosine), 0)), c = sine < 0 ? -half : half, s = sqrt(ec_greater(0.5 * (1 - cosine), 0));
    if (is_all || !(apart > 1e-9)) {
        set_axis(a, a->axis, between > 0 && !is_all ? c : -1);
        return;
    }
    const double along = c * ca + s * sa, across = (s * ca - c * sa) / apart; /* a's axis, turned towards b's until a's edge is the cone's */
    for (int k = 0; k < 3; k++) axis[k] = along * a->axis[k] + across * aside[k];
    set_axis(a, axis, c);
}

void ec_light_bounds_add(ec_light_bounds *to, const ec_light_bounds *other)
{
    if (!(other->power > 0)) return;
    if (!(to->power > 0)) {
        *to = *other;
        return;
    }
    for (int k = 0; k < 3; k++) {
        to->low[k] = ec_lesser(to->low[k], other->low[k]);
        to->high[k] = ec_greater(to->high[k], other->high[k]);
    }
    join_cones(to, other);
    to->power += other->power;
    to->two_sided |= other->two_sided;
}

double ec_light_bounds_size2(const ec_light_bounds *b)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += (b->high[k] - b->low[k]) * (b->high[k] - b->low[k]);
    return sum;
}

/* Uses the squared diagonal instead of the box's surface, so that lamps in a row or at points have a size too. */
double ec_light_bounds_cost(const ec_light_bounds *b)
{
    if (!(b->power > 0)) return 0;
    const double co = b->cos_spread, so = sine_of(co);
    const double spread = 2 * PI * (1 - co) + (co >= 0 ? 0.5 * PI * (PI * so + 2 * co) : PI * (PI - acos(co)) * so);
    return b->power * spread * ec_light_bounds_size2(b);
}

/* fmax: without any power the share is NaN. */
ec_light_node ec_light_bounds_node(const ec_light_bounds *b, double most_power)
{
    ec_light_node node = {.power = (float)fmax(b->power / most_power, 1e-30), .flags = b->two_sided ? EC_LIGHT_NODE_TWO_SIDED : 0};
    double radius2 = 0, co = fmax(b->cos_spread - 1e-6, -1);
    for (int k = 0; k < 3; k++) {
        node.centre[k] = (float)(0.5 * (b->low[k] + b->high[k]));
        double reach = fmax(b->high[k] - node.centre[k], node.centre[k] - b->low[k]);
        radius2 += reach * reach;
        node.axis[k] = (float)b->axis[k];
    }
    /* Beyond a right angle, the back sides of two-sided lamps are in the cone as well. */
    if (b->two_sided && co < 0) co = -1;
    node.radius2 = (float)(radius2 * (1 + 1e-6));
    node.cos_spread = (float)co;
    node.sin_spread = (float)sqrt(fmax(1 - co * co, 0));
    return node;
}

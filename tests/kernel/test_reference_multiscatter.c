/* tier: full */
/* Multiple scattering between facets (--scattering multiple): its table against quadrature, its value against Kulla and Conty's formula in
 * double, reciprocity, and the energy with and without it. */
#include "kernel/layers_reference.h"
#define constant static const
#include "lib/multiscatter_table.h"

static const float *const table = multiscatter_table;
static cl_program single; /* without it, LANES 8 */

/* ---- the table ---- */

static double interpolated(double roughness, double contrast, double column)
{
    double place[3] = {(copysign(sqrt(fabs(contrast)), contrast) + 1) / 2 * (MULTISCATTER_CONTRASTS - 1), roughness * (MULTISCATTER_ROUGHNESSES - 1), column};
    int most[3] = {MULTISCATTER_CONTRASTS - 2, MULTISCATTER_ROUGHNESSES - 2, MULTISCATTER_COSINES}, node[3];
    double sum = 0;
    for (int k = 0; k < 3; k++) node[k] = (int)fmin(floor(place[k]), most[k]), place[k] -= node[k];
    for (int corner = 0; corner < 8; corner++) {
        double weight = 1;
        int at = 0;
        for (int k = 0; k < 3; k++) {
            int next = corner >> k & 1;
            weight *= next ? place[k] : 1 - place[k];
            at = at * (k == 0 ? MULTISCATTER_CONTRASTS : k == 1 ? MULTISCATTER_ROUGHNESSES : MULTISCATTER_COSINES + 1) + node[k] + next;
        }
        if (weight > 0) sum += weight * (double)table[at];
    }
    return sum;
}

static double lost(double roughness, double eta, double cosine)
{
    double x = sqrt(cosine) * (MULTISCATTER_COSINES - 1);
    return interpolated(roughness, (eta - 1) / (eta + 1), fmin(x, MULTISCATTER_COSINES - 1));
}
static double lost_mean(double roughness, double eta) { return interpolated(roughness, (eta - 1) / (eta + 1), MULTISCATTER_COSINES); }

static double fresnel(double c, double eta)
{
    double g2 = c * c + eta * eta - 1, g = sqrt(fmax(g2, 0));
    if (g2 <= 0) return 1;
    double s = (c - eta * g / eta) / (c + g), p = (eta * eta * c - g) / (eta * eta * c + g);
    return 0.5 * (s * s + p * p);
}

static double masking(double z, double alpha) { return sqrt(alpha * alpha + (1 - alpha * alpha) * z * z); }
static double seen(double z, double cosine, double alpha) /* G2 / G1 */
{
    return z > 0 ? z * (cosine + masking(cosine, alpha)) / (z * masking(cosine, alpha) + cosine * masking(z, alpha)) : 0;
}

/* Loss of white light over visible normals by spherical caps (Dupuy, Benyoub 2023). Root: the cap's own at its ends. */
static double quadrature(double roughness, double eta, double cosine)
{
    enum { STEPS = 400 };
    double alpha = roughness * roughness, sum = 0, weights = 0, sine = sqrt(1 - cosine * cosine), length = hypot(sine * alpha, cosine);
    double wx = sine * alpha / length, wz = cosine / length;
    for (int i = 0; i < STEPS; i++) {
        double s = (i + 0.5) / STEPS, weight = s * (1 - s), down = s * s * (3 - 2 * s) * (1 + wz), st = sqrt(fmax(down * (2 - down), 0));
        for (int j = 0; j < STEPS; j++) {
            double angle = pi * (j + 0.5) / STEPS, m[3] = {(st * cos(angle) + wx) * alpha, st * sin(angle) * alpha, 1 + wz - down};
            double size = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]), mz = m[2] / size, om = fmax(sine * m[0] / size + cosine * mz, 0);
            double back = seen(2 * om * mz - cosine, cosine, alpha), part = back;
            if (eta > 0) {
                double f = fresnel(om, eta), g = sqrt(fmax(om * om + eta * eta - 1, 0));
                part = f * back + (1 - f) * seen(((g - om) * mz + cosine) / eta, cosine, alpha);
            }
            sum += weight * part, weights += weight;
        }
    }
    return 1 - sum / weights;
}

static void table_is_right(void)
{
    double over = -1, under = 0, wide = 0;
    for (int i = 0; i < 160; i++) {
        double roughness = test_random_in(0.03, 1), cosine = pow(test_random_in(0.1, 1), 2), eta = i % 4 == 0 ? 0 : exp(test_random_in(-1.2, 1.2));
        double truth = quadrature(roughness, eta, cosine), found = lost(roughness, eta, cosine);
        over = fmax(over, found - truth);
        under = fmax(under, truth - found);
        if (eta == 0 && roughness > 0.25) wide = fmax(wide, truth - found);
        CHECK_MSG(found <= truth + 2e-6, "roughness %g, index %g, cosine %g: %.7f in the table, %.7f lost", roughness, eta, cosine, found, truth);
    }
    printf("table: over the truth by at most %.1e, under it by %.4f, of wide metal %.4f\n", over, under, wide);
    CHECK(under < 0.12 && wide < 0.01);
    for (int i = 0; i < 40; i++) { /* the means are those of the interpolated table */
        double roughness = test_random_in(0.02, 1), eta = i % 3 ? exp(test_random_in(-1, 1)) : 0, sum = 0;
        for (int k = 0; k < 20000; k++) sum += lost(roughness, eta, sqrt((k + 0.5) / 20000)) / 20000;
        CHECK_MSG(fabs(sum - lost_mean(roughness, eta)) < 1e-6 + 1e-4 * sum, "mean %.8f, not %.8f", lost_mean(roughness, eta), sum);
    }
}

/* ---- values ---- */

static double share_of(double f0, double mean)
{
    double f = f0 + (1 - f0) / 21;
    return f * f * (1 - mean) / (1 - f * mean);
}

/* Green channel. */
static double again(const float *m, vector l, vector v)
{
    double roughness = sqrt((double)m[PACKED_ALPHA]), base = m[PACKED_BASE + 1], z = fabs(l.z), metallic = m[PACKED_METALLIC];
    bool body = m[PACKED_ETA] != 1;
    double here = body ? m[PACKED_ETA] : 0, beyond = body ? 1 / (double)m[PACKED_ETA] : 0, r = ((double)m[PACKED_ETA] - 1) / ((double)m[PACKED_ETA] + 1);
    double of_metal = share_of(base, lost_mean(roughness, 0)) * lost(roughness, 0, v.z) * lost(roughness, 0, z) / lost_mean(roughness, 0) / pi * z;
    double glass = (1 - metallic) * m[PACKED_TRANSMISSION], mean = lost_mean(roughness, here), far = lost_mean(roughness, beyond);
    double passes = 20.0 / 21 * (1 - r * r) * fmin(1, body ? here * here * far / mean : 1);
    double of_glass = l.z > 0 ? (1 - passes) * lost(roughness, here, z) / mean : base * passes * lost(roughness, beyond, z) / far;
    return (l.z > 0 ? metallic * of_metal : 0) + glass * of_glass * lost(roughness, here, v.z) / pi * z;
}

/* The value with it minus the value without it. */
static void values(const char *what, const float *m)
{
    static float without[N];
    vector v = seen_from(m);
    double worst = 0;
    draw_directions(v, m[PACKED_ALPHA], 0, m[PACKED_TRANSMISSION] > 0);
    if (!RUN_ALL("bsdf_values", 3, SCALAR(n), IN(m, PACKED_FIELDS), IN(wi, 3 * N), OUT(f, N), OUT(pdf, N))) return;
    if (!KERNEL_CALL(&cl, single, "bsdf_values", N / 8, SCALAR(n), IN(m, PACKED_FIELDS), IN(wi, 3 * N), OUT(without, N), OUT(pdf, N))) return;
    for (uint32_t i = 0; i < N; i++) {
        double expected = again(m, direction(i), v), all = expected + without[i];
        worst = fmax(worst, fabs(f[i] - all) / (all + 1e-7));
    }
    printf("%s: relative error %.1e\n", what, worst);
    CHECK_MSG(worst < 3e-5, "%s: %g off, relatively", what, worst); /* about 60 roundings, and as many for a position between nodes */
}

/* Through a body's face: n^2 f is symmetric, as for basic radiance. */
static void through_both_ways(float alpha, float eta)
{
    static const float cosines[4] = {0.05f, 0.3f, 0.7f, 1};
    double there[4][4], back[4][4], worst = 0;
    for (int side = 0; side < 2; side++)
        for (int o = 0; o < 4; o++) {
            float m[PACKED_FIELDS] = {1, 1, 1, (eta - 1) * (eta - 1) / (eta + 1) / (eta + 1), 1, 0, alpha, cosines[o], 1, side ? 1 / eta : eta};
            static float without[N];
            for (uint32_t i = 0; i < N; i++) {
                double z = cosines[i % 4], r = sqrt(1 - z * z);
                wi[i] = 0, wi[N + i] = (float)r, wi[2 * N + i] = (float)-z;
            }
            if (!KERNEL_CALL(&cl, programs[EIGHT], "bsdf_values", N / 8, SCALAR(n), IN(m, PACKED_FIELDS), IN(wi, 3 * N), OUT(f, N), OUT(pdf, N))) return;
            if (!KERNEL_CALL(&cl, single, "bsdf_values", N / 8, SCALAR(n), IN(m, PACKED_FIELDS), IN(wi, 3 * N), OUT(without, N), OUT(pdf, N))) return;
            for (int k = 0; k < 4; k++) *(side ? &back[k][o] : &there[o][k]) = ((double)f[k] - (double)without[k]) / cosines[k] * (side ? (double)eta * eta : 1);
        }
    for (int o = 0; o < 4; o++)
        for (int k = 0; k < 4; k++) worst = fmax(worst, fabs(there[o][k] - back[o][k]) / (there[o][k] + back[o][k] + 1e-3));
    printf("through, alpha %g index %g: both ways alike within %.1e\n", (double)alpha, (double)eta, worst);
    CHECK_MSG(worst < 1e-4, "alpha %g index %g: %g apart", (double)alpha, (double)eta, worst);
}

/* ---- energy ---- */

/* Light that each of two builds returns at one roughness, integrated over cosines with weight 2 cosine. */
static void energy(const char *what, const float *white)
{
    static const float roughness[3] = {0.25f, 0.5f, 1};
    cl_program with = programs[EIGHT];
    for (int r = 0; r < 3; r++) {
        double sum[2] = {0}, se;
        for (int which = 0; which < 2; which++) {
            programs[EIGHT] = which ? with : single;
            for (int c = 0; c < 8; c++) {
                float m[PACKED_FIELDS];
                memcpy(m, white, sizeof m);
                m[PACKED_ALPHA] = roughness[r] * roughness[r];
                m[PACKED_COSINE] = (float)sqrt((c + 0.5) / 8);
                sum[which] += albedo(m, &se) / 8;
            }
        }
        printf("%s, roughness %g: %.2f %% lost, with multiple scattering %.2f %%\n", what, (double)roughness[r], 100 * (1 - sum[0]), 100 * (1 - sum[1]));
        CHECK_MSG(sum[1] > 0.985, "%s, roughness %g: %.4f comes back", what, (double)roughness[r], sum[1]);
    }
    programs[EIGHT] = with;
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
#define FEATURES "-DFEATURES=(EC_FEATURE_SPECULAR+EC_FEATURE_TRANSMISSION+EC_FEATURE_SMOOTH+EC_FEATURE_ANISOTROPY"
    for (int i = 0; i < kernel_widths(&cl); i++) programs[i] = kernel_build(&cl, "chi2", lane_widths[i], FEATURES "+EC_FEATURE_MULTISCATTER)");
    single = kernel_build(&cl, "chi2", 8, FEATURES ")");
    if (!test_failures) {
        static const float etas[5] = {1, 1.5f, 1 / 1.5f, 2.4f, 1.1f}, cosines[4] = {0.05f, 0.4f, 0.8f, 1};
        float metal[PACKED_FIELDS] = {0.9f, 0.6f, 0.3f, 0.04f, 1, 1, 0.3f, 0.5f, 0, 1}, half[PACKED_FIELDS] = {0.9f, 0.6f, 0.3f, 0.04f, 1, 0.5f, 0.3f, 0.5f, 1, 1};
        table_is_right();
        for (int c = 0; c < 4; c++)
            for (int e = 0; e < 5; e++) {
                char name[96];
                float *m = e == 0 && c % 2 ? metal : half, r = (etas[e] - 1) / (etas[e] + 1);
                m[PACKED_ALPHA] = c == 3 ? 1 : 0.1f + 0.2f * (float)c, m[PACKED_COSINE] = cosines[c], m[PACKED_ETA] = etas[e], m[PACKED_F0] = e ? r * r : 0.04f;
                snprintf(name, sizeof name, "metallic %g alpha %g cosine %g index %g", (double)m[PACKED_METALLIC], (double)m[PACKED_ALPHA], (double)cosines[c], (double)etas[e]);
                values(name, m);
            }
        metal[PACKED_ALPHA] = 0.4f;
        check_reciprocity("metal", metal);
        through_both_ways(0.5f, 1.5f);
        through_both_ways(1, 2.4f);
        float white[PACKED_FIELDS] = {1, 1, 1, 0.04f, 1, 1, 0.3f, 0.5f, 0, 1};
        furnace("white metal", white, PACKED_ALPHA, 0);
        energy("white metal", white);
        furnace("white metal of anisotropy 0.5", white, PACKED_ALPHA, 0.5); /* this one has single scattering */
        white[PACKED_METALLIC] = 0, white[PACKED_TRANSMISSION] = 1;
        for (int e = 0; e < 5; e++) {
            char name[64];
            float r = (etas[e] - 1) / (etas[e] + 1);
            white[PACKED_ETA] = etas[e], white[PACKED_F0] = e ? r * r : 0.04f;
            snprintf(name, sizeof name, e ? "glass of index %.3g" : "pane", (double)etas[e]);
            furnace(name, white, PACKED_ALPHA, 0);
            energy(name, white);
        }
    }
    for (int i = 0; i < kernel_widths(&cl); i++)
        if (programs[i]) clReleaseProgram(programs[i]);
    if (single) clReleaseProgram(single);
    ec_cl_close(&cl);
    TEST_END();
}

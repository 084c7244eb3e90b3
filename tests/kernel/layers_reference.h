/* Shared by the tests of layered surfaces against double precision: directions, f against a formula, reciprocity, a furnace. One surface a
 * call, N directions. Every lane width must give the same bits. */
#ifndef EC_TESTS_KERNEL_LAYERS_REFERENCE_H
#define EC_TESTS_KERNEL_LAYERS_REFERENCE_H

#include "kernel/kernel_reference.h"
#include "kernel/packed_material.h"

static float wi[3 * N], f[N], pdf[N];

typedef struct vector {
    double x, y, z;
} vector;

static inline double product(vector a, vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vector above(vector w) { return (vector){w.x, w.y, fabs(w.z)}; }
static inline vector in_frame(vector w, double sine, double cosine) { return (vector){w.x * cosine - w.z * sine, w.y, w.x * sine + w.z * cosine}; }
static inline vector half_of(vector a, vector b)
{
    vector h = {a.x + b.x, a.y + b.y, a.z + b.z};
    double length = sqrt(product(h, h));
    return (vector){h.x / length, h.y / length, h.z / length};
}

/* glTF 2.0, B.3: D and V of an isotropic lobe, times the cosine. */
static inline double lobe(double alpha, vector l, vector v)
{
    vector h = half_of(l, v);
    double a2 = alpha * alpha, k = (h.x * h.x + h.y * h.y) / a2 + h.z * h.z;
    return 0.5 * l.z / (pi * a2 * k * k) / (l.z * sqrt(a2 + (1 - a2) * v.z * v.z) + v.z * sqrt(a2 + (1 - a2) * l.z * l.z));
}

static inline vector seen_from(const float *m)
{
    double cosine = m[PACKED_COSINE];
    return (vector){sqrt(1 - cosine * cosine), 0, cosine};
}

/* Directions anywhere above, a quarter of them near the horizon. Half of all are where a lobe of this width, tilted by this sine, reflects
 * v; a third are below if light is transmitted. */
static inline void draw_directions(vector v, double alpha, double tilt, bool through)
{
    for (uint32_t i = 0; i < N; i++) {
        double z = i % 4 ? test_random_in(1e-3, 1) : pow(10, test_random_in(-4, 0)), angle = test_random_in(-pi, pi), r = sqrt(1 - z * z);
        vector l = {r * cos(angle), r * sin(angle), z};
        if (i % 2) {
            double x = alpha * tan(test_random_in(0, 1.4)), length = sqrt(1 + x * x);
            vector h = in_frame((vector){x * cos(angle) / length, x * sin(angle) / length, 1 / length}, -tilt, sqrt(1 - tilt * tilt));
            vector mirrored = {2 * product(v, h) * h.x - v.x, 2 * product(v, h) * h.y - v.y, 2 * product(v, h) * h.z - v.z};
            if (mirrored.z > 1e-3) l = mirrored;
        }
        wi[i] = (float)l.x, wi[N + i] = (float)l.y, wi[2 * N + i] = (float)(through && i % 3 == 0 ? -l.z : l.z);
    }
}

static inline vector direction(uint32_t i) { return (vector){wi[i], wi[N + i], wi[2 * N + i]}; }

static const float plain[PACKED_FIELDS] = {[PACKED_BASE] = 0.8f, [PACKED_BASE + 1] = 0.6f, [PACKED_BASE + 2] = 0.4f, [PACKED_F0] = 0.04f,
                                           [PACKED_F90] = 1, [PACKED_ALPHA] = 0.3f, [PACKED_ETA] = 1};

/* Runs and compares with want(), relative to the value or to `scale`. Rounding turns the half vector by 2 u, and a lobe of width alpha
 * changes by that over alpha, twice (as in test_reference.c). */
typedef double value_of(const float *m, vector l, vector v);
static inline void compare(const char *what, const float *m, double least_alpha, double tilt, value_of *want, value_of *scale)
{
    vector v = seen_from(m);
    draw_directions(v, least_alpha, tilt, m[PACKED_DIFFUSE_TRANSMISSION] > 0);
    if (!RUN_ALL("bsdf_values", 3, SCALAR(n), IN(m, PACKED_FIELDS), IN(wi, 3 * N), OUT(f, N), OUT(pdf, N))) return;
    double worst = 0, tolerance = 8e-6 + 16 * U / least_alpha / fmax(0.02, m[PACKED_COSINE]);
    uint32_t at = 0, dark = 0;
    for (uint32_t i = 0; i < N; i++) {
        vector l = direction(i);
        double expected = want(m, l, v), sum = sqrt(2 + 2 * product(above(l), v)); /* nearly opposite directions have an imprecise half vector */
        double error = fabs(f[i] - expected) / (scale(m, l, v) + 1e-7) / (1 + 0.1 / sum);
        if (error > worst) worst = error, at = i;
        dark += !(pdf[i] > 0) && expected > 1e-6;
    }
    printf("%s: relative error %.1e\n", what, worst);
    CHECK_MSG(worst <= tolerance, "%s: f = %.9g, double gives %.9g (%.1e > %.1e) at wo.z %g, wi (%g, %g, %g)", what, (double)f[at],
              want(m, direction(at), v), worst, tolerance, v.z, (double)wi[at], (double)wi[N + at], (double)wi[2 * N + at]);
    CHECK_MSG(dark == 0, "%s: %u directions without a density", what, dark);
}

/* Mean of f cos / pdf over samples: the light that returns in uniform white light. */
static inline double albedo(const float *m, double *se)
{
    enum { COUNT = 1 << 16 };
    static float out[5 * COUNT];
    const uint32_t count = COUNT;
    static uint32_t seed = 7;
    double sum = 0, squares = 0;
    seed++;
    if (!KERNEL_CALL(&cl, programs[EIGHT], "bsdf_samples", count / 8, SCALAR(count), SCALAR(seed), IN(m, PACKED_FIELDS), OUT(out, 5 * COUNT))) return 0;
    for (uint32_t i = 0; i < count; i++) {
        double weight = out[4 * COUNT + i];
        CHECK_MSG(weight >= 0 && weight < 1e4, "weight %g", weight);
        sum += weight / COUNT, squares += weight * weight / COUNT;
    }
    *se = sqrt(fmax(squares - sum * sum, 0) / COUNT);
    return sum;
}

/* f(wo, wi) = f(wi, wo) for six cosines each and N / 6 azimuths, except for rounding as in compare(). */
static inline void check_reciprocity(const char *what, const float *m)
{
    static const double cosines[6] = {0.01, 0.1, 0.3, 0.5, 0.8, 1};
    static float values[6][N];
    double worst = 0;
    for (uint32_t i = 0; i < N; i++) {
        double z = cosines[i % 6], angle = 2 * pi * (i / 6) / (N / 6.0), r = sqrt(1 - z * z); /* six with one azimuth */
        wi[i] = (float)(r * cos(angle)), wi[N + i] = (float)(r * sin(angle)), wi[2 * N + i] = (float)z;
    }
    for (int o = 0; o < 6; o++) {
        float turned[PACKED_FIELDS];
        memcpy(turned, m, sizeof turned);
        turned[PACKED_COSINE] = (float)cosines[o];
        if (!KERNEL_CALL(&cl, programs[EIGHT], "bsdf_values", n / 8, SCALAR(n), IN(turned, PACKED_FIELDS), IN(wi, 3 * N), OUT(values[o], N), OUT(pdf, N))) return;
    }
    for (uint32_t i = 0; i + 6 <= N; i += 6)
        for (uint32_t o = 0; o < 6; o++)
            for (uint32_t k = 0; k < o; k++) {
                double there = values[o][i + k] / cosines[k], back = values[k][i + o] / cosines[o];
                double sum = sqrt(2 + 2 * (cosines[o] * cosines[k] + sqrt((1 - cosines[o] * cosines[o]) * (1 - cosines[k] * cosines[k])) * cos(2 * pi * (i / 6) / (N / 6.0))));
                worst = fmax(worst, fabs(there - back) / (there + back + 0.1) / (1 + 0.1 / sum));
            }
    CHECK_MSG(worst < 1e-5, "%s: f(a, b) and f(b, a) differ by %g", what, worst);
    printf("%s: reciprocal within %.1e\n", what, worst);
}

/* Over roughness and angle: never more than arrives, by more than 4 standard errors; prints the smallest value. */
static inline void furnace(const char *what, const float *white, int roughness_field, double anisotropy)
{
    static const double roughness[7] = {0.02, 0.07, 0.15, 0.3, 0.5, 0.75, 1}, cosines[6] = {1, 0.7, 0.4, 0.15, 0.03, 0.003};
    double most = 0, least = 2, least_roughness = 0, least_cosine = 0;
    for (int r = 0; r < 7; r++)
        for (int c = 0; c < 6; c++) {
            float m[PACKED_FIELDS];
            double se = 0;
            memcpy(m, white, sizeof m);
            m[roughness_field] = (float)(roughness[r] * roughness[r]);
            m[PACKED_COSINE] = (float)cosines[c];
            if (anisotropy > 0) m[PACKED_STRETCH] = (float)(anisotropy * anisotropy * (1 / pow(roughness[r], 2) - 1)); /* mix(alpha, 1, strength^2) */
            double sum = albedo(m, &se);
            CHECK_MSG(sum <= 1 + 4 * se + 1e-5, "%s, roughness %g, cosine %g: %.5f +- %.5f comes back", what, roughness[r], cosines[c], sum, se);
            most = fmax(most, sum - 4 * se);
            if (sum < least) least = sum, least_roughness = roughness[r], least_cosine = cosines[c];
        }
    printf("%s: %.4f (roughness %g, cosine %g) to %.4f of the light comes back\n", what, least, least_roughness, least_cosine, most);
    CHECK(least > 0.2);
}

#endif

/* What lies over a surface against double precision, by the formulas of the extensions' texts; the energy of all of it, at roughness and
 * angles from end to end. One surface a call, N directions. Every lane width must give the same bits. */
#include "kernel/film_reference.h"
#include "kernel/kernel_reference.h"
#include "kernel/packed_material.h"
#define constant static const
#include "lib/sheen_table.h"

static float wi[3 * N], f[N], pdf[N];

typedef struct vector {
    double x, y, z;
} vector;

static double product(vector a, vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static vector above(vector w) { return (vector){w.x, w.y, fabs(w.z)}; }
static vector in_frame(vector w, double sine, double cosine) { return (vector){w.x * cosine - w.z * sine, w.y, w.x * sine + w.z * cosine}; }
static vector half_of(vector a, vector b)
{
    vector h = {a.x + b.x, a.y + b.y, a.z + b.z};
    double length = sqrt(product(h, h));
    return (vector){h.x / length, h.y / length, h.z / length};
}

/* glTF 2.0, B.3: D and V of an isotropic lobe, times the cosine. */
static double lobe(double alpha, vector l, vector v)
{
    vector h = half_of(l, v);
    double a2 = alpha * alpha, k = (h.x * h.x + h.y * h.y) / a2 + h.z * h.z;
    return 0.5 * l.z / (pi * a2 * k * k) / (l.z * sqrt(a2 + (1 - a2) * v.z * v.z) + v.z * sqrt(a2 + (1 - a2) * l.z * l.z));
}

/* Appendix B's plastic of one grey, no metal, f90 1. */
static double plastic(const float *m, vector l, vector v)
{
    double fresnel = m[PACKED_F0] + (1 - (double)m[PACKED_F0]) * pow(1 - product(half_of(l, v), v), 5);
    return fresnel * lobe(m[PACKED_ALPHA], l, v) + (1 - fresnel) * m[PACKED_BASE + 1] / pi * l.z;
}

static vector seen_from(const float *m)
{
    double cosine = m[PACKED_COSINE];
    return (vector){sqrt(1 - cosine * cosine), 0, cosine};
}

/* Anywhere above, a quarter of them near the horizon; half of all where a lobe of this width, bent by this sine, mirrors v;
 * a third of them below where light goes through. */
static void draw_directions(vector v, double alpha, double tilt, bool through)
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

static vector direction(uint32_t i) { return (vector){wi[i], wi[N + i], wi[2 * N + i]}; }

static const float plain[PACKED_FIELDS] = {[PACKED_BASE] = 0.8f, [PACKED_BASE + 1] = 0.6f, [PACKED_BASE + 2] = 0.4f, [PACKED_F0] = 0.04f,
                                           [PACKED_F90] = 1, [PACKED_ALPHA] = 0.3f, [PACKED_ETA] = 1};

/* Runs and compares with want(); relative, as rounding of the half vector turns it by 2 u and a lobe of width alpha changes by that
 * over alpha, twice (as in test_reference.c); relative to `scale`. */
typedef double value_of(const float *m, vector l, vector v);
static void compare(const char *what, const float *m, double least_alpha, double tilt, value_of *want, value_of *scale)
{
    vector v = seen_from(m);
    draw_directions(v, least_alpha, tilt, m[PACKED_SEEPS] > 0);
    if (!RUN_ALL("bsdf_values", 3, SCALAR(n), IN(m, PACKED_FIELDS), IN(wi, 3 * N), OUT(f, N), OUT(pdf, N))) return;
    double worst = 0, tolerance = 8e-6 + 16 * U / least_alpha / fmax(0.02, m[PACKED_COSINE]);
    uint32_t at = 0, dark = 0;
    for (uint32_t i = 0; i < N; i++) {
        vector l = direction(i);
        double expected = want(m, l, v), sum = sqrt(2 + 2 * product(above(l), v)); /* nearly opposite directions: their half vector is worth less */
        double error = fabs(f[i] - expected) / (scale(m, l, v) + 1e-7) / (1 + 0.1 / sum);
        if (error > worst) worst = error, at = i;
        dark += !(pdf[i] > 0) && expected > 1e-6;
    }
    printf("%s: relative error %.1e\n", what, worst);
    CHECK_MSG(worst <= tolerance, "%s: f = %.9g, double gives %.9g (%.1e > %.1e) at wo.z %g, wi (%g, %g, %g)", what, (double)f[at],
              want(m, direction(at), v), worst, tolerance, v.z, (double)wi[at], (double)wi[N + at], (double)wi[2 * N + at]);
    CHECK_MSG(dark == 0, "%s: %u directions without a density", what, dark);
}

/* Mean of f cos / pdf over samples: what white light from everywhere comes back as. */
static double albedo(const float *m, double *se)
{
    enum { COUNT = 1 << 16 };
    static float out[5 * COUNT];
    const uint32_t count = COUNT;
    static uint32_t seed = 7;
    double sum = 0, squares = 0;
    seed++;
    if (!KERNEL_CALL(&cl, programs[2], "bsdf_samples", count / 8, SCALAR(count), SCALAR(seed), IN(m, PACKED_FIELDS), OUT(out, 5 * COUNT))) return 0;
    for (uint32_t i = 0; i < count; i++) {
        double weight = out[4 * COUNT + i];
        CHECK_MSG(weight >= 0 && weight < 1e4, "weight %g", weight);
        sum += weight / COUNT, squares += weight * weight / COUNT;
    }
    *se = sqrt(fmax(squares - sum * sum, 0) / COUNT);
    return sum;
}

/* f(wo, wi) = f(wi, wo) for six cosines each and N / 6 azimuths, but for rounding as in compare(). */
static void check_reciprocity(const char *what, const float *m)
{
    static const double cosines[6] = {0.01, 0.1, 0.3, 0.5, 0.8, 1};
    static float values[6][N];
    double worst = 0;
    for (uint32_t i = 0; i < N; i++) {
        double z = cosines[i % 6], angle = 2 * pi * (i / 6) / (N / 6.0), r = sqrt(1 - z * z); /* six of the same azimuth */
        wi[i] = (float)(r * cos(angle)), wi[N + i] = (float)(r * sin(angle)), wi[2 * N + i] = (float)z;
    }
    for (int o = 0; o < 6; o++) {
        float turned[PACKED_FIELDS];
        memcpy(turned, m, sizeof turned);
        turned[PACKED_COSINE] = (float)cosines[o];
        if (!KERNEL_CALL(&cl, programs[2], "bsdf_values", n / 8, SCALAR(n), IN(turned, PACKED_FIELDS), IN(wi, 3 * N), OUT(values[o], N), OUT(pdf, N))) return;
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

/* Over roughness and angle: never more than comes in, by more than 4 standard errors; says how little comes back at the least. */
static void furnace(const char *what, const float *white, int roughness_field, double anisotropy)
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

/* ---- KHR_materials_clearcoat: mix(base, D V, weight (0.04 + 0.96 (1 - Nc . V)^5)) ---- */

static double coated(const float *m, vector l, vector v)
{
    double sine = m[PACKED_COAT_TILT], cosine = sqrt(1 - sine * sine);
    vector own_l = in_frame(l, sine, cosine), own_v = in_frame(v, sine, cosine);
    double share = m[PACKED_COAT] * (0.04 + 0.96 * pow(1 - fmax(own_v.z, 0), 5));
    double reflected = own_l.z > 0 && own_v.z > 0 ? lobe(m[PACKED_COAT_ALPHA], own_l, own_v) : 0;
    return (1 - share) * plastic(m, l, v) + share * reflected;
}

static void coats(void)
{
    static const float cases[6][4] = {{1, 0.1f, 0, 0.7f}, {0.5f, 0.01f, 0, 0.9f}, {1, 1, 0, 0.1f}, {1, 0.3f, 0.3f, 0.6f}, {0.25f, 0.2f, -0.5f, 0.5f}, {1, 1e-3f, 0, 0.4f}};
    for (int i = 0; i < 6; i++) {
        float m[PACKED_FIELDS];
        char name[96];
        memcpy(m, plain, sizeof m);
        m[PACKED_COAT] = cases[i][0], m[PACKED_COAT_ALPHA] = cases[i][1], m[PACKED_COAT_TILT] = cases[i][2], m[PACKED_COSINE] = cases[i][3];
        snprintf(name, sizeof name, "coat %g alpha %g tilt %g", (double)cases[i][0], (double)cases[i][1], (double)cases[i][2]);
        compare(name, m, fmin(cases[i][1], 0.3), cases[i][2], coated, coated);
    }
    /* Over a mirror of roughness 0.07 whose albedo is 1 but for 1e-3: what is missing is the coat's. */
    float white[PACKED_FIELDS] = {[PACKED_BASE] = 1, [PACKED_BASE + 1] = 1, [PACKED_BASE + 2] = 1, [PACKED_F0] = 1, [PACKED_F90] = 1,
                                  [PACKED_METALLIC] = 1, [PACKED_ALPHA] = 0.005f, [PACKED_ETA] = 1, [PACKED_COAT] = 1};
    furnace("coat over white metal", white, PACKED_COAT_ALPHA, 0);
    white[PACKED_COAT_TILT] = 0.3f;
    furnace("bent coat over white metal", white, PACKED_COAT_ALPHA, 0);
}

/* ---- KHR_materials_sheen, by Estevez and Kulla 2017; eclat's own: divided by E where E is more than 1 ---- */

static double sheen_fit(double x, double alpha)
{
    static const double ends[5][2] = {{25.3245, 21.5473}, {3.32435, 3.82987}, {0.16801, 0.19823}, {-1.27393, -1.97760}, {-4.85967, -4.32054}};
    double t = (1 - alpha) * (1 - alpha), p[5];
    for (int i = 0; i < 5; i++) p[i] = t * ends[i][0] + (1 - t) * ends[i][1];
    return p[0] / (1 + p[1] * pow(x, p[2])) + p[3] * x + p[4];
}

static double sheen_lambda(double cosine, double alpha)
{
    return exp(cosine < 0.5 ? sheen_fit(cosine, alpha) : 2 * sheen_fit(0.5, alpha) - sheen_fit(1 - cosine, alpha));
}

static double charlie(double alpha, vector l, vector v) /* times the cosine */
{
    vector h = half_of(l, v);
    double d = (2 + 1 / alpha) * pow(h.x * h.x + h.y * h.y, 0.5 / alpha) / (2 * pi);
    return d / ((1 + sheen_lambda(v.z, alpha) + sheen_lambda(l.z, alpha)) * 4 * v.z);
}

/* E of one direction by midpoints, z = u^3, azimuth dense where l mirrors v. */
static double charlie_albedo(double alpha, double cosine)
{
    enum { STEPS = 160 };
    double sum = 0;
    vector v = {sqrt(1 - cosine * cosine), 0, cosine};
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < STEPS; j++) {
            double u = (i + 0.5) / STEPS, z = u * u * u, q = 1 - (j + 0.5) / STEPS, angle = pi * (1 - q * q * q), r = sqrt(1 - z * z);
            vector l = {r * cos(angle), r * sin(angle), z};
            sum += charlie(alpha, l, v) * 3 * u * u / STEPS * 2 * pi * 3 * q * q / STEPS;
        }
    return sum;
}

static double table_albedo(double roughness, double cosine)
{
    double x = sqrt(cosine) * (SHEEN_COSINES - 1), y = (roughness - (double)SHEEN_LEAST_ROUGHNESS) / (1 - (double)SHEEN_LEAST_ROUGHNESS) * (SHEEN_ROUGHNESSES - 1);
    int i = (int)fmin(x, SHEEN_COSINES - 2), j = (int)fmin(fmax(y, 0), SHEEN_ROUGHNESSES - 2);
    const float *at = sheen_table + j * SHEEN_COSINES + i;
    double u = x - i, w = y - j;
    return (1 - w) * ((1 - u) * (double)at[0] + u * (double)at[1]) + w * ((1 - u) * (double)at[SHEEN_COSINES] + u * (double)at[SHEEN_COSINES + 1]);
}

/* The table against quadrature between its nodes: hardly under the truth, or what lies below would get too much; over it, what is lost. */
static void sheen_table_is_right(void)
{
    double over = 0, under = 0;
    for (int i = 0; i < 120; i++) {
        double roughness = test_random_in((double)SHEEN_LEAST_ROUGHNESS, 1), cosine = pow(test_random_in(0.032, 1), 2); /* below, E turns up again, and the table is far above */
        double error = fmin(table_albedo(roughness, cosine), 1) - fmin(charlie_albedo(roughness * roughness, cosine), 1);
        over = fmax(over, error), under = fmax(under, -error);
    }
    printf("sheen: table over E by at most %.4f, under by %.4f\n", over, under);
    CHECK(over < 0.005 && under < 1e-3);
}

static double with_sheen(const float *m, vector l, vector v)
{
    double roughness = fmax(m[PACKED_SHEEN_ROUGHNESS], SHEEN_LEAST_ROUGHNESS), most = fmax(m[PACKED_SHEEN], fmax(m[PACKED_SHEEN + 1], m[PACKED_SHEEN + 2]));
    double albedo = fmax(table_albedo(roughness, v.z), table_albedo(roughness, l.z));
    return m[PACKED_SHEEN + 1] * charlie(roughness * roughness, l, v) / fmax(albedo, 1) + (1 - most * fmin(albedo, 1)) * plastic(m, l, v);
}

static void sheens(void)
{
    static const float roughness[5] = {0.07f, 0.2f, 0.5f, 0.8f, 1}, cosines[5] = {0.05f, 0.3f, 0.6f, 0.9f, 1};
    sheen_table_is_right();
    for (int i = 0; i < 25; i++) {
        float m[PACKED_FIELDS];
        char name[96];
        memcpy(m, plain, sizeof m);
        m[PACKED_SHEEN] = 0.5f, m[PACKED_SHEEN + 1] = 0.9f, m[PACKED_SHEEN + 2] = 0.2f;
        m[PACKED_SHEEN_ROUGHNESS] = roughness[i / 5], m[PACKED_COSINE] = cosines[i % 5];
        snprintf(name, sizeof name, "sheen roughness %g cosine %g", (double)roughness[i / 5], (double)cosines[i % 5]);
        if (i % 5 == 0) check_reciprocity(name, m);
        /* sin^(1 / alpha): the power multiplies the error of the sine, of about 4 u, by 1 / alpha. */
        compare(name, m, fmin(0.3, (double)roughness[i / 5] * roughness[i / 5]), 0, with_sheen, with_sheen);
    }
    float white[PACKED_FIELDS] = {[PACKED_BASE] = 1, [PACKED_BASE + 1] = 1, [PACKED_BASE + 2] = 1, [PACKED_ALPHA] = 1, [PACKED_ETA] = 1,
                                  [PACKED_SHEEN] = 1, [PACKED_SHEEN + 1] = 1, [PACKED_SHEEN + 2] = 1};
    furnace("white sheen over white Lambert", white, PACKED_SHEEN_ROUGHNESS, 0);
}

/* ---- KHR_materials_anisotropy: D and V of Burley 2012 and Heitz 2014 for widths at and ab ---- */

static double stretched(const float *m, vector l, vector v)
{
    double turn = 2 * pi * (double)m[PACKED_TURN], c = cos(turn), s = sin(turn), ab = m[PACKED_ALPHA], at = ab * (1 + (double)m[PACKED_STRETCH]);
    vector own_l = {c * l.x - s * l.y, s * l.x + c * l.y, l.z}, own_v = {c * v.x - s * v.y, s * v.x + c * v.y, v.z}, h = half_of(own_l, own_v);
    double k = h.x * h.x / (at * at) + h.y * h.y / (ab * ab) + h.z * h.z, d = 1 / (pi * at * ab * k * k);
    double to_v = sqrt(pow(at * own_v.x, 2) + pow(ab * own_v.y, 2) + v.z * v.z), to_l = sqrt(pow(at * own_l.x, 2) + pow(ab * own_l.y, 2) + l.z * l.z);
    double fresnel = m[PACKED_F0] + (1 - (double)m[PACKED_F0]) * pow(1 - product(h, own_v), 5);
    return fresnel * d * 0.5 * l.z / (l.z * to_v + v.z * to_l) + (1 - fresnel) * m[PACKED_BASE + 1] / pi * l.z;
}

static void anisotropies(void)
{
    static const float cases[6][4] = {{0.3f, 1.5f, 0, 0.7f}, {0.1f, 9, 0.25f, 0.5f}, {0.1f, 3, 0.125f, 0.9f}, {0.01f, 99, 0.4f, 0.3f}, {0.05f, 10, 0.7f, 0.1f}, {0.2f, 0, 0.3f, 0.5f}};
    for (int i = 0; i < 6; i++) {
        float m[PACKED_FIELDS];
        char name[96];
        memcpy(m, plain, sizeof m);
        m[PACKED_ALPHA] = cases[i][0], m[PACKED_STRETCH] = cases[i][1], m[PACKED_TURN] = cases[i][2], m[PACKED_COSINE] = cases[i][3];
        snprintf(name, sizeof name, "anisotropy alpha %g stretch %g turn %g", (double)cases[i][0], (double)cases[i][1] + 1, (double)cases[i][2]);
        compare(name, m, cases[i][0], 0, stretched, stretched); /* whose formula does not change when l and v do: reciprocal */
    }
    float white[PACKED_FIELDS] = {[PACKED_BASE] = 1, [PACKED_BASE + 1] = 1, [PACKED_BASE + 2] = 1, [PACKED_F0] = 1, [PACKED_F90] = 1,
                                  [PACKED_METALLIC] = 1, [PACKED_ETA] = 1, [PACKED_TURN] = 0.1f};
    furnace("white metal of anisotropy 0.5", white, PACKED_ALPHA, 0.5);
    furnace("white metal of anisotropy 1", white, PACKED_ALPHA, 1);
}

/* ---- KHR_materials_iridescence: both Fresnel terms become the film's ---- */

static double filmed(const float *m, vector l, vector v)
{
    double cosine = product(half_of(l, v), v), metallic = m[PACKED_METALLIC], w = m[PACKED_FILM], f0[2][3], over[2][3], reflected[2];
    for (int k = 0; k < 3; k++) f0[0][k] = m[PACKED_F0], f0[1][k] = m[PACKED_BASE + k];
    for (int i = 0; i < 2; i++) {
        film_reference(cosine, m[PACKED_FILM + 1], m[PACKED_FILM + 2], f0[i], over[i]);
        reflected[i] = (1 - w) * film_schlick(f0[i][1], cosine) + w * over[i][1];
    }
    double left = (1 - w) * (1 - film_schlick(f0[0][1], cosine)) + w * (1 - fmax(over[0][0], fmax(over[0][1], over[0][2])));
    return ((1 - metallic) * reflected[0] + metallic * reflected[1]) * lobe(m[PACKED_ALPHA], l, v) + (1 - metallic) * left * m[PACKED_BASE + 1] / pi * l.z;
}

/* Colours are differences: a channel's error is one of the light that both faces send, not of what interference leaves of it. */
static double all_sent(const float *m, vector l, vector v)
{
    return filmed(m, l, v) + lobe(m[PACKED_ALPHA], l, v) + m[PACKED_BASE + 1] / pi * l.z;
}

static double bare(const float *m, vector l, vector v)
{
    return (1 - (double)m[PACKED_METALLIC]) * plastic(m, l, v) +
           m[PACKED_METALLIC] * film_schlick(m[PACKED_BASE + 1], product(half_of(l, v), v)) * lobe(m[PACKED_ALPHA], l, v);
}

/* Not of the surface's own index: there the inner face has no side, and the text's formula for it no answer that lasts. */
static void films(void)
{
    static const float cases[8][5] = {{1, 1.3f, 400, 0, 0.7f}, {1, 1.33f, 100, 1, 0.3f}, {0.5f, 2.5f, 700, 0.5f, 0.9f}, {1, 1.8f, 1200, 1, 0.05f},
                                      {1, 1.4f, 0.02f, 0, 0.6f}, {0.7f, 1.3f, 5000, 0.2f, 0.5f}, {1, 1.45f, 250, 0, 0.01f}, {1, 1.0001f, 300, 1, 0.6f}};
    for (int i = 0; i < 8; i++) {
        float m[PACKED_FIELDS];
        char name[96];
        memcpy(m, plain, sizeof m);
        memcpy(m + PACKED_FILM, cases[i], 3 * sizeof *m);
        m[PACKED_METALLIC] = cases[i][3], m[PACKED_COSINE] = cases[i][4];
        snprintf(name, sizeof name, "film %g index %g thickness %g metallic %g", (double)cases[i][0], (double)cases[i][1], (double)cases[i][2], (double)cases[i][3]);
        /* A way of t wavelengths to and fro turns by 2 pi t, of which 3 roundings are lost: the tolerance of a lobe of that width less. */
        double turns = 2 * (double)cases[i][1] * (double)cases[i][2] / 400;
        compare(name, m, fmin(0.3, 1 / (1 + turns)), 0, filmed, all_sent);
        if (i < 2) check_reciprocity(name, m);
        m[PACKED_FILM + i % 2 + 1] = i % 2 == 0 ? 1 : 0; /* of the air's index, or of no thickness: as if it were not there */
        compare("film of nothing", m, 0.3, 0, bare, all_sent);
    }
    float white[PACKED_FIELDS] = {[PACKED_BASE] = 1, [PACKED_BASE + 1] = 1, [PACKED_BASE + 2] = 1, [PACKED_F0] = 0.04f, [PACKED_F90] = 1,
                                  [PACKED_METALLIC] = 1, [PACKED_ETA] = 1, [PACKED_FILM] = 1, [PACKED_FILM + 1] = 1.6f, [PACKED_FILM + 2] = 350};
    furnace("film over white metal", white, PACKED_ALPHA, 0);
    white[PACKED_METALLIC] = 0, white[PACKED_TRANSMISSION] = 1;
    furnace("film on a white pane", white, PACKED_ALPHA, 0);
    white[PACKED_ETA] = 1.5f;
    furnace("film on glass", white, PACKED_ALPHA, 0);
    white[PACKED_ETA] = 1 / 1.5f;
    furnace("film on glass from inside", white, PACKED_ALPHA, 0);
}

/* ---- KHR_materials_diffuse_transmission: the base is mix(base / pi on this side, colour / pi on the other, share) ---- */

static double seeping(const float *m, vector l, vector v)
{
    double share = m[PACKED_SEEPS], fresnel = film_schlick(m[PACKED_F0], product(half_of(above(l), v), v));
    if (l.z < 0) return (1 - fresnel) * share * m[PACKED_SEEPS + 2] / pi * -l.z;
    return fresnel * lobe(m[PACKED_ALPHA], l, v) + (1 - fresnel) * (1 - share) * m[PACKED_BASE + 1] / pi * l.z;
}

static void seepings(void)
{
    static const float cases[4][3] = {{0.25f, 0.3f, 0.7f}, {1, 0.1f, 0.2f}, {0.5f, 1, 0.02f}, {0.9f, 0.02f, 1}};
    for (int i = 0; i < 4; i++) {
        float m[PACKED_FIELDS];
        char name[96];
        memcpy(m, plain, sizeof m);
        m[PACKED_SEEPS] = cases[i][0], m[PACKED_SEEPS + 1] = 0.2f, m[PACKED_SEEPS + 2] = 0.9f, m[PACKED_SEEPS + 3] = 0.5f;
        m[PACKED_ALPHA] = cases[i][1], m[PACKED_COSINE] = cases[i][2];
        snprintf(name, sizeof name, "diffuse transmission %g alpha %g cosine %g", (double)cases[i][0], (double)cases[i][1], (double)cases[i][2]);
        compare(name, m, fmin(0.3, cases[i][1]), 0, seeping, seeping); /* the same formula from below: reciprocal */
    }
    float white[PACKED_FIELDS] = {[PACKED_BASE] = 1, [PACKED_BASE + 1] = 1, [PACKED_BASE + 2] = 1, [PACKED_ETA] = 1, [PACKED_SEEPS] = 0.5f,
                                  [PACKED_SEEPS + 1] = 1, [PACKED_SEEPS + 2] = 1, [PACKED_SEEPS + 3] = 1};
    furnace("white paper", white, PACKED_ALPHA, 0);
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    for (int i = 0; i < kernel_widths(&cl); i++)
        programs[i] = kernel_build(&cl, "chi2", lane_widths[i],
                                   "-DFEATURES=(EC_FEATURE_SPECULAR+EC_FEATURE_TRANSMISSION+EC_FEATURE_SMOOTH+EC_FEATURE_CLEARCOAT+EC_FEATURE_CLEARCOAT_NORMAL_TEXTURE+"
                                   "EC_FEATURE_SHEEN+EC_FEATURE_ANISOTROPY+EC_FEATURE_IRIDESCENCE+EC_FEATURE_DIFFUSE_TRANSMISSION)");
    if (!test_failures) {
        coats();
        sheens();
        anisotropies();
        films();
        seepings();
    }
    for (int i = 0; i < kernel_widths(&cl); i++)
        if (programs[i]) clReleaseProgram(programs[i]);
    ec_cl_close(&cl);
    TEST_END();
}

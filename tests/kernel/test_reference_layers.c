/* What lies over a surface against double precision, by the formulas of the extensions' texts; the energy of all of it, at roughness and
 * angles from end to end. One surface a call, N directions. Every lane width must give the same bits. */
#include "kernel/kernel_reference.h"
#include "kernel/packed_material.h"

static float wi[3 * N], f[N], pdf[N];

typedef struct vector {
    double x, y, z;
} vector;

static double product(vector a, vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
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

/* Anywhere above, a quarter of them near the horizon; half of all where a lobe of this width, bent by this sine, mirrors v. */
static void draw_directions(vector v, double alpha, double tilt)
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
        wi[i] = (float)l.x, wi[N + i] = (float)l.y, wi[2 * N + i] = (float)l.z;
    }
}

static vector direction(uint32_t i) { return (vector){wi[i], wi[N + i], wi[2 * N + i]}; }

static const float plain[PACKED_FIELDS] = {[PACKED_BASE] = 0.8f, [PACKED_BASE + 1] = 0.6f, [PACKED_BASE + 2] = 0.4f, [PACKED_F0] = 0.04f,
                                           [PACKED_F90] = 1, [PACKED_ALPHA] = 0.3f, [PACKED_ETA] = 1};

/* Runs and compares with want(); relative, as rounding of the half vector turns it by 2 u and a lobe of width alpha changes by that
 * over alpha, twice (as in test_reference.c). */
static void compare(const char *what, const float *m, double least_alpha, double tilt, double (*want)(const float *m, vector l, vector v))
{
    vector v = seen_from(m);
    draw_directions(v, least_alpha, tilt);
    if (!RUN_ALL("bsdf_values", 3, SCALAR(n), IN(m, PACKED_FIELDS), IN(wi, 3 * N), OUT(f, N), OUT(pdf, N))) return;
    double worst = 0, tolerance = 8e-6 + 16 * U / least_alpha / fmax(0.02, m[PACKED_COSINE]);
    uint32_t at = 0, dark = 0;
    for (uint32_t i = 0; i < N; i++) {
        vector l = direction(i);
        double expected = want(m, l, v), sum = sqrt(2 + 2 * product(l, v)); /* nearly opposite directions: their half vector is worth less */
        double error = fabs(f[i] - expected) / (expected + 1e-7) / (1 + 0.1 / sum);
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

/* Over roughness and angle: never more than comes in, by more than 4 standard errors; says how little comes back at the least. */
static void furnace(const char *what, const float *white, int roughness_field)
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
        compare(name, m, fmin(cases[i][1], 0.3), cases[i][2], coated);
    }
    /* Over a mirror of roughness 0.07 whose albedo is 1 but for 1e-3: what is missing is the coat's. */
    float white[PACKED_FIELDS] = {[PACKED_BASE] = 1, [PACKED_BASE + 1] = 1, [PACKED_BASE + 2] = 1, [PACKED_F0] = 1, [PACKED_F90] = 1,
                                  [PACKED_METALLIC] = 1, [PACKED_ALPHA] = 0.005f, [PACKED_ETA] = 1, [PACKED_COAT] = 1};
    furnace("coat over white metal", white, PACKED_COAT_ALPHA);
    white[PACKED_COAT_TILT] = 0.3f;
    furnace("bent coat over white metal", white, PACKED_COAT_ALPHA);
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    for (int i = 0; i < LANE_WIDTHS; i++)
        programs[i] = kernel_build(&cl, "chi2", lane_widths[i],
                                   "-DFEATURES=(EC_FEATURE_SPECULAR+EC_FEATURE_TRANSMISSION+EC_FEATURE_SMOOTH+EC_FEATURE_CLEARCOAT+EC_FEATURE_CLEARCOAT_NORMAL_TEXTURE)");
    if (!test_failures) coats();
    for (int i = 0; i < LANE_WIDTHS; i++)
        if (programs[i]) clReleaseProgram(programs[i]);
    ec_cl_close(&cl);
    TEST_END();
}

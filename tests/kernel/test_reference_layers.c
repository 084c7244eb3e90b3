/* tier: full */
/* Layers over a surface against double precision, by the formulas of the extensions' texts; and the energy of all layers, over all
 * roughnesses and angles. */
#include "kernel/film_reference.h"
#include "kernel/layers_reference.h"
#define constant static const
#include "lib/sheen_table.h"

/* Appendix B's plastic of one grey: no metal, f90 1. */
static double plastic(const float *m, vector l, vector v)
{
    double fresnel = m[PACKED_F0] + (1 - (double)m[PACKED_F0]) * pow(1 - product(half_of(l, v), v), 5);
    return fresnel * lobe(m[PACKED_ALPHA], l, v) + (1 - fresnel) * m[PACKED_BASE + 1] / pi * l.z;
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
    /* Over a mirror of roughness 0.07 whose albedo is 1 to 1e-3: the difference is the coat's. */
    float white[PACKED_FIELDS] = {[PACKED_BASE] = 1, [PACKED_BASE + 1] = 1, [PACKED_BASE + 2] = 1, [PACKED_F0] = 1, [PACKED_F90] = 1,
                                  [PACKED_METALLIC] = 1, [PACKED_ALPHA] = 0.005f, [PACKED_ETA] = 1, [PACKED_COAT] = 1};
    furnace("coat over white metal", white, PACKED_COAT_ALPHA, 0);
    white[PACKED_COAT_TILT] = 0.3f;
    furnace("bent coat over white metal", white, PACKED_COAT_ALPHA, 0);
}

/* ---- KHR_materials_sheen, by Estevez and Kulla 2017; eclat divides it by E where E is more than 1 ---- */

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

/* E of one direction by the midpoint rule, z = u^3, with more azimuths where l mirrors v. */
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

/* The table against quadrature between its nodes: hardly below the truth, or the base would get too much light; above it, light is lost. */
static void sheen_table_is_right(void)
{
    double over = 0, under = 0;
    for (int i = 0; i < 120; i++) {
        double roughness = test_random_in((double)SHEEN_LEAST_ROUGHNESS, 1), cosine = pow(test_random_in(0.032, 1), 2); /* not below */
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
        compare(name, m, cases[i][0], 0, stretched, stretched); /* its formula is symmetric in l and v: reciprocal */
    }
    float white[PACKED_FIELDS] = {[PACKED_BASE] = 1, [PACKED_BASE + 1] = 1, [PACKED_BASE + 2] = 1, [PACKED_F0] = 1, [PACKED_F90] = 1,
                                  [PACKED_METALLIC] = 1, [PACKED_ETA] = 1, [PACKED_TURN] = 0.1f};
    furnace("white metal of anisotropy 0.5", white, PACKED_ALPHA, 0.5);
    furnace("white metal of anisotropy 1", white, PACKED_ALPHA, 1);
    static const struct {
        const char *what;
        float eta, f0, strength;
    } glass[] = {{"pane of anisotropy 0.5", 1, 0.04f, 0.5f}, {"pane of anisotropy 1", 1, 0.04f, 1}, {"glass of anisotropy 0.5", 1.5f, 0.04f, 0.5f},
                 {"glass of anisotropy 1", 1.5f, 0.04f, 1}, {"glass of anisotropy 0.5 from inside", 1 / 1.5f, 0.04f, 0.5f},
                 {"glass of anisotropy 1 from inside", 1 / 1.5f, 0.04f, 1}};
    white[PACKED_METALLIC] = 0, white[PACKED_TRANSMISSION] = 1;
    for (int i = 0; i < 6; i++) {
        white[PACKED_ETA] = glass[i].eta, white[PACKED_F0] = glass[i].f0;
        furnace(glass[i].what, white, PACKED_ALPHA, (double)glass[i].strength);
    }
}

/* ---- KHR_materials_iridescence: the film replaces both Fresnel terms ---- */

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

/* Colours are differences: a channel's error is relative to the light from both faces, not to what interference leaves of it. */
static double all_sent(const float *m, vector l, vector v)
{
    return filmed(m, l, v) + lobe(m[PACKED_ALPHA], l, v) + m[PACKED_BASE + 1] / pi * l.z;
}

static double bare(const float *m, vector l, vector v)
{
    return (1 - (double)m[PACKED_METALLIC]) * plastic(m, l, v) +
           m[PACKED_METALLIC] * film_schlick(m[PACKED_BASE + 1], product(half_of(l, v), v)) * lobe(m[PACKED_ALPHA], l, v);
}

/* Without the surface's own index: there the inner face has no sides, and the text's formula no stable result. */
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
        /* A path of t wavelengths there and back has a phase of 2 pi t, with 3 roundings: the tolerance of a lobe of that width, reduced. */
        double turns = 2 * (double)cases[i][1] * (double)cases[i][2] / 400;
        compare(name, m, fmin(0.3, 1 / (1 + turns)), 0, filmed, all_sent);
        if (i < 2) check_reciprocity(name, m);
        m[PACKED_FILM + i % 2 + 1] = i % 2 == 0 ? 1 : 0; /* with air's index, or no thickness, it has no effect */
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

static double diffuse_transmission(const float *m, vector l, vector v)
{
    double share = m[PACKED_DIFFUSE_TRANSMISSION], fresnel = film_schlick(m[PACKED_F0], product(half_of(above(l), v), v));
    if (l.z < 0) return (1 - fresnel) * share * m[PACKED_DIFFUSE_TRANSMISSION + 2] / pi * -l.z;
    return fresnel * lobe(m[PACKED_ALPHA], l, v) + (1 - fresnel) * (1 - share) * m[PACKED_BASE + 1] / pi * l.z;
}

static void check_diffuse_transmission(void)
{
    static const float cases[4][3] = {{0.25f, 0.3f, 0.7f}, {1, 0.1f, 0.2f}, {0.5f, 1, 0.02f}, {0.9f, 0.02f, 1}};
    for (int i = 0; i < 4; i++) {
        float m[PACKED_FIELDS];
        char name[96];
        memcpy(m, plain, sizeof m);
        m[PACKED_DIFFUSE_TRANSMISSION] = cases[i][0], m[PACKED_DIFFUSE_TRANSMISSION + 1] = 0.2f, m[PACKED_DIFFUSE_TRANSMISSION + 2] = 0.9f, m[PACKED_DIFFUSE_TRANSMISSION + 3] = 0.5f;
        m[PACKED_ALPHA] = cases[i][1], m[PACKED_COSINE] = cases[i][2];
        snprintf(name, sizeof name, "diffuse transmission %g alpha %g cosine %g", (double)cases[i][0], (double)cases[i][1], (double)cases[i][2]);
        compare(name, m, fmin(0.3, cases[i][1]), 0, diffuse_transmission, diffuse_transmission); /* this formula from below: reciprocal */
    }
    float white[PACKED_FIELDS] = {[PACKED_BASE] = 1, [PACKED_BASE + 1] = 1, [PACKED_BASE + 2] = 1, [PACKED_ETA] = 1, [PACKED_DIFFUSE_TRANSMISSION] = 0.5f,
                                  [PACKED_DIFFUSE_TRANSMISSION + 1] = 1, [PACKED_DIFFUSE_TRANSMISSION + 2] = 1, [PACKED_DIFFUSE_TRANSMISSION + 3] = 1};
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
        check_diffuse_transmission();
    }
    for (int i = 0; i < kernel_widths(&cl); i++)
        if (programs[i]) clReleaseProgram(programs[i]);
    ec_cl_close(&cl);
    TEST_END();
}

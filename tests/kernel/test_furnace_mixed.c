/* tier: full */
/* White surfaces with random mixtures of all effects, also at the ends of their ranges, in white light. No more light returns than arrives,
 * unless there is diffuse reflection below a Fresnel layer (glTF's own mix returns up to twice the light at grazing angles). No weight is
 * negative or NaN. */
#include "kernel/layers_reference.h"

enum { SURFACES = 600 };

static double pick(const double *list, int count) { return list[test_random_u64() % (uint64_t)count]; }
#define PICK(...) pick((const double[]){__VA_ARGS__}, sizeof((const double[]){__VA_ARGS__}) / sizeof(double))
static double log_between(double a, double b) { return a * pow(b / a, test_random()); }

static void put(float *m, int field, double value) { m[field] = (float)value; }

/* Values as host and surface.h make them from a file: metal transmits nothing, and refracting lobes are no narrower than float half vectors
 * resolve. */
static void draw_lobe(float *m)
{
    double eta = PICK(1, 1, 1.5, 1 / 1.5, 2.4, 1 / 2.4, 1.001, 1 / 1.001, 1.33 / 1.5), transmission = PICK(0, 0.3, 0.7, 1, 1);
    double alpha = PICK(1e-4, 1e-3, 0.25, 1, log_between(1e-4, 1)), metallic = PICK(0, 0, 0.5, 1), r;
    if (metallic == 1) transmission = 0;
    if (transmission == 0) eta = 1;
    if (eta != 1) alpha = fmin(fmax(alpha, 1.01e-4 * fmax(eta, 1) / fabs(eta - 1)), 1);
    r = (eta - 1) / (eta + 1);
    put(m, PACKED_METALLIC, metallic);
    put(m, PACKED_ALPHA, alpha);
    put(m, PACKED_ETA, eta);
    put(m, PACKED_TRANSMISSION, transmission);
    put(m, PACKED_F0, eta == 1 ? PICK(0, 0.04, 0.04, 0.5, 1) : r * r * PICK(1, 1, 0));
    put(m, PACKED_F90, PICK(1, 1, m[PACKED_F0]));
    put(m, PACKED_STRETCH, PICK(0, log_between(1, 1 / alpha) - 1, 1 / alpha - 1));
    put(m, PACKED_TURN, test_random());
    put(m, PACKED_COSINE, PICK(1, 0.5, 0.1, 0.01, 1e-3, test_random_in(1e-3, 1)));
}

static void draw_layers(float *m)
{
    const double share = PICK(0, 0.5, 1), colour = PICK(0, 0, 1, 1, 0.5);
    put(m, PACKED_DIFFUSE_TRANSMISSION, m[PACKED_METALLIC] < 1 ? share : 0);
    for (int k = 0; k < 3; k++) m[PACKED_BASE + k] = m[PACKED_DIFFUSE_TRANSMISSION + 1 + k] = 1, put(m, PACKED_SHEEN + k, colour);
    put(m, PACKED_SHEEN_ROUGHNESS, PICK(0, 0.07, 0.3, 1, test_random()));
    put(m, PACKED_COAT, PICK(0, 0, 0.5, 1));
    put(m, PACKED_COAT_ALPHA, PICK(1e-4, 0.01, 1, log_between(1e-4, 1)));
    const double tilt = PICK(0, 0, 0.3, -0.3, 0.9), cosine = m[PACKED_COSINE], sine = sqrt(1 - cosine * cosine);
    const double across = sine * cos(2 * pi * (double)m[PACKED_TURN]);
    put(m, PACKED_COAT_TILT, tilt * across + sqrt(1 - tilt * tilt) * cosine > 0.01 ? tilt : 0); /* surface_seen_normal: never from behind */
    put(m, PACKED_FILM, PICK(0, 0, 1, 0.5));
    put(m, PACKED_FILM + 1, PICK(1.3, 1, 2.5, 1.0001, test_random_in(1, 3)));
    put(m, PACKED_FILM + 2, PICK(0, 1e-3, 100, 400, 1200, 1e5));
}

static void say(const char *what, const float *m, double sum, double se)
{
    static const struct {
        const char *name;
        int field;
    } fields[] = {{"metallic", PACKED_METALLIC}, {"alpha", PACKED_ALPHA}, {"stretch less 1", PACKED_STRETCH}, {"turn", PACKED_TURN},
                  {"cosine", PACKED_COSINE}, {"transmission", PACKED_TRANSMISSION}, {"index", PACKED_ETA}, {"f0", PACKED_F0}, {"f90", PACKED_F90},
                  {"diffuse transmission", PACKED_DIFFUSE_TRANSMISSION}, {"sheen", PACKED_SHEEN}, {"its roughness", PACKED_SHEEN_ROUGHNESS}, {"coat", PACKED_COAT},
                  {"its alpha", PACKED_COAT_ALPHA}, {"its tilt", PACKED_COAT_TILT}, {"film", PACKED_FILM}, {"its index", PACKED_FILM + 1},
                  {"its nanometres", PACKED_FILM + 2}};
    printf("%s: %.5f +- %.5f;", what, sum, se);
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) printf(" %s %g", fields[i].name, (double)m[fields[i].field]);
    printf("\n");
}

static void surfaces(const char *what)
{
    float worst[PACKED_FIELDS] = {0}, open_worst[PACKED_FIELDS] = {0};
    double most = 0, most_se = 0, open_most = 0, open_se = 0;
    int closed_count = 0;
    for (int i = 0; i < SURFACES && !test_failures; i++) {
        float m[PACKED_FIELDS] = {0};
        double se = 0, sum;
        draw_lobe(m);
        draw_layers(m);
        sum = albedo(m, &se);
        bool closed = m[PACKED_METALLIC] == 1 || m[PACKED_TRANSMISSION] == 1 || m[PACKED_ETA] < 1;
        closed_count += closed;
        if (closed && sum - 5 * se > most - 5 * most_se) most = sum, most_se = se, memcpy(worst, m, sizeof m);
        if (!closed && sum > open_most) open_most = sum, open_se = se, memcpy(open_worst, m, sizeof m);
        CHECK_MSG(sum <= 2 + 5 * se, "surface %d: %g comes back", i, sum);
    }
    say(what, worst, most, most_se);
    say("scattered diffusely under it", open_worst, open_most, open_se);
    /* 5 standard errors: of 600 values, one exceeds that by chance 2 times in 10,000. */
    CHECK_MSG(most <= 1 + 5 * most_se + 2e-5, "%s: a white surface returns %.5f +- %.5f of what comes in", what, most, most_se);
    CHECK(closed_count > SURFACES / 3);
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    for (int again = 0; again < 2; again++) {
        char options[400];
        snprintf(options, sizeof options,
                 "-DFEATURES=(EC_FEATURE_SPECULAR+EC_FEATURE_TRANSMISSION+EC_FEATURE_SMOOTH+EC_FEATURE_CLEARCOAT+EC_FEATURE_CLEARCOAT_NORMAL_TEXTURE+"
                 "EC_FEATURE_SHEEN+EC_FEATURE_ANISOTROPY+EC_FEATURE_IRIDESCENCE+EC_FEATURE_DIFFUSE_TRANSMISSION%s)",
                 again ? "+EC_FEATURE_MULTISCATTER" : "");
        programs[EIGHT] = kernel_build(&cl, "chi2", 8, options);
        if (programs[EIGHT]) surfaces(again ? "facets scatter again" : "facets scatter once");
        if (programs[EIGHT]) clReleaseProgram(programs[EIGHT]);
    }
    ec_cl_close(&cl);
    TEST_END();
}

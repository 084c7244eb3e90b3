/* tiers: quick, full, long */
/* Compares bsdf_sample with bsdf_eval's density by chi-square, and the density's integral with 1. A sample where the density is 0 fails at
 * once. Polar cells are about the mirrored direction above the surface and the refracted one below, and are finer where the lobe is. */
#include "kernel/chi2.h"
#include "kernel/packed_material.h"

/* Kernels without and with transmission, with all layers, and with multiple scattering. Only the first is built for every width: the code
 * is the same for all widths, and the others take long to compile. */
static cl_program programs[LANE_WIDTHS], glass_programs[LANE_WIDTHS], layered_programs[LANE_WIDTHS], multi_programs[LANE_WIDTHS];

#define RINGS 20
#define SECTORS 24
#define CELLS (RINGS * SECTORS) /* on each side */
#define FINE 24 /* points of a cell's integral: radially, where rims of stretched lobes cross cells, … */
#define FINEST 96 /* … and in azimuth, where the horizon cuts cells */

typedef struct material {
    float metallic, alpha, cosine, base, transmission, eta; /* eta 1: thin */
} material;

typedef struct frame {
    double r[3], s[3], t[3]; /* r: the lobe's direction */
    double width;
} frame;

/* Angle from r at x in [0, 1], and its derivative times the sine. */
static double ring_angle(const frame *f, double x, double *density)
{
    double tangent = f->width * x / (1 - x), angle = 2 * atan(tangent);
    *density = 2 / (1 + tangent * tangent) * f->width / ((1 - x) * (1 - x)) * sin(angle);
    return angle;
}

static uint32_t cell_of(const frame *f, const double *w)
{
    double z = w[0] * f->r[0] + w[1] * f->r[1] + w[2] * f->r[2], x = w[0] * f->s[0] + w[1] * f->s[1] + w[2] * f->s[2];
    double y = w[0] * f->t[0] + w[1] * f->t[1] + w[2] * f->t[2], angle = atan2(sqrt(x * x + y * y), z);
    double tangent = tan(angle / 2) / f->width, ring = tangent / (1 + tangent), sector = atan2(y, x) / (2 * pi) + 0.5;
    uint32_t i = (uint32_t)fmin(ring * RINGS, RINGS - 1), j = (uint32_t)fmin(sector * SECTORS, SECTORS - 1);
    return i * SECTORS + j;
}

/* The direction in the plane of incidence at (x, z). */
static frame frame_about(double x, double z, double width)
{
    return (frame){{x, 0, z}, {z, 0, -x}, {0, 1, 0}, width};
}

static frame frame_above(const material *m)
{
    double sine = sqrt(1 - (double)m->cosine * m->cosine);
    return frame_about(-sine, m->cosine, m->metallic == 1 || m->transmission == 1 ? 2 * (double)m->alpha : 0.5);
}

/* By Snell's law; along the surface where a flat interface would reflect everything. */
static frame frame_below(const material *m)
{
    double sine = fmin(sqrt(1 - (double)m->cosine * m->cosine) / m->eta, 1), alpha = m->alpha;
    return frame_about(-sine, -sqrt(1 - sine * sine), m->eta == 1 ? 2 * alpha : sine == 1 ? 0.5 : alpha * fabs(1 - 1 / (double)m->eta));
}

static void integrate_cells(cl_program program, const frame *f, int side, const float *packed, double *mass)
{
    uint32_t n = CELLS * FINE * FINEST;
    float *wi = malloc(4 * n * sizeof *wi), *pdf = wi + 3 * n;
    double *weight = malloc(n * sizeof *weight);
    for (uint32_t p = 0; p < n; p++) {
        uint32_t cell = p / (FINE * FINEST), a = p / FINEST % FINE, b = p % FINEST;
        double density, angle = ring_angle(f, (cell / SECTORS + (a + 0.5) / FINE) / RINGS, &density);
        double phi = 2 * pi * ((cell % SECTORS + (b + 0.5) / FINEST) / SECTORS - 0.5);
        for (uint32_t k = 0; k < 3; k++)
            wi[k * n + p] = (float)(cos(angle) * f->r[k] + sin(angle) * (cos(phi) * f->s[k] + sin(phi) * f->t[k]));
        weight[p] = density / RINGS / FINE * 2 * pi / SECTORS / FINEST;
    }
    memset(mass, 0, CELLS * sizeof *mass);
    if (KERNEL_CALL(&cl, program, "bsdf_densities", n / 8, SCALAR(n), IN(packed, PACKED_FIELDS), IN(wi, 3 * n), OUT(pdf, n)))
        for (uint32_t p = 0; p < n; p++)
            if (wi[2 * n + p] * (float)side > 0) mass[p / (FINE * FINEST)] += weight[p] * pdf[p];
    free(wi);
    free(weight);
}

/* Without a diffuse base, all microfacets return F + (1 - F) = 1 of white light, times masking: the mean weight may not exceed 1. (glTF's
 * sum with a diffuse base may.) 4 standard errors of weights that are at most 1. */
static void check_energy(const char *name, const material *m)
{
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double weight = out[4 * SAMPLES + i];
        sum += weight / SAMPLES;
        squares += weight * weight / SAMPLES;
    }
    double se = sqrt(fmax(squares - sum * sum, 0) / SAMPLES);
    bool closed = m->base == 1 && (m->transmission == 1 || m->metallic == 1);
    CHECK_MSG(!closed || (sum <= 1 + 4 * se + 1e-5 && sum > 0.2), "%s: a white surface returns %g +- %g of what comes in", name, sum, se);
}

/* over: the layers, by the fields from PACKED_COAT on. */
static void check_covered(cl_program *built, int lanes, material m, const char *what, const float *over)
{
    char name[240];
    snprintf(name, sizeof name, "%s, LANES %d, metallic %g alpha %g cosine %g transmission %g eta %g", what, lane_widths[lanes],
             (double)m.metallic, (double)m.alpha, (double)m.cosine, (double)m.transmission, (double)m.eta);
    float r = (m.eta - 1) / (m.eta + 1), f0 = m.eta == 1 ? 0.04f : r * r;
    float packed[PACKED_FIELDS] = {m.base, m.base == 1 ? 1 : m.base * 0.5f, m.base == 1 ? 1 : 0.1f, f0, 1.0f, m.metallic, m.alpha, m.cosine,
                              m.transmission, m.eta};
    memcpy(packed + PACKED_COAT, over + PACKED_COAT, (PACKED_FIELDS - PACKED_COAT) * sizeof *packed);
    frame frames[2] = {frame_above(&m), frame_below(&m)};
    if (over[PACKED_DIFFUSE_TRANSMISSION] > 0 && m.transmission == 0) frames[1].width = 0.5;
    for (int side = 0; side < 2; side++) frames[side].width *= sqrt(1 + (double)over[PACKED_STRETCH]);
    double mass[CELLS], expected[2 * CELLS + 1], total = 0;
    uint32_t count[2 * CELLS + 1] = {0}, dark = 0, astray = 0;
    for (int side = 0; side < 2; side++) {
        integrate_cells(built[EIGHT], &frames[side], side ? -1 : 1, packed, mass);
        for (uint32_t i = 0; i < CELLS; i++) total += mass[i], expected[CELLS * side + i] = mass[i] * SAMPLES;
    }
    if (!KERNEL_CALL(&cl, built[lanes], "bsdf_samples", samples / (uint32_t)lane_widths[lanes], SCALAR(samples), SCALAR(seed),
                     IN(packed, PACKED_FIELDS), OUT(out, 5 * SAMPLES)))
        return;
    seed++;
    expected[2 * CELLS] = fmax(0, 1 - total) * SAMPLES; /* reflected by a microfacet to the wrong side */
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double w[3] = {out[i], out[SAMPLES + i], out[2 * SAMPLES + i]}, pdf = out[3 * SAMPLES + i];
        bool lost = w[2] == 0 || (w[2] < 0 && m.transmission == 0 && over[PACKED_DIFFUSE_TRANSMISSION] == 0);
        dark += !lost && !(pdf > 0);
        astray += lost ? pdf != 0 : fabs(w[0] * w[0] + w[1] * w[1] + w[2] * w[2] - 1) > 1e-5;
        count[lost ? 2 * CELLS : w[2] > 0 ? cell_of(&frames[0], w) : CELLS + cell_of(&frames[1], w)]++;
    }
    CHECK_MSG(dark == 0, "%s: %u samples where the density is 0", name, dark);
    CHECK_MSG(astray == 0, "%s: %u samples are no unit vectors or have a density although they are lost", name, astray);
    CHECK_MSG(total < 1 + 2e-3, "%s: the density integrates to %g", name, total);
    check_chi2(name, expected, count, 2 * CELLS + 1);
    check_energy(name, &m);
}

static void check_bsdf(cl_program *built, int lanes, material m)
{
    static const float nothing[PACKED_FIELDS];
    check_covered(built, lanes, m, "BSDF", nothing);
}

/* Thin walls, and bodies from outside and inside, where part or all of the light is totally reflected; half diffuse base; half metal. */
static void check_glass(void)
{
    static const float alphas[3] = {0.1f, 0.5f, 1.0f}, cosines[3] = {1.0f, 0.5f, 1e-2f}, etas[3] = {1.0f, 1.5f, 1 / 1.5f};
    static const material kinds[3] = {{0, 0, 0, 1, 1, 0}, {0, 0, 0, 0.8f, 0.5f, 0}, {0.5f, 0, 0, 1, 1, 0}};
    for (int k = 0; k < 3; k++)
        for (int e = 0; e < 3; e++)
            for (int a = 0; a < 3; a++)
                for (int c = k == 0 ? 0 : (a + e) % 3; c < (k == 0 ? 3 : (a + e) % 3 + 1); c++) {
                    material m = kinds[k];
                    m.eta = etas[e], m.alpha = alphas[a], m.cosine = cosines[c];
                    check_bsdf(glass_programs, EIGHT, m);
                }
    check_bsdf(glass_programs, EIGHT, (material){0, 1e-3f, 0.5f, 1, 1, 1.5f});
    check_bsdf(glass_programs, EIGHT, (material){0, 1e-3f, 0.8f, 1, 1, 1 / 1.5f});
    check_bsdf(glass_programs, EIGHT, (material){0, 0.3f, 0.7f, 1, 1, 1.01f}); /* nearly the index of air: a lobe of width 0.003 */
    check_bsdf(glass_programs, EIGHT, (material){0, 0.3f, 0.7f, 1, 1, 2.4f});
    check_bsdf(glass_programs, EIGHT, (material){0, 0.5f, 0.5f, 0.8f, 0, 1}); /* an opaque part beside glass */
}

static void check_opaque(void)
{
    static const float alphas[3] = {0.1f, 0.5f, 1.0f}, cosines[3] = {1.0f, 0.5f, 1e-2f}, metals[3] = {0.0f, 1.0f, 0.5f};
    for (int m = 0; m < 3; m++)
        for (int a = 0; a < 3; a++)
            for (int c = 0; c < 3; c++)
                check_bsdf(programs, (m + a + c) % kernel_widths(&cl), (material){metals[m], alphas[a], cosines[c], 0.8f, 0, 1});
    check_bsdf(programs, EIGHT, (material){1.0f, 1e-3f, 0.5f, 0.8f, 0, 1});
    check_bsdf(programs, 0, (material){0.0f, 0.5f, 0.5f, 0.0f, 0, 1}); /* black: one lobe */
}

static void check_coat_over(material m, float weight, float alpha, float tilt)
{
    const float over[PACKED_FIELDS] = {[PACKED_COAT] = weight, [PACKED_COAT_ALPHA] = alpha, [PACKED_COAT_TILT] = tilt};
    check_covered(layered_programs, EIGHT, m, tilt == 0 ? "coat" : "bent coat", over);
}

/* Clear coats over matt, metal and glass; with a tilted normal; over black, where only the coat is left. */
static void check_coat(void)
{
    static const float alphas[3] = {0.1f, 0.4f, 1.0f}, cosines[3] = {1.0f, 0.5f, 0.05f};
    for (int a = 0; a < 3; a++)
        for (int c = 0; c < 3; c++)
            check_coat_over((material){a == 1, 0.5f, cosines[c], a == 1 ? 1 : 0.8f, 0, 1}, 1, alphas[a], 0);
    check_coat_over((material){0, 0.5f, 0.6f, 0.8f, 0, 1}, 0.5f, 0.3f, 0.3f);
    check_coat_over((material){1, 0.3f, 0.4f, 1, 0, 1}, 1, 0.2f, -0.4f);
    check_coat_over((material){0, 0.5f, 0.5f, 1, 1, 1.5f}, 1, 0.2f, 0);
    check_coat_over((material){0, 0.5f, 0.3f, 0, 0, 1}, 1, 0.5f, 0);
}

/* Fibres, also with a coat. */
static void check_sheen(void)
{
    static const float roughness[3] = {0.2f, 0.5f, 1.0f}, cosines[3] = {1.0f, 0.5f, 0.05f};
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const float over[PACKED_FIELDS] = {[PACKED_SHEEN] = 0.3f, [PACKED_SHEEN + 1] = 0.9f, [PACKED_SHEEN + 2] = 0.1f,
                                               [PACKED_SHEEN_ROUGHNESS] = roughness[r], [PACKED_COAT] = r == 1, [PACKED_COAT_ALPHA] = 0.3f};
            check_covered(layered_programs, EIGHT, (material){c == 1, 0.5f, cosines[c], c == 1 ? 1 : 0.8f, r == 2, r == 2 ? 1.5f : 1}, "sheen", over);
        }
}

/* Lobes five and twenty times as long as wide, along, across and askew; also of panes, and of bodies from either side. */
static void check_anisotropy(void)
{
    static const float stretches[2] = {5, 20}, turns[3] = {0, 0.25f, 0.1f}, cosines[3] = {1, 0.5f, 0.1f}, etas[3] = {1, 1.5f, 1 / 1.5f};
    for (int s = 0; s < 2; s++)
        for (int a = 0; a < 3; a++) {
            const float over[PACKED_FIELDS] = {[PACKED_STRETCH] = stretches[s] - 1, [PACKED_TURN] = turns[a]};
            float alpha = s ? 0.05f : 0.15f;
            check_covered(layered_programs, EIGHT, (material){a != 2, alpha, cosines[(s + a) % 3], a == 2 ? 0.8f : 1, 0, 1}, "anisotropy", over);
            check_covered(layered_programs, EIGHT, (material){0, alpha, cosines[a], 1, 1, etas[(s + a) % 3]}, "brushed glass", over);
            check_covered(layered_programs, EIGHT, (material){0, alpha, cosines[(a + 1) % 3], 1, 1, etas[(s + a + 1) % 3]}, "brushed glass", over);
        }
}

/* Thin films, which decide how often light is reflected, transmitted or reaches the base. */
static void check_film(void)
{
    const float over[PACKED_FIELDS] = {[PACKED_FILM] = 1, [PACKED_FILM + 1] = 1.6f, [PACKED_FILM + 2] = 350};
    check_covered(layered_programs, EIGHT, (material){0, 0.3f, 0.5f, 0.8f, 0, 1}, "film", over);
    check_covered(layered_programs, EIGHT, (material){0.5f, 0.2f, 0.2f, 1, 0, 1}, "film", over);
    check_covered(layered_programs, EIGHT, (material){0, 0.3f, 0.7f, 1, 1, 1}, "film on a pane", over);
    check_covered(layered_programs, EIGHT, (material){0, 0.3f, 0.5f, 1, 1, 1.5f}, "film on glass", over);
    check_covered(layered_programs, EIGHT, (material){0, 0.2f, 0.6f, 1, 0.5f, 1 / 1.5f}, "film on glass from inside", over);
}

/* Paper, a leaf that is black on one side, frosted panes, and glass with a diffusely transmitting base. */
static void check_diffuse_transmission(void)
{
    const float over[PACKED_FIELDS] = {[PACKED_DIFFUSE_TRANSMISSION] = 0.4f, [PACKED_DIFFUSE_TRANSMISSION + 1] = 0.3f, [PACKED_DIFFUSE_TRANSMISSION + 2] = 0.9f, [PACKED_DIFFUSE_TRANSMISSION + 3] = 0.1f};
    check_covered(layered_programs, EIGHT, (material){0, 0.3f, 0.5f, 0.8f, 0, 1}, "diffuse transmission", over);
    check_covered(layered_programs, EIGHT, (material){0, 0.5f, 0.1f, 0, 0, 1}, "diffuse transmission", over);
    check_covered(layered_programs, EIGHT, (material){0, 0.3f, 0.7f, 0.8f, 0.5f, 1}, "diffuse transmission", over);
    check_covered(layered_programs, EIGHT, (material){0.5f, 0.4f, 0.6f, 0.8f, 0.5f, 1.5f}, "diffuse transmission", over);
}

/* Multiple scattering between facets, on either side. */
static void check_multiscatter(void)
{
    check_bsdf(multi_programs, EIGHT, (material){1, 0.25f, 0.5f, 1, 0, 1});
    check_bsdf(multi_programs, EIGHT, (material){1, 1, 0.05f, 1, 0, 1});
    check_bsdf(multi_programs, EIGHT, (material){0.5f, 0.5f, 0.7f, 0.8f, 0, 1});
    check_bsdf(multi_programs, EIGHT, (material){0, 0.5f, 0.3f, 1, 1, 1});
    check_bsdf(multi_programs, EIGHT, (material){0, 0.3f, 0.5f, 1, 1, 1.5f});
    check_bsdf(multi_programs, EIGHT, (material){0.3f, 1, 0.6f, 0.8f, 0.5f, 1 / 1.5f});
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    if (test_tier("quick") || test_tier("long")) chi2_build(programs, "-DFEATURES=EC_FEATURE_SPECULAR");
    if (test_tier("full") || test_tier("long"))
        glass_programs[EIGHT] = kernel_build(&cl, "chi2", lane_widths[EIGHT], "-DFEATURES=(EC_FEATURE_SPECULAR+EC_FEATURE_TRANSMISSION+EC_FEATURE_SMOOTH)");
    if (test_tier("full")) {
        layered_programs[EIGHT] = kernel_build(&cl, "chi2", lane_widths[EIGHT], "-DFEATURES=(EC_FEATURE_SPECULAR+EC_FEATURE_TRANSMISSION+EC_FEATURE_SMOOTH+EC_FEATURE_CLEARCOAT+EC_FEATURE_CLEARCOAT_NORMAL_TEXTURE+EC_FEATURE_SHEEN+EC_FEATURE_ANISOTROPY+EC_FEATURE_IRIDESCENCE+EC_FEATURE_DIFFUSE_TRANSMISSION)");
        multi_programs[EIGHT] = kernel_build(&cl, "chi2", lane_widths[EIGHT], "-DFEATURES=(EC_FEATURE_SPECULAR+EC_FEATURE_TRANSMISSION+EC_FEATURE_SMOOTH+EC_FEATURE_MULTISCATTER)");
    }
    if (!test_failures && (test_tier("quick") || test_tier("long"))) check_opaque();
    if (!test_failures && (test_tier("full") || test_tier("long"))) check_glass();
    if (!test_failures && test_tier("full")) {
        check_coat();
        check_sheen();
        check_anisotropy();
        check_film();
        check_diffuse_transmission();
        check_multiscatter();
    }
    printf("%d chi-square tests\n", tests);
    CHECK(tests <= TESTS - 20); /* the lights' tests */
    chi2_release(programs);
    chi2_release(glass_programs);
    chi2_release(layered_programs);
    chi2_release(multi_programs);
    ec_cl_close(&cl);
    TEST_END();
}

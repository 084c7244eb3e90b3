/* Sampling routines against their densities by chi-square; densities against 1 and against the alias tables' exact
 * probabilities. Cells that expect fewer than 5 are pooled; significance 0.01 over all tests (Sidak). A sample where the
 * density is 0 fails at once. */
#include "kernel/kernel_run.h"
#include "pack/alias.h"
#include "pack/pack.h"
#include "shared/params.h"

#define SAMPLES (1u << 17)
#define TESTS 120 /* at least as many as there are */

static ec_cl cl;
static cl_program programs[LANE_WIDTHS], glass_programs[LANE_WIDTHS]; /* without and with transmission */
static const double pi = 3.14159265358979323846;
static float out[5 * SAMPLES];
static uint32_t samples = SAMPLES, seed = 1;
static int tests;

/* Upper tail of chi-square by Wilson and Hilferty 1931: good to a few per cent of p for the k here. */
static double chi2_p(double chi2, double k)
{
    double z = (cbrt(chi2 / k) - (1 - 2 / (9 * k))) / sqrt(2 / (9 * k));
    return 0.5 * erfc(z / sqrt(2));
}

static void check_chi2(const char *name, const double *expected, const uint32_t *count, uint32_t cells)
{
    double chi2 = 0, pooled = 0, pooled_count = 0;
    uint32_t k = 0;
    for (uint32_t i = 0; i < cells; i++) {
        if (expected[i] >= 5) {
            chi2 += (count[i] - expected[i]) * (count[i] - expected[i]) / expected[i];
            k++;
        } else {
            pooled += expected[i];
            pooled_count += count[i];
        }
    }
    if (pooled >= 5) chi2 += (pooled_count - pooled) * (pooled_count - pooled) / pooled, k++;
    else CHECK_MSG(pooled_count <= 25, "%s: %g samples where %g are expected", name, pooled_count, pooled);
    double p = k > 1 ? chi2_p(chi2, k - 1) : 1, least = 1 - pow(0.99, 1.0 / TESTS);
    CHECK_MSG(p > least && k > 1, "%s: chi^2 %.1f with %u degrees of freedom, p = %.2g < %.2g", name, chi2, k - 1, p, least);
    tests++;
}

/* ---- the BSDF: polar cells about the mirrored direction above the surface and about the refracted one below, finer where
 * the lobe is ---- */

#define RINGS 20
#define SECTORS 24
#define CELLS (RINGS * SECTORS) /* each side */
#define FINE 12 /* points of a cell's integral: along the radius … */
#define FINEST 96 /* … and around, where the horizon cuts cells in two */

typedef struct material {
    float metallic, alpha, cosine, base, transmission, eta; /* eta 1: thin */
} material;

typedef struct frame {
    double r[3], s[3], t[3]; /* r: where the lobe points */
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

/* In the plane of incidence, at (x, z). */
static frame frame_about(double x, double z, double width)
{
    return (frame){{x, 0, z}, {z, 0, -x}, {0, 1, 0}, width};
}

static frame frame_above(const material *m)
{
    double sine = sqrt(1 - (double)m->cosine * m->cosine);
    return frame_about(-sine, m->cosine, m->metallic == 1 || m->transmission == 1 ? 2 * (double)m->alpha : 0.5);
}

/* By Snell's law; along the surface where a flat one would reflect everything. */
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
    if (KERNEL_CALL(&cl, program, "bsdf_densities", n / 8, SCALAR(n), IN(packed, 10), IN(wi, 3 * n), OUT(pdf, n)))
        for (uint32_t p = 0; p < n; p++)
            if (wi[2 * n + p] * (float)side > 0) mass[p / (FINE * FINEST)] += weight[p] * pdf[p];
    free(wi);
    free(weight);
}

/* What all microfacets return of white light is F + (1 - F) = 1 times masking where nothing is scattered diffusely: the mean
 * weight may not exceed 1. (glTF's sum of a diffuse base may.) 4 standard errors, of weights that are at most 1. */
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

static void check_bsdf(cl_program *built, int lanes, material m)
{
    char name[160];
    snprintf(name, sizeof name, "BSDF, LANES %d, metallic %g alpha %g cosine %g transmission %g eta %g", lane_widths[lanes],
             (double)m.metallic, (double)m.alpha, (double)m.cosine, (double)m.transmission, (double)m.eta);
    float r = (m.eta - 1) / (m.eta + 1), f0 = m.eta == 1 ? 0.04f : r * r;
    const float packed[10] = {m.base, m.base == 1 ? 1 : m.base * 0.5f, m.base == 1 ? 1 : 0.1f, f0, 1.0f, m.metallic, m.alpha, m.cosine,
                              m.transmission, m.eta};
    const frame frames[2] = {frame_above(&m), frame_below(&m)};
    double mass[CELLS], expected[2 * CELLS + 1], total = 0;
    uint32_t count[2 * CELLS + 1] = {0}, dark = 0, astray = 0;
    for (int side = 0; side < 2; side++) {
        integrate_cells(built[2], &frames[side], side ? -1 : 1, packed, mass);
        for (uint32_t i = 0; i < CELLS; i++) total += mass[i], expected[CELLS * side + i] = mass[i] * SAMPLES;
    }
    if (!KERNEL_CALL(&cl, built[lanes], "bsdf_samples", samples / (uint32_t)lane_widths[lanes], SCALAR(samples), SCALAR(seed),
                     IN(packed, 10), OUT(out, 5 * SAMPLES)))
        return;
    seed++;
    expected[2 * CELLS] = fmax(0, 1 - total) * SAMPLES; /* off a microfacet onto the wrong side */
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double w[3] = {out[i], out[SAMPLES + i], out[2 * SAMPLES + i]}, pdf = out[3 * SAMPLES + i];
        bool lost = w[2] == 0 || (w[2] < 0 && m.transmission == 0);
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

/* Thin walls, bodies from outside and from inside, where part or all of the light is reflected totally; half of the base
 * diffuse; half metal. */
static void check_glass(void)
{
    static const float alphas[3] = {0.1f, 0.5f, 1.0f}, cosines[3] = {1.0f, 0.5f, 1e-2f}, etas[3] = {1.0f, 1.5f, 1 / 1.5f};
    static const material kinds[3] = {{0, 0, 0, 1, 1, 0}, {0, 0, 0, 0.8f, 0.5f, 0}, {0.5f, 0, 0, 1, 1, 0}};
    int turn = 0;
    for (int k = 0; k < 3; k++)
        for (int e = 0; e < 3; e++)
            for (int a = 0; a < 3; a++)
                for (int c = k == 0 ? 0 : (a + e) % 3; c < (k == 0 ? 3 : (a + e) % 3 + 1); c++) {
                    material m = kinds[k];
                    m.eta = etas[e], m.alpha = alphas[a], m.cosine = cosines[c];
                    check_bsdf(glass_programs, turn++ % LANE_WIDTHS, m);
                }
    check_bsdf(glass_programs, 0, (material){0, 1e-3f, 0.5f, 1, 1, 1.5f});
    check_bsdf(glass_programs, 1, (material){0, 1e-3f, 0.8f, 1, 1, 1 / 1.5f});
    check_bsdf(glass_programs, 2, (material){0, 0.3f, 0.7f, 1, 1, 1.01f}); /* nearly air: a lobe of width 0.003 */
    check_bsdf(glass_programs, 3, (material){0, 0.3f, 0.7f, 1, 1, 2.4f});
    check_bsdf(glass_programs, 1, (material){0, 0.5f, 0.5f, 0.8f, 0, 1}); /* what is opaque beside glass */
}

/* ---- a triangle: cells of equal area, and what of its solid angle they have where it is near ---- */

static double solid_angle_of_cells(const float (*v)[3], const float *p, const double *n, double area, double *cells)
{
    enum { STEPS = 40 };
    double total = 0;
    for (int cell = 0; cell < 100; cell++) {
        cells[cell] = 0;
        for (int step = 0; step < STEPS * STEPS; step++) {
            double root = sqrt((cell / 10 + (step / STEPS + 0.5) / STEPS) / 10), across = (cell % 10 + (step % STEPS + 0.5) / STEPS) / 10;
            double w[3], d2 = 0, projected = 0;
            for (int k = 0; k < 3; k++) {
                w[k] = (1 - root) * (double)v[0][k] + root * (1 - across) * (double)v[1][k] + root * across * (double)v[2][k] - (double)p[k];
                d2 += w[k] * w[k], projected += w[k] * n[k] / (2 * area);
            }
            cells[cell] += area / 100 / STEPS / STEPS * fabs(projected) / (d2 * sqrt(d2));
        }
        total += cells[cell];
    }
    return total;
}

static void check_triangle(int lanes, bool two_sided, bool near, const float *p)
{
    const float v[3][3] = {{-1.0f, 2.0f, 0.5f}, {1.5f, 2.5f, -0.5f}, {0.25f, 3.0f, 2.0f}};
    ec_params params = {.light_count = 2, .scene_radius = 10};
    ec_light_data table[2] = {{.kind = EC_KIND_TRIANGLE | (two_sided ? EC_LIGHT_TWO_SIDED : 0), .prim = 7},
                              {.kind = EC_KIND_POINT, .prim = EC_NO_ID, .a = {5, 5, 5}, .b = {0, 0, 1}}};
    double e1[3], e2[3], n[3], pmf[2], area = 0;
    for (int k = 0; k < 3; k++) e1[k] = (double)v[1][k] - v[0][k], e2[k] = (double)v[2][k] - v[0][k];
    for (int k = 0; k < 3; k++) n[k] = e1[(k + 1) % 3] * e2[(k + 2) % 3] - e1[(k + 2) % 3] * e2[(k + 1) % 3];
    area = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
    ec_alias alias[2];
    ec_error err = {""};
    CHECK_OK(ec_alias_build((const double[]){3, 1}, 2, alias, pmf, &err), err);
    memcpy(table[0].a, v[0], sizeof v[0]);
    memcpy(table[0].b, v[1], sizeof v[1]);
    memcpy(table[0].c, v[2], sizeof v[2]);
    for (int i = 0; i < 2; i++) table[i].pmf = (float)pmf[i];
    table[0].pdf_a = (float)(pmf[0] / area);
    const float nothing[16] = {0};
    if (!KERNEL_CALL(&cl, programs[lanes], "light_samples", samples / (uint32_t)lane_widths[lanes], SCALAR(samples), SCALAR(seed),
                     IN(&params, 1), IN(p, 4), IN(table, 2), IN(alias, 2), IN(nothing, 16), IN(nothing, 16), OUT(out, 4 * SAMPLES)))
        return;
    uint32_t count[101] = {0}, wrong = 0, points = 0, hidden = 0;
    double expected[101], solid_angle = solid_angle_of_cells(v, p, n, area, expected);
    for (int i = 0; i < 100; i++) expected[i] = pmf[0] * SAMPLES * (near ? expected[i] / solid_angle : 0.01);
    expected[100] = pmf[1] * SAMPLES;
    bool seen = two_sided;
    double from_front = 0;
    for (int k = 0; k < 3; k++) from_front += n[k] * ((double)p[k] - v[0][k]);
    seen |= from_front > 0;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double w[3] = {out[i], out[SAMPLES + i], out[2 * SAMPLES + i]}, q[3], s[3], det = 0, b1 = 0, b2 = 0, t = 0, pdf = out[3 * SAMPLES + i];
        if (fabs(w[0] - (5 - p[0]) / sqrt(pow(5 - p[0], 2) + pow(5 - p[1], 2) + pow(5 - p[2], 2))) < 1e-5 && pdf == (double)table[1].pmf) {
            points++;
            count[100]++;
            continue;
        }
        if (pdf == 0) {
            hidden++;
            continue;
        }
        for (int k = 0; k < 3; k++) q[k] = w[(k + 1) % 3] * e2[(k + 2) % 3] - w[(k + 2) % 3] * e2[(k + 1) % 3], s[k] = (double)p[k] - v[0][k];
        for (int k = 0; k < 3; k++) det += e1[k] * q[k], b1 += s[k] * q[k];
        for (int k = 0; k < 3; k++) q[k] = s[(k + 1) % 3] * e1[(k + 2) % 3] - s[(k + 2) % 3] * e1[(k + 1) % 3];
        for (int k = 0; k < 3; k++) b2 += w[k] * q[k], t += e2[k] * q[k];
        b1 /= det, b2 /= det, t /= det;
        double cosine = fabs(n[0] * w[0] + n[1] * w[1] + n[2] * w[2]) / (2 * area);
        double want = near ? pmf[0] / solid_angle : pmf[0] / area * t * t / cosine;
        wrong += fabs(pdf / want - 1) > 1e-4 || fmin(fmin(b1, b2), 1 - b1 - b2) < -1e-5;
        double root = fmin(fmax(b1 + b2, 0), 1), across = fmin(fmax(b2 / fmax(root, 1e-12), 0), 1);
        count[(uint32_t)fmin(root * root * 10, 9) * 10 + (uint32_t)fmin(across * 10, 9)]++;
    }
    CHECK_MSG(wrong == 0, "triangle light: %u samples off the triangle or with another density than theirs", wrong);
    if (seen) check_chi2(near ? "near triangle light" : two_sided ? "triangle light, two-sided" : "triangle light", expected, count, 101);
    else CHECK_MSG(hidden + points == SAMPLES, "a light seen from behind gives %u samples", SAMPLES - hidden - points);
    CHECK(!seen || hidden == 0);
}

/* ---- the environment ---- */

#define WIDTH 24u
#define HEIGHT 12u

static void directions_of(double u, double v, double *w)
{
    double phi = 2 * pi * (u - 0.5), theta = pi * v;
    w[0] = sin(theta) * cos(phi), w[1] = cos(theta), w[2] = sin(theta) * sin(phi);
}

static double bilinear(const float *rgb, double u, double v)
{
    double x = u * WIDTH - 0.5, y = v * HEIGHT - 0.5, fx = x - floor(x), fy = y - floor(y), sum = 0;
    for (int k = 0; k < 4; k++) {
        int64_t i = ((int64_t)floor(x) + (k & 1) + WIDTH) % WIDTH, j = (int64_t)floor(y) + (k >> 1);
        j = j < 0 ? 0 : (j >= (int64_t)HEIGHT ? HEIGHT - 1 : j);
        sum += (k & 1 ? fx : 1 - fx) * (k & 2 ? fy : 1 - fy) * rgb[3 * (j * WIDTH + i)];
    }
    return sum;
}

static void check_environment(void)
{
    static float rgb[3 * WIDTH * HEIGHT], wi[3 * SAMPLES], look[2 * SAMPLES], factor[4] = {2, 2, 2, 0};
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        bool black = i % WIDTH > 14 && i / WIDTH > 2 && i / WIDTH < 10;
        float value = black ? 0.0f : (float)pow(10, test_random_in(-2, 0.5));
        if (i == 5 * WIDTH + 4) value = 200;
        for (int k = 0; k < 3; k++) rgb[3 * i + (uint32_t)k] = value;
    }
    ec_scene scene = {.has_environment = true};
    scene.environment.width = WIDTH;
    scene.environment.height = HEIGHT;
    scene.environment.rgb = rgb;
    ec_pack pack = {0};
    double mean;
    ec_error err = {""};
    CHECK_OK(ec_pack_environment(&scene, &pack, &mean, &err), err);
    if (!pack.environment_alias) return;
    ec_params params = {.light_count = 1, .environment_width = WIDTH, .environment_height = HEIGHT, .environment_pmf = 1, .scene_radius = 3};
    memcpy(params.environment, factor, sizeof factor);
    const ec_light_data light = {.kind = EC_KIND_ENVIRONMENT, .prim = EC_NO_ID, .pmf = 1};
    const ec_alias only = {UINT32_MAX, 0};
    const float p[4] = {0};
    for (int lanes = 0; lanes < LANE_WIDTHS; lanes += 3) {
        if (!KERNEL_CALL(&cl, programs[lanes], "light_samples", samples / (uint32_t)lane_widths[lanes], SCALAR(samples), SCALAR(seed),
                         IN(&params, 1), IN(p, 4), IN(&light, 1), IN(&only, 1), IN(pack.environment_texels, 4 * WIDTH * HEIGHT),
                         IN(pack.environment_alias, WIDTH * HEIGHT), OUT(out, 4 * SAMPLES)))
            break;
        uint32_t count[WIDTH * HEIGHT] = {0}, dark = 0, wrong = 0;
        double expected[WIDTH * HEIGHT];
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) expected[i] = (double)pack.environment_texels[4 * i + 3] * SAMPLES;
        for (uint32_t i = 0; i < SAMPLES; i++) {
            double w[3] = {out[i], out[SAMPLES + i], out[2 * SAMPLES + i]};
            double x = (atan2(w[2], w[0]) / (2 * pi) + 0.5) * WIDTH, y = acos(fmin(fmax(w[1], -1), 1)) / pi * HEIGHT;
            uint32_t cell = (uint32_t)fmin(y, HEIGHT - 1) * WIDTH + (uint32_t)fmin(x, WIDTH - 1);
            bool inside = fabs(x - round(x)) > 1e-4 && fabs(y - round(y)) > 1e-4;
            double want = expected[cell] / SAMPLES * WIDTH * HEIGHT / (2 * pi * pi * sqrt(w[0] * w[0] + w[2] * w[2]));
            count[cell]++;
            dark += inside && expected[cell] == 0;
            wrong += inside && expected[cell] > 0 && fabs(out[3 * SAMPLES + i] / want - 1) > 1e-3 * (y < 0.1 || y > HEIGHT - 0.1 ? 10 : 1);
        }
        CHECK_MSG(dark == 0, "environment: %u samples where it is black", dark);
        CHECK_MSG(wrong == 0, "environment: %u samples with another density than their texel's", wrong);
        check_chi2("environment", expected, count, WIDTH * HEIGHT);
    }
    /* The density of look-ups integrates to 1, and what is looked up is the bilinear map. 288 texels of 21 x 21 points. */
    uint32_t n = WIDTH * HEIGHT * 21 * 21 / 16 * 16;
    for (uint32_t i = 0; i < n; i++) {
        double w[3];
        uint32_t x = i % (WIDTH * 21), y = i / (WIDTH * 21);
        directions_of((x + 0.5) / (WIDTH * 21), (y + 0.5) / (HEIGHT * 21), w);
        for (uint32_t k = 0; k < 3; k++) wi[k * n + i] = (float)w[k];
    }
    if (KERNEL_CALL(&cl, programs[3], "environment_densities", n / 16, SCALAR(n), IN(&params, 1), IN(pack.environment_texels, 4 * WIDTH * HEIGHT),
                    IN(pack.environment_alias, WIDTH * HEIGHT), IN(wi, 3 * n), OUT(look, 2 * n))) {
        double total = 0, worst = 0;
        uint32_t at = 0;
        for (uint32_t i = 0; i < n; i++) {
            uint32_t x = i % (WIDTH * 21), y = i / (WIDTH * 21);
            double u = (x + 0.5) / (WIDTH * 21), v = (y + 0.5) / (HEIGHT * 21), sine = sin(pi * v), want = 2 * bilinear(rgb, u, v);
            total += (double)look[i] * sine * 2 * pi / (WIDTH * 21) * pi / (HEIGHT * 21);
            double error = fabs(look[n + i] - want) / (want + 4);
            if (error > worst) worst = error, at = i;
        }
        printf("environment: density integrates to 1 %+.1e, bilinear error %.1e\n", total - 1, worst);
        CHECK_MSG(fabs(total - 1) < 1e-4, "the environment's density integrates to %.6f", total);
        CHECK_MSG(worst < 1e-4, "the environment's bilinear look-up is off by %g at column %u, row %u of %u: %g", worst, at % (WIDTH * 21), at / (WIDTH * 21), HEIGHT * 21, (double)look[n + at]);
    }
    free(pack.environment_texels);
    free(pack.environment_alias);
}

/* ---- alias tables: the probabilities are those of the kernels' 2^32 random numbers, exactly ---- */

/* What light_sample_one and environment_sample do with a random number. */
static uint32_t picked(const ec_alias *table, uint32_t n, uint32_t r)
{
    uint32_t column = (uint32_t)((uint64_t)r * n >> 32), rest = r * n;
    return rest < table[column].threshold ? column : table[column].other;
}

static void check_alias(uint32_t n, int kind)
{
    double *weights = malloc(n * sizeof *weights), *pmf = malloc(n * sizeof *pmf), sum = 0, total = 0, worst = 0;
    uint64_t *count = calloc(n, sizeof *count);
    ec_alias *table = malloc(n * sizeof *table);
    for (uint32_t i = 0; i < n; i++) {
        weights[i] = kind == 0 ? 1 : pow(10, test_random_in(-6, 3));
        if (kind == 2 && i % 3 == 1) weights[i] = 0;
        sum += weights[i];
    }
    ec_error err = {""};
    CHECK_OK(ec_alias_build(weights, n, table, pmf, &err), err);
    for (uint32_t c = 0; c < n; c++) {
        uint64_t first = (((uint64_t)c << 32) + n - 1) / n, end = (((uint64_t)(c + 1) << 32) + n - 1) / n, low = first, high = end;
        while (low < high) { /* the column's numbers below its threshold come first */
            uint64_t middle = (low + high) / 2;
            if ((uint32_t)((uint32_t)middle * n) < table[c].threshold) low = middle + 1;
            else high = middle;
        }
        count[c] += low - first;
        count[table[c].other] += end - low;
        for (uint64_t r = first; r < end && r < first + 3; r++) CHECK(weights[picked(table, n, (uint32_t)r)] > 0);
        CHECK(end > first && weights[picked(table, n, (uint32_t)(end - 1))] > 0);
    }
    for (uint32_t i = 0; i < n; i++) {
        total += pmf[i];
        worst = fmax(worst, fabs(pmf[i] - weights[i] / sum));
        if ((double)count[i] * 0x1p-32 != pmf[i]) {
            CHECK_MSG(false, "alias table of %u: entry %u is picked %llu times in 2^32, not %.17g", n, i, (unsigned long long)count[i], pmf[i] * 0x1p32);
            break;
        }
        CHECK(weights[i] > 0 ? pmf[i] > 0 : pmf[i] == 0);
    }
    CHECK_MSG(total == 1.0, "alias table of %u: probabilities sum to %.17g", n, total);
    CHECK_MSG(worst <= 1e-9 + 4 * n * 0x1p-32, "alias table of %u: a probability is off by %g", n, worst);
    free(weights);
    free(pmf);
    free(count);
    free(table);
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    for (int i = 0; i < LANE_WIDTHS; i++) {
        programs[i] = kernel_build(&cl, "chi2", lane_widths[i],
                                   "-DFEATURES=(EC_FEATURE_SPECULAR+EC_FEATURE_AREA_LIGHTS+EC_FEATURE_PUNCTUAL_LIGHTS+EC_FEATURE_ENVIRONMENT"
                                   "+EC_FEATURE_ENVIRONMENT_MAP)");
        glass_programs[i] = kernel_build(&cl, "chi2", lane_widths[i],
                                         "-DFEATURES=(EC_FEATURE_SPECULAR+EC_FEATURE_TRANSMISSION+EC_FEATURE_SMOOTH)");
    }
    if (!test_failures) {
        static const float alphas[3] = {0.1f, 0.5f, 1.0f}, cosines[3] = {1.0f, 0.5f, 1e-2f}, metals[3] = {0.0f, 1.0f, 0.5f};
        for (int m = 0; m < 3; m++)
            for (int a = 0; a < 3; a++)
                for (int c = 0; c < 3; c++)
                    check_bsdf(programs, (m + a + c) % LANE_WIDTHS, (material){metals[m], alphas[a], cosines[c], 0.8f, 0, 1});
        check_bsdf(programs, 2, (material){1.0f, 1e-3f, 0.5f, 0.8f, 0, 1});
        check_bsdf(programs, 1, (material){0.0f, 0.5f, 0.5f, 0.0f, 0, 1}); /* black: one lobe */
        check_glass();
        check_triangle(0, false, true, (const float[4]){0.1f, -0.3f, 0.2f}); /* before it */
        check_triangle(3, false, true, (const float[4]){0.1f, 6.0f, 0.2f}); /* behind it */
        check_triangle(2, true, true, (const float[4]){0.1f, 6.0f, 0.2f});
        check_triangle(1, false, true, (const float[4]){0.2f, 2.45f, 0.6f}); /* 0.04 from its face */
        check_triangle(3, false, true, (const float[4]){1.4f, 2.4f, -0.3f}); /* by a corner */
        check_triangle(0, false, false, (const float[4]){0.1f, -9.0f, 0.2f});
        check_triangle(2, true, false, (const float[4]){-14.0f, 6.0f, 0.2f});
        check_environment();
        for (int kind = 0; kind < 3; kind++)
            for (uint32_t n = 1; n <= 100000; n *= 10) check_alias(n + (uint32_t)kind * 2, kind);
        printf("%d chi-square tests\n", tests);
        CHECK(tests <= TESTS);
    }
    for (int i = 0; i < LANE_WIDTHS; i++) {
        if (programs[i]) clReleaseProgram(programs[i]);
        if (glass_programs[i]) clReleaseProgram(glass_programs[i]);
    }
    ec_cl_close(&cl);
    TEST_END();
}

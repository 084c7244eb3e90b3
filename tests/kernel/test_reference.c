/* tiers: quick, long */
/* Kernels against double precision: transcendental functions, the BRDF of glTF 2.0 appendix B. Every
 * lane width must give the same bits. */
#include "kernel/kernel_reference.h"

static void sines(void)
{
    static float u[N], s[N], c[N];
    for (uint32_t i = 0; i < N; i++) {
        u[i] = (float)i / (N - 1);                                               /* 0 and 1 included */
        if (i % 4 == 1) u[i] = (float)(test_random_u64() >> 40) * 0x1p-24f;      /* numbers of the sampler */
        if (i % 4 == 2) u[i] = (float)(i / 4 % 9) / 8 + (float)(i / 36) * 0x1p-24f; /* about multiples of 1/8 */
        if (i % 4 == 3) u[i] = (float)pow(2, -(double)(i % 120));
        u[i] = fminf(u[i], 1.0f);
    }
    if (!RUN_ALL("sincos_of", 1, IN(u, N), OUT(s, N), OUT(c, N))) return;
    double worst = 0, circle = 0;
    for (uint32_t i = 0; i < N; i++) {
        worst = fmax(worst, fmax(fabs(s[i] - sin(2 * pi * u[i])), fabs(c[i] - cos(2 * pi * u[i]))));
        circle = fmax(circle, fabs((double)s[i] * s[i] + (double)c[i] * c[i] - 1));
    }
    printf("sincos_2pi: error %.2f ulp of 1, s^2 + c^2 - 1 = %.1e\n", worst / (2 * U), circle);
    CHECK_MSG(worst < 2 * 2 * U, "sincos_2pi: error %g", worst);
    CHECK(s[0] == 0.0f && c[0] == 1.0f);
}

static void arcs(void)
{
    static float y[N], x[N], a[N];
    static const float special[5] = {0.0f, -0.0f, 1.0f, -1.0f, 1e-30f};
    for (uint32_t i = 0; i < N; i++) {
        double angle = test_random_in(-pi, pi), length = pow(10, test_random_in(-6, 6));
        y[i] = (float)(length * sin(angle));
        x[i] = (float)(length * cos(angle));
        if (i < 25) y[i] = special[i / 5], x[i] = special[i % 5];
        if (i % 8 == 7) y[i] = (float)(x[i] * pow(10, test_random_in(-9, 0)));
    }
    if (RUN_ALL("atan2_of", 2, IN(y, N), IN(x, N), OUT(a, N))) {
        double worst = 0;
        for (uint32_t i = 0; i < N; i++) {
            double want = x[i] == 0.0f && y[i] == 0.0f ? 0.0 : atan2((double)y[i], (double)x[i]) / (2 * pi);
            double error = fabs(a[i] - want);
            if (y[i] == 0.0f && x[i] < 0.0f) error = fabs(fabs(a[i]) - 0.5); /* either side of the seam */
            if (error > worst) worst = error;
            CHECK_MSG(fabsf(a[i]) <= 0.5f, "atan2(%g, %g) = %g", (double)y[i], (double)x[i], (double)a[i]);
        }
        printf("atan2_over_2pi: error %.2e\n", worst);
        CHECK_MSG(worst <= 2.5e-8 / 8 + 2 * U, "atan2_over_2pi: error %g", worst); /* as its comment states, plus rounding */
    }
}

static void logarithms(void)
{
    static float x[N], out[N];
    for (uint32_t i = 0; i < N; i++) {
        x[i] = i % 2 ? random_float(0.25, 1) : (float)exp2(test_random_in(-126, 0));
        if (i % 8 == 0) x[i] = (float)(1 - exp2(test_random_in(-24, 0))); /* near the function's zero */
    }
    x[0] = 1.0f, x[1] = 0.0f, x[2] = 1e-45f, x[3] = 0x1p-126f;
    if (!RUN_ALL("log_of", 1, IN(x, N), OUT(out, N))) return;
    double worst = 0;
    for (uint32_t i = 0; i < N; i++) {
        double want = log(fmax(x[i], 0x1p-126));
        CHECK_MSG(out[i] <= 0.0f, "log(%g) = %g", (double)x[i], (double)out[i]);
        if (x[i] < 1) worst = fmax(worst, fabs(out[i] - want) / exp2(floor(log2(-want)) - 23));
    }
    printf("log_unit: error %.2f ulp\n", worst);
    CHECK_MSG(worst < 2, "log_unit: error %g ulp", worst); /* as its comment states */
    CHECK(out[0] == 0.0f && out[1] == out[3] && out[2] == out[3]);
}

/* ---- the BRDF ---- */

typedef struct material {
    double base[3], f0[3], f90, metallic, alpha;
} material;

/* glTF 2.0, B.2 and B.3, in their own terms: mix(dielectric_brdf, metal_brdf, metallic), times n.l. D is computed from tan^2, so that the
 * smallest alphas keep their digits in double; G is Smith's height-correlated form (Heitz 2014, eq. 99). */
static void gltf_brdf(const material *m, const double *l, const double *v, double *f)
{
    double h[3] = {l[0] + v[0], l[1] + v[1], l[2] + v[2]}, length = sqrt(dot(h, h));
    for (int k = 0; k < 3; k++) h[k] /= length;
    double a2 = m->alpha * m->alpha, vh = dot(v, h), nh = h[2], nl = l[2], nv = v[2];
    double tan2 = (h[0] * h[0] + h[1] * h[1]) / (nh * nh);
    double D = 1 / (pi * a2 * pow(nh, 4) * (1 + tan2 / a2) * (1 + tan2 / a2));
    double lambda_v = (sqrt(1 + a2 * (1 - nv * nv) / (nv * nv)) - 1) / 2, lambda_l = (sqrt(1 + a2 * (1 - nl * nl) / (nl * nl)) - 1) / 2;
    double specular = D / (1 + lambda_v + lambda_l) / (4 * nl * nv), schlick = pow(1 - vh, 5);
    double dielectric_f[3], most = 0;
    for (int k = 0; k < 3; k++) {
        dielectric_f[k] = m->f0[k] + (m->f90 - m->f0[k]) * schlick;
        most = fmax(most, dielectric_f[k]);
    }
    for (int k = 0; k < 3; k++) {
        double metal = specular * (m->base[k] + (1 - m->base[k]) * schlick);
        double dielectric = dielectric_f[k] * specular + (1 - fmin(most, 1)) * m->base[k] / pi;
        f[k] = (m->metallic * metal + (1 - m->metallic) * dielectric) * nl;
    }
}

static double visible_density(double alpha, const double *l, const double *v)
{
    double h[3] = {l[0] + v[0], l[1] + v[1], l[2] + v[2]}, length = sqrt(dot(h, h)), a2 = alpha * alpha;
    for (int k = 0; k < 3; k++) h[k] /= length;
    double k = (h[0] * h[0] + h[1] * h[1]) / a2 + h[2] * h[2];
    return 1 / (pi * a2 * k * k) / (2 * (v[2] + sqrt(a2 + (1 - a2) * v[2] * v[2])));
}

static void random_direction(float *w, double z)
{
    double angle = test_random_in(-pi, pi), r = sqrt(1 - z * z);
    w[0] = (float)(r * cos(angle));
    w[N] = (float)(r * sin(angle));
    w[2 * N] = (float)z;
}

static float wo[3 * N], wi[3 * N], materials[9 * N], values[3 * N], swapped[3 * N], pdf[N];

static material random_material(uint32_t i)
{
    static const double alphas[8] = {1.0, 0.5, 0.1, 0.01, 1e-3, 1e-4, 0.25, 0.7};
    material m = {{random_float(0, 1), random_float(0, 1), random_float(0, 1)}, {0}, 1.0, (double)(i / 3 % 3) / 2, alphas[i % 8]};
    double weight = i % 5 == 0 ? 0.0 : (i % 5 == 1 ? random_float(0, 1) : 1.0);
    for (int k = 0; k < 3; k++) m.f0[k] = fmin(0.04 * (i % 7 == 0 ? random_float(0, 40) : 1.0), 1.0) * weight;
    m.f90 = weight;
    return m;
}

static void make_brdf_arguments(void)
{
    for (uint32_t i = 0; i < N; i++) {
        material m = random_material(i);
        for (int k = 0; k < 3; k++) {
            materials[(uint32_t)k * N + i] = (float)m.base[k];
            materials[(uint32_t)(3 + k) * N + i] = (float)m.f0[k];
        }
        materials[6 * N + i] = (float)m.f90;
        materials[7 * N + i] = (float)m.metallic;
        materials[8 * N + i] = (float)m.alpha;
        random_direction(wo + i, i % 4 ? test_random_in(1e-3, 1) : pow(10, test_random_in(-5, 0)));
        if (i % 2) {
            random_direction(wi + i, test_random_in(i % 6 == 1 ? -1 : 1e-4, 1));
        } else { /* inside the lobe: the mirror direction of a normal near z */
            double h[3], scale = m.alpha * tan(test_random_in(0, 1.4)), angle = test_random_in(-pi, pi);
            h[0] = scale * cos(angle), h[1] = scale * sin(angle), h[2] = 1;
            double length = sqrt(dot(h, h)), o[3] = {wo[i], wo[N + i], wo[2 * N + i]}, oh = dot(o, h) / length;
            for (uint32_t k = 0; k < 3; k++) wi[k * N + i] = (float)(2 * oh * h[k] / length - o[k]);
        }
    }
}

static void brdf_is_gltf(void)
{
    make_brdf_arguments();
    if (!RUN_ALL("bsdf_of", 4, SCALAR(n), IN(wo, 3 * N), IN(wi, 3 * N), IN(materials, 9 * N), OUT(values, 3 * N), OUT(pdf, N))) return;
    double worst_wide = 0, worst_narrow = 0;
    uint32_t below = 0, wrong_pdfs = 0;
    for (uint32_t i = 0; i < N; i++) {
        double o[3] = {wo[i], wo[N + i], wo[2 * N + i]}, l[3] = {wi[i], wi[N + i], wi[2 * N + i]}, want[3] = {0};
        material m = {{materials[i], materials[N + i], materials[2 * N + i]}, {materials[3 * N + i], materials[4 * N + i], materials[5 * N + i]},
                      materials[6 * N + i], materials[7 * N + i], materials[8 * N + i]};
        if (l[2] <= 0) {
            below++;
            CHECK_MSG(pdf[i] == 0.0f && values[i] == 0.0f && values[N + i] == 0.0f && values[2 * N + i] == 0.0f, "light from below, %u", i);
            continue;
        }
        gltf_brdf(&m, l, o, want);
        /* Rounding turns the half vector by about 2 u; a narrow lobe changes by that over alpha, twice. */
        double tolerance = 4e-6 + 16 * U / m.alpha / fmax(0.02, fmin(o[2] + l[2], 1));
        /* Unit vectors have an error of 2 u. For two that are nearly opposite, wo . h differs from wi . h by that over |wo + wi|, and (1 -
         * wo . h)^5 by five times as much. */
        tolerance += 10 * U / sqrt(pow(o[0] + l[0], 2) + pow(o[1] + l[1], 2) + pow(o[2] + l[2], 2));
        for (uint32_t k = 0; k < 3; k++) {
            double error = fabs(values[k * N + i] - want[k]) / (want[k] + 1e-7);
            if (m.alpha >= 0.1) worst_wide = fmax(worst_wide, error);
            else worst_narrow = fmax(worst_narrow, error * m.alpha);
            if (!(error <= tolerance)) {
                CHECK_MSG(false, "alpha %g metallic %g, wo.z %g wi.z %g: f = %.9g, double gives %.9g (error %.2e > %.2e)", m.alpha,
                          m.metallic, o[2], l[2], (double)values[k * N + i], want[k], error, tolerance);
                if (test_failures > 8) return;
            }
        }
        /* A metal has one lobe: visible normals, D G1 / (4 no) (Heitz 2018). */
        double density = visible_density(m.alpha, l, o), bad = m.metallic == 1 ? fabs(pdf[i] - density) / density : !(pdf[i] > 0);
        if (!(bad <= tolerance) && wrong_pdfs++ == 0)
            fprintf(stderr, "pdf %.9g, double gives %.9g: alpha %g, metallic %g, wo.z %g, wi.z %g\n", (double)pdf[i],
                    m.metallic == 1 ? density : NAN, m.alpha, m.metallic, o[2], l[2]);
    }
    CHECK(below > N / 100);
    CHECK_MSG(wrong_pdfs == 0, "%u of %u densities are wrong", wrong_pdfs, N - below);
    printf("bsdf_eval: relative error %.1e (alpha >= 0.1), %.1e / alpha below\n", worst_wide, worst_narrow);
}

/* Relative error, except for small values beside a diffuse surface, where 1 - F cancels at grazing angles; and where a and b are nearly
 * opposite, their half vector is imprecise. f(wo, wi) cos wi / cos wi = f(wi, wo) cos wo / cos wo */
static void brdf_is_reciprocal(void)
{
    make_brdf_arguments();
    for (uint32_t i = 0; i < 3 * N; i++) wi[i] = i >= 2 * N ? fmaxf(fabsf(wi[i]), 1e-4f) : wi[i];
    if (!RUN_ALL("bsdf_of", 4, SCALAR(n), IN(wo, 3 * N), IN(wi, 3 * N), IN(materials, 9 * N), OUT(values, 3 * N), OUT(pdf, N))) return;
    if (!RUN_ALL("bsdf_of", 4, SCALAR(n), IN(wi, 3 * N), IN(wo, 3 * N), IN(materials, 9 * N), OUT(swapped, 3 * N), OUT(pdf, N))) return;
    double worst = 0;
    uint32_t at = 0;
    for (uint32_t i = 0; i < N; i++)
        for (uint32_t k = 0; k < 3; k++) {
            double a = (double)values[k * N + i] / wi[2 * N + i], b = (double)swapped[k * N + i] / wo[2 * N + i];
            double h[3] = {(double)wo[i] + wi[i], (double)wo[N + i] + wi[N + i], (double)wo[2 * N + i] + wi[2 * N + i]};
            double difference = fabs(a - b) / (a + b + 0.1) / (1 + 0.1 / sqrt(dot(h, h)));
            if (difference > worst) worst = difference, at = i;
        }
    printf("reciprocity: relative difference %.1e\n", worst);
    CHECK_MSG(worst < 1e-5, "f(a, b) and f(b, a) differ by %g: a.z %g b.z %g, f cos %g and %g, alpha %g metallic %g", worst,
              (double)wo[2 * N + at], (double)wi[2 * N + at], (double)values[at], (double)swapped[at],
              (double)materials[8 * N + at], (double)materials[7 * N + at]);
}

/* Albedo of a white metal with single scattering (Smith, height-correlated), by quadrature over 2000^2 visible normals in double. */
static void albedo_is_that_of_ggx(void)
{
    static const double expected[9] = {.98831, .96920, .88345, .68785, .69825, .86010, .30685, .45069, .76021};
    static const float alphas[9] = {.1f, .1f, .1f, .5f, .5f, .5f, 1, 1, 1}, cosines[9] = {1, .5f, .1f, 1, .5f, .1f, 1, .5f, .1f};
    static float sums[9 * 16];
    const uint32_t count = 1 << 16;
    for (int i = 0; i < kernel_widths(&cl); i++) {
        if (!kernel_call(&cl, programs[i], "albedo_of", 9, 1, (kernel_array[]){SCALAR(count), IN(cosines, 9), IN(alphas, 9), OUT(sums, 144)}, 4))
            return;
        for (int k = 0; k < 9; k++) {
            double sum = 0;
            for (int lane = 0; lane < lane_widths[i]; lane++) sum += sums[16 * k + lane];
            CHECK_MSG(fabs(sum / count - expected[k]) < 5e-5, "LANES %d, alpha %g, cosine %g: albedo %.5f, not %.5f", lane_widths[i],
                      (double)alphas[k], (double)cosines[k], sum / count, expected[k]);
        }
    }
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    for (int i = 0; i < kernel_widths(&cl); i++) programs[i] = kernel_build(&cl, "reference", lane_widths[i], "-DFEATURES=EC_FEATURE_SPECULAR");
    if (!test_failures) {
        sines();
        arcs();
        logarithms();
        brdf_is_gltf();
        brdf_is_reciprocal();
        albedo_is_that_of_ggx();
    }
    for (int i = 0; i < kernel_widths(&cl); i++)
        if (programs[i]) clReleaseProgram(programs[i]);
    ec_cl_close(&cl);
    TEST_END();
}

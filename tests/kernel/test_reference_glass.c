/* tiers: quick, long */
/* Glass against double precision: Fresnel's reflectance, Snell's law, the Beer-Lambert exponential, the rough transmission of Walter et al.
 * 2007, and the single directions of smooth surfaces. Every lane width must give the same bits. */
#include "kernel/kernel_reference.h"

static float cosines[N], etas[N], values[N], pdf[N], wo[3 * N], wi[3 * N], there[3 * N], materials[6 * N];

static void exponentials(void)
{
    static float x[N];
    for (uint32_t i = 0; i < N; i++) x[i] = i % 2 ? random_float(-88, 0) : -(float)pow(10, test_random_in(-9, 2.5));
    x[0] = 0.0f, x[1] = -0.0f, x[2] = -INFINITY, x[3] = -3e38f, x[4] = -1e-45f;
    if (!RUN_ALL("exp_of", 1, IN(x, N), OUT(values, N))) return;
    double worst = 0;
    for (uint32_t i = 0; i < N; i++) {
        double want = exp((double)x[i]), error = fabs(values[i] - want);
        CHECK_MSG(values[i] >= 0 && values[i] <= 1, "exp(%g) = %g", (double)x[i], (double)values[i]);
        if (want > 0x1p-126) worst = fmax(worst, error / (want * 2 * U));
        else CHECK_MSG(error <= 0x1p-125, "exp(%g) = %g", (double)x[i], (double)values[i]);
    }
    printf("exp_negative: error %.2f ulp\n", worst);
    CHECK_MSG(worst < 2, "exp_negative: error %g ulp", worst); /* as its comment states */
    CHECK(values[0] == 1.0f && values[1] == 1.0f && values[2] == 0.0f && values[4] == 1.0f); /* without absorption, exactly 1 */
}

/* Born and Wolf, Principles of Optics, 1.5.2: amplitudes of the two polarisations. 1 beyond the critical angle. */
static double fresnel(double cosine, double eta)
{
    double cos2_t = (eta * eta - 1 + cosine * cosine) / (eta * eta), cos_t = sqrt(fmax(cos2_t, 0));
    double perpendicular = (cosine - eta * cos_t) / (cosine + eta * cos_t), parallel = (eta * cosine - cos_t) / (eta * cosine + cos_t);
    return cos2_t <= 0 ? 1 : (perpendicular * perpendicular + parallel * parallel) / 2;
}

static const double indices[10] = {1.5, 1 / 1.5, 1.33, 1 / 1.33, 2.4, 1 / 2.4, 1, 1 + 1e-6, 1 - 1e-6, 1000};

static double critical_angle(double eta)
{
    return eta < 1 ? asin(eta) : pi / 2;
}

static void reflectances(void)
{
    for (uint32_t i = 0; i < N; i++) {
        etas[i] = (float)indices[i % 10];
        double critical = critical_angle(etas[i]), angle = acos(test_random());
        if (i / 10 % 4 == 1) angle = critical + (test_random() < 0.5 ? -1 : 1) * pow(10, test_random_in(-9, -1));
        if (i / 10 % 4 == 2) angle = pi / 2 - pow(10, test_random_in(-6, 0));
        cosines[i] = (float)fmin(fmax(cos(angle), 0), 1);
        if (i / 10 % 32 == 3) cosines[i] = 1;
        if (i / 10 % 32 == 7) cosines[i] = 0;
    }
    if (!RUN_ALL("fresnel_of", 2, IN(cosines, N), IN(etas, N), OUT(values, N))) return;
    double worst = 0, worst_at = 0, worst_eta = 0, near = 0;
    for (uint32_t i = 0; i < N; i++) {
        double want = fresnel(cosines[i], etas[i]), error = fabs(values[i] - want);
        double from_critical = fabs(acos((double)cosines[i]) - critical_angle(etas[i]));
        CHECK_MSG(values[i] >= 0 && values[i] <= 1, "reflectance %g at cosine %g, index %g", (double)values[i], (double)cosines[i], (double)etas[i]);
        if (from_critical <= 1e-6) near = fmax(near, error);
        else if (error > worst) worst = error, worst_at = cosines[i], worst_eta = etas[i];
    }
    printf("fresnel_dielectric: error %.1e, within 1e-6 rad of the critical angle %.1e\n", worst, near);
    /* cos_t^2 is a difference there, and R falls as its square root. */
    CHECK_MSG(worst <= 1e-6, "fresnel_dielectric: error %g at cosine %g, index %.7g", worst, worst_at, worst_eta);
    CHECK_MSG(near <= 2e-3, "fresnel_dielectric: error %g at the critical angle", near);
}

/* Reflectance rises towards grazing angles, except for rounding, and is exactly 1 from the critical angle on. (Indices above 2 + sqrt(3)
 * dip before they rise.) An interface of index 1 reflects exactly 0. */
static void reflectance_rises(void)
{
    static const float rising[4] = {1.5f, 1 / 1.5f, 2.4f, 1 / 2.4f};
    for (int k = 0; k < 5; k++) {
        for (uint32_t i = 0; i < N; i++) {
            double angle = k == 4 ? pi / 2 * i / N : k % 2 && i % 2 ? asin((double)rising[k]) + ((double)i - N / 2.0) * 1e-9 : pi / 2 * i / N;
            cosines[i] = (float)cos(angle);
            etas[i] = k == 4 ? 1.0f : rising[k];
        }
        for (uint32_t i = 1; i < N; i++) /* insertion sort, since half of them are in order */
            for (uint32_t j = i; j > 0 && cosines[j] > cosines[j - 1]; j--) {
                float c = cosines[j];
                cosines[j] = cosines[j - 1], cosines[j - 1] = c;
            }
        if (!RUN_ALL("fresnel_of", 2, IN(cosines, N), IN(etas, N), OUT(values, N))) return;
        uint32_t falls = 0, total = 0;
        for (uint32_t i = 0; i < N; i++) {
            if (k == 4) {
                CHECK_MSG(values[i] == 0.0f, "index 1 reflects %g at cosine %g", (double)values[i], (double)cosines[i]);
                continue;
            }
            falls += i > 0 && values[i] < values[i - 1] - 4 * (float)U;
            bool beyond = cosines[i] * (double)cosines[i] < 1 - (double)etas[i] * etas[i] - 1e-7;
            total += beyond;
            CHECK_MSG(!beyond || values[i] == 1.0f, "total reflection is %.8g at cosine %g, index %g", (double)values[i], (double)cosines[i], (double)etas[i]);
        }
        CHECK_MSG(falls == 0, "index %g: reflectance falls %u times towards grazing angles", (double)rising[k % 4], falls);
        CHECK(k == 4 || (total > 100) == (rising[k] < 1));
    }
}

static void random_direction(float *w, double z)
{
    double angle = test_random_in(-pi, pi), r = sqrt(1 - z * z);
    w[0] = (float)(r * cos(angle));
    w[N] = (float)(r * sin(angle));
    w[2 * N] = (float)z;
}

/* Refracts w about m (Snell): the tangential part is divided by the index. False beyond the critical angle. */
static bool snell(const double *w, const double *m, double eta, double *out)
{
    double c = dot(w, m), cos2_t = 1 - (dot(w, w) - c * c) / (eta * eta);
    for (int k = 0; k < 3; k++) out[k] = -(w[k] - c * m[k]) / eta - sqrt(fmax(cos2_t, 0)) * m[k];
    return cos2_t > 0;
}

static void refractions(void)
{
    static float m[3 * N];
    for (uint32_t i = 0; i < N; i++) {
        etas[i] = (float)indices[i % 10];
        random_direction(m + i, test_random_in(-1, 1));
        random_direction(wo + i, test_random_in(-1, 1));
        double n_[3] = {m[i], m[N + i], m[2 * N + i]}, w[3] = {wo[i], wo[N + i], wo[2 * N + i]};
        if (dot(n_, w) < 0)
            for (uint32_t k = 0; k < 3; k++) m[k * N + i] = -m[k * N + i];
    }
    if (!RUN_ALL("refract_of", 4, SCALAR(n), IN(wo, 3 * N), IN(m, 3 * N), IN(etas, N), OUT(wi, 3 * N))) return;
    double worst = 0, straight = 0;
    for (uint32_t i = 0; i < N; i++) {
        double mm[3] = {m[i], m[N + i], m[2 * N + i]}, w[3] = {wo[i], wo[N + i], wo[2 * N + i]}, want[3];
        double c = dot(w, mm), eta = etas[i], cos2_t = 1 - (1 - c * c) / (eta * eta);
        if (!snell(w, mm, eta, want) || cos2_t < 1e-4) continue; /* near the critical angle cos_t has half the digits */
        for (uint32_t k = 0; k < 3; k++) {
            double error = fabs(wi[k * N + i] - want[k]);
            worst = fmax(worst, error * sqrt(cos2_t));
            if (eta == 1) straight = fmax(straight, fabs((double)wi[k * N + i] + wo[k * N + i]));
        }
    }
    printf("refract: error %.1e / cos_t; straight on to %.1e where the index is 1\n", worst, straight);
    CHECK_MSG(worst < 1e-6, "refract: error %g / cos_t", worst);
    CHECK_MSG(straight < 2 * U, "refract: an index of 1 bends by %g", straight);
}

/* ---- rough glass ---- */

typedef struct glass {
    double base, f0, alpha, transmission, eta, along; /* along: its width along x; across it is alpha */
} glass;

static glass glass_at(uint32_t i)
{
    const float *m = materials + i;
    return (glass){m[0], m[N], m[2 * N], m[3 * N], m[4 * N], m[2 * N] * (double)m[5 * N]};
}

/* Above an index of 2 + sqrt(3) the exact reflectance dips before it rises; ours keeps its value at normal incidence (fresnel_rise). */
static double schlick_or_exact(const glass *g, double cosine)
{
    return g->eta == 1 ? g->f0 + (1 - g->f0) * pow(1 - cosine, 5) : fmax(fresnel(cosine, g->eta), g->f0);
}

/* GGX by slopes (Walter et al. 2007, eq. 33; with two widths Heitz 2014, eq. 85). */
static double ggx(const glass *g, const double *h)
{
    double x = h[0] / h[2] / g->along, y = h[1] / h[2] / g->alpha;
    return 1 / (pi * g->along * g->alpha * pow(h[2], 4) * (1 + x * x + y * y) * (1 + x * x + y * y));
}

static double smith(const glass *g, const double *w) /* Lambda (Heitz 2014, eq. 72 and 86) */
{
    double x = g->along * w[0] / w[2], y = g->alpha * w[1] / w[2];
    return (sqrt(1 + x * x + y * y) - 1) / 2;
}

/* f |cos wi| for wi below the surface.
 *
 * Bodies: Walter et al. 2007, eq. 16 and 21, with height-correlated masking 1 / (1 + L(o) + L(i)) for their G. Their f_s is between
 * radiances; ours is between basic radiances L / n^2, so that what arrives from side i has n_i^2 for their n_o^2:
 *   f = |i.h| |o.h| / (|i.n| |o.n|) n_i^2 (1 - F) G D / (n_i (i.h) + n_o (o.h))^2
 * Thin walls: the reflected lobe mirrored, with 1 - F for F (KHR_materials_transmission). density: of h seen from wo. */
static double below(const glass *g, const double *o, const double *i, double *density)
{
    bool thin = g->eta == 1;
    double h[3] = {o[0] + g->eta * i[0], o[1] + g->eta * i[1], thin ? o[2] - i[2] : o[2] + g->eta * i[2]}, length = sqrt(dot(h, h));
    for (int k = 0; k < 3; k++) h[k] /= h[2] < 0 ? -length : length;
    double oh = dot(o, h), ih = thin ? oh : dot(i, h), masking = 1 / (1 + smith(g, o) + smith(g, i));
    *density = 0;
    if (oh <= 0 || (!thin && ih >= 0)) return 0;
    double denominator = g->eta * ih + oh, D = ggx(g, h), passes = (1 - schlick_or_exact(g, oh)) * g->base * g->transmission;
    double jacobian = thin ? 1 / (4 * oh) : g->eta * g->eta * fabs(ih) / (denominator * denominator); /* eq. 17 */
    *density = D * oh / o[2] / (1 + smith(g, o)) * jacobian;
    return thin ? passes * masking * D / (4 * o[2]) : fabs(ih) * oh / o[2] * g->eta * g->eta * passes * masking * D / (denominator * denominator);
}

/* stretched: up to 300 times, but at most to a width of 1; narrow lobes keep a width of 1e-3 across. */
static void make_glass(bool stretched)
{
    static const double alphas[6] = {1.0, 0.5, 0.1, 0.01, 1e-3, 0.3}, bodies[7] = {1, 1.5, 1 / 1.5, 1.33, 2.4, 1 / 2.4, 1.05};
    for (uint32_t i = 0; i < N; i++) {
        double eta = (float)bodies[i % 7], r = (eta - 1) / (eta + 1), alpha = alphas[i / 7 % 6];
        materials[i] = random_float(0.2, 1);
        materials[N + i] = eta == 1 ? 0.04f : (float)(r * r);
        materials[2 * N + i] = (float)alpha;
        materials[3 * N + i] = i % 3 ? 1.0f : random_float(0, 1);
        materials[4 * N + i] = (float)eta;
        materials[5 * N + i] = stretched ? (float)fmin(i % 2 ? 1 / alpha : pow(10, test_random_in(0, 2.5)), 1 / alpha) : 1;
        random_direction(wo + i, i % 4 ? test_random_in(1e-2, 1) : pow(10, test_random_in(-3, 0)));
        double h[3], o[3] = {wo[i], wo[N + i], wo[2 * N + i]}, t[3] = {0}, scale, angle;
        bool passes = false;
        for (int tries = 0; tries < 100 && !passes; tries++) { /* inside the lobe */
            scale = alpha * tan(test_random_in(0, 1.4)), angle = test_random_in(-pi, pi);
            h[0] = scale * cos(angle) * (double)materials[5 * N + i], h[1] = scale * sin(angle), h[2] = 1;
            double length = sqrt(dot(h, h));
            for (int k = 0; k < 3; k++) h[k] /= length;
            if (eta == 1)
                for (int k = 0; k < 3; k++) t[k] = (k == 2 ? -1 : 1) * (2 * dot(o, h) * h[k] - o[k]);
            passes = dot(o, h) > 0 && (eta == 1 || snell(o, h, eta, t)) && t[2] < -1e-3;
        }
        if (!passes || i % 5 == 4) random_direction(wi + i, test_random_in(-1, -1e-3));
        else
            for (uint32_t k = 0; k < 3; k++) wi[k * N + i] = (float)t[k];
    }
}

/* Relative error by rounding: h has an error of about u / |wo + eta wi|, which the flank of a narrow lobe multiplies by 4 / alpha. Its
 * cosine with wo has that error too, and 1 - F depends on it more strongly near the critical angle. */
static double glass_tolerance(const glass *g, const double *o, const double *i)
{
    double sum[3] = {o[0] + g->eta * i[0], o[1] + g->eta * i[1], o[2] + (g->eta == 1 ? -1 : g->eta) * i[2]}, length = sqrt(dot(sum, sum));
    double cosine = fmin(fabs(dot(o, sum)) / length, 1), turned = 4 * U / length;
    double passes = 1 - schlick_or_exact(g, cosine), less = 1 - schlick_or_exact(g, fmax(cosine - turned, 0));
    return 1e-5 + 32 * U / g->alpha / length + 2 * fabs(passes - less) / fmax(passes, 1e-30) + 4 * U / fmax(passes, 1e-30);
}

static void glass_is_walter(bool stretched)
{
    make_glass(stretched);
    if (!RUN_ALL("glass_of", 4, SCALAR(n), IN(wo, 3 * N), IN(wi, 3 * N), IN(materials, 6 * N), OUT(values, N), OUT(pdf, N))) return;
    double worst = 0;
    uint32_t lit = 0, shown = 0;
    for (uint32_t i = 0; i < N && shown < 8; i++) {
        glass g = glass_at(i);
        double o[3] = {wo[i], wo[N + i], wo[2 * N + i]}, l[3] = {wi[i], wi[N + i], wi[2 * N + i]}, density, want = below(&g, o, l, &density);
        double sum[3] = {o[0] + g.eta * l[0], o[1] + g.eta * l[1], o[2] + (g.eta == 1 ? -1 : g.eta) * l[2]}, length = sqrt(dot(sum, sum));
        double F = schlick_or_exact(&g, fmin(fabs(dot(o, sum)) / length, 1)), tolerance = glass_tolerance(&g, o, l);
        double error = fabs(values[i] - want) / (want + 1e-6);
        lit += want > 0;
        worst = fmax(worst, error / tolerance);
        bool right = error <= tolerance;
        /* With full transmission the only choice is between reflection and transmission, by F against (1 - F) base. */
        if (g.transmission == 1) {
            double p = density * (1 - F) * g.base / (F + (1 - F) * g.base);
            right &= fabs(pdf[i] - p) <= tolerance * (p + 1e-6);
            CHECK_MSG(right, "alpha %g x %g eta %g, wo.z %g wi.z %g: f = %.8g, double gives %.8g; pdf %.8g, double gives %.8g", g.along, g.alpha, g.eta, o[2], l[2],
                      (double)values[i], want, (double)pdf[i], p);
        } else {
            CHECK_MSG(right, "alpha %g x %g eta %g, wo.z %g wi.z %g: f = %.8g, double gives %.8g", g.along, g.alpha, g.eta, o[2], l[2], (double)values[i], want);
            CHECK_MSG((pdf[i] > 0) == (want > 0), "pdf %g where f is %g", (double)pdf[i], want);
        }
        shown += !right;
    }
    printf("bsdf_eval below the surface%s: at most %.2f of the rounding allowed, %u of %u directions lit\n", stretched ? ", stretched" : "", worst, lit, N);
    CHECK(lit > N / 2);
}

/* For basic radiances light goes both ways alike per n^2 cos d omega (Nicodemus 1963; Veach 1997, 5.2): from the other side eta is its
 * inverse, up is down, and f(o, i) / n_i^2 = f(i, o) / n_o^2. */
static void glass_is_reciprocal(bool stretched)
{
    make_glass(stretched);
    static float back[N];
    if (!RUN_ALL("glass_of", 4, SCALAR(n), IN(wo, 3 * N), IN(wi, 3 * N), IN(materials, 6 * N), OUT(values, N), OUT(pdf, N))) return;
    for (uint32_t i = 0; i < 3 * N; i++) {
        float sign = i >= 2 * N ? -1.0f : 1.0f, o = wo[i];
        wo[i] = sign * wi[i];
        there[i] = sign * o;
    }
    for (uint32_t i = 0; i < N; i++) materials[4 * N + i] = 1 / materials[4 * N + i];
    if (!RUN_ALL("glass_of", 4, SCALAR(n), IN(wo, 3 * N), IN(there, 3 * N), IN(materials, 6 * N), OUT(back, N), OUT(pdf, N))) return;
    double worst = 0;
    uint32_t at = 0;
    for (uint32_t i = 0; i < N; i++) {
        glass g = glass_at(i), front = g; /* g: seen from behind */
        front.eta = 1 / g.eta;
        double o[3] = {wo[i], wo[N + i], wo[2 * N + i]}, l[3] = {there[i], there[N + i], there[2 * N + i]};
        double a = (double)values[i] / wo[2 * N + i] * g.eta * g.eta, b = (double)back[i] / -there[2 * N + i];
        double oo[3] = {o[0], o[1], -o[2]}, ll[3] = {l[0], l[1], -l[2]};
        double difference = fabs(a - b) / (fmax(a, b) + 1e-6) / (glass_tolerance(&g, o, l) + glass_tolerance(&front, ll, oo));
        if (difference > worst) worst = difference, at = i;
    }
    printf("reciprocity of glass%s: at most %.2f of the rounding allowed\n", stretched ? ", stretched" : "", worst);
    CHECK_MSG(worst < 1, "f / n^2 from either side differ by %g times what is allowed: %g and %g, alpha %g, eta %g", worst, (double)values[at], (double)back[at],
              (double)materials[2 * N + at], (double)materials[4 * N + at]);
}

/* One direction of reflection, one of transmission. White glass returns all light, so each weight is 1. It reflects for u below Fresnel's
 * reflectance, and otherwise transmits at Snell's angle, or straight through a thin wall. */
static void smooth_glass(void)
{
    static float u[N], weight[N];
    for (uint32_t i = 0; i < N; i++) {
        double eta = (float)indices[i % 10], r = (eta - 1) / (eta + 1);
        materials[i] = 1;
        materials[N + i] = eta == 1 ? 0.04f : (float)(r * r);
        materials[2 * N + i] = 1e-4f;
        materials[3 * N + i] = 1;
        materials[4 * N + i] = (float)eta;
        materials[5 * N + i] = 1;
        u[i] = (float)(test_random_u64() >> 40) * 0x1p-24f;
        random_direction(wo + i, i % 3 ? test_random_in(1e-3, 1) : pow(10, test_random_in(-5, 0)));
    }
    if (!RUN_ALL("smooth_of", 4, SCALAR(n), IN(wo, 3 * N), IN(materials, 6 * N), IN(u, N), OUT(wi, 3 * N), OUT(weight, N), OUT(pdf, N))) return;
    uint32_t passed = 0;
    for (uint32_t i = 0; i < N; i++) {
        glass g = glass_at(i);
        double o[3] = {wo[i], wo[N + i], wo[2 * N + i]}, up[3] = {0, 0, 1}, want[3] = {-o[0], -o[1], o[2]}, error = 0;
        double F = schlick_or_exact(&g, o[2]);
        bool passes = wi[2 * N + i] < 0;
        passed += passes;
        CHECK_MSG(pdf[i] == -1.0f, "a smooth surface's direction has the density %g", (double)pdf[i]);
        /* Two reciprocals and a product; 1 - F has an error of 1e-6 / (1 - F), which cancels. */
        CHECK_MSG(fabs(weight[i] - 1) <= 8 * U, "white glass of index %g weighs %.8g at cosine %g", g.eta, (double)weight[i], o[2]);
        CHECK_MSG(passes == (u[i] >= F) || fabs(u[i] - F) < 1e-6, "u = %.8g, reflectance %.8g: %s", (double)u[i], F, passes ? "passes" : "reflects");
        double cos2_t = 1 - (1 - o[2] * o[2]) / (g.eta * g.eta);
        if (passes && g.eta == 1) want[0] = -o[0], want[1] = -o[1], want[2] = -o[2];
        else if (passes) snell(o, up, g.eta, want);
        for (uint32_t k = 0; k < 3; k++) error = fmax(error, fabs(wi[k * N + i] - want[k]));
        CHECK_MSG(error <= 1e-6 / (passes ? sqrt(fmax(cos2_t, 1e-6)) : 1), "index %g, cosine %g: direction off by %g", g.eta, o[2], error);
        if (test_failures > 20) return;
    }
    CHECK(passed > N / 4 && passed < N);
}

static void build(const char *more)
{
    char options[160];
    snprintf(options, sizeof options, "-DFEATURES=(EC_FEATURE_SPECULAR+EC_FEATURE_TRANSMISSION+EC_FEATURE_SMOOTH%s)", more);
    for (int i = 0; i < kernel_widths(&cl); i++) programs[i] = kernel_build(&cl, "reference", lane_widths[i], options);
}

static void release(void)
{
    for (int i = 0; i < kernel_widths(&cl); i++)
        if (programs[i]) clReleaseProgram(programs[i]);
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    build("");
    if (!test_failures) {
        exponentials();
        reflectances();
        reflectance_rises();
        refractions();
        glass_is_walter(false);
        glass_is_reciprocal(false);
        smooth_glass();
    }
    release();
    build("+EC_FEATURE_ANISOTROPY");
    if (!test_failures) {
        glass_is_walter(true);
        glass_is_reciprocal(true);
    }
    release();
    ec_cl_close(&cl);
    TEST_END();
}

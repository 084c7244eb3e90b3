/* tier: full */
/* Measurements of `eclat cost` against theory.
 *
 * Numbers of samples are fixed here, not times, so that the figures are the same in every run. */
#include "film/clamp.h"
#include "support/cost_reference.h"
#include "support/gltf_writer.h"

typedef struct strategy {
    ec_session *session;
    ec_cost_tally tally;
    ec_cost_row row;
    float *mean;
    uint32_t index;
} strategy;

static strategy open_strategy(const ec_scene *scene, const ec_render_options *o, const ec_cost_reference *reference)
{
    strategy s = {.mean = malloc((size_t)o->width * o->height * 12)};
    ec_error err = {0};
    ec_render_stats stats;
    s.row.rung.unbiased = true;
    if (!s.mean || ec_session_open(case_cl(), scene, o, 64, &s.session, &stats, &err) != EC_OK) case_end("session", &err);
    CHECK_OK(ec_cost_tally_create(reference, (uint64_t)o->width * o->height, &s.tally, &err), err);
    return s;
}

static void close_strategy(strategy *s)
{
    ec_session_close(s->session);
    ec_cost_tally_free(&s->tally);
    free(s->mean);
}

static void take(strategy *s, uint32_t samples)
{
    ec_error err = {0};
    ec_session_batch batch = {.seed = ec_session_seed(7, EC_COST_STREAM_RUNGS, s->index++), .samples = samples, .rgb = s->mean};
    CHECK_OK(ec_session_take(s->session, &batch, &err), err);
    CHECK(batch.complete && batch.invalid == 0);
    ec_cost_tally_add(&s->tally, s->mean);
}

static void take_level(strategy *s, uint32_t samples, uint32_t pictures)
{
    ec_cost_tally_begin(&s->tally, samples);
    for (uint32_t i = 0; i < pictures; i++) take(s, samples);
    ec_cost_tally_end(&s->tally, &s->row);
}

static ec_cost_row curve(const ec_scene *scene, const ec_render_options *o, const ec_cost_reference *reference, uint32_t most)
{
    strategy s = open_strategy(scene, o, reference);
    for (uint32_t samples = 1; samples <= most; samples *= 2) take_level(&s, samples, 24);
    ec_cost_tally_bias(&s.tally, &s.row);
    for (uint32_t i = 0; i < s.row.point_count; i++) s.row.points[i].seconds = s.row.points[i].samples;
    ec_cost_conclude(&s.row);
    close_strategy(&s);
    return s.row;
}

/* With independent samples the error falls as n^-1/2. Owen-scrambled points do better for smooth light, and never worse. The reference is a
 * render too: the slope would bend if its noise were not subtracted. A render that converges to the same picture has no bias. */
static void slopes(void)
{
    ec_scene *scene = case_load(OWN_SCENE("cornell-box/cornell-box.gltf"), NULL);
    ec_render_options o = case_options(32, 32, 0);
    ec_cost_reference reference = cost_reference(scene, &o, 1024);
    o.sampler = EC_SAMPLER_INDEPENDENT;
    ec_cost_row independent = curve(scene, &o, &reference, 64);
    o.sampler = EC_SAMPLER_SOBOL;
    ec_cost_row sobol = curve(scene, &o, &reference, 64);
    printf("slopes: independent %.3f +- %.3f, sobol %.3f +- %.3f; bias^2 %.2g +- %.2g, %.2g +- %.2g\n", independent.fit.slope,
           independent.fit.se, sobol.fit.slope, sobol.fit.se, independent.bias2, independent.bias2_se, sobol.bias2, sobol.bias2_se);
    CHECK_NEAR(independent.fit.slope, -0.5, 0.05); /* 2.8 of its standard errors */
    CHECK_MSG(independent.fit.se < 0.02, "%g", independent.fit.se);
    CHECK_MSG(sobol.fit.slope < -0.55, "%g", sobol.fit.slope);
    CHECK(fabs(independent.bias2) < 4 * independent.bias2_se && fabs(sobol.bias2) < 4 * sobol.bias2_se);
    /* mse = variance / n: the same figure computed from the spread of the pictures alone */
    const ec_cost_point *p = &independent.points[4];
    CHECK_NEAR(independent.variance / p->samples, p->mse, 5 * p->mse_se + 0.02 * p->mse);

    /* Two segments leave out indirect light: the bias is detected, and the curve ends near its floor. */
    o.max_depth = 2;
    ec_cost_row direct = curve(scene, &o, &reference, 64);
    ec_render_options full = case_options(32, 32, 1024), cut = full;
    cut.max_depth = 2;
    case_image a = case_render(scene, &full), b = case_render(scene, &cut);
    double square = 0, luminance = 0;
    for (size_t i = 0; i < 32 * 32; i++) {
        double y = 0, d = 0, w[3] = {0.2126, 0.7152, 0.0722};
        for (int c = 0; c < 3; c++) y += w[c] * a.rgb[3 * i + c], d += w[c] * (b.rgb[3 * i + c] - a.rgb[3 * i + c]);
        square += d * d / 1024;
        luminance += y / 1024;
    }
    printf("without indirect light: bias %.4f +- %.4f, from long renders %.4f\n", sqrt(direct.bias2), 0.5 * direct.bias2_se / sqrt(direct.bias2), sqrt(square) / luminance);
    CHECK_NEAR(sqrt(direct.bias2), sqrt(square) / luminance, 0.01);

    /* With a clamp, the floor is the bias that a render itself states, relative to its own mean. */
    o.max_depth = full.max_depth;
    full.clamp = o.clamp = 0.5;
    full.clamp_luminance = o.clamp_luminance = 0.5 * reference.mean_luminance;
    ec_cost_row clamped = curve(scene, &o, &reference, 64);
    case_image c = case_render(scene, &full);
    const ec_clamp_error stated = ec_film_clamp_error(&c.film);
    const double bias = stated.bias * ec_film_estimate_error(&c.film).mean_luminance / reference.mean_luminance;
    printf("with a clamp: bias %.4f +- %.4f, stated %.4f\n", sqrt(clamped.bias2), 0.5 * clamped.bias2_se / sqrt(clamped.bias2), bias);
    CHECK(c.stats.clamp_luminance == (double)(float)full.clamp_luminance);
    CHECK_NEAR(sqrt(clamped.bias2), bias, 0.01);
    case_free(&c);
    const ec_cost_point *last = &direct.points[direct.point_count - 1];
    CHECK_MSG(fabs(last->mse - direct.bias2) < 0.2 * direct.bias2, "at the end %g", last->mse);
    case_free(&a);
    case_free(&b);
    ec_cost_reference_free(&reference);
    ec_scene_free(scene);
}

/* A point of a matt floor under a square lamp of side s at height 1; all pixels see this point. A black sheet half way up hides exactly one
 * half of the lamp.
 *   Uniform directions, pdf 1 / 2 pi: X = 2 pi f L cos t where the lamp is visible, else 0. With integrals over the visible half,
 *     E X^2 / (E X)^2 = 2 pi I2 / I1^2,   I1 = int cos t dw,  I2 = int cos^2 t dw
 *   and the relative variance is that minus 1, proportional to 1 / area while the lamp is small.
 *   A direction to the lamp, pdf 1 / W for its solid angle W: X = W f L cos t on the visible half, so
 *     E X^2 / (E X)^2 = W I2 / I1^2
 *   which is 2 for a small lamp of any area, since half of it is hidden: relative variance 1. */
static void predict(double side, double *hemisphere, double *light)
{
    enum { N = 400 };
    /* From the point, 1e-3 on the lit side, the sheet's edge appears at x = -2e-3 on the lamp, and its middle at -1e-3. */
    const double edge = -2e-3, ends[2] = {-side / 2 - 1e-3, side / 2 - 1e-3};
    double I1 = 0, I2 = 0, W = 0;
    for (int seen = 0; seen < 2; seen++)
        for (int i = 0; i < N; i++)
            for (int k = 0; k < N; k++) {
                const double x = edge + (i + 0.5) / N * (ends[seen] - edge), z = ((k + 0.5) / N - 0.5) * side;
                const double cos2 = 1 / (1 + x * x + z * z), c = sqrt(cos2);
                const double solid_angle = side / N * fabs(ends[seen] - edge) / N * cos2 * c; /* dA cos' / d^2 */
                W += solid_angle;
                if (seen) I1 += c * solid_angle, I2 += cos2 * solid_angle;
            }
    *hemisphere = 2 * acos(-1) * I2 / (I1 * I1) - 1;
    *light = W * I2 / (I1 * I1) - 1;
}

static ec_scene *lamp_scene(double side, const char *name)
{
    gltf_writer *w = gltf_new();
    gltf_quad(w, gltf_lambert(w, 0.5, 0), (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
    gltf_quad(w, gltf_lambert(w, 0, 4), (double[3]){-side / 2, 1, -side / 2}, (double[3]){side, 0, 0}, (double[3]){0, 0, side});
    gltf_quad(w, gltf_lambert(w, 0, 0), (double[3]){-2, 0.5, -2}, (double[3]){2, 0, 0}, (double[3]){0, 0, 4});
    gltf_camera(w, (double[3]){1e-3, 0.2, 0}, (double[3]){1e-3, 0, 0}, 1e-6); /* slightly on the lit side of the edge's image */
    ec_scene *scene = case_load(gltf_write(w, name), NULL);
    free(w);
    return scene;
}

static void area_of_the_light(void)
{
    static const double sides[2] = {0.5, 0.35355339};
    double measured[2][2];
    for (int i = 0; i < 2; i++) {
        ec_scene *scene = lamp_scene(sides[i], i ? "cost-half-lamp" : "cost-lamp");
        ec_render_options o = case_options(32, 32, 0);
        o.max_depth = 2;
        ec_cost_reference reference = cost_reference(scene, &o, 4096);
        o.sampler = EC_SAMPLER_INDEPENDENT;
        double expected[2];
        predict(sides[i], &expected[0], &expected[1]);
        for (int k = 0; k < 2; k++) {
            o.sample = k ? EC_SAMPLE_LIGHT : EC_SAMPLE_HEMISPHERE;
            strategy s = open_strategy(scene, &o, &reference);
            take_level(&s, 16, 128);
            measured[i][k] = s.row.variance;
            /* 1024 pixels of 2048 samples: a variance known from two million draws; 1 + 1 / (p N) for the mean */
            double se = expected[k] * sqrt(2 * (expected[k] + 1) / (1024 * 2048.0)) + 0.002 * expected[k];
            printf("lamp of side %.3f, %-10s variance %.4f, expected %.4f +- %.4f\n", sides[i], k ? "light:" : "hemisphere:", measured[i][k], expected[k], se);
            CHECK_NEAR(measured[i][k], expected[k], 4 * se);
            close_strategy(&s);
        }
        ec_cost_reference_free(&reference);
        ec_scene_free(scene);
    }
    printf("half the area: hemisphere x%.3f, light x%.3f\n", measured[1][0] / measured[0][0], measured[1][1] / measured[0][1]);
    CHECK_NEAR(measured[1][0] / measured[0][0], 2, 0.2);
    CHECK_NEAR(measured[1][1] / measured[0][1], 1, 0.05);
}

/* Small lamps and rough plates suit light sampling, large lamps and smooth plates BSDF sampling. With as many samples, neither may beat
 * their combination on the whole picture by more than three standard errors, by MSE or by relMSE. */
static void veach(void)
{
    enum { ROUNDS = 24, SAMPLES = 16 };
    static const ec_sample samples[3] = {EC_SAMPLE_MIS, EC_SAMPLE_LIGHT, EC_SAMPLE_BSDF};
    static const char *const names[3] = {"mis", "light", "bsdf"};
    ec_scene *scene = case_load(OWN_SCENE("veach-plates/veach-plates.gltf"), NULL);
    ec_render_options o = case_options(96, 64, 0);
    ec_cost_reference reference = cost_reference(scene, &o, 1024);
    strategy s[3];
    for (int k = 0; k < 3; k++) {
        o.sample = samples[k];
        s[k] = open_strategy(scene, &o, &reference);
        ec_cost_tally_begin(&s[k].tally, SAMPLES);
        for (int i = 0; i < ROUNDS; i++) take(&s[k], SAMPLES);
        ec_cost_tally_end(&s[k].tally, &s[k].row);
        const ec_cost_point *p = &s[k].row.points[0], *mis = &s[0].row.points[0];
        printf("veach %-6s mse %.4g +- %.2g, relmse %.4g +- %.2g\n", names[k], p->mse, p->mse_se, p->relmse, p->relmse_se);
        if (k == 0) continue;
        double advantage = log(p->mse / mis->mse), relative = log(p->relmse / mis->relmse);
        double se = hypot(p->mse_se / p->mse, mis->mse_se / mis->mse);
        double relative_se = hypot(p->relmse_se / p->relmse, mis->relmse_se / mis->relmse);
        printf("  mis is better by mse x%.2f a sample (log +- %.2f), by relmse x%.2f (log +- %.2f)\n", exp(advantage), se, exp(relative), relative_se);
        CHECK_MSG(advantage > -3 * se, "%s beats mis: log %g +- %g", names[k], advantage, se);
        CHECK_MSG(relative > -3 * relative_se, "%s beats mis by relmse: log %g +- %g", names[k], relative, relative_se);
    }
    for (int k = 0; k < 3; k++) close_strategy(&s[k]);
    ec_cost_reference_free(&reference);
    ec_scene_free(scene);
}

int main(void)
{
    slopes();
    area_of_the_light();
    veach();
    TEST_END();
}

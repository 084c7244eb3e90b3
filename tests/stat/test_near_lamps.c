/* tier: full */
/* Lamps that touch the surface they light, fill its sky, or are smaller than floats resolve. The mean is known in closed form. The relative
 * standard deviation of one sample stays below 2 wherever the lamp is; with uniform samples of the area it would grow as 1 / distance. (A
 * lamp of two triangles, one of which fills the sky, has 1.2 from choosing between them.) */
#include "support/floor_case.h"

enum { SPP = 2048, PIXELS = 64 };

static double worst_deviation;

/* Light sampling alone and with MIS, independent samples. slack: relative tolerance of the mean for float rounding. */
static void check_lamp(const char *path, double expected, double slack, double most_deviation)
{
    static uint64_t seed;
    ec_scene *scene = case_load(path, NULL);
    for (int s = 0; s <= EC_SAMPLE_LIGHT; s++) {
        ec_render_options o = case_options(8, 8, SPP);
        o.max_depth = 2;
        o.sample = (ec_sample)s;
        o.seed = seed++;
        o.sampler = EC_SAMPLER_INDEPENDENT;
        case_image image = case_render(scene, &o);
        double mean = image.mean[1], se = image.mean_se[1], deviation = expected > 0 ? se * sqrt(PIXELS * SPP) / expected : 0;
        printf("%-28s %-5s %.7f +- %.7f, expected %.7f; deviation of a sample %.2f\n", strrchr(path, '/') + 1, ec_sample_names[s],
               mean, se, expected, deviation);
        CHECK_MSG(fabs(mean - expected) <= 4.5 * se + slack * expected, "%s, %s: %.8g +- %.2g, expected %.8g", path,
                  ec_sample_names[s], mean, se, expected);
        CHECK_MSG(deviation < most_deviation, "%s, %s: a sample has a relative standard deviation of %g", path, ec_sample_names[s], deviation);
        if (most_deviation == 2) worst_deviation = fmax(worst_deviation, deviation);
        case_free(&image);
    }
    ec_scene_free(scene);
}

/* A skewed scene is rotated by 5-12-13 and 3-4-5 triangles: no edge is parallel to an axis, and nothing is exact. */
static void turn(int askew, const double *from, double *to)
{
    static const double rows[3][3] = {{15, -60, 20}, {36, 25, 48}, {-52, 0, 39}};
    for (int k = 0; k < 3; k++)
        to[k] = askew ? (rows[k][0] * from[0] + rows[k][1] * from[1] + rows[k][2] * from[2]) / 65 : from[k];
}

static void quad(gltf_writer *w, int askew, int material, const double *at, const double *u, const double *v)
{
    double a[3], b[3], c[3];
    turn(askew, at, a);
    turn(askew, u, b);
    turn(askew, v, c);
    gltf_quad(w, material, a, b, c);
}

/* The floor_scene, rotated. */
static gltf_writer *near_scene(int askew, double camera_height)
{
    if (!askew) return floor_scene(camera_height);
    gltf_writer *w = gltf_new();
    quad(w, 1, gltf_lambert(w, 0.6, 0), (double[3]){-3, 0, 3}, (double[3]){6, 0, 0}, (double[3]){0, 0, -6});
    double at[3];
    turn(1, (double[3]){0, camera_height, 0}, at);
    gltf_camera(w, at, (double[3]){0, 0, 0}, 1e-5);
    return w;
}

static double form_factor(const double (*corners)[3])
{
    return lambert(corners, 4, up) / PI;
}

/* A lamp of 2 x 2 and radiance 3 at height h, its centre above (x, z). At the middle the form factors are known in closed form. A point of
 * the lamp is a sum of three rounded products, with an error of 1.5e-7. From a height h this turns its direction by 1.5e-7 / h, and changes
 * the mean of many by about the square of that. */
static void check_above(int askew, double x, double z, double h)
{
    double lamp[4][3] = {{x - 1, h, z - 1}, {x + 1, h, z - 1}, {x + 1, h, z + 1}, {x - 1, h, z + 1}};
    double expected = form_factor((const double(*)[3])lamp);
    gltf_writer *w = near_scene(askew, 0.5 * h);
    quad(w, askew, gltf_lambert(w, 0, 3), lamp[0], (double[3]){2, 0, 0}, (double[3]){0, 0, 2}); /* x cross z = -y: faces down */
    char name[64];
    snprintf(name, sizeof name, "near-%s%g-%g-%g", askew ? "askew-" : "", x, z, h);
    check_lamp(gltf_write(w, name), 0.6 * 3 * expected, 1e-6 + pow(1.5e-7 / h, 2), 2);
    free(w);
}

static void check_heights(void)
{
    static const double heights[7] = {1, 0.1, 0.01, 1e-3, 1e-4, 1e-5, 1e-6}, known[4] = {0.5541264, 0.9918856, 0.9999182, 0.99999918};
    for (int i = 0; i < 7; i++) {
        double h = heights[i], lamp[4][3] = {{-1, h, -1}, {1, h, -1}, {1, h, 1}, {-1, h, 1}};
        if (i < 4) CHECK_NEAR(form_factor((const double(*)[3])lamp), known[i], 1e-7);
        check_above(0, 0, 0, h);
        check_above(0, 0.31, -0.17, h);
        check_above(0, 1 - h, 0.17, h); /* near its edge */
        if (h > 0.5e-4) check_above(1, 0.31, -0.17, h);
    }
}

/* A lamp that stands on the floor, or passes through it, at a distance x from the point. The part below the floor is sampled too, half of
 * the samples: that doubles the second moment 1 + 2^2. */
static void check_wall(double x, double below)
{
    double lamp[4][3] = {{x, 0, -1}, {x, 0, 1}, {x, 2, 1}, {x, 2, -1}};
    gltf_writer *w = near_scene(0, 0.5);
    gltf_quad(w, gltf_lambert(w, 0, 3), (double[3]){x, -below, -1}, (double[3]){0, 0, 2}, (double[3]){0, 2 + below, 0});
    char name[64];
    snprintf(name, sizeof name, "near-wall-%g-%g", x, below);
    check_lamp(gltf_write(w, name), 0.6 * 3 * form_factor((const double(*)[3])lamp), 1e-6, below > 0 ? 3 : 2);
    free(w);
}

/* A lamp in the plane of the floor, beside the point or touching it, gives no light. */
static void check_level(double x)
{
    gltf_writer *w = gltf_new();
    gltf_quad(w, gltf_lambert(w, 0.6, 0), (double[3]){-3, 0, 3}, (double[3]){3, 0, 0}, (double[3]){0, 0, -6});
    gltf_quad(w, gltf_lambert(w, 0, 3), (double[3]){x, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
    gltf_camera(w, (double[3]){-1e-3, 0.5, 0}, (double[3]){-1e-3, 0, 0}, 1e-5);
    char name[64];
    snprintf(name, sizeof name, "near-level-%g", x);
    check_lamp(gltf_write(w, name), 0, 0, 2);
    free(w);
}

/* A lamp a millionth as wide as its distance: L A cos cos / d^2 = L A. */
static void check_tiny(void)
{
    gltf_writer *w = near_scene(0, 0.5);
    gltf_quad(w, gltf_lambert(w, 0, 1e12), (double[3]){-5e-7, 1, -5e-7}, (double[3]){1e-6, 0, 0}, (double[3]){0, 0, 1e-6});
    check_lamp(gltf_write(w, "near-tiny"), 0.6 / PI, 1e-5, 2);
    free(w);
}

/* A box of any size that shines inwards: irradiance pi L. */
static void check_inside(double size)
{
    gltf_writer *w = near_scene(0, 0.5);
    gltf_box(w, gltf_lambert(w, 0, 3), (double[3]){size, 0.7 * size, size}, (double[3]){-size, -0.3 * size, -size});
    char name[64];
    snprintf(name, sizeof name, "near-inside-%g", size);
    check_lamp(gltf_write(w, name), 0.6 * 3, 1e-6, 2);
    free(w);
}

int main(void)
{
    static const double distances[5] = {1, 0.1, 1e-2, 1e-3, 1e-5};
    check_heights();
    for (int i = 0; i < 5; i++) check_wall(distances[i], i % 2);
    check_level(1);
    check_level(0);
    check_tiny();
    for (double size = 4; size < 5e4; size *= 100) check_inside(size);
    printf("relative standard deviation of a sample at most %.2f\n", worst_deviation);
    TEST_END();
}

/* tier: full */
/* The Blackman-Harris filter: a square lamp's picture pixel by pixel, its total light, its bits, and the stated errors. */
#include "support/lamp_picture.h"

/* The filter's cumulative distribution: the integral of its cosines from -width to x. */
static double distribution(double x, double width)
{
    const double a[4] = {0.35875, 0.48829, 0.14128, 0.01168}, t = fmin(fmax(0.5 + 0.5 * x / width, 0), 1), pi = 3.14159265358979323846;
    return t - a[1] / a[0] * sin(2 * pi * t) / (2 * pi) + a[2] / a[0] * sin(4 * pi * t) / (4 * pi) - a[3] / a[0] * sin(6 * pi * t) / (6 * pi);
}

static void check_picture(double width)
{
    static float expected[SIDE * SIDE];
    ec_scene *scene = lamp_at(0.05, -0.1, 4, "filter-lamp");
    ec_render_options o = lamp_options();
    o.filter = EC_FILTER_BLACKMAN_HARRIS;
    o.filter_width = width;
    case_image image = case_render(scene, &o);
    double pixels = SIDE / 2 / tan(0.5 * yfov) / 4, x = SIDE / 2 + 0.05 * pixels, y = SIDE / 2 + 0.1 * pixels, h = half_lamp * pixels;
    for (int i = 0; i < SIDE * SIDE; i++) {
        double u = i % SIDE + 0.5, v = i / SIDE + 0.5;
        expected[i] = (float)((distribution(x + h - u, width) - distribution(x - h - u, width)) *
                              (distribution(y + h - v, width) - distribution(y - h - v, width)));
    }
    char what[32];
    snprintf(what, sizeof what, "width %g", width);
    check_squares(&image, expected, 1, what);
    check_squares(&image, expected, 4, what);
    check_squares(&image, expected, SIDE, what);
    if (width == 1.5) check_lanes(scene, &o, &image);
    case_free(&image);
    ec_scene_free(scene);
}

/* Pixels' errors are independent and stated correctly. The lamp is inside the picture: over renders, the picture's mean differs from the
 * prediction by its standard error. The sum of 40 squared z is over 73.4 or under 16.9 in 1 run of 1 000 each. */
static void check_error(void)
{
    ec_scene *scene = lamp_at(0.05, -0.1, 4, "filter-error");
    double sum = 0, mean = 0, pixels = SIDE / 2 / tan(0.5 * yfov) / 4, width = 2, x = SIDE / 2 + 0.05 * pixels, y = SIDE / 2 + 0.1 * pixels;
    for (int i = 0; i < SIDE * SIDE; i++) {
        double u = i % SIDE + 0.5, v = i / SIDE + 0.5, h = half_lamp * pixels;
        mean += (distribution(x + h - u, width) - distribution(x - h - u, width)) * (distribution(y + h - v, width) - distribution(y - h - v, width));
    }
    for (int k = 0; k < 40; k++) {
        ec_render_options o = lamp_options();
        o.filter = EC_FILTER_BLACKMAN_HARRIS;
        o.filter_width = width;
        o.sampler = EC_SAMPLER_INDEPENDENT;
        o.spp = 64;
        o.seed = (uint64_t)k;
        case_image image = case_render(scene, &o);
        double z = (image.mean[1] - mean / (SIDE * SIDE)) / image.mean_se[1];
        sum += z * z;
        case_free(&image);
    }
    printf("sum of 40 squared z: %.1f\n", sum);
    CHECK_MSG(sum > 16.9 && sum < 73.4, "errors are not what is said: the sum of 40 squared z is %g", sum);
    ec_scene_free(scene);
}

int main(void)
{
    check_picture(1.5);
    check_picture(0.4); /* within the pixel */
    check_picture(4);
    check_error();
    TEST_END();
}

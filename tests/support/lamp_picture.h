/* A square lamp on black, and the share of a pixel's samples that see it: pictures that can be predicted pixel by pixel. */
#ifndef EC_TESTS_SUPPORT_LAMP_PICTURE_H
#define EC_TESTS_SUPPORT_LAMP_PICTURE_H

#include "support/gltf_writer.h"
#include "support/render_case.h"

enum { SIDE = 48, LAMP_SPP = 1024 };
static const double yfov = 0.5, half_lamp = 0.15;

/* A lamp at depth z that faces the camera: every sample is 1 or 0. */
static inline ec_scene *lamp_at(double x, double y, double z, const char *name)
{
    gltf_writer *w = gltf_new();
    gltf_quad(w, gltf_lambert(w, 0, 1), (double[3]){x - half_lamp, y - half_lamp, -z}, (double[3]){2 * half_lamp, 0, 0}, (double[3]){0, 2 * half_lamp, 0});
    gltf_camera(w, (double[3]){0, 0, 0}, (double[3]){0, 0, -1}, yfov);
    ec_scene *scene = case_load(gltf_write(w, name), NULL);
    free(w);
    return scene;
}

static inline ec_render_options lamp_options(void)
{
    ec_render_options o = case_options(SIDE, SIDE, LAMP_SPP);
    o.max_depth = 1;
    return o;
}

/* A sample is 1 or 0, so that n of them have a variance of at most p (1 - p) / n; stratified ones have less. Sums over squares of pixels
 * agree within 4.5 standard errors of independent samples (one of 150 exceeds that in 1 of 1 000 runs), plus 2 for small counts, which are
 * not normal. */
static inline void check_squares(const case_image *image, const float *expected, int side, const char *what)
{
    double worst = 0;
    for (int square = 0; square < SIDE / side * (SIDE / side); square++) {
        double seen = 0, mean = 0, variance = 0;
        for (int i = 0; i < side * side; i++) {
            int at = (square / (SIDE / side) * side + i / side) * SIDE + square % (SIDE / side) * side + i % side;
            double p = fmin(expected[at], 1);
            seen += LAMP_SPP * image->rgb[3 * at], mean += LAMP_SPP * p, variance += LAMP_SPP * p * (1 - p);
        }
        double z = fmax(fabs(seen - mean) - 2, 0) / sqrt(variance + 1);
        worst = fmax(worst, z);
        CHECK_MSG(z < 4.5, "%s, square %d of %d pixels: %g samples see the lamp, expected %g", what, square, side, seen, mean);
    }
    printf("%s: squares of %d pixels, worst z %.2f\n", what, side, worst);
}

/* Checks that every lane width gives the same bits. */
static inline void check_lanes(const ec_scene *scene, const ec_render_options *options, const case_image *image)
{
    ec_render_options o = *options;
    for (uint32_t lanes = 1; lanes <= 16; lanes = lanes == 1 ? 4 : 2 * lanes) {
        o.lanes = lanes;
        case_image other = case_render(scene, &o);
        CHECK_MSG(case_same_bits(&image->film, &other.film), "other bits with %u lanes", lanes);
        case_free(&other);
    }
}

#endif

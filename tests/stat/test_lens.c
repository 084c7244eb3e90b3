/* tier: full */
/* The thin lens and a small square lamp, pixel by pixel. A point at depth z, seen from the point p of the lens, appears where the pinhole
 * sees it, moved by p (1 / D - 1 / z) in the plane at distance 1. That is the thin-lens formula's circle of confusion, A |z - D| v / (z D)
 * across on a sensor at distance v. */
#include "support/lamp_picture.h"

static ec_render_options lens(double fstop, double focus)
{
    ec_render_options o = lamp_options();
    o.fstop = fstop;
    o.focus = focus;
    return o;
}

static double overlap(double low, double high, int pixel) { return fmax(fmin(high, pixel + 1) - fmax(low, pixel), 0); }

/* Mean over an aperture of radius r; each of its points sees the lamp's square at another place. */
static const float *expected_picture(double z, double r, double focus, double *blur)
{
    enum { STEPS = 1200 };
    static double sum[SIDE * SIDE];
    static float e[SIDE * SIDE];
    double pixels = SIDE / 2 / tan(0.5 * yfov), shift = (1 / focus - 1 / z) * pixels, points = 0;
    memset(sum, 0, sizeof sum);
    for (int i = 0; i < STEPS * STEPS; i++) {
        double px = (2.0 * (i % STEPS + 0.5) / STEPS - 1) * r, py = (2.0 * (i / STEPS + 0.5) / STEPS - 1) * r;
        if (px * px + py * py >= r * r && r > 0) continue;
        double x = SIDE / 2 + 0.05 / z * pixels + px * shift, y = SIDE / 2 + 0.1 / z * pixels - py * shift, h = half_lamp / z * pixels;
        points++;
        for (int v = (int)(y - h); v <= (int)(y + h); v++)
            for (int u = (int)(x - h); u <= (int)(x + h); u++) sum[v * SIDE + u] += overlap(x - h, x + h, u) * overlap(y - h, y + h, v);
    }
    for (int i = 0; i < SIDE * SIDE; i++) e[i] = (float)(sum[i] / points);
    *blur = fabs(shift) * r;
    return e;
}

/* A lens of radius 0.3: f = 12 mm / tan (yfov / 2), fstop = f / 0.6. */
static void check_blur(double z, double focus)
{
    ec_scene *scene = lamp_at(0.05, -0.1, z, "lens-lamp");
    ec_render_options o = lens(0.012 / tan(0.5 * yfov) / 0.6, focus);
    case_image image = case_render(scene, &o);
    double blur, x = SIDE / 2 * (1 + 0.05 / z / tan(0.5 * yfov)), y = SIDE / 2 * (1 + 0.1 / z / tan(0.5 * yfov)), furthest = 0;
    const float *expected = expected_picture(z, 0.3, focus, &blur);
    char what[64];
    snprintf(what, sizeof what, "lamp at %g, focus at %g", z, focus);
    check_squares(&image, expected, 4, what);
    check_squares(&image, expected, SIDE, what); /* the total light stays the same */
    for (int i = 0; i < SIDE * SIDE; i++)
        if (image.rgb[3 * i] > 0) furthest = fmax(furthest, hypot(i % SIDE + 0.5 - x, i / SIDE + 0.5 - y));
    double corner = sqrt(2) * half_lamp / z * SIDE / 2 / tan(0.5 * yfov), pixel = sqrt(0.5);
    CHECK_MSG(furthest < blur + corner + pixel && furthest > blur - pixel, "light as far as %g pixels, circle of confusion %g", furthest, blur);
    printf("%s: circle of confusion %.2f pixels, light as far as %.2f\n", what, blur, furthest);
    case_free(&image);
    ec_scene_free(scene);
}

/* A lens without width equals a pinhole, bit for bit, for any focus; and every lens gives the same bits in every lane width. */
static void check_bits(void)
{
    ec_scene *scene = lamp_at(0.05, -0.1, 4, "lens-bits");
    ec_render_options o = lens(0, 0);
    case_image pinhole = case_render(scene, &o);
    o = lens(INFINITY, 1.5);
    case_image narrow = case_render(scene, &o);
    CHECK(case_same_bits(&pinhole.film, &narrow.film));
    o = lens(0.1, 1.5);
    case_image wide = case_render(scene, &o);
    CHECK(!case_same_bits(&pinhole.film, &wide.film) && strstr(case_effects(&wide), "depth-of-field") && !strstr(case_effects(&pinhole), "depth-of-field"));
    check_lanes(scene, &o, &wide);
    case_free(&pinhole);
    case_free(&narrow);
    case_free(&wide);
    ec_scene_free(scene);
}

static void check_refused(void)
{
    ec_scene *scene = lamp_at(0.05, -0.1, 4, "lens-refused");
    ec_error err = {0};
    case_image image;
    ec_render_options o = lens(2, NAN);
    CHECK(case_try(scene, &o, &image, &err) == EC_FAILED && strstr(err.text, "focus"));
    o = lens(2, 1);
    scene->cameras[0].type = EC_CAMERA_ORTHOGRAPHIC;
    scene->cameras[0].xmag = scene->cameras[0].ymag = 1;
    CHECK(case_try(scene, &o, &image, &err) == EC_FAILED && strstr(err.text, "orthographic"));
    ec_scene_free(scene);
}

int main(void)
{
    check_blur(4, 1.5); /* behind the plane of focus */
    check_blur(2, 8);   /* before it */
    check_blur(3, 3);   /* in it: as sharp as with a pinhole */
    check_bits();
    check_refused();
    TEST_END();
}

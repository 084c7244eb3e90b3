/* tier: quick */
/* Camera moves of the preview: which quantities they keep and change, by geometry. */
#include <math.h>

#include "support/test.h"
#include "view/orbit.h"

#define NEAR(a, b) CHECK_NEAR(a, b, 1e-9)

static const double right_angle = 1.57079632679489661923;

static eclat_viewpoint start(void)
{
    return (eclat_viewpoint){.eye = {0, 0, 5}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 90};
}

static void turns_around_the_target(void)
{
    eclat_viewpoint v = start();
    ec_orbit_turn(&v, right_angle, 0); /* to the right: from +z to +x */
    NEAR(v.eye[0], 5); NEAR(v.eye[1], 0); NEAR(v.eye[2], 0);
    ec_orbit_turn(&v, 0, right_angle / 3);
    NEAR(v.eye[1], 2.5); NEAR(ec_orbit_distance(&v), 5); NEAR(v.target[0], 0);
    for (int i = 0; i < 50; i++) ec_orbit_turn(&v, 0.3, 0.7); /* stops before the pole */
    NEAR(ec_orbit_distance(&v), 5);
    CHECK(v.eye[1] < 5 && v.eye[1] > 4.99);
    for (int i = 0; i < 50; i++) ec_orbit_turn(&v, 0, -0.7);
    CHECK(v.eye[1] > -5 && v.eye[1] < -4.99);
}

static void looks_around_from_the_eye(void)
{
    eclat_viewpoint v = start();
    ec_orbit_look(&v, right_angle, 0); /* to the right: from -z to +x */
    NEAR(v.target[0], 5); NEAR(v.target[2], 5); NEAR(v.eye[2], 5);
    v = start();
    ec_orbit_look(&v, 0, right_angle / 3);
    NEAR(v.target[1], 2.5);
}

static void pans_by_heights_of_the_picture(void)
{
    eclat_viewpoint v = start(); /* at the target, the picture is 10 m high */
    ec_orbit_pan(&v, 0.1, -0.2);
    NEAR(v.eye[0], 1); NEAR(v.eye[1], -2); NEAR(v.target[0], 1); NEAR(v.target[1], -2); NEAR(v.eye[2], 5);
    v.fov = 0, v.tall = 3;
    ec_orbit_pan(&v, 1, 0);
    NEAR(v.eye[0], 4);
}

static void comes_nearer_and_flies(void)
{
    eclat_viewpoint v = start();
    ec_orbit_dolly(&v, 0.5);
    NEAR(v.eye[2], 2.5); NEAR(v.target[2], 0);
    ec_orbit_fly(&v, 1, 2, 3);
    NEAR(v.eye[0], 2); NEAR(v.eye[1], 3); NEAR(v.eye[2], 1.5); NEAR(v.target[2], -1);
    v.fov = 0, v.tall = 3;
    ec_orbit_dolly(&v, 0.5);
    NEAR(v.tall, 1.5); NEAR(v.eye[2], 1.5);
}

static void frames_a_sphere(void)
{
    const double center[3] = {1, 2, 3};
    eclat_viewpoint v = start(), tall = start();
    ec_orbit_frame(&v, center, 2, 1.5);
    NEAR(v.eye[0], 1); NEAR(v.eye[1], 2); NEAR(v.eye[2], 3 + 2 * sqrt(2)); /* 2 / sin 45 degrees */
    ec_orbit_frame(&tall, center, 2, 0.5);
    CHECK(ec_orbit_distance(&tall) > 1.5 * ec_orbit_distance(&v)); /* the narrow side must contain it too */
}

static void keeps_roll(void)
{
    eclat_viewpoint v;
    const double tilted[3] = {0, 0.99, 0.1}, rolled[3] = {0.5, 0.5, 0};
    v = start();
    for (int k = 0; k < 3; k++) v.up[k] = tilted[k];
    ec_orbit_settle(&v);
    CHECK(v.up[1] == 1 && v.up[2] == 0); /* no roll: +y is up */
    for (int k = 0; k < 3; k++) v.up[k] = rolled[k];
    ec_orbit_settle(&v);
    CHECK(v.up[0] == 0.5);
}

int main(void)
{
    turns_around_the_target();
    looks_around_from_the_eye();
    pans_by_heights_of_the_picture();
    comes_nearer_and_flies();
    frames_a_sphere();
    keeps_roll();
    TEST_END();
}

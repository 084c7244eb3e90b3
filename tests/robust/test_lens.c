/* tier: full */
/* A lens in front of a lamp that is out of focus. */
#include <math.h>
#include <stdio.h>

#include "gltf/model.h"
#include "robust/cases.h"
#include "selftest/shot.h"

static const double pi = 3.14159265358979323846;

/* A pixel sees a strip of width 2 w at twice the focus distance. From a point p of the aperture it sees the strip shifted by -p. So the
 * result is the share of a disc of radius 1/2 between two chords. The field of view of 10^-4 gives a focal length of 240 m. */
static ec_result lens_case(ec_selftest *t, ec_error *err)
{
    static const double widths[] = {0.05, 0.25, 0.45};
    for (int i = 0; i < 3; i++) {
        ec_model *m = ec_model_new();
        ec_scene *scene;
        double w = widths[i], q = 2 * w, focal_length = 0.012 / tan(0.5e-4);
        char what[32];
        if (m) {
            ec_material lamp = ec_material_lambert(0, 1);
            ec_model_quad(m, ec_model_material(m, &lamp), (double[3]){-w, -5, -4}, (double[3]){2 * w, 0, 0}, (double[3]){0, 10, 0});
            ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){0, 0, 0}, (double[3]){0, 0, -1}, 1e-4);
        }
        EC_TRY(ec_model_scene(m, &scene, err));
        ec_render_options o = ec_shot_options(t, 16, 256);
        o.fstop = focal_length;
        o.focus = 2;
        snprintf(what, sizeof what, "strip of %g", q);
        ec_result result = ec_shot_row(t, what, scene, &o, 2 / pi * (asin(q) + q * sqrt(1 - q * q)), err);
        ec_scene_free(scene);
        EC_TRY(result);
    }
    return EC_OK;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"camera/lens", false, lens_case, "blur of another width than the thin lens's"},
    };
    return RUN_CASES(cases);
}

/* tier: quick */
/* Requests that ec_render itself refuses, for every caller, and requests that it accepts. The scene is open, so that even endless paths end
 * by leaving it: the test would fail rather than hang. */
#include "support/render_case.h"

static const ec_scene *scene;

static ec_result attempt(double survival, uint32_t max_depth, ec_integrator integrator, ec_error *err)
{
    ec_render_options o = case_options(8, 8, 2);
    case_image image;
    o.survival = survival;
    o.max_depth = max_depth;
    o.integrator = integrator;
    ec_result result = case_try(scene, &o, &image, err);
    if (result != EC_OK) CHECK(!image.film.part_count && !image.film.batch_count); /* nothing was started */
    case_free(&image);
    return result;
}

int main(void)
{
    ec_error err = {0};
    scene = case_load(OWN_SCENE("cornell-box/cornell-box.gltf"), NULL);
    const double endless[] = {1.0, 1.5, -0.5, NAN};
    for (int i = 0; i < 4; i++) {
        err.text[0] = 0;
        CHECK_MSG(attempt(endless[i], 0, EC_INTEGRATOR_PATH, &err) == EC_FAILED, "survival %g", endless[i]);
        CHECK_MSG(strstr(err.text, "max_depth") && !strchr(err.text, '\n'), "survival %g: %s", endless[i], err.text);
    }
    CHECK_OK(attempt(1.0, 3, EC_INTEGRATOR_PATH, &err), err);
    CHECK_OK(attempt(0.0, 0, EC_INTEGRATOR_PATH, &err), err);
    CHECK_OK(attempt(0.5, 0, EC_INTEGRATOR_PATH, &err), err);
    CHECK_OK(attempt(1.0, 0, EC_INTEGRATOR_WHITTED, &err), err);
    CHECK_OK(attempt(1.0, 0, EC_INTEGRATOR_RASTER, &err), err);
    ec_scene_free((ec_scene *)scene);
    TEST_END();
}

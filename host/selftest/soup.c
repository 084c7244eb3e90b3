#include "selftest/soup.h"

#include <math.h>
#include <stdlib.h>

#include "gltf/model.h"

ec_result ec_soup_make(uint32_t count, ec_soup *soup, ec_error *err)
{
    *soup = (ec_soup){count, calloc(9 * (size_t)count + 1, sizeof(float))};
    return soup->vertices ? EC_OK : ec_fail(err, "out of memory for %u triangles", count);
}

void ec_soup_free(ec_soup *soup)
{
    free(soup->vertices);
    *soup = (ec_soup){0};
}

float ec_soup_largest(const ec_soup *soup)
{
    float largest = 0;
    for (size_t i = 0; i < 9 * (size_t)soup->count; i++) largest = fmaxf(largest, fabsf(soup->vertices[i]));
    return largest;
}

ec_result ec_soup_from_scene(const ec_scene *scene, ec_soup *soup, ec_error *err)
{
    EC_TRY(ec_soup_make(scene->triangle_count, soup, err));
    for (size_t i = 0; i < 3 * (size_t)soup->count; i++)
        for (size_t k = 0; k < 3; k++) soup->vertices[3 * i + k] = scene->positions[3 * (size_t)scene->indices[i] + k];
    return EC_OK;
}

ec_result ec_soup_ball(int levels, double bumps, const double stretch[3], const double centre[3], ec_soup *soup, ec_error *err)
{
    ec_model *m = ec_model_new();
    ec_scene *scene;
    ec_material material = ec_material_default();
    ec_model_sphere(m, ec_model_material(m, &material), (double[3]){0, 0, 0}, 1, levels, false);
    EC_TRY(ec_model_scene(m, &scene, err));
    ec_result result = ec_soup_from_scene(scene, soup, err);
    ec_scene_free(scene);
    EC_TRY(result);
    /* Equal corners stay equal, so the ball stays closed. */
    for (size_t i = 0; i < 3 * (size_t)soup->count; i++) {
        float *p = soup->vertices + 3 * i;
        double radius = 1 + bumps * (sin(9.0 * p[0]) * sin(7.0 * p[1] + 1) + sin(31.0 * p[2]) * cos(23.0 * p[0] + 40.0 * p[1])) / 2;
        for (int k = 0; k < 3; k++) p[k] = (float)(centre[k] + stretch[k] * radius * p[k]);
    }
    return EC_OK;
}

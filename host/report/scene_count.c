#include "report/scene_report.h"

static bool gives_light(const ec_material *material)
{
    return material->unlit || material->emission[0] > 0 || material->emission[1] > 0 || material->emission[2] > 0;
}

void ec_scene_report_count(ec_scene_report *report)
{
    const ec_scene *scene = report->scene;
    report->emissive_triangles = 0;
    for (uint32_t i = 0; i < scene->triangle_count; i++)
        report->emissive_triangles += gives_light(&scene->materials[scene->triangle_material[i]]);
    for (uint32_t i = 0; i < scene->light_count; i++) report->light_types[scene->lights[i].type]++;
    report->has_light = ec_scene_has_light(scene);
}

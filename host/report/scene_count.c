#include "report/scene_report.h"

#include "pack/pack.h"

ec_result ec_scene_report_count(ec_scene_report *report, ec_error *err)
{
    const ec_scene *scene = report->scene;
    ec_scene_light light;
    EC_TRY(ec_scene_find_light(scene, &light, err));
    report->has_light = light.any;
    report->emissive_triangles = light.triangles;
    for (uint32_t i = 0; i < scene->light_count; i++) report->light_types[scene->lights[i].type]++;
    return EC_OK;
}

#include "pack/view.h"

#include <stdlib.h>
#include <string.h>

ec_result ec_scene_view_make(const ec_scene *scene, ec_scene_view *view, ec_error *err)
{
    view->scene = *scene;
    view->scene.materials = malloc((scene->material_count + 1) * sizeof *view->scene.materials);
    view->scene.lights = malloc((scene->light_count + 1) * sizeof *view->scene.lights);
    if (!view->scene.materials || !view->scene.lights) {
        ec_scene_view_free(view);
        return ec_fail(err, "out of memory for %u materials", scene->material_count);
    }
    memcpy(view->scene.materials, scene->materials, scene->material_count * sizeof *view->scene.materials);
    if (scene->light_count) memcpy(view->scene.lights, scene->lights, scene->light_count * sizeof *view->scene.lights);
    return EC_OK;
}

void ec_scene_view_free(ec_scene_view *view)
{
    free(view->scene.materials);
    free(view->scene.lights);
    *view = (ec_scene_view){0};
}

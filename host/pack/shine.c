/* Tells whether a scene gives light, in the same view as the scan and the table of lights, where what has no power is none. */
#include "pack/pack.h"

static bool shines(const ec_material *m)
{
    return m->unlit ? m->base_color[0] > 0 || m->base_color[1] > 0 || m->base_color[2] > 0 : ec_emits(m);
}

ec_result ec_scene_find_light(const ec_scene *scene, ec_scene_light *light, ec_error *err)
{
    ec_scene_view plain;
    const ec_scene *s = &plain.scene;
    *light = (ec_scene_light){0};
    EC_TRY(ec_scene_view_plain(scene, &plain, err));
    for (uint32_t t = 0; t < s->triangle_count; t++) light->triangles += shines(&s->materials[s->triangle_material[t]]);
    light->any = light->triangles || s->light_count || s->has_environment;
    /* Without triangles, lamps may be there at another moment, and the surroundings should be the same then. */
    for (uint32_t m = 0; !scene->triangle_count && m < scene->material_count; m++)
        light->any |= scene->materials[m].unlit || ec_emits(&scene->materials[m]);
    ec_scene_view_free(&plain);
    return EC_OK;
}

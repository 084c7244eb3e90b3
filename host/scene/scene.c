/* The scene as a whole: what it owns and whether it is lit. */
#include "scene/texture_range.h"

#include <stdlib.h>

static void free_strings(char **list, uint32_t count)
{
    for (uint32_t i = 0; list && i < count; i++) free(list[i]);
    free(list);
}

void ec_scene_free(ec_scene *s)
{
    if (!s) return;
    for (uint32_t i = 0; i < s->material_count; i++) free(s->materials[i].name);
    for (uint32_t i = 0; i < s->camera_count; i++) free(s->cameras[i].name);
    for (uint32_t i = 0; i < s->light_count; i++) free(s->lights[i].name);
    for (uint32_t i = 0; i < s->image_count; i++) {
        if (s->images[i].lent) continue;
        free(s->images[i].rgba8);
        free(s->images[i].rgba16);
        free(s->images[i].name);
    }
    free(s->positions);
    free(s->normals);
    free(s->tangents);
    free(s->uv[0]);
    free(s->uv[1]);
    free(s->colors);
    free(s->indices);
    free(s->triangle_material);
    free(s->shapes);
    free(s->placed);
    free(s->parts);
    free_strings(s->node_names, s->node_count);
    free(s->materials);
    free(s->textures);
    free(s->images);
    free(s->lights);
    free(s->cameras);
    if (!s->environment.lent) free(s->environment.rgb);
    ec_motion_free(&s->motion);
    free_strings(s->extensions_used, s->extension_count);
    free_strings(s->extensions_ignored, s->extension_ignored_count);
    free(s->lost_image);
    ec_scene_contents_free(&s->contents);
    free(s);
}

bool ec_scene_has_light(const ec_scene *s)
{
    if (s->has_environment) return true;
    for (uint32_t i = 0; i < s->light_count; i++)
        if (s->lights[i].intensity[0] > 0 || s->lights[i].intensity[1] > 0 || s->lights[i].intensity[2] > 0) return true;
    const ec_material *dark = NULL; /* the last one looked at: neighbours share it */
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        const ec_material *m = &s->materials[s->triangle_material[i]];
        if (m != dark && (m->unlit || ec_emits(s, m))) return true;
        dark = m;
    }
    return false;
}

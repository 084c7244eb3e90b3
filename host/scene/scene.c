/* Frees what a scene owns. */
#include "scene/scene.h"

#include <stdlib.h>

#include "scene/texels.h"

#define DROP(memory) (free(memory), (memory) = NULL)

static void drop_pixels(ec_image *image)
{
    if (image->lent) return;
    if (!image->texels) free(image->rgba8);
    ec_texels_leave(image->texels);
    image->rgba8 = NULL;
    image->texels = NULL;
    DROP(image->rgba16);
}

void ec_image_free(ec_image *image)
{
    drop_pixels(image);
    if (!image->lent) free(image->name);
    *image = (ec_image){0};
}

void ec_scene_drop_data(ec_scene *s)
{
    for (uint32_t i = 0; i < s->image_count; i++) drop_pixels(&s->images[i]);
    ec_scene_free_geometry(s);
    if (!s->environment.lent) DROP(s->environment.rgb);
}

void ec_motion_free(ec_motion *m)
{
    free(m->positions);
    free(m->normals);
    free(m->tangents);
    free(m->swept);
    free(m->lights);
    free(m->cameras);
    *m = (ec_motion){0};
}

void ec_scene_free(ec_scene *s)
{
    if (!s) return;
    ec_scene_drop_data(s);
    for (uint32_t i = 0; i < s->material_count; i++) free(s->materials[i].name);
    for (uint32_t i = 0; i < s->camera_count; i++) free(s->cameras[i].name);
    for (uint32_t i = 0; i < s->light_count; i++) free(s->lights[i].name);
    for (uint32_t i = 0; i < s->image_count; i++) ec_image_free(&s->images[i]);
    free(s->shapes);
    free(s->placed);
    free(s->parts);
    for (uint32_t i = 0; s->node_names && i < s->node_count; i++) free(s->node_names[i]);
    free(s->node_names);
    free(s->node_roots);
    free(s->materials);
    free(s->textures);
    free(s->images);
    free(s->lights);
    free(s->cameras);
    ec_motion_free(&s->motion);
    free(s->lost_image);
    ec_scene_contents_free(&s->contents);
    free(s);
}

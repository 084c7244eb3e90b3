#include "pack/scene_view.h"

#include <stdlib.h>
#include <string.h>

#include "scene/texture_range.h"

ec_result ec_scene_view_make(const ec_scene *scene, ec_scene_view *view, ec_error *err)
{
    *view = (ec_scene_view){.scene = *scene};
    view->scene.materials = malloc((scene->material_count + 1) * sizeof *view->scene.materials);
    view->scene.lights = malloc((scene->light_count + 1) * sizeof *view->scene.lights);
    if (!view->scene.materials || !view->scene.lights) {
        ec_scene_view_free(view);
        return ec_fail(err, "out of memory for %u materials", scene->material_count);
    }
    if (scene->material_count)
        memcpy(view->scene.materials, scene->materials, scene->material_count * sizeof *view->scene.materials);
    if (scene->light_count) memcpy(view->scene.lights, scene->lights, scene->light_count * sizeof *view->scene.lights);
    return EC_OK;
}

/* Makes room for a white copy of each image, at its index plus their number; its pixels are made when needed. */
static ec_result make_room(ec_scene_view *view, ec_error *err)
{
    ec_scene *s = &view->scene;
    ec_image *images = calloc(2 * (size_t)s->image_count, sizeof *images);
    ec_texture *textures = malloc(2 * (size_t)s->texture_count * sizeof *textures);
    if (!images || !textures) {
        free(images);
        free(textures);
        return ec_fail(err, "out of memory for %u textures", s->texture_count);
    }
    memcpy(images, s->images, s->image_count * sizeof *images);
    for (uint32_t t = 0; t < s->texture_count; t++) {
        textures[t] = textures[s->texture_count + t] = s->textures[t];
        textures[s->texture_count + t].image += s->image_count;
    }
    view->first_white = s->image_count;
    s->images = images;
    s->textures = textures;
    s->image_count *= 2;
    s->texture_count *= 2;
    return EC_OK;
}

static ec_result whiten_image(const ec_image *from, ec_image *to, ec_error *err)
{
    const size_t count = 4 * (size_t)from->width * from->height;
    const size_t size = from->rgba16 ? sizeof *from->rgba16 : sizeof *from->rgba8;
    void *pixels = malloc(count ? count * size : 1);
    if (!pixels) return ec_fail(err, "out of memory for an image of %u x %u", from->width, from->height);
    *to = (ec_image){.width = from->width, .height = from->height};
    memset(pixels, 255, count * size);
    if (from->rgba16) to->rgba16 = pixels;
    else to->rgba8 = pixels;
    for (size_t i = 3; i < count; i += 4) {
        if (from->rgba16) to->rgba16[i] = from->rgba16[i];
        else to->rgba8[i] = from->rgba8[i];
    }
    ec_image_find_range(to);
    return EC_OK;
}

ec_result ec_scene_view_whiten(ec_scene_view *view, int32_t *texture, ec_error *err)
{
    if (!view->first_white) EC_TRY(make_room(view, err));
    ec_scene *s = &view->scene;
    *texture += (int32_t)(s->texture_count / 2);
    ec_image *to = &s->images[s->textures[*texture].image];
    return to->rgba8 || to->rgba16 ? EC_OK : whiten_image(to - view->first_white, to, err);
}

void ec_scene_view_free(ec_scene_view *view)
{
    if (view->first_white) {
        for (uint32_t i = view->first_white; i < view->scene.image_count; i++) {
            free(view->scene.images[i].rgba8);
            free(view->scene.images[i].rgba16);
        }
        free(view->scene.images);
        free(view->scene.textures);
    }
    free(view->scene.materials);
    free(view->scene.lights);
    *view = (ec_scene_view){0};
}

/* EXT_lights_image_based: the cube's sharpest mip is what the surroundings look like, and becomes the environment; the blurred mips and the
 * irradiance coefficients serve renderers that cannot integrate. Of the extension's two encodings one is read: sRGB divided by alpha (RGBD), which
 * JPEG and three-channel PNG lack. The specification does not say that RGBD colours are sRGB; Babylon.js, whose authors wrote it, treats them so.
 * Faces are laid out as OpenGL samples them: seen from inside, they are mirrored left to right ("flipped about its vertical axis"). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/image.h"
#include "gltf/cube.h"
#include "gltf/flatten.h"

enum { FACE_MOST = 2048 };

/* Decodes pixels to radiance. Alpha 0 would mean infinite brightness, and counts as the smallest value above it. */
static float *to_radiance(const ec_image *image, double intensity)
{
    size_t count = (size_t)image->width * image->height;
    const double one = image->rgba8 ? 255 : 65535, *bytes = ec_srgb_bytes();
    float *rgb = malloc(3 * count * sizeof *rgb);
    for (size_t i = 0; rgb && i < 4 * count; i++) {
        if (i % 4 == 3) continue;
        size_t alpha = i | 3;
        double divisor = image->rgba8 ? image->rgba8[alpha] : image->rgba16[alpha];
        double linear = image->rgba8 ? bytes[image->rgba8[i]] : ec_srgb_to_linear(image->rgba16[i] / one);
        double radiance = intensity * linear / (fmax(divisor, 1) / one);
        rgb[3 * (i / 4) + i % 4] = (float)fmin(radiance, (double)EC_RADIANCE_MOST);
    }
    return rgb;
}

typedef struct face {
    uint32_t width, height;
    bool failed;
    ec_error why;  /* why it failed; after success: how the image is damaged, or "" */
    float *rgb;    /* NULL: its size is not usable, or there is no memory */
} face;

static void load_face(const ec_gltf *g, int f, face *out)
{
    const ec_gltf_image_light *light = &g->image_light;
    ec_image image = {0};
    out->failed = !ec_gltf_image_load(g, (uint32_t)light->faces[f], &image, &out->why);
    out->width = image.width;
    out->height = image.height;
    if (!out->failed && image.width == image.height && image.width <= FACE_MOST) out->rgb = to_radiance(&image, light->intensity);
    ec_image_free(&image);
}

static ec_result check_face(const ec_gltf *g, int f, const face *faces, ec_error *err)
{
    static const char *const names[6] = {"+x", "-x", "+y", "-y", "+z", "-z"};
    const face *one = &faces[f];
    char where[80];
    snprintf(where, sizeof where, "the %s face of image-based light %d", names[f], g->image_light.index);
    if (one->failed) return ec_fail(err, "%s: %s: %.1200s", g->path, where, one->why.text);
    if (one->width != one->height)
        return ec_fail(err, "%s: %s has %u x %u pixels; faces must be square", g->path, where, one->width, one->height);
    if (one->width > FACE_MOST)
        return ec_fail(err, "%s: %s has %u x %u pixels, more than the limit of %d x %d; shrink the cube", g->path,
                       where, one->width, one->height, FACE_MOST, FACE_MOST);
    if (one->width != faces->width)
        return ec_fail(err, "%s: %s has %u x %u pixels, but the first face has %u x %u; all faces must have one size",
                       g->path, where, one->width, one->height, faces->width, faces->width);
    return one->rgb ? EC_OK : ec_fail(err, "%s: out of memory for %s", g->path, where);
}

/* Loads the faces in all threads. If several fail, the first one is reported. */
static ec_result load_faces(const ec_gltf *g, ec_cube *cube, const ec_log *log, ec_error *err)
{
    face faces[6] = {{0}};
    ec_result result = EC_OK;
#pragma omp parallel for schedule(dynamic, 1)
    for (int f = 0; f < 6; f++) load_face(g, f, &faces[f]);
    for (int f = 0; f < 6; f++) {
        if (result == EC_OK) result = check_face(g, f, faces, err);
        if (!faces[f].failed && faces[f].why.text[0]) ec_warn(log, "%s: %.1200s; what could be decoded is used", g->path, faces[f].why.text);
        cube->face[f] = faces[f].rgb;
    }
    cube->size = faces[0].width;
    return result;
}

ec_result ec_gltf_image_light_load(const ec_gltf *g, ec_scene *s, const ec_log *log, ec_error *err)
{
    const ec_gltf_image_light *light = &g->image_light;
    ec_cube cube = {0};
    ec_result result = EC_FAILED;
    if (!light->used || light->intensity == 0) return EC_OK;
    EC_TRY_CLEANUP(load_faces(g, &cube, log, err));
    if (light->size != cube.size)
        ec_warn(log, "%s: image-based light %d says that its faces have %u pixels a side, but they have %u; their own size is used",
                g->path, light->index, light->size, cube.size);
    EC_TRY_CLEANUP(ec_cube_environment(&cube, light->rotation, &s->environment, err));
    const float *constant = s->environment.constant;
    s->has_environment = s->environment.rgb || constant[0] > 0 || constant[1] > 0 || constant[2] > 0;
cleanup:
    ec_cube_free(&cube);
    return result;
}

/* EXT_lights_image_based: the cube's sharpest mip is what the surroundings look like, and so the environment; the blurred ones and the
 * irradiance coefficients are for those who cannot integrate. Of the extension's two encodings there is one here: sRGB, divided by
 * alpha (RGBD), which JPEG and three-channel PNG do not have. Its text does not say so of RGBD's colours; Babylon.js, whose authors
 * wrote it, has them in sRGB. Faces lie as OpenGL samples them: seen from inside, they are mirrored left to right ("flipped about its
 * vertical axis"). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/image.h"
#include "scene/cube.h"
#include "scene/flatten.h"

enum { FACE_MOST = 2048, WIDTH_MOST = 4096 };

/* Alpha 0 would be an infinite brightness: it counts as the least above it. */
static float *to_radiance(const ec_image *image, double intensity)
{
    size_t count = (size_t)image->width * image->height;
    double one = image->rgba8 ? 255 : 65535;
    float *rgb = malloc(3 * count * sizeof *rgb);
    for (size_t i = 0; rgb && i < 4 * count; i++) {
        if (i % 4 == 3) continue;
        size_t alpha = i | 3;
        double colour = image->rgba8 ? image->rgba8[i] : image->rgba16[i], divisor = image->rgba8 ? image->rgba8[alpha] : image->rgba16[alpha];
        double radiance = intensity * ec_srgb_to_linear(colour / one) / (fmax(divisor, 1) / one);
        rgb[3 * (i / 4) + i % 4] = (float)fmin(radiance, (double)EC_RADIANCE_MOST);
    }
    return rgb;
}

static ec_result load_face(const ec_gltf *g, int f, ec_cube *cube, ec_error *err)
{
    static const char *const names[6] = {"+x", "-x", "+y", "-y", "+z", "-z"};
    const ec_gltf_image_light *light = &g->image_light;
    ec_image image = {0};
    ec_error why;
    char where[80];
    ec_result result = EC_FAILED;
    snprintf(where, sizeof where, "the %s face of image-based light %d", names[f], light->index);
    if (!ec_gltf_image_load(g, (uint32_t)light->faces[f], &image, &why)) return ec_fail(err, "%s: %s: %.1200s", g->path, where, why.text);
    if (image.width != image.height)
        ec_fail(err, "%s: %s has %u x %u pixels; faces must be square", g->path, where, image.width, image.height);
    else if (image.width > FACE_MOST)
        ec_fail(err, "%s: %s has %u x %u pixels, more than the %d x %d that are read; shrink the cube", g->path, where, image.width,
                image.height, FACE_MOST, FACE_MOST);
    else if (f > 0 && image.width != cube->size)
        ec_fail(err, "%s: %s has %u x %u pixels, and the faces before it %u x %u; all must be of one size", g->path, where, image.width,
                image.height, cube->size, cube->size);
    else if (!(cube->face[f] = to_radiance(&image, light->intensity)))
        ec_fail(err, "%s: out of memory for %s", g->path, where);
    else
        result = EC_OK;
    cube->size = image.width;
    free(image.rgba8);
    free(image.rgba16);
    free(image.name);
    return result;
}

static bool is_uniform(const ec_cube *cube)
{
    size_t values = 3 * (size_t)cube->size * cube->size;
    for (int f = 0; f < 6; f++)
        for (size_t i = 0; i < values; i++)
            if (cube->face[f][i] != cube->face[0][i % 3]) return false;
    return true;
}

/* As many pixels around as four faces have, so that they are as dense as the cube's in the middle of a face. */
static ec_result unroll(const ec_cube *cube, ec_environment *e, const char *path, ec_error *err)
{
    uint32_t wanted = 4 * cube->size < 8 ? 8 : 4 * cube->size;
    e->width = wanted < WIDTH_MOST ? wanted : WIDTH_MOST;
    e->height = e->width / 2;
    e->rgb = malloc(3 * (size_t)e->width * e->height * sizeof *e->rgb);
    if (!e->rgb) return ec_fail(err, "%s: out of memory for an environment of %u x %u pixels", path, e->width, e->height);
    ec_cube_unroll(cube, e->width, e->height, 2 * (wanted / e->width), e->rgb);
    return EC_OK;
}

static void turn(const double rotation[4], ec_environment *e)
{
    static const double nowhere[3] = {0}, as_is[3] = {1, 1, 1};
    double matrix[16];
    ec_gltf_compose(nowhere, rotation, as_is, matrix);
    for (int i = 0; i < 9; i++) {
        e->turn[i] = (float)matrix[4 * (i % 3) + i / 3];
        if (e->turn[i] != (i % 4 == 0)) e->turned = true;
    }
}

ec_result ec_gltf_image_light_load(const ec_gltf *g, ec_scene *s, const ec_log *log, ec_error *err)
{
    const ec_gltf_image_light *light = &g->image_light;
    ec_cube cube = {0};
    ec_result result = EC_FAILED;
    if (!light->used || light->intensity == 0) return EC_OK;
    for (int f = 0; f < 6; f++) EC_TRY_CLEANUP(load_face(g, f, &cube, err));
    if (light->size != cube.size)
        ec_warn(log, "%s: image-based light %d says that its faces have %u pixels a side; they have %u, and are taken as they are",
                g->path, light->index, light->size, cube.size);
    if (is_uniform(&cube)) {
        float *constant = s->environment.constant;
        memcpy(constant, cube.face[0], sizeof s->environment.constant);
        s->has_environment = constant[0] > 0 || constant[1] > 0 || constant[2] > 0;
    } else {
        s->has_environment = true;
        EC_TRY_CLEANUP(unroll(&cube, &s->environment, g->path, err));
        turn(light->rotation, &s->environment);
    }
cleanup:
    ec_cube_free(&cube);
    return result;
}

/* How bright is an emissive texture over a small triangle of it, and how evenly? From means over ever larger squares, made once a texture. Inside
 * host/pack only. */
#ifndef EC_PACK_BRIGHTNESS_H
#define EC_PACK_BRIGHTNESS_H

#include "scene/scene.h"

/* Means of luminance and of its square. */
typedef struct ec_bright {
    float mean, square;
} ec_bright;

enum { EC_BRIGHT_LEVELS = 32 };

typedef struct ec_brightness {
    uint32_t width, height;
    ec_wrap wrap[2];
    bool nearest;
    const ec_image *image;                     /* borrowed */
    uint32_t stored;                           /* values that a channel of it may have */
    double *shares;                            /* [3][stored]: luminance of the material's radiance that each of them brings; owned */
    ec_bright *levels[EC_BRIGHT_LEVELS];       /* from 1 on: squares of 2^level patches, a patch lies between four texels' middles; owned */
    uint32_t columns[EC_BRIGHT_LEVELS], rows[EC_BRIGHT_LEVELS];
} ec_brightness;

ec_result ec_brightness_make(const ec_scene *scene, const ec_material *m, ec_brightness *b, ec_error *err);
void ec_brightness_free(ec_brightness *b); /* zero-initialised is fine */

/* Over a triangle by its corners on the picture, (0, 0) to (1, 1), and perhaps a little around it. *texels: how many it reaches across. */
ec_bright ec_brightness_over(const ec_brightness *b, const double corners[3][2], double *texels);

#endif

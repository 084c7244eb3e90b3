/* Measures how bright an emissive texture is over a small triangle of it, and how evenly, from means over squares of growing size, made once per
 * texture. Inside host/pack only. */
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
    uint32_t stored;                           /* number of values that a channel of it may have */
    double *shares;                            /* [3][stored]: the luminance that each value of each channel adds to the material's radiance; owned */
    ec_bright *levels[EC_BRIGHT_LEVELS];       /* from 1 on: means over squares of 2^level patches a side; a patch lies between four texel centres; owned */
    uint32_t columns[EC_BRIGHT_LEVELS], rows[EC_BRIGHT_LEVELS];
} ec_brightness;

ec_result ec_brightness_make(const ec_scene *scene, const ec_material *m, ec_brightness *b, ec_error *err);
void ec_brightness_free(ec_brightness *b); /* zero-initialised is fine */

/* Measures a triangle given by its corners on the picture, (0, 0) to (1, 1), perhaps with a little around it. *texels: its extent in texels. */
ec_bright ec_brightness_over(const ec_brightness *b, const double corners[3][2], double *texels);

#endif

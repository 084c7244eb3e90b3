/* Pictures from mapped pixel buffers into textures. The window's thread only. OpenGL 2.1: pixel buffers and textures of any size,
 * and quads need no more; every driver of the last twenty years has it, Mesa's software ones included. */
#ifndef EC_VIEW_TEXTURE_UPLOAD_H
#define EC_VIEW_TEXTURE_UPLOAD_H

#include "view/shared.h"

typedef struct ec_view_textures {
    unsigned texture[EC_ROLE_COUNT], buffer[EC_VIEW_SLOTS];
    uint32_t width[EC_ROLE_COUNT], height[EC_ROLE_COUNT]; /* 0: no picture yet */
    uint32_t largest; /* pixels of a side */
} ec_view_textures;

ec_result ec_view_textures_make(ec_view_textures *textures, ec_error *err);

/* Gives the renderer buffers for pictures of so many bytes. */
void ec_view_textures_fit(ec_view_textures *textures, ec_view *view, size_t bytes);

/* Takes what is ready; true: something was. */
bool ec_view_textures_take(ec_view_textures *textures, ec_view *view);

/* The part [u0, u1] of its width between x0 and x1, over the height: pixels from the bottom left. */
void ec_view_textures_draw(const ec_view_textures *textures, uint32_t role, double x0, double x1, double height,
                           double u0, double u1);

/* With the renderer's thread at its end. */
void ec_view_textures_free(ec_view_textures *textures, ec_view *view);

#endif

/* Pictures as textures. OpenGL 2.1: textures of any size and quads need no more; every driver of the last twenty years has it, Mesa's
 * software ones included. */
#ifndef EC_VIEW_TEXTURE_UPLOAD_H
#define EC_VIEW_TEXTURE_UPLOAD_H

#include <eclat/eclat.h>
#include <stdbool.h>

typedef struct ec_view_textures {
    unsigned texture[ECLAT_SHOWN_COUNT], buffer;
    uint32_t width[ECLAT_SHOWN_COUNT], height[ECLAT_SHOWN_COUNT]; /* 0: no picture yet */
    uint32_t largest; /* pixels of a side */
} ec_view_textures;

eclat_result ec_view_textures_make(ec_view_textures *textures, eclat_error *err);
void ec_view_textures_free(ec_view_textures *textures);

/* Takes what is new; true: something was. */
bool ec_view_textures_take(ec_view_textures *textures, eclat_live *live);

/* The part [u0, u1] of its width between x0 and x1, over the height: pixels from the bottom left. */
void ec_view_textures_draw(const ec_view_textures *textures, eclat_shown which, double x0, double x1, double height, double u0, double u1);

#endif

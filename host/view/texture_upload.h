/* Draws pictures as textures. OpenGL 2.1 suffices for textures of any size and quads, and every driver of the last twenty years has it, including
 * Mesa's software ones. */
#ifndef EC_VIEW_TEXTURE_UPLOAD_H
#define EC_VIEW_TEXTURE_UPLOAD_H

#include <eclat/eclat.h>
#include <stdbool.h>

typedef struct ec_view_textures {
    unsigned texture[ECLAT_SHOWN_COUNT], buffer;
    uint32_t width[ECLAT_SHOWN_COUNT], height[ECLAT_SHOWN_COUNT]; /* 0: no picture yet */
    uint32_t largest; /* pixels per side */
} ec_view_textures;

eclat_result ec_view_textures_make(ec_view_textures *textures, eclat_error *err);
void ec_view_textures_free(ec_view_textures *textures);

/* Takes new pictures; returns whether there were any. */
bool ec_view_textures_take(ec_view_textures *textures, eclat_live *live);

/* Draws the part [u0, u1] of its width between x0 and x1, over the full height; pixels from the bottom left. */
void ec_view_textures_draw(const ec_view_textures *textures, eclat_shown which, double x0, double x1, double height, double u0, double u1);

#endif

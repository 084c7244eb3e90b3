/* Draws words into a picture with the bitmap font of stb_easy_font.h (public domain; Debian's libstb-dev), if the build has it. */
#ifndef EC_IMAGE_LABEL_H
#define EC_IMAGE_LABEL_H

#include <stdint.h>

/* Returns the height of a line in pixels; 0: there is no font, and nothing is drawn. */
uint32_t ec_label_height(void);

/* Draws one line, centred in `width` pixels from (x, y) on, and shortened with ".." if it is wider. Characters that are not ASCII become "?". rgb: 3
 * bytes per pixel, `stride` pixels per row. */
void ec_label_draw(const char *text, uint32_t x, uint32_t y, uint32_t width, uint8_t shade, uint8_t *rgb, uint64_t stride);

#endif

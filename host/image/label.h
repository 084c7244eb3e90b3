/* Words in a picture, by a bitmap font: that of stb_easy_font.h (public domain; Debian's libstb-dev), where the build has it. */
#ifndef EC_IMAGE_LABEL_H
#define EC_IMAGE_LABEL_H

#include <stdint.h>

/* Pixels that a line takes; 0: there is no font, and nothing is drawn. */
uint32_t ec_label_height(void);

/* One line in the middle of `width` pixels from (x, y) on, cut short with ".." where it is wider. Characters that are not ASCII become "?".
 * rgb: 3 bytes a pixel, `stride` pixels a row. */
void ec_label_draw(const char *text, uint32_t x, uint32_t y, uint32_t width, uint8_t shade, uint8_t *rgb, uint64_t stride);

#endif

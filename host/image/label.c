#include "image/label.h"

#if __has_include(<stb/stb_easy_font.h>)
#include <stdio.h>
#include <string.h>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <stb/stb_easy_font.h>
#pragma GCC diagnostic pop

enum { HEIGHT = 12, MOST = 64 /* characters */ };

typedef struct corner { /* as written by stb_easy_font_print, four to a rectangle */
    float x, y, z;
    uint8_t color[4];
} corner;

uint32_t ec_label_height(void) { return HEIGHT; }

/* Copies as much of the text as fits; returns its width. */
static uint32_t shorten(const char *text, uint32_t width, char line[MOST + 3])
{
    size_t length = strnlen(text, MOST);
    for (size_t i = 0; i < length; i++) line[i] = (char)(text[i] < ' ' || text[i] > '~' ? '?' : text[i]);
    line[length] = 0;
    if (text[length]) memcpy(line + length, "..", 3);
    while (length > 0 && (uint32_t)stb_easy_font_width(line) > width) memcpy(line + --length, "..", 3);
    return length ? (uint32_t)stb_easy_font_width(line) : 0;
}

void ec_label_draw(const char *text, uint32_t x, uint32_t y, uint32_t width, uint8_t shade, uint8_t *rgb, uint64_t stride)
{
    char line[MOST + 3];
    corner corners[4 * 16 * MOST];
    const uint32_t wide = shorten(text, width, line);
    if (!wide) return;
    const int count = stb_easy_font_print((float)(x + (width - wide) / 2), (float)y + 2, line, NULL, corners, sizeof corners);
    for (const corner *c = corners; c < corners + 4 * count; c += 4)
        for (uint32_t v = (uint32_t)c[0].y; v < (uint32_t)c[2].y; v++)
            memset(rgb + 3 * (v * stride + (uint32_t)c[0].x), shade, 3 * (size_t)(c[2].x - c[0].x));
}
#else
uint32_t ec_label_height(void) { return 0; }

void ec_label_draw(const char *text, uint32_t x, uint32_t y, uint32_t width, uint8_t shade, uint8_t *rgb, uint64_t stride)
{
    (void)text, (void)x, (void)y, (void)width, (void)shade, (void)rgb, (void)stride;
}
#endif

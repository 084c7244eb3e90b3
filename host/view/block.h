/* Rows of text that fit a width, on a dark veil. */
#ifndef EC_VIEW_BLOCK_H
#define EC_VIEW_BLOCK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "view/glyphs.h"

enum { EC_BLOCK_ROWS = 64, EC_BLOCK_COLUMNS = 255 };
typedef struct ec_view_block {
    const ec_view_text *text;
    size_t columns;           /* that there is room for */
    uint32_t count, most;     /* rows */
    struct {
        char line[EC_BLOCK_COLUMNS + 1];
        const float *rgb;     /* the caller's */
    } row[EC_BLOCK_ROWS];
} ec_view_block;

/* Empty; for so many pixels of width and height, margins included. */
void ec_block_start(ec_view_block *block, const ec_view_text *text, double width, double height);

/* Goes on in the next row where it is too long, indented by `indent` characters. false: no row was left for the end of it. */
bool ec_block_add(ec_view_block *block, const char *line, size_t indent, const float rgb[3]);

/* With its margins, in pixels. */
double ec_block_height(const ec_view_block *block);
double ec_block_width(const ec_view_block *block);

/* Its top left corner there; the veil reaches to x1. */
void ec_block_draw(const ec_view_block *block, double x, double top, double x1);

#endif

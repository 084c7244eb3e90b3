/* A block of rows of text that fit a width, on a translucent dark rectangle. */
#ifndef EC_VIEW_BLOCK_H
#define EC_VIEW_BLOCK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "view/glyphs.h"

enum { EC_BLOCK_ROWS = 64, EC_BLOCK_COLUMNS = 255 };
typedef struct ec_view_block {
    const ec_view_text *text;
    size_t columns;           /* that fit into the width */
    uint32_t count, most;     /* rows */
    struct {
        char line[EC_BLOCK_COLUMNS + 1];
        const float *rgb;     /* the caller's */
    } row[EC_BLOCK_ROWS];
} ec_view_block;

/* Starts an empty block for a width and height in pixels, including margins. */
void ec_block_start(ec_view_block *block, const ec_view_text *text, double width, double height);

/* Adds a line, continued in further rows if it is too long, indented by `indent` characters. Returns false if there are not enough rows. */
bool ec_block_add(ec_view_block *block, const char *line, size_t indent, const float rgb[3]);

/* Size in pixels, including margins. */
double ec_block_height(const ec_view_block *block);
double ec_block_width(const ec_view_block *block);

/* Draws it with its top left corner at (x, top); its background reaches to x1. */
void ec_block_draw(const ec_view_block *block, double x, double top, double x1);

#endif

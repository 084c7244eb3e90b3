#include "view/block.h"

#include <math.h>
#include <string.h>

#define MARGIN 0.6 /* of a line's height, on all sides */

static double margin(const ec_view_block *b) { return b->text->size * MARGIN; }

void ec_block_start(ec_view_block *b, const ec_view_text *text, double width, double height)
{
    b->text = text;
    b->count = 0;
    double columns = floor((width - 2 * margin(b)) / text->advance), rows = floor((height - 2 * margin(b)) / text->line);
    b->columns = (size_t)fmin(fmax(columns, 8), EC_BLOCK_COLUMNS);
    b->most = (uint32_t)fmin(fmax(rows, 0), EC_BLOCK_ROWS);
}

/* Returns how many characters of a text go into a row: up to its last space, if that is not too far back. */
static size_t take(const char *text, size_t columns)
{
    size_t length = strnlen(text, columns);
    if (text[length])
        for (size_t k = length; k > columns / 2; k--)
            if (text[k] == ' ') return k;
    return length;
}

bool ec_block_add(ec_view_block *b, const char *line, size_t indent, const float rgb[3])
{
    if (indent > b->columns / 2) indent = 0;
    for (size_t in = 0; *line; in = indent) {
        if (b->count == b->most) return false;
        char *row = b->row[b->count].line;
        size_t taken = take(line, b->columns - in);
        memset(row, ' ', in);
        memcpy(row + in, line, taken);
        row[in + taken] = 0;
        b->row[b->count++].rgb = rgb;
        line += taken;
        line += strspn(line, " ");
    }
    return true;
}

double ec_block_height(const ec_view_block *b)
{
    return b->count ? b->count * b->text->line + 2 * margin(b) : 0;
}

double ec_block_width(const ec_view_block *b)
{
    size_t longest = 0;
    for (uint32_t i = 0; i < b->count; i++) longest = strlen(b->row[i].line) > longest ? strlen(b->row[i].line) : longest;
    return (double)longest * b->text->advance + 2 * margin(b);
}

void ec_block_draw(const ec_view_block *b, double x, double top, double x1)
{
    if (!b->count) return;
    ec_view_veil(x, top - ec_block_height(b), x1, top);
    for (uint32_t i = 0; i < b->count; i++)
        ec_view_text_draw(b->text, x + margin(b), top - margin(b) - i * b->text->line, x1, b->row[i].line, b->row[i].rgb);
}

/* Draws text over the picture: stb_truetype makes a texture of an embedded font (DejaVu Sans Mono). It is the one maintained library that does only
 * this: the window has lines of text and no widgets, and so no use for the layout and input handling of Nuklear or of Dear ImGui, which is C++
 * besides. */
#ifndef EC_VIEW_GLYPHS_H
#define EC_VIEW_GLYPHS_H

#include <eclat/eclat.h>

typedef struct ec_view_text {
    unsigned texture;
    double size, ascent, line, advance; /* pixels; line: from one line to the next; advance: of every character */
    struct ec_view_glyphs *glyphs;      /* owned */
} ec_view_text;

#define EC_TEXT_NARROW 0.52 /* approximate width of a character over `size` */

/* size: height of a line in pixels */
eclat_result ec_view_text_make(ec_view_text *text, double size, eclat_error *err);
void ec_view_text_free(ec_view_text *text); /* zero-initialised is fine */

/* Draws one line with its top left corner at (x, y), in pixels from the bottom left of the window, up to `right`. Characters beyond ASCII become
 * question marks. */
void ec_view_text_draw(const ec_view_text *text, double x, double y, double right, const char *line, const float rgb[3]);

/* Draws a translucent dark rectangle behind text. */
void ec_view_veil(double x0, double y0, double x1, double y1);

#endif

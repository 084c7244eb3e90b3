/* Text over the picture: stb_truetype makes a texture of a font that is inside the program (DejaVu Sans Mono). Of the libraries that
 * are kept, it is the one that does this and nothing else: the window has lines of text, no widgets, and so no use for the layout
 * and input handling of Nuklear or Dear ImGui (which is C++ besides). */
#ifndef EC_VIEW_GLYPHS_H
#define EC_VIEW_GLYPHS_H

#include <eclat/eclat.h>

typedef struct ec_view_text {
    unsigned texture;
    double size, ascent, line, advance; /* pixels; line: from one to the next; advance: of every character */
    struct ec_view_glyphs *glyphs;      /* owned */
} ec_view_text;

#define EC_TEXT_NARROW 0.52 /* a character's width over `size`, about */

/* size: pixels of a line's height */
eclat_result ec_view_text_make(ec_view_text *text, double size, eclat_error *err);
void ec_view_text_free(ec_view_text *text); /* zero-initialised is fine */

/* One line, its top left corner at x, y: pixels from the bottom left of the window. Draws nothing past `right`. Characters beyond
 * ASCII are a question mark each. */
void ec_view_text_draw(const ec_view_text *text, double x, double y, double right, const char *line, const float rgb[3]);

/* A dark veil for text to stand on. */
void ec_view_veil(double x0, double y0, double x1, double y1);

#endif

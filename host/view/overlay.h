/* The lines over the picture. */
#ifndef EC_VIEW_OVERLAY_H
#define EC_VIEW_OVERLAY_H

#include "view/glyphs.h"
#include "view/input.h"

typedef struct ec_view_overlay {
    const ec_view_input *input;
    const eclat_status *status;
    const char *against;       /* the file beside the picture; NULL: none */
    bool message;              /* what was told of the last save is still shown */
    bool has_second;           /* the one that is wished is there */
    const ec_view_text *small; /* that of the help */
} ec_view_overlay;

void ec_view_overlay_draw(const ec_view_overlay *overlay, const ec_view_text *text, double width, double height);

#endif

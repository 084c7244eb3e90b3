/* The lines over the picture. */
#ifndef EC_VIEW_OVERLAY_H
#define EC_VIEW_OVERLAY_H

#include "view/shared.h"
#include "view/glyphs.h"

typedef struct ec_view_overlay {
    const ec_view_wish *wish;
    const ec_view_status *status;
    const ec_view_facts *facts;
    const ec_view_request *request;
    ec_view_layout layout;
    ec_view_lines lines;
    bool help, effects;     /* lists that are open */
    uint32_t effects_page;
    bool message;           /* what was told of the last save is still shown */
    bool has_second;        /* the one that is wished is there */
    const ec_view_probe *selected; /* node < 0: nothing */
    const ec_view_text *small;     /* that of the help */
} ec_view_overlay;

void ec_view_overlay_draw(const ec_view_overlay *overlay, const ec_view_text *text, double width, double height);

#endif

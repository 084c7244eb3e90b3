/* The lines over the picture. */
#ifndef EC_VIEW_OVERLAY_H
#define EC_VIEW_OVERLAY_H

#include "view/window.h"

void ec_view_overlay_draw(const ec_window *window, double width, double height);

#endif

#ifndef EC_REPORT_FORECAST_TEXT_H
#define EC_REPORT_FORECAST_TEXT_H

#include "render/render.h"

/* "2 % needs about 230 samples a pixel, 41 s (95 %: 36 s to 52 s)" */
void ec_forecast_text(const ec_forecast *forecast, const ec_render_options *options, char *text, size_t size);

#endif

/* Describes the progress of a render, and what its pilot predicts. */
#ifndef EC_REPORT_PROGRESS_TEXT_H
#define EC_REPORT_PROGRESS_TEXT_H

#include "render/render.h"

/* Writes e.g. "37 %  0:12 left  96 spp  5.42 M samples/s  error 2.31 % (bound 2.40 %)". */
void ec_progress_text(const ec_progress *progress, char *text, size_t size);

/* Writes e.g. "2 % needs about 230 samples a pixel, 41 s (95 %: 36 s to 52 s)". */
void ec_forecast_text(const ec_forecast *forecast, const ec_render_options *options, char *text, size_t size);

#endif

/* How far a render is, in words. */
#ifndef EC_REPORT_PROGRESS_TEXT_H
#define EC_REPORT_PROGRESS_TEXT_H

#include "render/render.h"

/* "37 %  0:12 left  96 spp  5.42 M samples/s  error 2.31 % (bound 2.40 %)" */
void ec_progress_text(const ec_progress *progress, char *text, size_t size);

#endif

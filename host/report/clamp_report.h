/* A clamp's error in words and in JSON, for renders and merged pictures alike. */
#ifndef EC_REPORT_CLAMP_REPORT_H
#define EC_REPORT_CLAMP_REPORT_H

#include "film/clamp.h"
#include "report/json.h"

/* "3.1 % of the light is missing (standard error 0.2 %); noise 1.2 %, bias 4.0 %, together 4.2 %". is_open: more may be missing (film/rare.h). */
void ec_clamp_text(const ec_clamp_error *clamp, bool is_open, char *text, size_t size);

/* limit: as the option has it, in mean luminances; luminance: the limit itself. */
void ec_clamp_json(cJSON *root, double limit, double luminance, const ec_clamp_error *clamp);

#endif

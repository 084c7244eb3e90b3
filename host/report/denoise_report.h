/* Report the results of --denoise as text, JSON and attributes. denoised NULL: not asked for. */
#ifndef EC_REPORT_DENOISE_REPORT_H
#define EC_REPORT_DENOISE_REPORT_H

#include <stdio.h>

#include "denoise/denoise.h"
#include "report/attributes.h"

void ec_denoised_text(const ec_denoised *denoised, FILE *to);
void ec_denoised_json(cJSON *root, const ec_denoised *denoised);
void ec_denoised_attributes(ec_report_attributes *attributes, const ec_denoised *denoised);

#endif

/* A picture to be compared: an EXR of ours or of another renderer. */
#ifndef EC_JOBS_COMPARE_INPUT_H
#define EC_JOBS_COMPARE_INPUT_H

#include "film/measured.h"
#include "image/image.h"

typedef struct ec_compare_input {
    const char *path;
    ec_measured measured;       /* points into what follows */
    char *why;                  /* owned: why the file states no bound of its error; NULL: it does, or says nothing */
    float *rgb, *se, *se_y;     /* owned; se and se_y NULL where the file has none, or only one replicate */
} ec_compare_input;

/* R, G, B; stderr.R, .G, .B, .Y where there are any. Fails where a channel is missing or a value is not finite. */
ec_result ec_compare_input_load(const char *path, ec_compare_input *input, ec_error *err);
void ec_compare_input_free(ec_compare_input *input); /* zero-initialised ones are fine */

#endif

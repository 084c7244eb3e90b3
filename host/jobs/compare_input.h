/* Reads pictures to compare: EXRs of eclat or another renderer, and files made for a screen. */
#ifndef EC_JOBS_COMPARE_INPUT_H
#define EC_JOBS_COMPARE_INPUT_H

#include <stdbool.h>

#include "base/error.h"
#include "film/measured.h"

typedef struct ec_compare_input {
    const char *path;
    ec_measured measured;       /* points into the fields below */
    const char *format;         /* e.g. "8-bit PNG": sRGB values from 0 to 1; NULL: linear floats */
    bool is_lossy;              /* values may be off by more than a quantisation step */
    char *why;                  /* owned: why the file states no bound of its error; NULL: it does, or does not say why */
    float *rgb, *se, *se_y;     /* owned; se and se_y are NULL if the file has no standard errors, or only one replicate */
    float *slack, *tail_se;     /* owned; NULL: none */
    uint8_t *mask;              /* owned: 0 where the picture is not opaque; NULL: it is opaque everywhere */
} ec_compare_input;

/* Reads EXR, Radiance, PNG, JPEG, WebP or AVIF, by content. Fails if a channel is missing or a value is not finite. Must be freed on failure too. */
ec_result ec_compare_read(const char *path, ec_compare_input *input, ec_error *err);
void ec_compare_input_free(ec_compare_input *input); /* zero-initialised is fine */

/* compare_exr.c, compare_picture.c: read one kind each; *input must be zero. */
ec_result ec_compare_read_exr(const char *path, ec_compare_input *input, ec_error *err);
ec_result ec_compare_read_picture(const char *path, ec_compare_input *input, ec_error *err);

/* Reads a mask: a malloc'ed array of one byte per pixel, 0 where the mask's luminance is below a half or it is not opaque. */
ec_result ec_compare_read_mask(const char *path, uint32_t width, uint32_t height, uint8_t **mask, ec_error *err);

#endif

/* A picture that is compared: an EXR of ours or of another renderer, or what a program shows. */
#ifndef EC_JOBS_COMPARE_INPUT_H
#define EC_JOBS_COMPARE_INPUT_H

#include <stdbool.h>

#include "base/error.h"
#include "film/measured.h"

typedef struct ec_compare_input {
    const char *path;
    ec_measured measured;       /* points into what follows */
    const char *format;         /* "8-bit PNG": sRGB values from 0 to 1; NULL: linear floats */
    bool is_lossy;              /* its values may be off by more than a step */
    char *why;                  /* owned: why the file states no bound of its error; NULL: it does, or says nothing */
    float *rgb, *se, *se_y;     /* owned; se and se_y NULL where the file has none, or only one replicate */
    float *slack;               /* owned; NULL: none */
    uint8_t *mask;              /* owned: 0 where the picture is not opaque; NULL: it is */
} ec_compare_input;

/* Reads any: EXR, Radiance, PNG, JPEG, WebP, AVIF, by content. Fails where a channel is missing or a value is not finite. To be freed on failure too. */
ec_result ec_compare_read(const char *path, ec_compare_input *input, ec_error *err);
void ec_compare_input_free(ec_compare_input *input); /* zero-initialised is fine */

/* compare_exr.c, compare_picture.c: that kind alone; *input is zero. */
ec_result ec_compare_read_exr(const char *path, ec_compare_input *input, ec_error *err);
ec_result ec_compare_read_picture(const char *path, ec_compare_input *input, ec_error *err);

/* Which pixels a picture of another file leaves out: 1 a pixel, malloc'ed; 0 where its luminance is under a half or it is not opaque.  */
ec_result ec_compare_read_mask(const char *path, uint32_t width, uint32_t height, uint8_t **mask, ec_error *err);

#endif

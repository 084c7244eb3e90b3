/* A text inside a PNG, by a keyword: an iTXt chunk, which viewers leave alone. */
#ifndef EC_IMAGE_PNG_TEXT_H
#define EC_IMAGE_PNG_TEXT_H

#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

/* Puts it before the picture's data. *bytes, an encoded PNG, is malloc'ed and grows. keyword: up to 79 characters. */
ec_result ec_png_add_text(uint8_t **bytes, size_t *size, const char *keyword, const char *text, ec_error *err);

/* malloc'ed; NULL where there is none, or the file is not whole. */
char *ec_png_whole_text(const char *path, const char *keyword);

#endif

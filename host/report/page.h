/* Writes HTML pages that contain everything they need and open without a network. */
#ifndef EC_REPORT_PAGE_H
#define EC_REPORT_PAGE_H

#include <cjson/cJSON.h>
#include <stdint.h>

#include "base/error.h"

/* The replacement of @NAME@ in a page; one of the three is set. */
typedef struct ec_page_part {
    const char *name;
    const char *text;   /* inserted unchanged */
    const char *prose;  /* inserted with < and & escaped */
    const cJSON *json;  /* for a script element, which it cannot end */
} ec_page_part;

/* Writes a page. page: its text from the title in the head on. parts: ended by a NULL name; must include every @NAME@ of the page. Leaves no file on
 * failure. */
ec_result ec_page_write(const char *path, const char *page, const ec_page_part *parts, ec_error *err);

/* Makes *text the PNG of a picture as a data URI. rgb: 3 bytes per pixel. */
ec_result ec_page_picture(uint32_t width, uint32_t height, const uint8_t *rgb, cJSON **text, ec_error *err);

#endif

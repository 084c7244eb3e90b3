/* A page of HTML with everything inside: opens without a network. */
#ifndef EC_REPORT_PAGE_H
#define EC_REPORT_PAGE_H

#include <cjson/cJSON.h>
#include <stdint.h>

#include "base/error.h"

/* What stands at @NAME@ of a page: one of the three. */
typedef struct ec_page_part {
    const char *name;
    const char *text;   /* as it is */
    const char *prose;  /* with < and & escaped */
    const cJSON *json;  /* for a script element: nothing in it ends that */
} ec_page_part;

/* page: from its title on, within the head. parts: a name of NULL ends them; each @NAME@ of the page is among them. All of the file or none of it. */
ec_result ec_page_write(const char *path, const char *page, const ec_page_part *parts, ec_error *err);

/* *text: a PNG as a data URI. rgb: 3 bytes a pixel. */
ec_result ec_page_picture(uint32_t width, uint32_t height, const uint8_t *rgb, cJSON **text, ec_error *err);

#endif

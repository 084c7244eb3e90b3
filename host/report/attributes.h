/* Collects the attributes of an EXR. */
#ifndef EC_REPORT_ATTRIBUTES_H
#define EC_REPORT_ATTRIBUTES_H

#include "image/image.h"
#include "report/json.h"

enum { EC_REPORT_ATTRIBUTES_MAX = 96 };
typedef struct ec_report_attributes {
    ec_attribute list[EC_REPORT_ATTRIBUTES_MAX];
    uint32_t count;
    char text[32768]; /* texts made here; list points into it, so it must not be moved or copied */
    size_t text_used;
} ec_report_attributes;

/* Adds fields. Whole numbers become ints, or texts if they do not fit. Keys and texts must last as long as the attributes. */
#define EC_ATTRIBUTES(attributes, ...) ec_attributes_add(attributes, (const ec_field[]){__VA_ARGS__, {0}})
void ec_attributes_add(ec_report_attributes *attributes, const ec_field *fields);

/* Adds a formatted text, which is stored in `attributes`. */
__attribute__((format(printf, 3, 4))) void ec_attributes_made(ec_report_attributes *attributes, const char *name, const char *format, ...);

#endif

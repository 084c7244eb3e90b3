#include "report/attributes.h"

#include <inttypes.h>
#include <stdarg.h>

static void add(ec_report_attributes *attributes, ec_attribute attribute)
{
    if (attributes->count < EC_REPORT_ATTRIBUTES_MAX) attributes->list[attributes->count++] = attribute;
}

void ec_attributes_made(ec_report_attributes *attributes, const char *name, const char *format, ...)
{
    char *text = attributes->text + attributes->text_used;
    size_t room = sizeof attributes->text - attributes->text_used;
    va_list args;
    va_start(args, format);
    int size = vsnprintf(text, room, format, args);
    va_end(args);
    if (size < 0 || (size_t)size >= room) return;
    attributes->text_used += (size_t)size + 1;
    add(attributes, (ec_attribute){.name = name, .type = EC_ATTR_STRING, .string = text});
}

void ec_attributes_add(ec_report_attributes *attributes, const ec_field *f)
{
    for (; f->key; f++) {
        if (f->kind == EC_FIELD_TEXT) add(attributes, (ec_attribute){.name = f->key, .type = EC_ATTR_STRING, .string = f->text});
        else if (f->kind == EC_FIELD_REAL) add(attributes, (ec_attribute){.name = f->key, .type = EC_ATTR_DOUBLE, .number = f->real});
        else if (f->whole > INT32_MAX) ec_attributes_made(attributes, f->key, "%" PRIu64, f->whole);
        else add(attributes, (ec_attribute){.name = f->key, .type = EC_ATTR_INT, .number = (double)f->whole});
    }
}

#include "report/page.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/atomic_file.h"
#include "image/image.h"

/* A character and its replacement. */
typedef struct replaced {
    char character;
    const char *by;
} replaced;

static void put(FILE *to, const char *text, const replaced *replaced)
{
    for (; *text; text++) {
        int i = 0;
        while (replaced[i].by && replaced[i].character != *text) i++;
        if (replaced[i].by) fputs(replaced[i].by, to);
        else fputc(*text, to);
    }
}

/* Prints JSON within a script element, which only < could end. */
static void put_json(FILE *to, const cJSON *object)
{
    char *text = cJSON_PrintUnformatted(object);
    put(to, text ? text : "null", (const replaced[]){{'<', "\\u003c"}, {0, NULL}});
    cJSON_free(text);
}

static void put_part(FILE *to, const char *name, size_t size, const ec_page_part *part)
{
    while (part->name && (strlen(part->name) != size || memcmp(part->name, name, size))) part++;
    if (part->text) fputs(part->text, to);
    if (part->prose) put(to, part->prose, (const replaced[]){{'<', "&lt;"}, {'&', "&amp;"}, {0, NULL}});
    if (part->json) put_json(to, part->json);
}

static void put_page(FILE *to, const char *page, const ec_page_part *parts)
{
    const char *at;
    while ((at = strchr(page, '@')) != NULL) {
        const char *end = strchr(at + 1, '@');
        fwrite(page, 1, (size_t)(at - page), to);
        put_part(to, at + 1, (size_t)(end - at - 1), parts);
        page = end + 1;
    }
    fputs(page, to);
}

/* The beginning of every page, which forbids loading anything from elsewhere. */
static const char head[] = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta name=\"generator\" content=\"eclat\">\n"
                           "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'; "
                           "script-src 'unsafe-inline'\">\n<link rel=\"icon\" href=\"data:,\">\n";

ec_result ec_page_write(const char *path, const char *page, const ec_page_part *parts, ec_error *err)
{
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    if (to) fputs(head, to);
    if (to) put_page(to, page, parts);
    bool good = to && !ferror(to);
    if (to) good = fclose(to) == 0 && good;
    ec_result result = good ? ec_atomic_write(path, text, size, err) : ec_fail(err, "out of memory for '%s'", path);
    free(text);
    return result;
}

static char *data_uri(const uint8_t *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/",
                      head[] = "data:image/png;base64,";
    char *text = malloc(sizeof head + (size + 2) / 3 * 4), *to = text;
    if (!text) return NULL;
    to += sprintf(to, "%s", head);
    for (size_t i = 0; i < size; i += 3) {
        uint32_t word = (uint32_t)bytes[i] << 16 | (i + 1 < size ? (uint32_t)bytes[i + 1] << 8 : 0) | (i + 2 < size ? bytes[i + 2] : 0);
        for (size_t k = 0; k < 4; k++) *to++ = i + k <= size ? digits[word >> (18 - 6 * k) & 63] : '=';
    }
    *to = 0;
    return text;
}

ec_result ec_page_picture(uint32_t width, uint32_t height, const uint8_t *rgb, cJSON **text, ec_error *err)
{
    uint8_t *png = NULL;
    size_t size = 0;
    EC_TRY(ec_png_encode(width, height, rgb, &png, &size, err));
    char *uri = data_uri(png, size);
    *text = uri ? cJSON_CreateString(uri) : NULL;
    free(png);
    free(uri);
    return *text ? EC_OK : ec_fail(err, "out of memory for the pictures of a page");
}

/* One page with everything inside. */
#include <stdlib.h>
#include <string.h>

#include "cost/page.h"
#include "cost/cost_internal.h"
#include "cost/report.h"

/* With these characters written otherwise. */
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

/* Within a script element only < could end it. */
static void put_json(FILE *to, cJSON *object)
{
    char *text = cJSON_PrintUnformatted(object);
    put(to, text ? text : "null", (const replaced[]){{'<', "\\u003c"}, {0, NULL}});
    cJSON_free(text);
}

static void put_table(FILE *to, const ec_cost_report *report)
{
    char *text = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&text, &size);
    if (!memory) return;
    ec_cost_table(report, false, memory);
    fclose(memory);
    put(to, text, (const replaced[]){{'<', "&lt;"}, {'&', "&amp;"}, {0, NULL}});
    free(text);
}

typedef struct page_parts {
    const ec_cost_report *report;
    cJSON *data, *images;
} page_parts;

static void put_part(FILE *to, const char *name, size_t size, const page_parts *parts)
{
#define IS(word) (size == strlen(word) && !memcmp(name, word, size))
    if (IS("STYLE")) fputs(ec_text_page_css, to);
    if (IS("CHART")) fputs(ec_text_chart_js, to);
    if (IS("SCRIPT")) fputs(ec_text_page_js, to);
    if (IS("TEXT")) put_table(to, parts->report);
    if (IS("DATA")) put_json(to, parts->data);
    if (IS("IMAGES")) put_json(to, parts->images);
#undef IS
}

static void put_page(FILE *to, const void *parts)
{
    const char *c = ec_text_page_html, *at;
    while ((at = strchr(c, '@')) != NULL) {
        const char *end = strchr(at + 1, '@');
        fwrite(c, 1, (size_t)(at - c), to);
        put_part(to, at + 1, (size_t)(end - at - 1), parts);
        c = end + 1;
    }
    fputs(c, to);
}

ec_result ec_cost_write_html(const ec_cost_report *report, const char *path, ec_error *err)
{
    page_parts parts = {.report = report, .data = ec_cost_json(report)};
    ec_result result = ec_cost_pictures(report->study, &parts.images, err);
    if (result == EC_OK) result = ec_cost_write(path, put_page, &parts, err);
    cJSON_Delete(parts.data);
    cJSON_Delete(parts.images);
    return result;
}

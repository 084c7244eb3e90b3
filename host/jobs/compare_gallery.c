#include "jobs/compare_gallery.h"

#include <stdlib.h>
#include <string.h>

#include "image/error_map.h"
#include "report/page.h"

enum { GREY = 128 }; /* of pixels that are not compared, in maps */

static ec_result add(cJSON *pair, const char *key, const ec_compare_job *job, const uint8_t *rgb, ec_error *err)
{
    cJSON *text;
    EC_TRY(ec_page_picture(job->a.measured.width, job->a.measured.height, rgb, &text, err));
    cJSON_AddItemToObject(pair, key, text);
    return EC_OK;
}

static ec_result add_pictures(cJSON *pair, const ec_compare_job *job, uint8_t *rgb, ec_error *err)
{
    static const char *const keys[2] = {"a", "b"};
    const uint64_t pixels = (uint64_t)job->a.measured.width * job->a.measured.height;
    for (int i = 0; i < 2; i++) {
        for (uint64_t k = 0; k < 3 * pixels; k++) rgb[k] = (uint8_t)lrintf(255 * job->seen[i][k]);
        EC_TRY(add(pair, keys[i], job, rgb, err));
    }
    ec_compare_map(job, rgb);
    EC_TRY(add(pair, "error", job, rgb, err));
    for (uint64_t p = 0; p < pixels; p++)
        if (job->mask && !job->mask[p]) memset(rgb + 3 * p, GREY, 3);
        else ec_magma(job->flip[p], rgb + 3 * p);
    return add(pair, "flip", job, rgb, err);
}

ec_result ec_gallery_add(cJSON *pairs, const ec_compare_job *job, ec_error *err)
{
    uint8_t *rgb = malloc(3ull * job->a.measured.width * job->a.measured.height);
    if (!rgb) return ec_fail(err, "out of memory for the pictures of a page");
    cJSON *pair = cJSON_CreateObject();
    cJSON_AddItemToObject(pair, "report", ec_compare_report_json(&job->report));
    cJSON_AddItemToArray(pairs, pair);
    ec_result result = add_pictures(pair, job, rgb, err);
    free(rgb);
    return result;
}

ec_result ec_gallery_write(const char *path, const cJSON *pairs, const char *text, ec_error *err)
{
    return ec_page_write(path, ec_text_gallery_html,
                         (const ec_page_part[]){{.name = "STYLE", .text = ec_text_gallery_css}, {.name = "SCRIPT", .text = ec_text_gallery_js},
                                                {.name = "TEXT", .prose = text}, {.name = "DATA", .json = pairs}, {0}}, err);
}

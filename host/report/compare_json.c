#include "report/compare_report.h"
#include "report/json.h"

static void add_picture(cJSON *root, const char *key, const char *path, const char *why, const ec_measured *image, double mean)
{
    EC_JSON(ec_json_object(root, key), EC_STRING("path", path), EC_REAL("mean_luminance", mean), EC_FLAG("standard_errors", image->se != NULL),
            EC_REAL("replicates", image->se ? image->replicates : INFINITY), EC_STRING("error_bound_why", why));
}

static void add_place(cJSON *root, const char *key, const ec_noise_place *place)
{
    EC_JSON(ec_json_object(root, key), EC_WHOLE("x", place->x), EC_WHOLE("y", place->y), EC_REAL("standard_errors", place->t));
}

static void add_test(cJSON *root, const ec_noise_test *test)
{
    EC_JSON(root, EC_REAL("p", test->p), EC_REAL("p_mean", test->p_mean), EC_REAL("p_blocks", test->p_blocks), EC_REAL("p_pixels", test->p_pixels),
            EC_REAL("p_share", test->p_share), EC_REAL("significance", EC_NOISE_SIGNIFICANCE));
    cJSON_AddItemToObject(root, "mean_difference", cJSON_CreateDoubleArray(test->mean_difference, 3));
    cJSON_AddItemToObject(root, "mean_standard_errors", cJSON_CreateDoubleArray(test->mean_t, 3));
    ec_json_real(root, "outlying_share", test->judged ? (double)test->outlying / (double)test->judged : 0);
    add_place(root, "worst_block", &test->block);
    add_place(root, "worst_pixel", &test->pixel);
    ec_json_whole(root, "exact_unequal", test->exact_unequal);
}

ec_result ec_compare_report_json(const ec_compare_report *report, FILE *to, ec_error *err)
{
    const ec_difference *d = &report->difference;
    cJSON *root = cJSON_CreateObject();
    add_picture(root, "a", report->path_a, report->why_a, report->a, d->mean_a);
    add_picture(root, "b", report->path_b, report->why_b, report->b, d->mean_b);
    EC_JSON(root, EC_WHOLE("width", report->a->width), EC_WHOLE("height", report->a->height), EC_FLAG("differ", report->differ),
            EC_WHOLE("unequal_pixels", d->unequal), EC_REAL("error", d->relative_rms), EC_REAL("error_of_noise", d->noise_relative_rms),
            EC_REAL("rmse", d->rmse), EC_REAL("relmse", d->relmse), EC_REAL("relmse_of_noise", d->noise_relmse), EC_REAL("mape", d->mape),
            EC_REAL("psnr", d->psnr));
    if (report->tested)
        add_test(cJSON_AddObjectToObject(root, "noise_test"), &report->test);
    else
        cJSON_AddNullToObject(root, "noise_test");
    ec_json_text(root, "diff", report->diff_path);
    return ec_json_print(root, to, err);
}

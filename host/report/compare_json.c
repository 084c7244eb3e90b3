#include "report/compare_report.h"
#include "report/json.h"

static void add_picture(cJSON *root, const char *key, const char *path, const char *why, const ec_measured *image, double mean)
{
    cJSON *object = cJSON_AddObjectToObject(root, key);
    ec_json_text(object, "path", path);
    ec_json_real(object, "mean_luminance", mean);
    cJSON_AddBoolToObject(object, "standard_errors", image->se != NULL);
    ec_json_real(object, "replicates", image->se ? image->replicates : INFINITY);
    ec_json_text(object, "error_bound_why", why);
}

static void add_place(cJSON *root, const char *key, const ec_noise_place *place)
{
    cJSON *object = cJSON_AddObjectToObject(root, key);
    ec_json_whole(object, "x", place->x);
    ec_json_whole(object, "y", place->y);
    ec_json_real(object, "standard_errors", place->t);
}

static void add_test(cJSON *root, const ec_noise_test *test)
{
    ec_json_real(root, "p", test->p);
    ec_json_real(root, "p_mean", test->p_mean);
    ec_json_real(root, "p_blocks", test->p_blocks);
    ec_json_real(root, "p_pixels", test->p_pixels);
    ec_json_real(root, "p_share", test->p_share);
    ec_json_real(root, "significance", EC_NOISE_SIGNIFICANCE);
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
    ec_json_whole(root, "width", report->a->width);
    ec_json_whole(root, "height", report->a->height);
    cJSON_AddBoolToObject(root, "differ", report->differ);
    ec_json_whole(root, "unequal_pixels", d->unequal);
    ec_json_real(root, "error", d->relative_rms);
    ec_json_real(root, "error_of_noise", d->noise_relative_rms);
    ec_json_real(root, "rmse", d->rmse);
    ec_json_real(root, "relmse", d->relmse);
    ec_json_real(root, "relmse_of_noise", d->noise_relmse);
    ec_json_real(root, "mape", d->mape);
    ec_json_real(root, "psnr", d->psnr);
    if (report->tested)
        add_test(cJSON_AddObjectToObject(root, "noise_test"), &report->test);
    else
        cJSON_AddNullToObject(root, "noise_test");
    ec_json_text(root, "diff", report->diff_path);
    return ec_json_print(root, to, err);
}

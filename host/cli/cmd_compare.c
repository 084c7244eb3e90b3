/* eclat compare A.exr B.exr */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cli/cli.h"
#include "cli/compare_input.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/setters.h"
#include "image/error_map.h"
#include "report/compare_report.h"

typedef struct compare_request {
    const char *a, *b, *diff;
    bool json, quiet;
} compare_request;

#define REQUEST ((compare_request *)target)

FLAG_SETTER(json, json)
FLAG_SETTER(quiet, quiet)

SETTER(diff)
{
    size_t size = strlen(value);
    if (size <= 4 || value[size - 5] == '/' || strcasecmp(value + size - 4, ".png"))
        return ec_usage(err, "--%s: '%s' must be named NAME.png", option, value);
    REQUEST->diff = value;
    return EC_OK;
}

static const ec_option options[] = {{"diff", 0, true, set_diff}, {"json", 0, false, set_json}, {"quiet", 'q', false, set_quiet}};

static ec_result take_operands(int argc, char **argv, int first, compare_request *request, ec_error *err)
{
    if (argc - first < 2 || !*argv[first] || !*argv[first + 1])
        return ec_usage(err, "compare needs two pictures, A.exr and the reference B.exr; see 'eclat compare --help'");
    if (argc - first > 2) return ec_usage(err, "two pictures at a time: '%s' is one operand too many", argv[first + 2]);
    request->a = argv[first];
    request->b = argv[first + 1];
    return EC_OK;
}

static ec_result check_diff(const compare_request *request, ec_error *err)
{
    if (!request->diff) return EC_OK;
    if (ec_same_file(request->diff, request->a) || ec_same_file(request->diff, request->b))
        return ec_fail(err, "'%s' is one of the pictures compared; give --diff another name", request->diff);
    return ec_image_check_writable(request->diff, err);
}

static ec_result write_map(const char *path, const ec_measured *a, const ec_measured *b, ec_error *err)
{
    uint64_t pixels = (uint64_t)a->width * a->height;
    uint8_t *map = malloc(3 * pixels);
    if (!map) return ec_fail(err, "out of memory for '%s'", path);
    ec_error_map(a->rgb, b->rgb, pixels, map);
    ec_result result = ec_png_write(path, a->width, a->height, map, err);
    free(map);
    return result;
}

static ec_result measure(const compare_request *request, ec_compare_report *report, ec_error *err)
{
    const ec_measured *a = report->a, *b = report->b;
    if (a->width != b->width || a->height != b->height)
        return ec_fail(err, "cannot compare '%s' with '%s': %ux%u pixels against %ux%u; render both at one --size", request->a, request->b,
                       a->width, a->height, b->width, b->height);
    report->difference = ec_measure_difference(a, b);
    report->tested = a->se || b->se;
    if (report->tested) EC_TRY(ec_test_noise(a, b, &report->test, err));
    report->differ = report->tested ? report->test.p < EC_NOISE_SIGNIFICANCE : report->difference.unequal > 0;
    report->diff_path = request->diff;
    return request->diff ? write_map(request->diff, a, b, err) : EC_OK;
}

static ec_result compare(const compare_request *request, bool *differ, ec_error *err)
{
    ec_compare_input a = {0}, b = {0};
    ec_compare_report report = {.path_a = request->a, .path_b = request->b, .a = &a.measured, .b = &b.measured};
    ec_result result;
    EC_TRY_CLEANUP(check_diff(request, err));
    EC_TRY_CLEANUP(ec_compare_input_load(request->a, &a, err));
    EC_TRY_CLEANUP(ec_compare_input_load(request->b, &b, err));
    report.why_a = a.why;
    report.why_b = b.why;
    EC_TRY_CLEANUP(measure(request, &report, err));
    if (request->json)
        result = ec_compare_report_json(&report, stdout, err);
    else if (!request->quiet)
        ec_compare_report_text(&report, stdout);
    *differ = report.differ;
cleanup:
    ec_compare_input_free(&a);
    ec_compare_input_free(&b);
    return result;
}

ec_result ec_cmd_compare(ec_cli *cli, int argc, char **argv, ec_error *err)
{
    compare_request request = {0};
    int first = 0;
    bool differ = false;
    ec_request asked;
    EC_TRY(ec_options_parse(options, sizeof options / sizeof options[0], &request, argc, argv, &first, NULL, &asked, err));
    if (ec_request_serve(asked, argv[0])) return EC_OK;
    EC_TRY(take_operands(argc, argv, first, &request, err));
    EC_TRY(compare(&request, &differ, err));
    if (differ) cli->exit_code = 1;
    return EC_OK;
}

/* eclat compare A.exr B.exr */
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "cli/cli.h"
#include "jobs/compare_job.h"
#include "jobs/option_parser.h"
#include "jobs/outputs.h"
#include "jobs/setters.h"

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

static const ec_option options[] = {
    {.name = "diff", .metavar = "FILE", .set = set_diff,
     .help = "write a map of the error relative to B, a .png: black is 0.1 % or less, pale yellow 100 % or more"},
    {.name = "json", .set = set_json, .help = "print one JSON object instead of text"},
    {.name = "quiet", .letter = 'q', .set = set_quiet, .help = "print nothing; only the exit code tells"},
};

int ec_compare_rows(ec_option *rows)
{
    memcpy(rows, options, sizeof options);
    return sizeof options / sizeof options[0];
}

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

static ec_result compare(const compare_request *request, bool *differ, ec_error *err)
{
    ec_compare_job job = {.a = {0}};
    ec_result result;
    EC_TRY_CLEANUP(check_diff(request, err));
    EC_TRY_CLEANUP(ec_compare_load(request->a, request->b, &job, err));
    EC_TRY_CLEANUP(ec_compare_measure(&job.report, request->diff, err));
    if (request->json)
        result = ec_compare_report_json(&job.report, stdout, err);
    else if (!request->quiet)
        ec_compare_report_text(&job.report, stdout);
    *differ = job.report.differ;
cleanup:
    ec_compare_free(&job);
    return result;
}

ec_result ec_cmd_compare(ec_cli *cli, int argc, char **argv, ec_error *err)
{
    compare_request request = {0};
    int first = 0;
    bool differ = false;
    ec_request asked;
    EC_TRY(ec_options_parse(options, sizeof options / sizeof options[0], &request, argc, argv, &first, NULL, &asked, err));
    if (ec_cli_leaves(cli, asked)) return EC_OK;
    EC_TRY(take_operands(argc, argv, first, &request, err));
    EC_TRY(compare(&request, &differ, err));
    if (differ) cli->exit_code = 1;
    return EC_OK;
}

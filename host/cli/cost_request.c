#include "cli/cost_request.h"

#include <string.h>
#include <strings.h>

#include "cli/cli.h"
#include "jobs/defaults.h"
#include "jobs/option_parser.h"
#include "jobs/render_setters.h"
#include "jobs/setters.h"

#define REQUEST ((ec_cost_request *)target)

TEXT_SETTER(json, json)
TEXT_SETTER(reference, reference)
PARSED_SETTER(budget, ec_parse_seconds, budget)
RANGE_SETTER(seed, ec_parse_whole, 0, UINT64_MAX, render.options.seed)

SETTER(output)
{
    const char *dot = strrchr(value, '.');
    if (!dot || (strcasecmp(dot, ".html") && strcasecmp(dot, ".htm")))
        return ec_usage(err, "-o: '%s' must be named NAME.html; the figures go to a file by --json", value);
    (void)option;
    REQUEST->html = value;
    return EC_OK;
}

static const ec_option own[] = {
    {.name = "budget", .metavar = "S", .set = set_budget, .group = EC_GROUP_STUDY,
     .help = "time for the whole study, the reference included; 40s, 2m and 1h are understood too. A kernel that is being compiled when the time is up is "
             "finished. Compiled kernels are kept for the next study",
     .otherwise = "2m"},
    {.name = "json", .metavar = "FILE", .set = set_json, .group = EC_GROUP_RESULTS, .help = "write every figure to FILE; - prints them instead of the table"},
    {.name = "output", .letter = 'o', .metavar = "FILE", .set = set_output, .group = EC_GROUP_RESULTS,
     .help = "write FILE.html, one page with charts, tables and pictures that opens without a network"},
    {.name = "quiet", .letter = 'q', .set = ec_set_quiet, .group = EC_GROUP_MESSAGES, .help = "print only warnings and errors"},
    {.name = "reference", .metavar = "FILE", .set = set_reference, .group = EC_GROUP_STUDY,
     .help = "compare with this .exr; its standard errors, if it has any, count as its uncertainty",
     .otherwise = "a picture rendered first, for a third of the budget"},
    {.name = "seed", .metavar = "N", .set = set_seed, .group = EC_GROUP_STUDY, .help = "another N gives another, independent study", .otherwise = "0"},
    {.name = "size", .metavar = "WxH", .set = ec_set_size, .group = EC_GROUP_PICTURE, .help = "width and height in pixels",
     .otherwise = "the reference's; else " EC_TEXT(EC_COST_HEIGHT) " high, and as wide as the camera's aspect ratio requires"},
};

int ec_cost_rows(ec_option *rows)
{
    int count = ec_render_rows_for(EC_OPTION_COST, rows);
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++) rows[count++] = own[i];
    return count;
}

ec_result ec_cost_request_parse(int argc, char **argv, ec_cost_request *request, ec_request *asked, ec_error *err)
{
    ec_option rows[EC_OPTIONS_MAX];
    int count = ec_cost_rows(rows), first = 0;
    request->budget = EC_DEFAULT_BUDGET;
    request->render.options.cutoff = EC_DEFAULT_CUTOFF;
    request->render.env_strength = 1;
    EC_TRY(ec_options_parse(rows, count, request, argc, argv, &first, NULL, asked, err));
    if (*asked != EC_REQUEST_RUN) return EC_OK;
    return ec_options_scene(argc, argv, first, &request->render.scene, err);
}

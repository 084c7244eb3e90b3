/* eclat render SCENE */
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "cli/cli.h"
#include "cli/teller.h"
#include "jobs/sequence.h"
#include "jobs/render_job.h"
#include "jobs/render_plan.h"

static ec_result plan(ec_render_job *job, ec_error *err)
{
    ec_plan plan;
    EC_TRY(ec_render_plan(job, &plan, err));
    if (job->request->json) return ec_plan_json(&plan, stdout, err);
    ec_plan_text(&plan, job->devices->name, stdout);
    return EC_OK;
}

int ec_render_command_rows(ec_option *rows)
{
    memcpy(rows, ec_render_rows, (size_t)ec_render_row_count * sizeof *rows);
    return ec_render_row_count;
}

ec_result ec_cmd_render(ec_cli *cli, int argc, char **argv, ec_error *err)
{
    double start = ec_now();
    ec_render_request request = {0};
    ec_request asked = EC_REQUEST_RUN;
    char folder[PATH_MAX] = "", **as_given = malloc(((size_t)argc + 1) * sizeof *as_given); /* getopt changes their order */
    if (!as_given) return ec_fail(err, "out of memory");
    memcpy(as_given, argv, ((size_t)argc + 1) * sizeof *as_given);
    if (!getcwd(folder, sizeof folder)) folder[0] = 0;
    ec_teller teller = {.console = &cli->console};
    const ec_listener listener = ec_teller_listener(&teller);
    ec_render_job job = {.request = &request, .listener = &listener, .takes_several = true, .ranks = cli->ranks, .program = cli->argv[0], .command = cli->line,
                         .job = {.argc = argc, .argv = as_given, .folder = folder}};
    ec_result result = EC_OK;
    EC_TRY_CLEANUP(ec_render_request_parse(argc, argv, &request, &asked, err));
    if (ec_cli_leaves(cli, asked)) goto cleanup;
    if (request.resume) EC_TRY_CLEANUP(ec_render_job_take_up(&job, argc, argv, err));
    cli->console.quiet = teller.quiet = request.quiet;
    teller.json = request.json;
    if (request.frames.given) {
        ec_given_options given;
        cli->console.says_once = true; /* frames are much alike */
        EC_TRY_CLEANUP(ec_given_options_read(argc, as_given, &given, err));
        result = ec_frames_render(&listener, &request, job.ranks, &given, start, err);
        goto cleanup;
    }
    if (request.plan_ranks) job.ranks = NULL; /* one process and its device stand for all */
    result = request.plan_ranks ? ec_render_job_load(&job, err) : ec_render_job_prepare(&job, err);
    if (result == EC_FAILED && request.resume && strcmp(folder, job.job.folder))
        ec_fail_more(err, "; the job was begun in '%s'", job.job.folder);
    if (result != EC_OK) goto cleanup;
    result = request.plan_ranks ? plan(&job, err) : ec_render_job_complete(&job, start, err);
cleanup:
    ec_render_job_free(&job);
    free(as_given);
    return result;
}

/* eclat view SCENE: a window that shows the render; what it saves is what `eclat render` would have written. */
#include "base/module.h"
#include "cli/cli.h"
#include "cli/stop.h"
#include "jobs/defaults.h"
#include "jobs/frame_job.h"
#include "jobs/setters.h"
#include "view/view.h"

typedef struct view_command {
    ec_render_request render; /* first: the setters of its options are used, to refuse values at once */
    ec_given_options given;   /* for the job */
    const char *against, *script;
    bool stats;
} view_command;

#define REQUEST ((view_command *)target)
TEXT_SETTER(against, against)
TEXT_SETTER(script, script)
FLAG_SETTER(stats, stats)

static ec_result set_and_keep(void *target, const char *option, const char *value, ec_error *err)
{
    ec_given_options *given = &REQUEST->given;
    const ec_option *row = ec_render_row(option);
    EC_TRY(row->set(target, option, value, err));
    if (row->uses & EC_OPTION_COMMAND_LINE) return EC_OK;
    if (given->count == EC_GIVEN_MAX) return ec_fail(err, "more than %d options", EC_GIVEN_MAX);
    given->list[given->count].option = row->name;
    given->list[given->count++].value = value;
    return EC_OK;
}

static const ec_option own[] = {
    {.name = "against", .metavar = "FILE.exr", .set = set_against, .help = "picture to compare with the rendered one (V and Tab)"},
    {.name = "script", .metavar = "FILE", .set = set_script,
     .help = "move the camera and press keys as a script says, then close; the script orbit turns once around. Lines: turn YAW PITCH SECONDS (degrees), "
             "pan RIGHT UP SECONDS (picture heights), dolly FACTOR SECONDS, wait SECONDS, settle (until the limit is met), key NAME (e, E, 1, Tab, Save, ...; "
             "after X digits switch effects), quit. 0 SECONDS means at once"},
    {.name = "stats", .set = set_stats, .help = "report at the end when there was first light, and how long frames took while the camera moved"},
};

int ec_view_rows(ec_option *rows)
{
    int count = 0;
    for (; count < (int)(sizeof own / sizeof own[0]); count++) rows[count] = own[count];
    for (int i = 0; i < ec_render_row_count && count < EC_OPTIONS_MAX; i++) {
        rows[count] = ec_render_rows[i];
        rows[count].uses |= EC_OPTION_BORROWED;
        rows[count++].set = ec_render_rows[i].not_in_window ? ec_render_refuse_live : set_and_keep;
    }
    ec_option *size = &rows[ec_options_find(rows, count, "size") - rows];
    size->group = EC_GROUP_OPTIONS;
    size->uses &= ~(uint32_t)EC_OPTION_BORROWED;
    size->help = "size of the window when it opens, in pixels";
    size->otherwise = EC_TEXT(EC_LIVE_HEIGHT) " high";
    return count;
}

ec_result ec_view_load(const struct ec_view_module **module, ec_error *err)
{
    const void *symbol = NULL;
    EC_TRY(ec_module_load("view", "this eclat was built without its preview window: install libglfw3-dev, libepoxy-dev, libstb-dev and "
                                  "fonts-dejavu-core, then build again with -DECLAT_PREVIEW=ON; 'eclat render' needs none of them", &symbol, err));
    *module = symbol;
    return EC_OK;
}

static void write_message(void *console, eclat_severity severity, const char *text)
{
    const ec_log log = ec_console_log(console);
    log.write(log.user, (ec_severity)severity, text);
}

static eclat_result make_job(const view_command *command, ec_console *console, eclat_job **job, eclat_error *err)
{
    eclat_result result = eclat_job_new(command->render.scene, job, err);
    for (int i = 0; i < command->given.count && result == ECLAT_OK; i++)
        result = eclat_job_set(*job, command->given.list[i].option, command->given.list[i].value, err);
    if (*job) eclat_job_listen(*job, &(eclat_listener){.user = console, .message = write_message});
    return result;
}

ec_result ec_cmd_view(ec_cli *cli, int argc, char **argv, ec_error *err)
{
    view_command command = {.against = NULL};
    ec_option rows[EC_OPTIONS_MAX];
    ec_request asked;
    int first = 0;
    ec_render_request_start(&command.render);
    EC_TRY(ec_options_parse(rows, ec_view_rows(rows), &command, argc, argv, &first, NULL, &asked, err));
    if (ec_cli_leaves(cli, asked)) return EC_OK;
    EC_TRY(ec_options_scene(argc, argv, first, &command.render.scene, err));
    cli->console.quiet = command.render.quiet;
    const ec_view_module *window;
    EC_TRY(ec_view_load(&window, err));
    eclat_job *job = NULL;
    eclat_error why;
    eclat_result result = make_job(&command, &cli->console, &job, &why);
    const ec_view_request request = {.job = job, .against = command.against, .script = command.script, .stats = command.stats};
    ec_stop_catch_signals(false);
    ec_stop_call(window->stop);
    if (result == ECLAT_OK) result = window->run(&request, &why);
    eclat_job_free(job);
    if (result != ECLAT_OK) ec_fail(err, "%s", why.text);
    return (ec_result)result;
}

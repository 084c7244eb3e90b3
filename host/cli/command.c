/* Finds the command that is meant, and ends the program. */
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/help.h"
#include "cli/progress.h"
#include "cli/stop.h"
#include "cli/suggest.h"

typedef struct cli {
    ec_console console;
    int argc;
    char **argv;
    int exit_code;       /* of a command that succeeded: 1 if the answer is no, as from compare and selftest */
    eclat_ranks *ranks;  /* the other processes of an MPI job; NULL: none */
    ec_asked asked;
} cli;

static eclat_result unknown_command(const char *name, eclat_error *err)
{
    const char *names[EC_PAGES_MOST + 1];
    const char *nearest = ec_suggest(name, names, ec_page_names(names));
    const char *dot = strrchr(name, '.');
    if (name[0] == '-')
        return ec_wrong(err, "unknown option '%s' before a command; see 'eclat --help'", name);
    if (nearest)
        return ec_wrong(err, "unknown command '%s'; did you mean 'eclat %s'?", name, nearest);
    if (dot && (!strcmp(dot, ".gltf") || !strcmp(dot, ".glb")))
        return ec_wrong(err, "'%s' is a scene, not a command: 'eclat render %s' renders it", name, name);
    return ec_wrong(err, "unknown command '%s'; see 'eclat --help'", name);
}

static eclat_result set_man(void *user, const char *option, const char *value, eclat_error *err)
{
    (void)option, (void)value, (void)err;
    *(bool *)user = true;
    return ECLAT_OK;
}

static eclat_result print_help(int argc, char **argv, bool man, eclat_error *err)
{
    const char *topic = argc > 0 && strcmp(argv[0], "help") ? argv[0] : "";
    const eclat_command *page = *topic ? ec_page_find(topic) : &ec_page_main;
    if (argc > 1) return ec_wrong(err, "help takes one command, as in 'eclat help render'");
    if (!page) return unknown_command(topic, err);
    if (man) ec_help_manual(stdout);
    else ec_help_plain(page, stdout);
    return ECLAT_OK;
}

static eclat_result print_completion(int argc, char **argv, eclat_error *err)
{
    if (argc != 1) return ec_wrong(err, "completion takes the name of a shell, bash, fish or zsh; see 'eclat completion --help'");
    for (const char *const *shell = ec_shell_names; *shell; shell++) {
        if (strcmp(*shell, argv[0])) continue;
        ec_help_completion(*shell, stdout);
        return ECLAT_OK;
    }
    return ec_wrong(err, "there is no completion for '%s'; give bash, fish or zsh", argv[0]);
}

typedef struct setting {
    cli *cli;
    eclat_job *job;
} setting;

static eclat_result set(void *user, const char *option, const char *value, eclat_error *err)
{
    const setting *s = user;
    s->cli->console.quiet |= !strcmp(option, "quiet");
    return eclat_job_set(s->job, option, value, err);
}

static eclat_result run_job(cli *cli, eclat_job *job, int first, eclat_error *err)
{
    ec_progress_view view = {.console = &cli->console, .has_bar = !strcmp(cli->argv[1], "render")};
    const eclat_listener listener = ec_progress_listener(&view);
    eclat_result result = ECLAT_OK;
    for (int i = first; result == ECLAT_OK && i < cli->argc - 1; i++) result = eclat_job_add(job, cli->argv[1 + i], err);
    if (result != ECLAT_OK) return result;
    eclat_job_listen(job, &listener);
    eclat_job_share(job, cli->ranks);
    ec_stop_job(job);
    result = eclat_job_run(job, NULL, err);
    ec_stop_job(NULL);
    ec_stop_hint(NULL);
    cli->exit_code = eclat_job_says_no(job);
    return result;
}

/* Takes a command of the library. */
static eclat_result take_job(cli *cli, const eclat_command *page, const eclat_option *rows, int count, eclat_error *err)
{
    setting s = {.cli = cli};
    int first = 0;
    eclat_result result = eclat_job_new(page->name, &s.job, err);
    if (result == ECLAT_OK) result = eclat_job_typed(s.job, cli->argc, cli->argv, err);
    if (result == ECLAT_OK) result = ec_arguments_read(rows, count, cli->argc - 1, cli->argv + 1, set, &s, &first, &cli->asked, err);
    if (result == ECLAT_OK && cli->asked == EC_ASKED_RUN) result = run_job(cli, s.job, first, err);
    eclat_job_free(s.job);
    return result;
}

/* Takes a command of the program itself. */
static eclat_result take_own(cli *cli, const eclat_command *page, const eclat_option *rows, int count, eclat_error *err)
{
    int argc = cli->argc - 1, first = 0;
    char **argv = cli->argv + 1;
    bool man = false;
    const eclat_result result = ec_arguments_read(rows, count, argc, argv, set_man, &man, &first, &cli->asked, err);
    if (result != ECLAT_OK || cli->asked != EC_ASKED_RUN) return result;
    if (page == &ec_page_completion) return print_completion(argc - first, argv + first, err);
    return print_help(argc - first, argv + first, man, err);
}

/* Scripts read the first line. */
static void print_version(void)
{
    eclat_note note;
    puts("eclat " EC_VERSION);
    for (size_t i = 0; (note = eclat_build_at(i)).term; i++) printf("%-9s %s\n", note.term, note.text);
}

static eclat_result run(cli *cli, eclat_error *err)
{
    eclat_option rows[EC_OPTIONS_MOST];
    const char *name = cli->argv[1];
    if (!strcmp(name, "--help") || !strcmp(name, "-h")) name = "help";
    if (!strcmp(name, "--version")) {
        print_version();
        return ECLAT_OK;
    }
    const eclat_command *page = ec_page_find(name);
    if (!page) return unknown_command(name, err);
    const int count = ec_page_options(page, rows);
    const bool is_own = page == &ec_page_help || page == &ec_page_completion;
    const eclat_result result = (is_own ? take_own : take_job)(cli, page, rows, count, err);
    if (result == ECLAT_OK && cli->asked == EC_ASKED_HELP) ec_help_plain(page, stdout);
    if (result == ECLAT_OK && cli->asked == EC_ASKED_VERSION) print_version();
    return result;
}

/* Fails if the results could not be written, however well the render went. */
static eclat_result flush_results(eclat_error *err)
{
    errno = 0;
    int lost = ferror(stdout);
    if (fflush(stdout) == 0 && !lost) return ECLAT_OK;
    snprintf(err->text, sizeof err->text, "cannot write the result to standard output: %s", errno ? strerror(errno) : "an earlier write failed");
    return ECLAT_FAILED;
}

/* Runs the command, as the only process or the first of several. */
static int lead(eclat_ranks *ranks, int argc, char **argv)
{
    cli cli = {.console = ec_console_of_process(), .argc = argc, .argv = argv, .ranks = ranks};
    if (argc < 2) {
        ec_help_short(stderr);
        return ECLAT_USAGE;
    }
    eclat_error err = {{0}, ECLAT_ERROR_OTHER};
    eclat_result result = run(&cli, &err);
    if (result == ECLAT_OK) result = flush_results(&err);
    if (result != ECLAT_OK) ec_console_say(&cli.console, ECLAT_FAILURE, err.text);
    return result != ECLAT_OK ? (int)result : cli.exit_code;
}

/* Serves as another rank of an MPI job, which reads no command line. It ends when rank 0 says so: signals reach all ranks, and only rank 0 has
 * something to write. */
static int follow(eclat_ranks *ranks)
{
    eclat_error err;
    ec_console console = {0};
    ec_progress_view view = {.console = &console};
    const eclat_listener listener = ec_progress_listener(&view);
    ec_stop_catch_signals(false);
    if (eclat_ranks_serve(ranks, &listener, &err) == ECLAT_OK) return 0;
    ec_console_say(&console, ECLAT_FAILURE, err.text);
    return ECLAT_FAILED;
}

int ec_cli_main(int argc, char **argv)
{
    eclat_ranks *ranks = NULL;
    eclat_error err;
    ec_console console = ec_console_of_process();
    if (eclat_ranks_join(&ranks, &err) != ECLAT_OK) {
        if (eclat_ranks_number(NULL) == 0) ec_console_say(&console, ECLAT_FAILURE, err.text);
        eclat_ranks_leave(ranks);
        return ECLAT_FAILED;
    }
    if (ranks && eclat_ranks_number(ranks) > 0) return follow(ranks);
    int code = lead(ranks, argc, argv);
    eclat_ranks_leave(ranks);
    return code;
}

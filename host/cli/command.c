/* Which command is meant, and how the program ends. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "jobs/command_line.h"
#include "cli/help.h"
#include "cli/stop.h"
#include "jobs/suggest.h"
#include "jobs/usage.h"

static ec_result cmd_completion(ec_cli *cli, int argc, char **argv, ec_error *err);
static ec_result cmd_help(ec_cli *cli, int argc, char **argv, ec_error *err);

typedef struct command {
    const char *name;
    ec_result (*run)(ec_cli *cli, int argc, char **argv, ec_error *err);
    bool by_all; /* the ranks of an MPI job, not the first of them alone */
} command;

static const command commands[] = {
    {"render", ec_cmd_render, true},
    {"cost", ec_cmd_cost, false},
    {"info", ec_cmd_info, false},
    {"compare", ec_cmd_compare, false},
    {"merge", ec_cmd_merge, false},
    {"devices", ec_cmd_devices, false},
    {"selftest", ec_cmd_selftest, false},
    {"view", ec_cmd_view, false},
    {"completion", cmd_completion, false},
    {"help", cmd_help, false},
};
enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static const command *find_command(const char *name)
{
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (!strcmp(commands[i].name, name)) return &commands[i];
    return NULL;
}

static ec_result unknown_command(const char *name, ec_error *err)
{
    const char *names[COMMAND_COUNT];
    for (int i = 0; i < COMMAND_COUNT; i++) names[i] = commands[i].name;
    const char *nearest = ec_suggest(name, names, COMMAND_COUNT);
    const char *dot = strrchr(name, '.');
    if (name[0] == '-')
        return ec_usage(err, "unknown option '%s' before a command; see 'eclat --help'", name);
    if (nearest)
        return ec_usage(err, "unknown command '%s'; did you mean 'eclat %s'?", name, nearest);
    if (dot && (!strcmp(dot, ".gltf") || !strcmp(dot, ".glb")))
        return ec_usage(err, "'%s' is a scene, not a command: 'eclat render %s' renders it", name, name);
    return ec_usage(err, "unknown command '%s'; see 'eclat --help'", name);
}

static ec_result cmd_help(ec_cli *cli, int argc, char **argv, ec_error *err)
{
    ec_option rows[1];
    bool man = false;
    int first = 0;
    ec_request asked;
    EC_TRY(ec_options_parse(rows, ec_help_command_rows(rows), &man, argc, argv, &first, NULL, &asked, err));
    if (ec_cli_leaves(cli, asked)) return EC_OK;
    const char *topic = first < argc && strcmp(argv[first], "help") ? argv[first] : "";
    if (argc - first > 1) return ec_usage(err, "help takes one command, as in 'eclat help render'");
    if (*topic && !find_command(topic)) return unknown_command(topic, err);
    if (man) ec_help_manual(stdout);
    else ec_print_help(topic);
    return EC_OK;
}

static ec_result cmd_completion(ec_cli *cli, int argc, char **argv, ec_error *err)
{
    int first = 0;
    uint32_t shell;
    ec_request asked;
    EC_TRY(ec_options_parse(NULL, 0, NULL, argc, argv, &first, NULL, &asked, err));
    if (ec_cli_leaves(cli, asked)) return EC_OK;
    if (argc - first != 1) return ec_usage(err, "completion takes the name of a shell, bash or zsh; see 'eclat completion --help'");
    for (shell = 0; ec_shell_names[shell] && strcmp(ec_shell_names[shell], argv[first]); shell++) continue;
    if (!ec_shell_names[shell]) return ec_usage(err, "there is no completion for '%s'; give bash or zsh", argv[first]);
    ec_help_completion(ec_shell_names[shell], stdout);
    return EC_OK;
}

static ec_result run(ec_cli *cli, ec_error *err)
{
    const char *name = cli->argv[1];
    if (!strcmp(name, "--help") || !strcmp(name, "-h")) name = "help";
    if (!strcmp(name, "--version")) {
        ec_print_version();
        return EC_OK;
    }
    const command *found = find_command(name);
    if (!found) return unknown_command(name, err);
    if (cli->ranks && !found->by_all) ec_console_say(&cli->console, "note: only render is shared out; rank 0 does this alone");
    EC_TRY(found->run(cli, cli->argc - 1, cli->argv + 1, err));
    if (cli->asked == EC_REQUEST_HELP) ec_print_help(found->name);
    if (cli->asked == EC_REQUEST_VERSION) ec_print_version();
    return EC_OK;
}

/* A result that did not arrive is a failure, however well the render went. */
static ec_result flush_results(ec_error *err)
{
    errno = 0;
    int lost = ferror(stdout);
    if (fflush(stdout) != 0 || lost)
        return ec_fail(err, "cannot write the result to standard output: %s",
                       errno ? strerror(errno) : "an earlier write failed");
    return EC_OK;
}

/* What a process does that is alone, or the first of several. */
static int lead(ec_ranks *ranks, int argc, char **argv)
{
    ec_cli cli = {.console = {.terminal = isatty(STDERR_FILENO) == 1}, .argc = argc, .argv = argv, .ranks = ranks};
    if (argc < 2) {
        ec_help_short(stderr);
        return EC_USAGE;
    }
    ec_error err = {0};
    cli.line = ec_command_line(argc, argv);
    ec_result result = cli.line ? run(&cli, &err) : ec_fail(&err, "out of memory");
    if (result == EC_OK) result = flush_results(&err);
    if (result != EC_OK) ec_console_error(&cli.console, err.text);
    free(cli.line);
    return result != EC_OK ? (int)result : cli.exit_code;
}

/* The other ranks of an MPI job read no command line. They end when rank 0 says so: signals go to all, and what is to be written is its. One that
 * fails ends without leaving, so that the launcher ends the others, which may be waiting for it. */
static int follow(ec_ranks *ranks)
{
    ec_error err = {0};
    ec_console console = {0};
    const ec_log log = ec_console_log(&console);
    ec_stop_catch_signals(false);
    if (ec_ranks_serve(ranks, &log, &err) == EC_OK) {
        ec_ranks_leave(ranks);
        return 0;
    }
    ec_fail_more(&err, "; this was rank %d; eclat render --resume FILE goes on from what --checkpoint FILE has kept", ec_ranks_number(ranks));
    ec_console_error(&console, err.text);
    return EC_FAILED;
}

int ec_cli_main(int argc, char **argv)
{
    if (ec_ranks_launched() < 2) return lead(NULL, argc, argv);
    ec_ranks *ranks = NULL;
    ec_error err = {0};
    ec_console console = {0};
    if (ec_ranks_join(&ranks, &err) != EC_OK) {
        if (ec_ranks_launched_first()) ec_console_error(&console, err.text);
        ec_ranks_leave(ranks);
        return EC_FAILED;
    }
    if (ec_ranks_number(ranks) > 0) return follow(ranks);
    int code = lead(ranks, argc, argv);
    ec_ranks_leave(ranks);
    return code;
}

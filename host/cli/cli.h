/* The commands of `eclat`, and what they share. */
#ifndef EC_CLI_CLI_H
#define EC_CLI_CLI_H

#include "base/error.h"
#include "cli/console.h"
#include "jobs/option_parser.h"
#include "ranks/ranks.h"

struct ec_view_module; /* view/view.h */

/* What a command gets: the console, and the whole command line as it was typed. */
typedef struct ec_cli {
    ec_console console;
    int argc;
    char **argv;
    int exit_code; /* of a command that succeeded: 1 where the answer is no, as of compare and selftest */
    char *line;  /* the same as one text, before getopt reorders it; owned */
    ec_ranks *ranks; /* the other processes of an MPI job; NULL: there are none */
    ec_request asked; /* --help or --version, in place of what the command does */
} ec_cli;

/* Runs the command that argv names; returns the exit code: 0, 1 (failed, or the answer is no) or 2 (usage). */
int ec_cli_main(int argc, char **argv);

/* One command each; argv[0] is its name. The error is the caller's to print. */
ec_result ec_cmd_compare(ec_cli *cli, int argc, char **argv, ec_error *err);
ec_result ec_cmd_cost(ec_cli *cli, int argc, char **argv, ec_error *err);
ec_result ec_cmd_devices(ec_cli *cli, int argc, char **argv, ec_error *err);
ec_result ec_cmd_info(ec_cli *cli, int argc, char **argv, ec_error *err);
ec_result ec_cmd_merge(ec_cli *cli, int argc, char **argv, ec_error *err);
ec_result ec_cmd_render(ec_cli *cli, int argc, char **argv, ec_error *err);
ec_result ec_cmd_selftest(ec_cli *cli, int argc, char **argv, ec_error *err);
ec_result ec_cmd_view(ec_cli *cli, int argc, char **argv, ec_error *err);

/* Their options, those borrowed from `render` included; return the number. */
int ec_compare_rows(ec_option *rows);
int ec_devices_rows(ec_option *rows);
int ec_help_command_rows(ec_option *rows);
int ec_info_rows(ec_option *rows);
int ec_merge_rows(ec_option *rows);
int ec_render_command_rows(ec_option *rows);
int ec_selftest_rows(ec_option *rows);
int ec_view_rows(ec_option *rows);

/* The window, a module; fails where the program was built without it. */
ec_result ec_view_load(const struct ec_view_module **module, ec_error *err);

/* Prints `eclat VERSION` or a command's help ("" for the program's own) to stdout. */
void ec_print_version(void);
void ec_print_help(const char *command);

/* Is that --help or --version? Then the command is done, and the answer is its caller's. */
static inline bool ec_cli_leaves(ec_cli *cli, ec_request asked)
{
    cli->asked = asked;
    return asked != EC_REQUEST_RUN;
}

#endif

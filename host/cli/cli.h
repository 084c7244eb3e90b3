/* The program: argv in, exit code out. */
#ifndef EC_CLI_CLI_H
#define EC_CLI_CLI_H

/* Runs the command that argv names; returns the exit code: 0, 1 (failed, or the answer is no) or 2 (usage). */
int ec_cli_main(int argc, char **argv);

#endif

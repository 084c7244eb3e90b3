/* Reads a command's arguments by its table of options. */
#ifndef EC_CLI_ARGUMENTS_H
#define EC_CLI_ARGUMENTS_H

#include <eclat/eclat.h>

enum { EC_OPTIONS_MOST = 100 };

/* --help or --version in place of what the command does. */
typedef enum ec_asked { EC_ASKED_RUN, EC_ASKED_HELP, EC_ASKED_VERSION } ec_asked;

/* Takes an option's value, NULL for one without. */
typedef eclat_result ec_take(void *user, const char *option, const char *value, eclat_error *err);

/* Every table gets --help (-h) and --version too. The operands are left in argv, and *first is the index of the first of them. */
eclat_result ec_arguments_read(const eclat_option *options, int count, int argc, char **argv, ec_take *take, void *user, int *first, ec_asked *asked,
                               eclat_error *err);

/* Formats what is wrong with the command line, and returns ECLAT_USAGE. */
eclat_result ec_wrong(eclat_error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif

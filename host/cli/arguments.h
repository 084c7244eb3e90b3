/* Reads a command's arguments by its table of options. */
#ifndef EC_CLI_ARGUMENTS_H
#define EC_CLI_ARGUMENTS_H

#include <eclat/eclat.h>

enum { EC_OPTIONS_MOST = 100 };

/* The action that a command line asks for: to run the command, or --help or --version instead. */
typedef enum ec_asked { EC_ASKED_RUN, EC_ASKED_HELP, EC_ASKED_VERSION } ec_asked;

/* Takes an option and its value, NULL if it has none. */
typedef eclat_result ec_take(void *user, const char *option, const char *value, eclat_error *err);

/* Reads options and passes them to `take`. Every table has --help (-h) and --version too. The operands are left in argv, from index *first on. */
eclat_result ec_arguments_read(const eclat_option *options, int count, int argc, char **argv, ec_take *take, void *user, int *first, ec_asked *asked,
                               eclat_error *err);

/* Formats what is wrong with the command line. Returns ECLAT_USAGE. */
eclat_result ec_wrong(eclat_error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif

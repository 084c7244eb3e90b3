/* Reads a command's arguments by a table: one row an option. */
#ifndef EC_JOBS_OPTIONS_H
#define EC_JOBS_OPTIONS_H

#include <stdbool.h>

#include "base/error.h"

/* Stores one option's value; `option` is its name, value NULL for a flag. */
typedef ec_result (*ec_option_set)(void *target, const char *option, const char *value, ec_error *err);

enum { EC_VALUE_OPTIONAL = 2 }; /* as getopt_long has it */

typedef struct ec_option {
    const char *name;  /* without dashes */
    char letter;       /* short form; 0 = none */
    int takes_value; /* false, true, or EC_VALUE_OPTIONAL: then after "=" alone, and NULL without */
    ec_option_set set;
} ec_option;

enum { EC_OPTIONS_MAX = 64 };

typedef enum ec_request { EC_REQUEST_RUN, EC_REQUEST_HELP, EC_REQUEST_VERSION } ec_request;

/* Every table gets --help (-h) and --version too. Sets values in target; what is left in argv are operands, and *first
 * is the index of the first of them. given, if not NULL, has a place for each option: was it there? */
ec_result ec_options_parse(const ec_option *options, int count, void *target, int argc, char **argv, int *first,
                           bool *given, ec_request *request, ec_error *err);

/* The one operand SCENE. */
ec_result ec_options_scene(int argc, char **argv, int first, const char **scene, ec_error *err);

#endif

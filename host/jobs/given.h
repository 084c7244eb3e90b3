/* A job's options as they were given, and the command that gives them again. */
#ifndef EC_JOBS_GIVEN_H
#define EC_JOBS_GIVEN_H

#include "jobs/option.h"

/* In the order in which they were given. Zero-initialised: none. */
typedef struct ec_given_options {
    struct {
        char *option, *value; /* owned; value NULL: it has none */
    } *list;
    int count;
} ec_given_options;

ec_result ec_given_add(ec_given_options *given, const char *option, const char *value, ec_error *err);

/* Adds those whose rows have none of these EC_OPTION_* to another list. */
ec_result ec_given_add_all(ec_given_options *given, const ec_given_options *from, const ec_option *rows, int row_count, uint32_t but, ec_error *err);
bool ec_given_has(const ec_given_options *given, const char *option);
void ec_given_drop_last(ec_given_options *given);
void ec_given_free(ec_given_options *given);

/* Sets them in target, whose texts point into the list then; is_given, if not NULL, has a place for each row: was it there? */
ec_result ec_given_apply(const ec_given_options *given, const ec_option *rows, int row_count, void *target, bool *is_given, ec_error *err);

/* A command as words. Zero-initialised: none. */
typedef struct ec_words {
    char **list;   /* owned; NULL behind the last */
    int count;
    bool is_short; /* memory ran out: some are missing */
} ec_words;

__attribute__((format(printf, 2, 3))) void ec_words_add(ec_words *words, const char *format, ...);
void ec_words_add_file(ec_words *words, const char *path); /* so that it is taken for no option */

/* "eclat", the command's name, inputs, options. To be freed on failure too. */
ec_result ec_words_make(ec_words *words, const char *command, char *const *inputs, int input_count, const ec_given_options *given,
                        const ec_option *rows, int row_count, ec_error *err);
void ec_words_free(ec_words *words);

/* A command line as one text that a shell would read back as it was; malloc'ed, NULL when out of memory. */
char *ec_command_line(int argc, char **argv);

/* Reads options back from a command's name and what follows it, and its last operand, which is one of the words. */
ec_result ec_given_read(ec_given_options *given, const char **operand, int argc, char *const *argv, const ec_option *rows, int row_count,
                        ec_error *err);

#endif

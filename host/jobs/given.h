/* A job's options as given, and the command that gives them again. */
#ifndef EC_JOBS_GIVEN_H
#define EC_JOBS_GIVEN_H

#include "jobs/option.h"

/* In the order given. Zero-initialised: none. */
typedef struct ec_given_options {
    struct {
        char *option, *value; /* owned; value NULL: none */
    } *list;
    int count;
} ec_given_options;

ec_result ec_given_add(ec_given_options *given, const char *option, const char *value, ec_error *err);

/* Appends those of `from` whose rows have none of the EC_OPTION_* bits `but`. */
ec_result ec_given_add_all(ec_given_options *given, const ec_given_options *from, const ec_option *rows, int row_count, uint32_t but, ec_error *err);
bool ec_given_has(const ec_given_options *given, const char *option);
void ec_given_drop_last(ec_given_options *given);
void ec_given_free(ec_given_options *given);

/* Stores the options in target, whose texts then point into the list. is_given, if not NULL, is set for each row that was given. */
ec_result ec_given_apply(const ec_given_options *given, const ec_option *rows, int row_count, void *target, bool *is_given, ec_error *err);

/* A command as words. Zero-initialised: none. */
typedef struct ec_words {
    char **list;   /* owned; ended by NULL */
    int count;
    bool is_short; /* memory ran out, and words are missing */
} ec_words;

__attribute__((format(printf, 2, 3))) void ec_words_add(ec_words *words, const char *format, ...);
void ec_words_add_file(ec_words *words, const char *path); /* escapes a path that looks like an option */

/* Makes "eclat", the command's name, inputs and options. Must be freed on failure too. */
ec_result ec_words_make(ec_words *words, const char *command, char *const *inputs, int input_count, const ec_given_options *given,
                        const ec_option *rows, int row_count, ec_error *err);
void ec_words_free(ec_words *words);

/* Returns a command line as one text that a shell reads back unchanged; malloc'ed, NULL when out of memory. */
char *ec_command_line(int argc, char **argv);

/* Reads options from a command's words; *operand is the last operand, which points to one of the words. */
ec_result ec_given_read(ec_given_options *given, const char **operand, int argc, char *const *argv, const ec_option *rows, int row_count,
                        ec_error *err);

#endif

#define _GNU_SOURCE /* for vasprintf */
#include "jobs/given.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "jobs/option.h"

ec_result ec_given_add(ec_given_options *given, const char *option, const char *value, ec_error *err)
{
    void *list = realloc(given->list, ((size_t)given->count + 1) * sizeof *given->list);
    if (!list) return ec_fail(err, "out of memory for option %s", option);
    given->list = list;
    char *name = strdup(option), *text = value ? strdup(value) : NULL;
    given->list[given->count].option = name;
    given->list[given->count++].value = text;
    if (name && (text || !value)) return EC_OK;
    ec_given_drop_last(given);
    return ec_fail(err, "out of memory for option %s", option);
}

ec_result ec_given_add_all(ec_given_options *given, const ec_given_options *from, const ec_option *rows, int row_count, uint32_t but, ec_error *err)
{
    for (int i = 0; i < from->count; i++)
        if (!(ec_options_find(rows, row_count, from->list[i].option)->uses & but))
            EC_TRY(ec_given_add(given, from->list[i].option, from->list[i].value, err));
    return EC_OK;
}

bool ec_given_has(const ec_given_options *given, const char *option)
{
    for (int i = 0; i < given->count; i++)
        if (!strcmp(given->list[i].option, option)) return true;
    return false;
}

void ec_given_drop_last(ec_given_options *given)
{
    given->count--;
    free(given->list[given->count].option);
    free(given->list[given->count].value);
}

void ec_given_free(ec_given_options *given)
{
    while (given->count) ec_given_drop_last(given);
    free(given->list);
    given->list = NULL;
}

ec_result ec_given_apply(const ec_given_options *given, const ec_option *rows, int row_count, void *target, bool *is_given, ec_error *err)
{
    for (int i = 0; i < given->count; i++) {
        const ec_option *row = ec_options_find(rows, row_count, given->list[i].option);
        EC_TRY(ec_option_store(row, target, given->list[i].value, err));
        if (is_given) is_given[row - rows] = true;
    }
    return EC_OK;
}

void ec_words_add(ec_words *words, const char *format, ...)
{
    char **longer = words->is_short ? NULL : realloc(words->list, ((size_t)words->count + 2) * sizeof *longer);
    va_list args;
    words->is_short = !longer;
    if (!longer) return;
    words->list = longer;
    va_start(args, format);
    words->is_short = vasprintf(&longer[words->count], format, args) < 0;
    va_end(args);
    words->count += !words->is_short;
    longer[words->count] = NULL;
}

void ec_words_add_file(ec_words *words, const char *path) { ec_words_add(words, *path == '-' ? "./%s" : "%s", path); }

static void add_option(ec_words *words, const ec_option *row, const char *value)
{
    const bool is_apart = value && !row->value_optional;
    if (row->letter) ec_words_add(words, "-%c", row->letter);
    else ec_words_add(words, value && !is_apart ? "--%s=%s" : "--%s", row->name, value);
    if (is_apart) ec_words_add(words, "%s", value);
}

ec_result ec_words_make(ec_words *words, const char *command, char *const *inputs, int input_count, const ec_given_options *given,
                        const ec_option *rows, int row_count, ec_error *err)
{
    ec_words_add(words, "eclat");
    ec_words_add(words, "%s", command);
    for (int i = 0; i < input_count; i++) ec_words_add_file(words, inputs[i]);
    for (int i = 0; i < given->count; i++) add_option(words, ec_options_find(rows, row_count, given->list[i].option), given->list[i].value);
    return words->is_short ? ec_fail(err, "out of memory for a command line") : EC_OK;
}

void ec_words_free(ec_words *words)
{
    while (words->count) free(words->list[--words->count]);
    free(words->list);
    words->list = NULL;
}

/* Finds the row of "--name", "--name=value" or "-n". */
static const ec_option *find_word(const char *word, const ec_option *rows, int row_count)
{
    const size_t size = strcspn(word, "=");
    for (int i = 0; i < row_count; i++) {
        const bool is_long = !strncmp(word, "--", 2) && size == strlen(rows[i].name) + 2 && !strncmp(word + 2, rows[i].name, size - 2);
        if (is_long || (rows[i].letter && word[1] == rows[i].letter && !word[2])) return &rows[i];
    }
    return NULL;
}

ec_result ec_given_read(ec_given_options *given, const char **operand, int argc, char *const *argv, const ec_option *rows, int row_count,
                        ec_error *err)
{
    for (int i = 1; i < argc; i++) {
        const char *word = argv[i], *equals = strchr(word, '=');
        if (word[0] != '-') {
            *operand = word;
            continue;
        }
        const ec_option *row = find_word(word, rows, row_count);
        const bool is_apart = row && ec_option_takes_value(row) == true && !equals;
        if (!row || (is_apart && i + 1 == argc) || (equals && !row->metavar)) return ec_usage(err, "'%s' is not an option, or lacks its value", word);
        EC_TRY(ec_given_add(given, row->name, is_apart ? argv[++i] : equals ? equals + 1 : NULL, err));
    }
    return EC_OK;
}

static int is_plain(const char *word)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=./,:@%";
    return *word && word[strspn(word, plain)] == '\0';
}

/* Quotes as 'it'\''s': in single quotes everything but the quote itself is literal. */
static char *put_quoted(char *to, const char *word)
{
    *to++ = '\'';
    for (; *word; word++) {
        if (*word == '\'') {
            memcpy(to, "'\\'", 3);
            to += 3;
        }
        *to++ = *word;
    }
    *to++ = '\'';
    return to;
}

char *ec_command_line(int argc, char **argv)
{
    size_t room = 1;
    for (int i = 0; i < argc; i++) room += 4 * strlen(argv[i]) + 3;
    char *line = malloc(room);
    if (!line) return NULL;
    char *to = line;
    for (int i = 0; i < argc; i++) {
        if (i) *to++ = ' ';
        if (is_plain(argv[i])) {
            size_t size = strlen(argv[i]);
            memcpy(to, argv[i], size);
            to += size;
        } else {
            to = put_quoted(to, argv[i]);
        }
    }
    *to = '\0';
    return line;
}

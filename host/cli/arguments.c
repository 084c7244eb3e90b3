#include "cli/arguments.h"

#include <getopt.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/suggest.h"

enum { LONG_BASE = 256, HELP = LONG_BASE + EC_OPTIONS_MOST, VERSION };

typedef struct parser {
    struct option longs[EC_OPTIONS_MOST + 3];
    char shorts[2 * EC_OPTIONS_MOST + 4];
} parser;

eclat_result ec_wrong(eclat_error *err, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(err->text, sizeof err->text, format, args);
    va_end(args);
    return ECLAT_USAGE;
}

static parser make_parser(const eclat_option *options, int count)
{
    parser p = {.shorts = ":h"};
    size_t used = strlen(p.shorts);
    for (int i = 0; i < count; i++) {
        p.longs[i] = (struct option){options[i].name, options[i].takes_value, NULL, LONG_BASE + i};
        if (!options[i].letter) continue;
        p.shorts[used++] = options[i].letter;
        if (options[i].metavar) p.shorts[used++] = ':';
    }
    p.longs[count] = (struct option){"help", no_argument, NULL, HELP};
    p.longs[count + 1] = (struct option){"version", no_argument, NULL, VERSION};
    return p;
}

static const eclat_option *find_option(const eclat_option *options, int count, int code)
{
    for (int i = 0; i < count; i++)
        if (code == LONG_BASE + i || (options[i].letter && code == options[i].letter)) return &options[i];
    return NULL;
}

static int by_name(const void *a, const void *b) { return strcmp(*(const char *const *)a, *(const char *const *)b); }

/* Reports an argument that getopt_long did not know, and suggests the option that was meant. */
static eclat_result unknown_option(const parser *p, const char *argument, const char *command, eclat_error *err)
{
    const char *names[EC_OPTIONS_MOST + 2];
    char typed[64], matches[256] = "";
    int count = 0, match_count = 0;
    const char *name = argument + strspn(argument, "-");
    snprintf(typed, sizeof typed, "%.*s", (int)strcspn(name, "="), name);
    for (; p->longs[count].name; count++) names[count] = p->longs[count].name;
    qsort(names, (size_t)count, sizeof *names, by_name);
    for (int i = 0; i < count; i++) {
        if (*typed == 0 || strncmp(names[i], typed, strlen(typed))) continue;
        size_t used = strlen(matches);
        snprintf(matches + used, sizeof matches - used, "%s--%s", match_count++ ? ", " : "", names[i]);
    }
    if (match_count > 1) return ec_wrong(err, "option '--%s' is ambiguous: %s", typed, matches);
    const char *nearest = ec_suggest(typed, names, count);
    if (nearest) return ec_wrong(err, "unknown option '--%s'; did you mean '--%s'?", typed, nearest);
    return ec_wrong(err, "unknown option '%s'; see 'eclat %s --help'", argument, command);
}

/* Reports what getopt_long found: '?', or ':' for a missing value; optopt tells the option, if it is known. */
static eclat_result complain(const parser *p, const eclat_option *options, int count, int code, char **argv, eclat_error *err)
{
    const eclat_option *option = find_option(options, count, optopt);
    if (code == ':' && option)
        return ec_wrong(err, "option '--%s' needs a value; see 'eclat %s --help'", option->name, argv[0]);
    if (optopt >= LONG_BASE)
        return ec_wrong(err, "option '%.*s' takes no value", (int)strcspn(argv[optind - 1], "="), argv[optind - 1]);
    if (optopt) return ec_wrong(err, "unknown option '-%c'; see 'eclat %s --help'", optopt, argv[0]);
    return unknown_option(p, argv[optind - 1], argv[0], err);
}

eclat_result ec_arguments_read(const eclat_option *options, int count, int argc, char **argv, ec_take *take, void *user, int *first, ec_asked *asked,
                               eclat_error *err)
{
    parser p = make_parser(options, count);
    int code;
    eclat_result result = ECLAT_OK;
    optind = 0; /* glibc: restart */
    opterr = 0;
    *asked = EC_ASKED_RUN;
    while (result == ECLAT_OK && (code = getopt_long(argc, argv, p.shorts, p.longs, NULL)) != -1) {
        if (code == 'h' || code == HELP || code == VERSION) {
            *asked = code == VERSION ? EC_ASKED_VERSION : EC_ASKED_HELP;
            return ECLAT_OK;
        }
        if (code == '?' || code == ':') return complain(&p, options, count, code, argv, err);
        const eclat_option *option = find_option(options, count, code);
        result = take(user, option->name, option->metavar ? optarg : NULL, err);
    }
    *first = optind;
    return result;
}

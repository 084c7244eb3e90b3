#include "jobs/option_parser.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "jobs/suggest.h"
#include "jobs/usage.h"

enum { LONG_BASE = 256, HELP = LONG_BASE + EC_OPTIONS_MAX, VERSION };

typedef struct parser {
    struct option longs[EC_OPTIONS_MAX + 3];
    char shorts[2 * EC_OPTIONS_MAX + 4];
} parser;

int ec_option_takes_value(const ec_option *option)
{
    return option->value_optional ? EC_VALUE_OPTIONAL : option->metavar != NULL;
}

const ec_option *ec_options_find(const ec_option *options, int count, const char *name)
{
    for (int i = 0; i < count; i++)
        if (!strcmp(options[i].name, name)) return &options[i];
    return NULL;
}

static parser make_parser(const ec_option *options, int count)
{
    parser p = {.shorts = ":h"};
    size_t used = strlen(p.shorts);
    for (int i = 0; i < count; i++) {
        p.longs[i] = (struct option){options[i].name, ec_option_takes_value(&options[i]), NULL, LONG_BASE + i};
        if (!options[i].letter) continue;
        p.shorts[used++] = options[i].letter;
        if (options[i].metavar) p.shorts[used++] = ':';
    }
    p.longs[count] = (struct option){"help", no_argument, NULL, HELP};
    p.longs[count + 1] = (struct option){"version", no_argument, NULL, VERSION};
    return p;
}

static const ec_option *find_option(const ec_option *options, int count, int code)
{
    for (int i = 0; i < count; i++)
        if (code == LONG_BASE + i || (options[i].letter && code == options[i].letter)) return &options[i];
    return NULL;
}

static int by_name(const void *a, const void *b) { return strcmp(*(const char *const *)a, *(const char *const *)b); }

/* An argument getopt_long did not know: which option was meant? */
static ec_result unknown_option(const parser *p, const char *argument, const char *command, ec_error *err)
{
    const char *names[EC_OPTIONS_MAX + 2];
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
    if (match_count > 1) return ec_usage(err, "option '--%s' is ambiguous: %s", typed, matches);
    const char *nearest = ec_suggest(typed, names, count);
    if (nearest) return ec_usage(err, "unknown option '--%s'; did you mean '--%s'?", typed, nearest);
    return ec_usage(err, "unknown option '%s'; see 'eclat %s --help'", argument, command);
}

/* getopt_long said '?' or ':' (missing value); optopt says for which option where it knows. */
static ec_result complain(const parser *p, const ec_option *options, int count, int code, char **argv, ec_error *err)
{
    const ec_option *option = find_option(options, count, optopt);
    if (code == ':' && option)
        return ec_usage(err, "option '--%s' needs a value; see 'eclat %s --help'", option->name, argv[0]);
    if (optopt >= LONG_BASE)
        return ec_usage(err, "option '%.*s' takes no value", (int)strcspn(argv[optind - 1], "="), argv[optind - 1]);
    if (optopt) return ec_usage(err, "unknown option '-%c'; see 'eclat %s --help'", optopt, argv[0]);
    return unknown_option(p, argv[optind - 1], argv[0], err);
}

ec_result ec_options_parse(const ec_option *options, int count, void *target, int argc, char **argv, int *first,
                           bool *given, ec_request *request, ec_error *err)
{
    parser p = make_parser(options, count);
    int code;
    optind = 0; /* glibc: start afresh */
    opterr = 0;
    *request = EC_REQUEST_RUN;
    while ((code = getopt_long(argc, argv, p.shorts, p.longs, NULL)) != -1) {
        if (code == 'h' || code == HELP || code == VERSION) {
            *request = code == VERSION ? EC_REQUEST_VERSION : EC_REQUEST_HELP;
            return EC_OK;
        }
        if (code == '?' || code == ':') return complain(&p, options, count, code, argv, err);
        const ec_option *option = find_option(options, count, code);
        EC_TRY(option->set(target, option->name, option->metavar ? optarg : NULL, err));
        if (given) given[option - options] = true;
    }
    *first = optind;
    return EC_OK;
}

ec_result ec_options_scene(int argc, char **argv, int first, const char **scene, ec_error *err)
{
    if (first >= argc || !*argv[first])
        return ec_usage(err, "%s needs a SCENE (.gltf or .glb); see 'eclat %s --help'", argv[0], argv[0]);
    if (first + 1 < argc)
        return ec_usage(err, "one scene at a time: '%s' is one operand too many", argv[first + 1]);
    *scene = argv[first];
    return EC_OK;
}

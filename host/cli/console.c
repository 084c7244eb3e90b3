#include "cli/console.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

bool ec_console_wants_progress(const ec_console *console)
{
    return console->terminal && !console->quiet;
}

int ec_console_columns(const ec_console *console)
{
    struct winsize size;
    if (console->terminal && ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1) return size.ws_col - 1;
    return 79;
}

void ec_console_erase(ec_console *console)
{
    if (console->drawn == 0) return;
    fprintf(stderr, "\r%*s\r", console->drawn, "");
    fflush(stderr);
    console->drawn = 0;
}

void ec_console_draw(ec_console *console, const char *line)
{
    if (!ec_console_wants_progress(console)) return;
    int room = ec_console_columns(console);
    int size = (int)strlen(line);
    if (size > room) size = room;
    int rest = console->drawn > size ? console->drawn - size : 0;
    fprintf(stderr, "\r%.*s%*s", size, line, rest, "");
    fflush(stderr);
    console->drawn = size + rest;
}

/* Names in messages come from files: no control character of theirs may reach the terminal. Lines of a build log may
 * stay lines. */
static void print_message(ec_console *console, const char *kind, const char *text)
{
    ec_console_erase(console);
    fprintf(stderr, "eclat: %s", kind);
    for (const unsigned char *c = (const unsigned char *)text; *c; c++)
        fputc((*c < 0x20 && *c != '\n' && *c != '\t') || *c == 0x7f ? '?' : *c, stderr);
    fputc('\n', stderr);
}

void ec_console_error(ec_console *console, const char *text)
{
    print_message(console, "error: ", text);
}

void ec_console_say(ec_console *console, const char *format, ...)
{
    if (console->quiet) return;
    char text[2048];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    print_message(console, "", text);
}

/* FNV-1a. Where more is said than is remembered, it is said again. */
static bool was_said(ec_console *console, const char *text)
{
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (; *text; text++) hash = (hash ^ (unsigned char)*text) * UINT64_C(0x100000001b3);
    for (int i = 0; i < console->said_count; i++)
        if (console->said[i] == hash) return true;
    if (console->said_count < (int)(sizeof console->said / sizeof *console->said)) console->said[console->said_count++] = hash;
    return false;
}

static void write_log(void *user, ec_severity severity, const char *text)
{
    ec_console *console = user;
    static const char *const kinds[] = {[EC_STATUS] = "", [EC_NOTE] = "note: ", [EC_WARNING] = "warning: ", [EC_FAILURE] = "error: "};
    const bool may_repeat = severity == EC_STATUS || severity == EC_FAILURE;
    if (console->says_once && !may_repeat && was_said(console, text)) return;
    if (severity >= EC_WARNING || !console->quiet) print_message(console, kinds[severity], text);
}

ec_log ec_console_log(ec_console *console)
{
    return (ec_log){.write = write_log, .user = console};
}

#include "cli/console.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

/* Tells whether fd is a terminal that understands escape sequences. */
static bool has_styles(int fd)
{
    const char *kind = getenv("TERM");
    return isatty(fd) == 1 && !(kind && !strcmp(kind, "dumb"));
}

ec_console ec_console_of_process(void)
{
    const char *refused = getenv("NO_COLOR"); /* no-color.org: set and not empty */
    return (ec_console){.terminal = isatty(STDERR_FILENO) == 1, .coloured = has_styles(STDERR_FILENO) && !(refused && *refused)};
}

bool ec_console_has_bold_results(void) { return has_styles(STDOUT_FILENO); }

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

/* Names in messages come from files: none of their control characters may reach the terminal. Lines of a build log remain lines. */
void ec_console_say(ec_console *console, eclat_severity severity, const char *text)
{
    static const struct { const char *word, *colour; } kinds[] = {
        [ECLAT_STATUS] = {"", ""}, [ECLAT_NOTE] = {"note: ", "\033[1;36m"}, [ECLAT_WARNING] = {"warning: ", "\033[1;33m"}, [ECLAT_FAILURE] = {"error: ", "\033[1;31m"}};
    const bool is_coloured = console->coloured && *kinds[severity].word;
    ec_console_erase(console);
    fprintf(stderr, "eclat: %s%s%s", is_coloured ? kinds[severity].colour : "", kinds[severity].word, is_coloured ? "\033[0m" : "");
    for (const unsigned char *c = (const unsigned char *)text; *c; c++)
        fputc((*c < 0x20 && *c != '\n' && *c != '\t') || *c == 0x7f ? '?' : *c, stderr);
    fputc('\n', stderr);
}

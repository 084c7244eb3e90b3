/* Everything that goes to stderr: messages, and the one line of progress that they must not tear. */
#ifndef EC_CLI_CONSOLE_H
#define EC_CLI_CONSOLE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

typedef struct ec_console {
    bool quiet;     /* warnings and errors only */
    bool terminal;  /* stderr is a terminal: progress may be drawn */
    int drawn;      /* columns that the progress line takes now */
    bool says_once; /* a note or a warning of the library that has been said is not said again: for frames, which are much alike */
    uint64_t said[64]; /* their hashes */
    int said_count;
} ec_console;

void ec_console_error(ec_console *console, const char *text);
/* "eclat: text", unless quiet. */
void ec_console_say(ec_console *console, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Notes (unless quiet) and warnings of the library; the log points at the console. */
ec_log ec_console_log(ec_console *console);

/* Draws over the progress line, cut to the terminal's width; nothing where progress is not wanted. */
void ec_console_draw(ec_console *console, const char *line);
void ec_console_erase(ec_console *console);
/* What fits on a line of the terminal without wrapping. */
int ec_console_columns(const ec_console *console);
bool ec_console_wants_progress(const ec_console *console);

#endif

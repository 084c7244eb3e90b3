/* Writes everything that goes to stderr: messages, and the single line of progress, which they must not break. */
#ifndef EC_CLI_CONSOLE_H
#define EC_CLI_CONSOLE_H

#include <eclat/eclat.h>
#include <stdbool.h>

typedef struct ec_console {
    bool quiet;     /* no progress */
    bool terminal;  /* stderr is a terminal, where progress may be drawn */
    bool coloured;  /* stderr shows colours, and NO_COLOR is not set */
    int drawn;      /* columns that the progress line takes at present */
} ec_console;

ec_console ec_console_of_process(void);

/* Tells whether stdout is a terminal that shows bold type. */
bool ec_console_has_bold_results(void);

void ec_console_say(ec_console *console, eclat_severity severity, const char *text);

/* Replaces the progress line, cut to the terminal's width; does nothing if progress is not wanted. */
void ec_console_draw(ec_console *console, const char *line);
void ec_console_erase(ec_console *console);
/* Returns the columns of the terminal that can be used without wrapping. */
int ec_console_columns(const ec_console *console);
bool ec_console_wants_progress(const ec_console *console);

#endif

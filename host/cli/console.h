/* Everything that goes to stderr: messages, and the one line of progress that they must not tear. */
#ifndef EC_CLI_CONSOLE_H
#define EC_CLI_CONSOLE_H

#include <eclat/eclat.h>
#include <stdbool.h>

typedef struct ec_console {
    bool quiet;     /* no progress */
    bool terminal;  /* stderr is a terminal: progress may be drawn */
    bool coloured;  /* it shows colours, and the user has not set NO_COLOR */
    int drawn;      /* columns that the progress line takes now */
} ec_console;

ec_console ec_console_of_process(void);

/* stdout is a terminal that shows bold type. */
bool ec_console_has_bold_results(void);

void ec_console_say(ec_console *console, eclat_severity severity, const char *text);

/* Draws over the progress line, cut to the terminal's width; nothing where progress is not wanted. */
void ec_console_draw(ec_console *console, const char *line);
void ec_console_erase(ec_console *console);
/* Columns of the terminal that can be used without wrapping. */
int ec_console_columns(const ec_console *console);
bool ec_console_wants_progress(const ec_console *console);

#endif

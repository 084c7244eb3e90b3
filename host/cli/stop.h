/* Ctrl-C: the first asks the render to stop, the second ends the process at once. */
#ifndef EC_CLI_STOP_H
#define EC_CLI_STOP_H

#include <stdbool.h>

/* From here on SIGINT, SIGTERM and SIGHUP only set a flag, the first time. Ignored signals stay ignored (nohup). */
void ec_stop_catch_signals(void);
bool ec_stop_requested(void);

#endif

/* Ctrl-C: the first signal asks the render to stop, the second ends the process at once. Further signals within half a second count as the first. */
#ifndef EC_CLI_STOP_H
#define EC_CLI_STOP_H

#include <eclat/eclat.h>
#include <stdbool.h>

/* To be called first, while there is one thread: directs SIGINT, SIGTERM and SIGHUP to a thread of their own, which for now ends the process as
 * usual. They are blocked in all other threads and in programs started by these, as PoCL aborts if Ctrl-C kills its linker. Ignored signals stay
 * ignored (nohup). */
void ec_stop_watch_signals(void);

/* Makes files larger than `ulimit -f` allows an error like others. To be called again after a driver's compiler may have changed the signal. */
void ec_stop_ignore_file_size(void);

/* From here on the first signal only asks the job to stop, and says so on standard error if `tell`. */
void ec_stop_catch_signals(bool tell);

/* Sets the job that the first signal asks to stop; NULL: none, as before the job is freed. */
void ec_stop_job(eclat_job *job);

/* Sets a line to show on standard error when the first signal comes, whatever happens then. It must last; NULL: none. */
void ec_stop_hint(const char *line);

#endif

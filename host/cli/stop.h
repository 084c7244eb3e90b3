/* Ctrl-C: the first asks the render to stop, the second ends the process at once; what comes within half a second is the first one still. */
#ifndef EC_CLI_STOP_H
#define EC_CLI_STOP_H

#include <eclat/eclat.h>
#include <stdbool.h>

/* First of all, while there is one thread: SIGINT, SIGTERM and SIGHUP go to a thread of their own, which for now ends the process as
 * they would have. They are blocked in all others and in the programs these start: PoCL aborts if Ctrl-C kills its linker. Ignored
 * signals stay ignored (nohup). */
void ec_stop_watch_signals(void);

/* Files larger than `ulimit -f` allows are to be an error like others. Again where a driver's compiler may have taken the signal since. */
void ec_stop_ignore_file_size(void);

/* From here on the first one only asks the job to stop, and says so on standard error if `tell`. */
void ec_stop_catch_signals(bool tell);

/* The job that the first one asks to stop; NULL: none, as before it is freed. */
void ec_stop_job(eclat_job *job);

/* Said on standard error when the first one comes, whatever happens then. A text that stays; NULL: none. */
void ec_stop_hint(const char *line);

#endif

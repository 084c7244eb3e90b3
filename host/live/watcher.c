/* The watcher's thread: sleeps until something happens in a folder of the scene's files. */
#include <errno.h>
#include <poll.h>
#include <unistd.h>

#include "live/shared.h"

#define BETWEEN_TELLS 300 /* milliseconds: a folder that others keep writing to wakes the loader no more often */

static void drain(int events)
{
    char names[4096];
    while (read(events, names, sizeof names) > 0) continue;
}

void *ec_live_watcher(void *argument)
{
    ec_live *live = argument;
    struct pollfd on[] = {{live->leave, POLLIN, 0}, {live->files, POLLIN, 0}};
    while (poll(on, 2, -1) >= 0 || errno == EINTR) {
        if (on[0].revents) break;
        if (!on[1].revents) continue;
        drain(live->files);
        pthread_mutex_lock(&live->lock);
        live->file_events++;
        ec_live_wake(live);
        pthread_mutex_unlock(&live->lock);
        poll(on, 1, BETWEEN_TELLS);
    }
    return NULL;
}

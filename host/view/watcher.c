/* The watcher's thread: asleep until something happens in a folder of the scene's files, or somebody outside wants the window closed. */
#include <errno.h>
#include <poll.h>
#include <unistd.h>

#include "view/shared.h"

#define BETWEEN_TELLS 300 /* milliseconds: a folder that others write to all the time wakes nobody more often */

static void drain(int events)
{
    char names[4096];
    while (read(events, names, sizeof names) > 0) continue;
}

void *ec_view_watcher(void *argument)
{
    ec_view *view = argument;
    struct pollfd on[] = {{view->leave, POLLIN, 0}, {view->request->stop, POLLIN, 0}, {view->files, POLLIN, 0}};
    while (poll(on, 3, -1) >= 0 || errno == EINTR) {
        bool stop = on[1].revents != 0, touched = on[2].revents != 0;
        if (on[0].revents) break;
        if (stop) on[1].fd = -1;
        if (touched) drain(view->files);
        pthread_mutex_lock(&view->lock);
        view->stopped |= stop;
        view->file_events += touched;
        ec_view_post(view);
        pthread_mutex_unlock(&view->lock);
        if (touched) poll(on, 2, BETWEEN_TELLS);
    }
    return NULL;
}

/* Has a file changed that a scene is made of? By times and sizes: works on every file system. When to look: inotify tells, but where a
 * folder is another machine's. */
#ifndef EC_LIVE_WATCH_H
#define EC_LIVE_WATCH_H

#include <stdbool.h>
#include <stdint.h>

enum { EC_WATCH_MOST = 1024 };
typedef struct ec_watch {
    char *paths[EC_WATCH_MOST]; /* owned */
    uint64_t seen[EC_WATCH_MOST];
    uint32_t count;
    bool is_deaf;               /* of some nobody tells: look now and then */
} ec_watch;

/* Watches the files of scene and environment (may be NULL), with the buffers and images that the scene names. As they are now. events: one of
 * inotify, readable when it is time to ask; -1: none. */
void ec_watch_start(ec_watch *watch, const char *scene, const char *environment, int events);
void ec_watch_stop(ec_watch *watch);

/* Since the last time it was asked, or started. */
bool ec_watch_changed(ec_watch *watch);

#endif

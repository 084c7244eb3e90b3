/* Tells whether a file that a scene is made of has changed, by times and sizes, which works on every file system. inotify tells when to look, except
 * on network file systems. */
#ifndef EC_LIVE_WATCH_H
#define EC_LIVE_WATCH_H

#include <stdbool.h>
#include <stdint.h>

enum { EC_WATCH_MOST = 1024 };
typedef struct ec_watch {
    char *paths[EC_WATCH_MOST]; /* owned */
    uint64_t seen[EC_WATCH_MOST];
    uint32_t count;
    bool is_deaf;               /* changes of some are not reported: look now and then */
} ec_watch;

/* Watches the files of scene and environment (may be NULL), including the buffers and images that the scene names, from their present state on.
 * events: a descriptor of inotify, readable when it is time to look; -1: none. */
void ec_watch_start(ec_watch *watch, const char *scene, const char *environment, int events);
void ec_watch_stop(ec_watch *watch);

/* Tells whether a file has changed since the last call, or since ec_watch_start. */
bool ec_watch_changed(ec_watch *watch);

#endif

/* Has a file changed that a scene is made of? By times and sizes: works on every file system. */
#ifndef EC_VIEW_WATCH_H
#define EC_VIEW_WATCH_H

#include <stdbool.h>
#include <stdint.h>

enum { EC_WATCH_MOST = 1024 };
typedef struct ec_watch {
    char *paths[EC_WATCH_MOST]; /* owned */
    uint64_t seen[EC_WATCH_MOST];
    uint32_t count;
} ec_watch;

/* Of scene and environment (may be NULL), with the buffers and images that the scene names. As they are now. */
void ec_watch_start(ec_watch *watch, const char *scene, const char *environment);
void ec_watch_stop(ec_watch *watch);

/* Since the last time it was asked, or started. */
bool ec_watch_changed(ec_watch *watch);

#endif

#include "live/watch.h"

#include <limits.h>
#include <linux/magic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include "gltf/reader.h"

#define LINKS_MOST 40

/* Returns a number that changes with the size, time or identity of the file; 0: there is no file. */
static uint64_t state_of(const char *path)
{
    struct stat s;
    if (stat(path, &s) != 0) return 0;
    uint64_t h = (uint64_t)s.st_mtim.tv_sec * 1000000007u + (uint64_t)s.st_mtim.tv_nsec;
    return (h * 31 + (uint64_t)s.st_size) * 31 + (uint64_t)s.st_ino;
}

/* Tells whether the kernel reports changes in a folder; it does not hear of what other machines do to shared files. */
static bool is_told_of(const char *folder)
{
    static const unsigned long remote[] = {NFS_SUPER_MAGIC, SMB_SUPER_MAGIC, SMB2_SUPER_MAGIC, CIFS_SUPER_MAGIC, AFS_SUPER_MAGIC,
                                           V9FS_MAGIC, FUSE_SUPER_MAGIC};
    struct statfs s;
    bool told = statfs(folder, &s) == 0;
    for (size_t i = 0; i < sizeof remote / sizeof remote[0]; i++) told = told && (uint32_t)s.f_type != (uint32_t)remote[i];
    return told;
}

/* Watches the file's folder, since a file that replaces another is a different file. */
static bool hear_folder(int events, const char *path)
{
    const uint32_t mask = IN_CLOSE_WRITE | IN_MODIFY | IN_ATTRIB | IN_CREATE | IN_DELETE | IN_MOVED_FROM | IN_MOVED_TO |
                          IN_DELETE_SELF | IN_MOVE_SELF;
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/');
    if (snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) + 1 : 1, slash ? path : ".") >= (int)sizeof folder) return false;
    return is_told_of(folder) && inotify_add_watch(events, folder, mask) >= 0;
}

/* Watches the file's folder, and those of all symbolic links on its path; depth: how many may follow one another. */
static bool hear(int events, const char *path, int depth)
{
    char link[PATH_MAX], target[PATH_MAX], next[2 * PATH_MAX];
    for (const char *end = path; *end && depth; end++) {
        int length = (int)(end - path) + 1;
        if ((end[1] && end[1] != '/') || snprintf(link, sizeof link, "%.*s", length, path) >= (int)sizeof link) continue;
        ssize_t size = readlink(link, target, sizeof target - 1);
        if (size < 0) continue;
        target[size] = 0;
        const char *slash = strrchr(link, '/');
        int folder = *target == '/' || !slash ? 0 : (int)(slash - link) + 1;
        int used = snprintf(next, sizeof next, "%.*s%s%s", folder, link, target, path + length);
        return hear_folder(events, link) && used < PATH_MAX && hear(events, next, depth - 1);
    }
    return depth && hear_folder(events, path);
}

static void add(ec_watch *w, const char *path, int events)
{
    if (w->count == EC_WATCH_MOST || !(w->paths[w->count] = strdup(path))) return;
    w->is_deaf |= !hear(events, path, LINKS_MOST);
    w->seen[w->count++] = state_of(path);
}

void ec_watch_start(ec_watch *w, const char *scene, const char *environment, int events)
{
    *w = (ec_watch){.count = 0};
    ec_scene_files files;
    ec_scene_files_list(scene, &files);
    if (environment) add(w, environment, events);
    for (uint32_t i = 0; i < files.count; i++) add(w, files.paths[i], events);
    ec_scene_files_free(&files);
}

void ec_watch_stop(ec_watch *w)
{
    for (uint32_t i = 0; i < w->count; i++) free(w->paths[i]);
    w->count = 0;
}

bool ec_watch_changed(ec_watch *w)
{
    bool changed = false;
    for (uint32_t i = 0; i < w->count; i++) {
        uint64_t now = state_of(w->paths[i]);
        changed |= now != w->seen[i];
        w->seen[i] = now;
    }
    return changed;
}

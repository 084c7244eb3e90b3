#include "view/watch.h"

#include <cjson/cJSON.h>
#include <ctype.h>
#include <limits.h>
#include <linux/magic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#define LARGEST_JSON (256u << 20)
#define LINKS_MOST 40

/* One number that another size, time or file changes. 0: there is none. */
static uint64_t state_of(const char *path)
{
    struct stat s;
    if (stat(path, &s) != 0) return 0;
    uint64_t h = (uint64_t)s.st_mtim.tv_sec * 1000000007u + (uint64_t)s.st_mtim.tv_nsec;
    return (h * 31 + (uint64_t)s.st_size) * 31 + (uint64_t)s.st_ino;
}

/* What another machine does to its files, its kernel tells nobody here. */
static bool is_told_of(const char *folder)
{
    static const unsigned long remote[] = {NFS_SUPER_MAGIC, SMB_SUPER_MAGIC, SMB2_SUPER_MAGIC, CIFS_SUPER_MAGIC, AFS_SUPER_MAGIC,
                                           V9FS_MAGIC, FUSE_SUPER_MAGIC};
    struct statfs s;
    bool told = statfs(folder, &s) == 0;
    for (size_t i = 0; i < sizeof remote / sizeof remote[0]; i++) told = told && (uint32_t)s.f_type != (uint32_t)remote[i];
    return told;
}

/* By its folder, since a file that takes another's place is another file. */
static bool hear_folder(int events, const char *path)
{
    const uint32_t mask = IN_CLOSE_WRITE | IN_MODIFY | IN_ATTRIB | IN_CREATE | IN_DELETE | IN_MOVED_FROM | IN_MOVED_TO | IN_DELETE_SELF | IN_MOVE_SELF;
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/');
    if (snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) + 1 : 1, slash ? path : ".") >= (int)sizeof folder) return false;
    return is_told_of(folder) && inotify_add_watch(events, folder, mask) >= 0;
}

/* The file's folder, and those of all links on the way to it; depth: as many as may follow one another. */
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

static void decode_percent(char *text)
{
    char *out = text, hex[3] = "";
    for (const char *in = text; *in; in++) {
        bool escape = *in == '%' && isxdigit((unsigned char)in[1]) && isxdigit((unsigned char)in[2]);
        if (escape) hex[0] = in[1], hex[1] = in[2];
        *out++ = escape ? (char)strtol(hex, NULL, 16) : *in;
        if (escape) in += 2;
    }
    *out = 0;
}

static void add_uris(ec_watch *w, const cJSON *list, const char *folder, int folder_length, int events)
{
    char path[4096];
    const cJSON *item;
    cJSON_ArrayForEach(item, list)
    {
        const char *uri = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(item, "uri"));
        if (!uri || !strncmp(uri, "data:", 5)) continue;
        snprintf(path, sizeof path, "%.*s%s", folder_length, folder, uri);
        decode_percent(path + folder_length);
        add(w, path, events);
    }
}

/* The JSON of a .gltf, or the first chunk of a .glb. malloc'ed; NULL: none to be had. */
static char *read_json(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    uint8_t head[20] = {0};
    size_t got = fread(head, 1, sizeof head, file), size = 0;
    bool is_glb = got == sizeof head && !memcmp(head, "glTF", 4);
    if (is_glb) size = head[12] | (size_t)head[13] << 8 | (size_t)head[14] << 16 | (size_t)head[15] << 24;
    else if (fseek(file, 0, SEEK_END) == 0 && ftell(file) > 0) size = (size_t)ftell(file), rewind(file);
    char *text = size && size < LARGEST_JSON ? calloc(size + 1, 1) : NULL;
    if (text && fread(text, 1, size, file) == 0) text[0] = 0;
    fclose(file);
    return text;
}

void ec_watch_start(ec_watch *w, const char *scene, const char *environment, int events)
{
    *w = (ec_watch){.count = 0};
    add(w, scene, events);
    if (environment) add(w, environment, events);
    char *text = read_json(scene);
    const char *slash = strrchr(scene, '/');
    int folder_length = slash ? (int)(slash - scene) + 1 : 0;
    cJSON *json = text ? cJSON_Parse(text) : NULL;
    add_uris(w, cJSON_GetObjectItemCaseSensitive(json, "buffers"), scene, folder_length, events);
    add_uris(w, cJSON_GetObjectItemCaseSensitive(json, "images"), scene, folder_length, events);
    cJSON_Delete(json);
    free(text);
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

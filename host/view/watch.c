#include "view/watch.h"

#include <ctype.h>
#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define LARGEST_JSON (256u << 20)

/* One number that another size, time or file changes. 0: there is none. */
static uint64_t state_of(const char *path)
{
    struct stat s;
    if (stat(path, &s) != 0) return 0;
    uint64_t h = (uint64_t)s.st_mtim.tv_sec * 1000000007u + (uint64_t)s.st_mtim.tv_nsec;
    return (h * 31 + (uint64_t)s.st_size) * 31 + (uint64_t)s.st_ino;
}

static void add(ec_watch *w, const char *path)
{
    if (w->count == EC_WATCH_MOST || !(w->paths[w->count] = strdup(path))) return;
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

static void add_uris(ec_watch *w, const cJSON *list, const char *folder, int folder_length)
{
    char path[4096];
    const cJSON *item;
    cJSON_ArrayForEach(item, list)
    {
        const char *uri = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(item, "uri"));
        if (!uri || !strncmp(uri, "data:", 5)) continue;
        snprintf(path, sizeof path, "%.*s%s", folder_length, folder, uri);
        decode_percent(path + folder_length);
        add(w, path);
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

void ec_watch_start(ec_watch *w, const char *scene, const char *environment)
{
    *w = (ec_watch){.count = 0};
    add(w, scene);
    if (environment) add(w, environment);
    char *text = read_json(scene);
    const char *slash = strrchr(scene, '/');
    int folder_length = slash ? (int)(slash - scene) + 1 : 0;
    cJSON *json = text ? cJSON_Parse(text) : NULL;
    add_uris(w, cJSON_GetObjectItemCaseSensitive(json, "buffers"), scene, folder_length);
    add_uris(w, cJSON_GetObjectItemCaseSensitive(json, "images"), scene, folder_length);
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

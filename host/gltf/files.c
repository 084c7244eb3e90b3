/* Lists the files that a scene is read from. Only its JSON is read, so that the list is known early, and also for a scene that cannot be loaded. */
#include <cjson/cJSON.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/freed.h"
#include "gltf/gltf.h"
#include "gltf/reader.h"

#define LARGEST_JSON (256u << 20)

/* Appends folder + name to the list, or leaves it out if there is no memory. */
static void add(ec_scene_files *files, const char *folder, int folder_length, const char *name)
{
    char **more = realloc(files->paths, (files->count + 1) * sizeof *more);
    size_t size = (size_t)folder_length + strlen(name) + 1;
    if (!more) return;
    files->paths = more;
    if (!(more[files->count] = malloc(size))) return;
    snprintf(more[files->count++], size, "%.*s%s", folder_length, folder, name);
}

static void add_uris(ec_scene_files *files, const cJSON *list, const char *folder, int folder_length)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, list)
    {
        const char *uri = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(item, "uri"));
        EC_FREED char *name = uri ? ec_gltf_uri_file(uri) : NULL;
        if (name) add(files, folder, folder_length, name);
    }
}

/* Opens regular files only: a pipe could block for ever. */
static FILE *open_regular(const char *path)
{
    struct stat info;
    int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    FILE *file = fd >= 0 && fstat(fd, &info) == 0 && S_ISREG(info.st_mode) ? fdopen(fd, "rb") : NULL;
    if (fd >= 0 && !file) close(fd);
    return file;
}

/* Returns the JSON of a .gltf, or the first chunk of a .glb, malloc'ed; NULL if there is none. */
static char *read_json(const char *path)
{
    FILE *file = open_regular(path);
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

void ec_scene_files_list(const char *scene, ec_scene_files *files)
{
    const char *slash = strrchr(scene, '/');
    const int folder_length = slash ? (int)(slash - scene) + 1 : 0;
    EC_FREED char *text = read_json(scene);
    cJSON *json = text ? cJSON_Parse(text) : NULL;
    *files = (ec_scene_files){0};
    add(files, "", 0, scene);
    add_uris(files, cJSON_GetObjectItemCaseSensitive(json, "buffers"), scene, folder_length);
    add_uris(files, cJSON_GetObjectItemCaseSensitive(json, "images"), scene, folder_length);
    cJSON_Delete(json);
}

void ec_scene_files_free(ec_scene_files *files)
{
    for (uint32_t i = 0; i < files->count; i++) free(files->paths[i]);
    free(files->paths);
    *files = (ec_scene_files){0};
}

/* Tiny glTF files for the loader's tests, written into the test output folder. Text may contain marks @NAME@, which are replaced by data
 * URIs of the given blobs. */
#ifndef EC_TEST_SCENE_FILES_H
#define EC_TEST_SCENE_FILES_H

#include <stdarg.h>
#include <unistd.h>

#include "gltf/reader.h"
#include "scene/validate.h"
#include "support/test.h"

typedef struct blob {
    const char *mark; /* e.g. "@pos@" */
    const void *bytes;
    size_t size;
} blob;

static inline char *data_uri(const void *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char head[] = "data:application/octet-stream;base64,";
    const unsigned char *in = bytes;
    char *text = malloc(sizeof head + (size + 2) / 3 * 4), *out = text;
    out += sprintf(out, "%s", head);
    for (size_t i = 0; i < size; i += 3) {
        unsigned word = (unsigned)in[i] << 16 | (i + 1 < size ? in[i + 1] : 0u) << 8 | (i + 2 < size ? in[i + 2] : 0u);
        *out++ = digits[word >> 18];
        *out++ = digits[word >> 12 & 63];
        *out++ = i + 1 < size ? digits[word >> 6 & 63] : '=';
        *out++ = i + 2 < size ? digits[word & 63] : '=';
    }
    *out = 0;
    return text;
}

static inline char *replace(const char *text, const char *mark, const char *by)
{
    const char *at = strstr(text, mark);
    if (!at) return strdup(text);
    char *out = malloc(strlen(text) + strlen(by) + 1);
    sprintf(out, "%.*s%s%s", (int)(at - text), text, by, at + strlen(mark));
    return out;
}

/* "x" becomes 'x' in the sources: JSON in C is unreadable with escaped quotes. Quotes only; \ stays. */
static inline char *from_single_quotes(const char *text)
{
    char *out = strdup(text);
    for (char *c = out; *c; c++)
        if (*c == '\'') *c = '"';
    return out;
}

static inline const char *temp_path(const char *suffix)
{
    static char path[512];
    snprintf(path, sizeof path, ECLAT_TEST_OUT "/scene_%d%s", (int)getpid(), suffix);
    return path;
}

static inline void write_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size) {
        fprintf(stderr, "cannot write %s\n", path);
        exit(1);
    }
    fclose(file);
}

/* The last load's messages, one a line. */
static char messages[8192];
static inline void keep_message(void *user, ec_severity severity, const char *text)
{
    (void)user;
    CHECK_MSG(!strchr(text, '\n'), "a message of more than one line: %s", text);
    size_t used = strlen(messages);
    snprintf(messages + used, sizeof messages - used, "%s%s\n", severity == EC_WARNING ? "W " : "N ", text);
}

/* Choices for the next loads. */
static ec_scene_choice wanted;

static inline ec_scene *load_bytes(const void *bytes, size_t size, const char *suffix, ec_error *err)
{
    ec_log log = {keep_message, NULL};
    ec_scene *scene = (ec_scene *)1;
    const char *path = temp_path(suffix);
    write_file(path, bytes, size);
    messages[0] = 0;
    err->text[0] = 0;
    ec_result result = ec_scene_load_choice(path, &wanted, &scene, &log, err);
    remove(path);
    CHECK((result == EC_OK) == (scene != NULL));
    CHECK_MSG((result == EC_OK) == (err->text[0] == 0), "message %s", err->text);
    CHECK_MSG(!strchr(err->text, '\n'), "an error of more than one line: %s", err->text);
    ec_error invalid = {.text = "fine"};
    if (scene) CHECK_MSG(ec_scene_validate(scene, &invalid) == EC_OK, "%s", invalid.text);
    return scene;
}

/* Blobs end with {0}. NULL with err set on failure. */
static inline ec_scene *load_text(const char *quoted, const blob *blobs, ec_error *err)
{
    char *text = from_single_quotes(quoted);
    for (; blobs && blobs->mark; blobs++) {
        char *uri = data_uri(blobs->bytes, blobs->size), *next = replace(text, blobs->mark, uri);
        free(uri);
        free(text);
        text = next;
    }
    ec_scene *scene = load_bytes(text, strlen(text), ".gltf", err);
    free(text);
    return scene;
}

/* Checks that loading fails, with a message that contains `needle`. */
static inline void expect_failure(const char *quoted, const blob *blobs, const char *needle)
{
    ec_error err;
    ec_scene *scene = load_text(quoted, blobs, &err);
    CHECK_MSG(!scene, "loaded although it should fail with \"%s\"", needle);
    CHECK_MSG(strstr(err.text, needle) != NULL, "message \"%s\" does not say \"%s\"", err.text, needle);
    ec_scene_free(scene);
}

/* A unit right triangle in the xy plane facing +z; accessor 0 = positions, buffer 0. %s places: node members, more
 * primitive members, more root members. */
static const float triangle_positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
#define TRIANGLE(NODE, ATTRIBUTES, PRIMITIVE, ROOT)                                                                    \
    "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0" NODE "}],"                                \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0" ATTRIBUTES "}" PRIMITIVE "}]}],"                            \
    "'buffers':[{'byteLength':36,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':36}],"                        \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}]" ROOT "}"
static const blob triangle_blobs[] = {{"@pos@", triangle_positions, sizeof triangle_positions}, {0}};

/* A triangle's corner in the file's coordinates. */
static inline void world_corner(const ec_scene *s, uint32_t triangle, uint32_t corner, double out[3])
{
    for (uint32_t k = 0; k < 3; k++) out[k] = (double)s->positions[3 * s->indices[3 * triangle + corner] + k] + s->center[k];
}

static inline void face_normal(const ec_scene *s, uint32_t triangle, double out[3])
{
    const float *p[3];
    double u[3], v[3];
    for (int i = 0; i < 3; i++) p[i] = s->positions + 3 * s->indices[3 * triangle + (uint32_t)i];
    for (int i = 0; i < 3; i++) {
        u[i] = (double)p[1][i] - p[0][i];
        v[i] = (double)p[2][i] - p[0][i];
    }
    for (int i = 0; i < 3; i++) out[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
}

#endif

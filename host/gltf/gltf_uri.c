/* Reads the bytes that URIs stand for: data URIs and files beside the glTF file. Neither a URI nor a symbolic link may lead out of the scene's
 * folder: a scene may come from anybody, and must not be able to read (or probe for) anything else on the machine. */
#include "base/freed.h"
#include "base/text.h"
#include "gltf/gltf.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* Decodes in place and returns the new length. A '%' that starts no escape is kept. */
static size_t percent_decode(char *text, size_t length)
{
    size_t out = 0;
    for (size_t i = 0; i < length; i++) {
        text[out++] = text[i];
        if (text[i] != '%' || i + 2 >= length || !isxdigit((unsigned char)text[i + 1]) || !isxdigit((unsigned char)text[i + 2])) continue;
        const char digits[3] = {text[i + 1], text[i + 2]};
        text[out - 1] = (char)strtol(digits, NULL, 16);
        i += 2;
    }
    text[out] = 0;
    return out;
}

static bool has_scheme(const char *uri)
{
    if (!isalpha((unsigned char)*uri)) return false;
    while (isalnum((unsigned char)*uri) || *uri == '+' || *uri == '-' || *uri == '.') uri++;
    return *uri == ':';
}

/* Tells whether a relative path climbs above its start. "a/../b" does not. */
static bool climbs_out(const char *path)
{
    int depth = 0;
    while (*path) {
        size_t length = strcspn(path, "/");
        if (length == 2 && !strncmp(path, "..", 2)) depth--;
        else if (length && !(length == 1 && *path == '.')) depth++;
        if (depth < 0) return true;
        path += length;
        while (*path == '/') path++;
    }
    return false;
}

static const char *escape_reason(const char *uri, const char *decoded, size_t decoded_length)
{
    if (strlen(decoded) != decoded_length) return "it holds a NUL character";
    if (has_scheme(uri) || has_scheme(decoded)) return "it has a scheme";
    if (strchr(decoded, '\\')) return "it holds a backslash";
    if (decoded[0] == '/') return "it is an absolute path";
    if (climbs_out(decoded)) return "it leaves the folder with \"..\"";
    return NULL;
}

static bool is_data_uri(const char *uri)
{
    return !strncasecmp(uri, "data:", 5);
}

/* Reports the lack of memory as the machine's fault, not the file's, also for files that a scene may do without. */
static ec_result out_of_memory(const char *where, uint64_t bytes, ec_error *err)
{
    ec_fail(err, "%s: out of memory for %llu bytes", where, (unsigned long long)bytes);
    if (err) err->kind = EC_ERROR_HOST_MEMORY;
    return EC_FAILED;
}

/* Decodes the path of the file that a URI names, relative to the scene's folder. The caller frees it, also after a failure. */
static ec_result decode_file_uri(const char *where, const char *uri, char **path, ec_error *err)
{
    size_t length = strlen(uri);
    char *decoded = *path = strdup(uri);
    if (!decoded) return out_of_memory(where, length, err);
    length = percent_decode(decoded, length);
    const char *reason = length ? escape_reason(uri, decoded, length) : "it is empty";
    if (!reason) return EC_OK;
    return ec_fail(err, "%s: refusing URI \"%.*s\": %s; put the file in the scene's folder and name it relative "
                   "to the scene", where, EC_CUT(uri, 200), reason);
}

ec_result ec_gltf_uri_check(const char *where, const char *uri, ec_error *err)
{
    EC_FREED char *path = NULL;
    return is_data_uri(uri) ? EC_OK : decode_file_uri(where, uri, &path, err);
}

char *ec_gltf_uri_file(const char *uri)
{
    char *path = NULL;
    if (is_data_uri(uri) || decode_file_uri("", uri, &path, NULL) == EC_OK) return path;
    free(path);
    return NULL;
}

static int base64_value(char c)
{
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    if (c == '/' || c == '_') return 63;
    return -1;
}

/* Decodes in place, as the output is never longer than the input. Returns false on a character that is not base64. */
static bool base64_decode(char *text, size_t length, uint64_t *out_length)
{
    uint32_t bits = 0;
    int bit_count = 0;
    size_t out = 0;
    while (length && text[length - 1] == '=') length--;
    for (size_t i = 0; i < length; i++) {
        int value = base64_value(text[i]);
        if (value < 0) {
            if (isspace((unsigned char)text[i])) continue;
            return false;
        }
        bits = bits << 6 | (uint32_t)value;
        bit_count += 6;
        if (bit_count >= 8) {
            bit_count -= 8;
            text[out++] = (char)(bits >> bit_count & 255);
        }
    }
    *out_length = out;
    return true;
}

static ec_result load_data_uri(const char *where, const char *uri, uint8_t **bytes, uint64_t *length, ec_error *err)
{
    const char *comma = strchr(uri, ',');
    if (!comma) return ec_fail(err, "%s: the data URI has no comma, so no data", where);
    static const char base64[] = ";base64";
    size_t tail = sizeof base64 - 1;
    bool is_base64 = (size_t)(comma - uri) >= tail && !strncasecmp(comma - tail, base64, tail);
    size_t text_length = strlen(comma + 1);
    char *text = strdup(comma + 1);
    if (!text) return out_of_memory(where, text_length, err);
    if (!is_base64 || strchr(text, '%')) text_length = percent_decode(text, text_length);
    *length = text_length;
    if (is_base64 && !base64_decode(text, text_length, length)) {
        free(text);
        return ec_fail(err, "%s: the data URI's base64 is broken; export the file again", where);
    }
    char *smaller = realloc(text, *length + 1); /* base64 was a third longer than the bytes */
    *bytes = (uint8_t *)(smaller ? smaller : text);
    return EC_OK;
}

static ec_result read_all(int file, const char *name, uint8_t **bytes, uint64_t *length, ec_error *err)
{
    struct stat info;
    if (fstat(file, &info) != 0 || !S_ISREG(info.st_mode))
        return ec_fail(err, "%s: not a regular file", name); /* a pipe or a device could block for ever */
    uint64_t size = (uint64_t)info.st_size;
    uint8_t *data = malloc(size + 1);
    if (!data) return out_of_memory(name, size, err);
    uint64_t done = 0;
    while (done < size) {
        ssize_t got = read(file, data + done, size - done);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        done += (uint64_t)got;
    }
    if (done < size) {
        free(data);
        return ec_fail(err, "%s: cannot read: %s", name, errno ? strerror(errno) : "it shrank while being read");
    }
    data[size] = 0;
    *bytes = data;
    *length = size;
    return EC_OK;
}

ec_result ec_gltf_file_load(const char *name, uint8_t **bytes, uint64_t *length, ec_error *err)
{
    int file = open(name, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return ec_fail(err, "%s: cannot open: %s", name, strerror(errno));
    errno = 0;
    ec_result result = read_all(file, name, bytes, length, err);
    close(file);
    return result;
}

/* Fails if the path leaves the folder once links are followed. A path that cannot be resolved passes; opening it will fail and say why. */
static ec_result check_links(const char *folder, const char *full, const char *where, ec_error *err)
{
    EC_FREED char *inside = realpath(*folder ? folder : ".", NULL), *real = realpath(full, NULL);
    const size_t size = inside ? strlen(inside) : 0;
    const bool is_root = size == 1; /* "/" */
    if (!inside || !real || is_root || (!strncmp(real, inside, size) && (!real[size] || real[size] == '/'))) return EC_OK;
    return ec_fail(err, "%s: refusing '%s': it is a symbolic link out of the scene's folder, to '%s'; copy the file there, or allow it with --follow-links",
                   where, full, real);
}

ec_result ec_gltf_uri_load(const ec_gltf *g, const char *where, const char *uri, uint8_t **bytes, uint64_t *length, ec_error *err)
{
    const char *folder = g->folder;
    if (is_data_uri(uri)) return load_data_uri(where, uri, bytes, length, err);
    EC_FREED char *name = NULL;
    EC_TRY(decode_file_uri(where, uri, &name, err));
    size_t size = strlen(folder) + strlen(name) + 1;
    EC_FREED char *full = malloc(size);
    if (!full) return out_of_memory(where, size, err);
    strcpy(full, folder);
    strcat(full, name);
    if (!g->follow_links) EC_TRY(check_links(folder, full, where, err));
    ec_error inner;
    if (ec_gltf_file_load(full, bytes, length, &inner) == EC_OK) return EC_OK;
    ec_fail(err, "%s: %.1200s", where, inner.text);
    if (err) err->kind = inner.kind;
    return EC_FAILED;
}

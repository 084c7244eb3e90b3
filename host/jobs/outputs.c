#include "jobs/outputs.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "image/image.h"
#include "jobs/option.h"
#include "report/format.h"

bool ec_same_file(const char *a, const char *b)
{
    struct stat sa, sb;
    return stat(a, &sa) == 0 && stat(b, &sb) == 0 && sa.st_dev == sb.st_dev && sa.st_ino == sb.st_ino;
}

bool ec_inputs_have(ec_inputs *inputs, const char *path)
{
    if (access(path, F_OK) != 0) return false;
    for (int i = 0; i < inputs->file_count; i++)
        if (inputs->files[i] && ec_same_file(path, inputs->files[i])) return true;
    if (inputs->scene && !inputs->of_scene.count) ec_scene_files_list(inputs->scene, &inputs->of_scene);
    for (uint32_t i = 0; i < inputs->of_scene.count; i++)
        if (ec_same_file(path, inputs->of_scene.paths[i])) return true;
    return false;
}

void ec_inputs_free(ec_inputs *inputs) { ec_scene_files_free(&inputs->of_scene); }

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static bool kind_of(const char *path, uint32_t *kind)
{
    const char *name = name_of(path), *dot = strrchr(name, '.');
    if (!dot || dot == name) return false;
    for (uint32_t f = 0; f < EC_FORMAT_COUNT; f++)
        for (const char *const *ending = ec_formats[f].endings; *ending; ending++)
            if (!strcasecmp(dot, *ending)) return *kind = EC_OUTPUT_PIXELS + f, true;
    *kind = EC_OUTPUT_EXR;
    return !strcasecmp(dot, ".exr");
}

const ec_format *ec_output_format(const ec_output *output) { return output->kind == EC_OUTPUT_EXR ? NULL : &ec_formats[output->kind - EC_OUTPUT_PIXELS]; }

bool ec_outputs_have_exr(const ec_outputs *outputs)
{
    bool have = false;
    for (int i = 0; i < outputs->count; i++) have |= outputs->file[i].kind == EC_OUTPUT_EXR;
    return have;
}

ec_result ec_outputs_add(ec_outputs *outputs, const char *path, ec_error *err)
{
    uint32_t kind;
    if (!kind_of(path, &kind))
        return ec_usage(err, "-o: '%s' has no known extension; use .exr (all data), .png, .jpg, .avif or .jxl (picture), or .hdr (radiance)", path);
    const ec_format *format = kind == EC_OUTPUT_EXR ? NULL : &ec_formats[kind - EC_OUTPUT_PIXELS];
    if (format && format->encode && !*format->encode)
        return ec_usage(err, "-o: '%s' needs %s, which this eclat was built without; write a .png, or build eclat with %s-dev", path, format->library, format->library);
    if (strlen(path) >= sizeof outputs->file[0].path)
        return ec_usage(err, "-o: the path is longer than %d bytes", PATH_MAX - 1);
    for (int i = 0; i < outputs->count; i++)
        if (!strcmp(outputs->file[i].path, path)) return ec_usage(err, "-o: '%s' is given twice", path);
    if (outputs->count == EC_OUTPUTS_MAX)
        return ec_usage(err, "-o: at most %d files, '%s' is one too many", EC_OUTPUTS_MAX, path);
    ec_output *output = &outputs->file[outputs->count++];
    output->kind = kind;
    snprintf(output->path, sizeof output->path, "%s", path);
    return EC_OK;
}

ec_result ec_outputs_add_named(ec_outputs *outputs, const char *scene, ec_error *err, const char *ending, ...)
{
    char path[PATH_MAX];
    const char *name = name_of(scene), *dot = strrchr(name, '.');
    int stem = dot && dot != name ? (int)(dot - name) : (int)strlen(name), size = stem;
    if (stem && stem < PATH_MAX) {
        va_list args;
        memcpy(path, name, (size_t)stem);
        va_start(args, ending);
        size += vsnprintf(path + stem, PATH_MAX - (size_t)stem, ending, args);
        va_end(args);
    }
    if (stem == 0 || size >= PATH_MAX) return ec_usage(err, "'%s' gives no name for the picture; add -o FILE", scene);
    return ec_outputs_add(outputs, path, err);
}

ec_result ec_outputs_add_default(ec_outputs *outputs, const char *scene, ec_error *err)
{
    EC_TRY(ec_outputs_add_named(outputs, scene, err, ".exr"));
    return ec_outputs_add_named(outputs, scene, err, ".png");
}

static void folder_of(const char *path, char folder[PATH_MAX])
{
    const char *slash = strrchr(path, '/');
    snprintf(folder, PATH_MAX, "%.*s.", slash ? (int)(slash - path) + 1 : 0, path);
}

bool ec_same_target(const char *a, const char *b)
{
    char folder_a[PATH_MAX], folder_b[PATH_MAX], *end_a = ec_link_end(a), *end_b = ec_link_end(b);
    bool is_same = false;
    if (end_a && end_b) {
        folder_of(end_a, folder_a);
        folder_of(end_b, folder_b);
        is_same = !strcmp(name_of(end_a), name_of(end_b)) && ec_same_file(folder_a, folder_b);
    }
    free(end_a);
    free(end_b);
    return is_same || ec_same_file(a, b);
}

ec_result ec_outputs_check(const ec_outputs *outputs, ec_inputs *inputs, ec_error *err)
{
    for (int i = 0; i < outputs->count; i++) {
        const char *path = outputs->file[i].path;
        for (int k = 0; k < i; k++)
            if (ec_same_target(path, outputs->file[k].path))
                return ec_usage(err, "-o: '%s' and '%s' are the same file; leave one out", outputs->file[k].path, path);
        if (ec_inputs_have(inputs, path))
            return ec_fail(err, "'%s' is an input of this job; write the picture elsewhere with -o", path);
        EC_TRY(ec_image_check_writable(path, err));
    }
    return EC_OK;
}

/* Returns the free bytes of the file system of path's folder; UINT64_MAX: unknown. */
static uint64_t room_for(const char *path)
{
    char folder[PATH_MAX];
    struct statvfs disk;
    folder_of(path, folder);
    return statvfs(folder, &disk) == 0 ? (uint64_t)disk.f_bavail * disk.f_frsize : UINT64_MAX;
}

void ec_outputs_check_room(const ec_outputs *outputs, uint64_t pixel_count, ec_channel_set channels, const ec_log *log)
{
    for (int i = 0; i < outputs->count; i++) {
        const ec_output *output = &outputs->file[i];
        uint64_t needed = pixel_count * (output->kind == EC_OUTPUT_EXR ? ec_channels_bytes(channels) : 3), /* uncompressed */
                 room = room_for(output->path);
        if (needed <= room) continue;
        ec_warn(log, "'%s' may need up to %s, but its disk has %s left", output->path, ec_bytes(needed).text, ec_bytes(room).text);
    }
}

#include "image/exr_parts.h"

#include <stdlib.h>
#include <string.h>

#include "image/exr_input.h"
#include "image/seal.h"

struct ec_exr_file {
    ec_exr_input input;
    int part_count;
    uint32_t width, height;
};

static ec_result damaged(const ec_exr_file *file, exr_result_t code, ec_error *err)
{
    return ec_fail(err, "cannot read '%s': %s; the file is damaged; use an older one or render it again", file->input.path,
                   ec_exr_reason(&file->input, code));
}

static bool size_of(const ec_exr_file *file, int part, uint32_t *width, uint32_t *height)
{
    exr_attr_box2i_t window;
    if (exr_get_data_window(file->input.context, part, &window) != EXR_ERR_SUCCESS) return false;
    if (window.min.x != 0 || window.min.y != 0 || window.max.x < 0 || window.max.y < 0) return false;
    *width = (uint32_t)window.max.x + 1;
    *height = (uint32_t)window.max.y + 1;
    return true;
}

ec_result ec_exr_open(const char *path, ec_exr_file **out, uint32_t *width, uint32_t *height, ec_error *err)
{
    *out = NULL;
    EC_TRY(ec_seal_check(path, err));
    ec_exr_file *file = calloc(1, sizeof *file);
    if (!file) return ec_fail(err, "out of memory");
    exr_result_t code = ec_exr_input_open(&file->input, path);
    if (code == EXR_ERR_SUCCESS) code = exr_get_count(file->input.context, &file->part_count);
    if (code == EXR_ERR_SUCCESS && !size_of(file, 0, &file->width, &file->height)) code = EXR_ERR_FILE_BAD_HEADER;
    if (code != EXR_ERR_SUCCESS) {
        ec_result result = damaged(file, code, err);
        ec_exr_close(file);
        return result;
    }
    *width = file->width;
    *height = file->height;
    *out = file;
    return EC_OK;
}

void ec_exr_close(ec_exr_file *file)
{
    if (file) ec_exr_input_close(&file->input);
    free(file);
}

const char *ec_exr_text(const ec_exr_file *file, const char *name)
{
    const exr_attribute_t *found = NULL;
    if (exr_get_attribute_by_name(file->input.context, 0, name, &found) != EXR_ERR_SUCCESS || found->type != EXR_ATTR_STRING) return NULL;
    return found->string->str;
}

/* Returns the index of the part; -1, which no part has, if there is none. */
static int part_named(const ec_exr_file *file, const char *name)
{
    for (int i = 0; i < file->part_count; i++) {
        const char *own = NULL;
        if (exr_get_name(file->input.context, i, &own) == EXR_ERR_SUCCESS && own && !strcmp(own, name)) return i;
    }
    return -1;
}

bool ec_exr_has(const ec_exr_file *file, const char *part, const char *channel)
{
    const int index = part_named(file, part);
    return index >= 0 && ec_exr_channel(&file->input, index, channel) != NULL;
}

ec_result ec_exr_fill(ec_exr_file *file, const char *name, const ec_exr_room *rooms, uint32_t count, ec_error *err)
{
    int part = part_named(file, name);
    uint32_t width = 0, height = 0;
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    for (uint32_t i = 0; i < count; i++) {
        const exr_attr_chlist_entry_t *channel = ec_exr_channel(&file->input, part, rooms[i].name);
        if (!channel || channel->pixel_type == EXR_PIXEL_HALF || channel->x_sampling != 1 || channel->y_sampling != 1)
            return ec_fail(err, "cannot read '%s': part '%s' has no 32-bit channel '%s'; use the version of eclat that wrote it", file->input.path,
                           name, rooms[i].name);
    }
    exr_result_t code = exr_get_storage(file->input.context, part, &storage);
    bool fits = storage == EXR_STORAGE_SCANLINE && size_of(file, part, &width, &height) && width == file->width &&
                height == file->height;
    if (code == EXR_ERR_SUCCESS) code = fits ? ec_exr_decode(&file->input, part, rooms, count, false) : EXR_ERR_FILE_BAD_HEADER;
    return code == EXR_ERR_SUCCESS ? EC_OK : damaged(file, code, err);
}

#include "image/exr_parts.h"

#include <stdlib.h>
#include <string.h>

#include "image/exr_context.h"
#include "image/seal.h"

struct ec_exr_file {
    exr_context_t context;
    ec_exr_stream stream;
    const char *path;
    int part_count;
    uint32_t width, height;
};

static ec_result damaged(const ec_exr_file *file, exr_result_t code, ec_error *err)
{
    return ec_fail(err, "cannot read '%s': %s; the file is damaged, take an older one or render it again", file->path,
                   ec_exr_reason(&file->stream, code));
}

static bool size_of(const ec_exr_file *file, int part, uint32_t *width, uint32_t *height)
{
    exr_attr_box2i_t window;
    if (exr_get_data_window(file->context, part, &window) != EXR_ERR_SUCCESS) return false;
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
    file->path = path;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = ec_exr_keep_message;
    setup.user_data = &file->stream;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_result_t code = exr_start_read(&file->context, path, &setup);
    if (code == EXR_ERR_SUCCESS) code = exr_get_count(file->context, &file->part_count);
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
    if (file && file->context) exr_finish(&file->context);
    free(file);
}

const char *ec_exr_text(const ec_exr_file *file, const char *name)
{
    const exr_attribute_t *found = NULL;
    if (exr_get_attribute_by_name(file->context, 0, name, &found) != EXR_ERR_SUCCESS || found->type != EXR_ATTR_STRING) return NULL;
    return found->string->str;
}

static int part_named(const ec_exr_file *file, const char *name)
{
    for (int i = 0; i < file->part_count; i++) {
        const char *own = NULL;
        if (exr_get_name(file->context, i, &own) == EXR_ERR_SUCCESS && own && !strcmp(own, name)) return i;
    }
    return -1;
}

static const exr_attr_chlist_entry_t *channel_named(const ec_exr_file *file, int part, const char *name)
{
    const exr_attr_chlist_t *list = NULL;
    if (part < 0 || exr_get_channels(file->context, part, &list) != EXR_ERR_SUCCESS) return NULL;
    for (int i = 0; i < list->num_channels; i++)
        if (!strcmp(list->entries[i].name.str, name)) return &list->entries[i];
    return NULL;
}

bool ec_exr_has(const ec_exr_file *file, const char *part, const char *channel)
{
    return channel_named(file, part_named(file, part), channel) != NULL;
}

static exr_result_t decode(ec_exr_file *file, int part, exr_decode_pipeline_t *block, uint32_t y,
                           const ec_exr_room *rooms, uint32_t count)
{
    exr_chunk_info_t info;
    exr_result_t code = exr_read_scanline_chunk_info(file->context, part, (int)y, &info);
    if (code == EXR_ERR_SUCCESS)
        code = block->channels ? exr_decoding_update(file->context, part, &info, block)
                               : exr_decoding_initialize(file->context, part, &info, block);
    if (code != EXR_ERR_SUCCESS) return code;
    if (info.width != (int32_t)file->width || info.height < 1 || y + (uint64_t)info.height > file->height)
        return EXR_ERR_CORRUPT_CHUNK;
    for (int c = 0; c < block->channel_count; c++) {
        exr_coding_channel_info_t *channel = &block->channels[c];
        channel->decode_to_ptr = NULL;
        for (uint32_t i = 0; i < count; i++) {
            if (strcmp(rooms[i].name, channel->channel_name)) continue;
            channel->user_data_type = channel->data_type;
            channel->user_bytes_per_element = sizeof(uint32_t);
            channel->user_pixel_stride = (int32_t)(rooms[i].stride * sizeof(uint32_t));
            channel->user_line_stride = (int32_t)(rooms[i].stride * sizeof(uint32_t) * file->width);
            channel->decode_to_ptr = (uint8_t *)((uint32_t *)rooms[i].data + (uint64_t)rooms[i].stride * y * file->width);
        }
    }
    code = exr_decoding_choose_default_routines(file->context, part, block);
    return code == EXR_ERR_SUCCESS ? exr_decoding_run(file->context, part, block) : code;
}

ec_result ec_exr_fill(ec_exr_file *file, const char *name, const ec_exr_room *rooms, uint32_t count, ec_error *err)
{
    int part = part_named(file, name);
    uint32_t width = 0, height = 0;
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    for (uint32_t i = 0; i < count; i++) {
        const exr_attr_chlist_entry_t *channel = channel_named(file, part, rooms[i].name);
        if (!channel || channel->pixel_type == EXR_PIXEL_HALF || channel->x_sampling != 1 || channel->y_sampling != 1)
            return ec_fail(err, "cannot read '%s': part '%s' has no 32-bit channel '%s'; use the version of eclat that wrote it", file->path,
                           name, rooms[i].name);
    }
    int32_t lines = 1;
    exr_result_t code = exr_get_storage(file->context, part, &storage);
    bool fits = storage == EXR_STORAGE_SCANLINE && size_of(file, part, &width, &height) && width == file->width &&
                height == file->height;
    if (code == EXR_ERR_SUCCESS && !fits) code = EXR_ERR_FILE_BAD_HEADER;
    if (code == EXR_ERR_SUCCESS) code = exr_get_scanlines_per_chunk(file->context, part, &lines);
    if (code == EXR_ERR_SUCCESS && lines < 1) code = EXR_ERR_FILE_BAD_HEADER;
    exr_decode_pipeline_t block = EXR_DECODE_PIPELINE_INITIALIZER;
    for (uint32_t y = 0; code == EXR_ERR_SUCCESS && y < file->height; y += (uint32_t)lines)
        code = decode(file, part, &block, y, rooms, count);
    exr_decoding_destroy(file->context, &block);
    return code == EXR_ERR_SUCCESS ? EC_OK : damaged(file, code, err);
}

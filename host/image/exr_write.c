/* OpenEXR out: scan lines, ZIP (16 lines a block) or plain, 32-bit values; one part, or several and a seal. */
#include <errno.h>
#include <openexr.h>
#include <string.h>
#include <unistd.h>

#include "image/atomic_file.h"
#include "image/image.h"
#include "image/seal.h"

enum { SHORT_NAME_MAX = 31 }; /* longer names need a flag in the file header */

typedef struct exr_picture {
    const char *path;
    uint32_t width, height;
    const ec_exr_part *parts;
    uint32_t part_count;
} exr_picture;

typedef struct exr_target {
    int fd;
    int write_error; /* errno of the first failed write */
} exr_target;

/* The library calls both of these with its lock held: nothing of it that takes the lock may be called from here, error reports among
 * it, or a full disk would hang the program. */
static void ignore_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context, (void)code, (void)message;
}

static int64_t write_all(exr_const_context_t context, void *user, const void *buffer, uint64_t size, uint64_t offset,
                         exr_stream_error_func_ptr_t report)
{
    exr_target *stream = user;
    uint64_t done = 0;
    (void)context, (void)report;
    while (done < size) {
        ssize_t written = pwrite(stream->fd, (const char *)buffer + done, size - done, (off_t)(offset + done));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) {
            if (!stream->write_error) stream->write_error = written < 0 ? errno : ENOSPC;
            return -1;
        }
        done += (uint64_t)written;
    }
    return (int64_t)size;
}

static exr_result_t set_attribute(exr_context_t context, int part, const ec_attribute *attribute)
{
    switch (attribute->type) {
    case EC_ATTR_STRING: return exr_attr_set_string(context, part, attribute->name, attribute->string);
    case EC_ATTR_INT: return exr_attr_set_int(context, part, attribute->name, (int32_t)attribute->number);
    case EC_ATTR_FLOAT: return exr_attr_set_float(context, part, attribute->name, (float)attribute->number);
    case EC_ATTR_DOUBLE: return exr_attr_set_double(context, part, attribute->name, attribute->number);
    }
    return EXR_ERR_INVALID_ARGUMENT;
}

static int has_long_name(const exr_picture *picture)
{
    for (uint32_t k = 0; k < picture->part_count; k++) {
        const ec_exr_part *part = &picture->parts[k];
        for (uint32_t i = 0; i < part->channel_count; i++)
            if (strlen(part->channels[i].name) > SHORT_NAME_MAX) return 1;
        for (uint32_t i = 0; i < part->attribute_count; i++)
            if (strlen(part->attributes[i].name) > SHORT_NAME_MAX) return 1;
    }
    return 0;
}

static exr_result_t add_part(exr_context_t context, const exr_picture *picture, const ec_exr_part *part)
{
    int index = 0;
    exr_result_t code = exr_add_part(context, part->name, EXR_STORAGE_SCANLINE, &index);
    if (code == EXR_ERR_SUCCESS)
        code = exr_initialize_required_attr_simple(context, index, (int32_t)picture->width, (int32_t)picture->height,
                                                   part->is_plain ? EXR_COMPRESSION_NONE : EXR_COMPRESSION_ZIP);
    for (uint32_t i = 0; code == EXR_ERR_SUCCESS && i < part->channel_count; i++)
        code = exr_add_channel(context, index, part->channels[i].name, part->channels[i].is_words ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT,
                               EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    for (uint32_t i = 0; code == EXR_ERR_SUCCESS && i < part->attribute_count; i++)
        code = set_attribute(context, index, &part->attributes[i]);
    return code;
}

static exr_result_t write_header(exr_context_t context, const exr_picture *picture)
{
    exr_result_t code = has_long_name(picture) ? exr_set_longname_support(context, 1) : EXR_ERR_SUCCESS;
    for (uint32_t k = 0; code == EXR_ERR_SUCCESS && k < picture->part_count; k++) code = add_part(context, picture, &picture->parts[k]);
    return code == EXR_ERR_SUCCESS ? exr_write_header(context) : code;
}

/* Points every channel of the block (the library's order: sorted by name) at the caller's pixels, row y on. */
static void point_at_row(exr_encode_pipeline_t *block, const ec_exr_part *part, uint32_t width, uint32_t y)
{
    for (int c = 0; c < block->channel_count; c++) {
        exr_coding_channel_info_t *target = &block->channels[c];
        for (uint32_t i = 0; i < part->channel_count; i++) {
            const ec_channel *source = &part->channels[i];
            if (strcmp(source->name, target->channel_name) != 0) continue;
            const float *first = source->data + (uint64_t)source->stride * y * width;
            target->user_data_type = source->is_words ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
            target->user_bytes_per_element = sizeof(float);
            target->user_pixel_stride = (int32_t)(source->stride * sizeof(float));
            target->user_line_stride = (int32_t)(source->stride * sizeof(float) * width);
            target->encode_from_ptr = (const uint8_t *)first;
        }
    }
}

static exr_result_t write_part(exr_context_t context, const exr_picture *picture, int part)
{
    int32_t block_height = 1;
    exr_result_t code = exr_get_scanlines_per_chunk(context, part, &block_height);
    exr_encode_pipeline_t block = EXR_ENCODE_PIPELINE_INITIALIZER;
    for (uint32_t y = 0; code == EXR_ERR_SUCCESS && y < picture->height; y += (uint32_t)block_height) {
        exr_chunk_info_t info;
        code = exr_write_scanline_chunk_info(context, part, (int)y, &info);
        if (code == EXR_ERR_SUCCESS)
            code = y == 0 ? exr_encoding_initialize(context, part, &info, &block)
                          : exr_encoding_update(context, part, &info, &block);
        if (code == EXR_ERR_SUCCESS) point_at_row(&block, &picture->parts[part], picture->width, y);
        if (code == EXR_ERR_SUCCESS && y == 0) code = exr_encoding_choose_default_routines(context, part, &block);
        if (code == EXR_ERR_SUCCESS) code = exr_encoding_run(context, part, &block);
    }
    exr_encoding_destroy(context, &block);
    return code;
}

static ec_result check(const exr_picture *picture, const ec_exr_part *part, ec_error *err)
{
    if (picture->width == 0 || picture->height == 0 || part->channel_count == 0)
        return ec_fail(err, "cannot write '%s': an image of %u x %u pixels and %u channels is empty", picture->path,
                       picture->width, picture->height, part->channel_count);
    for (uint32_t i = 0; i < part->channel_count; i++) {
        const ec_channel *channel = &part->channels[i];
        if ((uint64_t)picture->width * channel->stride > INT32_MAX / sizeof(float) || picture->height > INT32_MAX)
            return ec_fail(err, "cannot write '%s': %u x %u pixels are too many for OpenEXR; render a smaller image",
                           picture->path, picture->width, picture->height);
        for (uint32_t j = 0; j < i; j++)
            if (strcmp(channel->name, part->channels[j].name) == 0)
                return ec_fail(err, "cannot write '%s': channel '%s' is given twice", picture->path, channel->name);
    }
    return EC_OK;
}

ec_result ec_exr_write(const char *path, uint32_t width, uint32_t height, const ec_channel *channels,
                       uint32_t channel_count, const ec_attribute *attributes, uint32_t attribute_count, ec_error *err)
{
    const ec_exr_part part = {"", channels, channel_count, attributes, attribute_count, false};
    return ec_exr_write_parts(path, width, height, &part, 1, err);
}

ec_result ec_exr_write_parts(const char *path, uint32_t width, uint32_t height, const ec_exr_part *parts, uint32_t part_count, ec_error *err)
{
    const exr_picture picture = {path, width, height, parts, part_count};
    for (uint32_t k = 0; k < part_count; k++) EC_TRY(check(&picture, &parts[k], err));
    ec_atomic_file file;
    EC_TRY(ec_atomic_open(&file, path, err));

    exr_target stream = {.fd = file.fd};
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = ignore_message;
    setup.user_data = &stream;
    setup.write_fn = write_all;
    exr_context_t context = NULL;
    exr_result_t code = exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &setup);
    if (code == EXR_ERR_SUCCESS) code = write_header(context, &picture);
    for (uint32_t k = 0; code == EXR_ERR_SUCCESS && k < part_count; k++) code = write_part(context, &picture, (int)k);
    exr_result_t finish_code = context ? exr_finish(&context) : EXR_ERR_SUCCESS; /* writes the table of blocks */
    if (code == EXR_ERR_SUCCESS) code = finish_code;

    if (code == EXR_ERR_SUCCESS && (part_count == 1 || (stream.write_error = ec_seal(file.fd)) == 0)) return ec_atomic_commit(&file, err);
    ec_atomic_abort(&file);
    if (stream.write_error) return ec_write_failed(err, path, stream.write_error);
    return ec_fail(err, "cannot write '%s': %s", path, exr_get_default_error_message(code));
}

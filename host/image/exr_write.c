/* OpenEXR out: one part, scan lines, ZIP (16 lines a block), 32-bit float. */
#include <errno.h>
#include <openexr.h>
#include <string.h>
#include <unistd.h>

#include "image/atomic_file.h"
#include "image/image.h"

enum { SHORT_NAME_MAX = 31 }; /* longer names need a flag in the file header */

typedef struct exr_picture {
    const char *path;
    uint32_t width, height;
    const ec_channel *channels;
    uint32_t channel_count;
    const ec_attribute *attributes;
    uint32_t attribute_count;
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

static exr_result_t set_attribute(exr_context_t context, const ec_attribute *attribute)
{
    switch (attribute->type) {
    case EC_ATTR_STRING: return exr_attr_set_string(context, 0, attribute->name, attribute->string);
    case EC_ATTR_INT: return exr_attr_set_int(context, 0, attribute->name, (int32_t)attribute->number);
    case EC_ATTR_FLOAT: return exr_attr_set_float(context, 0, attribute->name, (float)attribute->number);
    case EC_ATTR_DOUBLE: return exr_attr_set_double(context, 0, attribute->name, attribute->number);
    }
    return EXR_ERR_INVALID_ARGUMENT;
}

static int has_long_name(const exr_picture *picture)
{
    for (uint32_t i = 0; i < picture->channel_count; i++)
        if (strlen(picture->channels[i].name) > SHORT_NAME_MAX) return 1;
    for (uint32_t i = 0; i < picture->attribute_count; i++)
        if (strlen(picture->attributes[i].name) > SHORT_NAME_MAX) return 1;
    return 0;
}

static exr_result_t write_header(exr_context_t context, const exr_picture *picture)
{
    exr_result_t code = EXR_ERR_SUCCESS;
    int part = 0;
    if (has_long_name(picture)) code = exr_set_longname_support(context, 1);
    if (code == EXR_ERR_SUCCESS) code = exr_add_part(context, "", EXR_STORAGE_SCANLINE, &part);
    if (code == EXR_ERR_SUCCESS)
        code = exr_initialize_required_attr_simple(context, part, (int32_t)picture->width, (int32_t)picture->height,
                                                   EXR_COMPRESSION_ZIP);
    for (uint32_t i = 0; code == EXR_ERR_SUCCESS && i < picture->channel_count; i++)
        code = exr_add_channel(context, part, picture->channels[i].name, EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC,
                               1, 1);
    for (uint32_t i = 0; code == EXR_ERR_SUCCESS && i < picture->attribute_count; i++)
        code = set_attribute(context, &picture->attributes[i]);
    if (code == EXR_ERR_SUCCESS) code = exr_write_header(context);
    return code;
}

/* Points every channel of the block (the library's order: sorted by name) at the caller's pixels, row y on. */
static void point_at_row(exr_encode_pipeline_t *block, const exr_picture *picture, uint32_t y)
{
    for (int c = 0; c < block->channel_count; c++) {
        exr_coding_channel_info_t *target = &block->channels[c];
        for (uint32_t i = 0; i < picture->channel_count; i++) {
            const ec_channel *source = &picture->channels[i];
            if (strcmp(source->name, target->channel_name) != 0) continue;
            const float *first = source->data + (uint64_t)source->stride * y * picture->width;
            target->user_data_type = EXR_PIXEL_FLOAT;
            target->user_bytes_per_element = sizeof(float);
            target->user_pixel_stride = (int32_t)(source->stride * sizeof(float));
            target->user_line_stride = (int32_t)(source->stride * sizeof(float) * picture->width);
            target->encode_from_ptr = (const uint8_t *)first;
        }
    }
}

static exr_result_t write_pixels(exr_context_t context, const exr_picture *picture)
{
    int32_t block_height = 1;
    exr_result_t code = exr_get_scanlines_per_chunk(context, 0, &block_height);
    exr_encode_pipeline_t block = EXR_ENCODE_PIPELINE_INITIALIZER;
    for (uint32_t y = 0; code == EXR_ERR_SUCCESS && y < picture->height; y += (uint32_t)block_height) {
        exr_chunk_info_t info;
        code = exr_write_scanline_chunk_info(context, 0, (int)y, &info);
        if (code == EXR_ERR_SUCCESS)
            code = y == 0 ? exr_encoding_initialize(context, 0, &info, &block)
                          : exr_encoding_update(context, 0, &info, &block);
        if (code == EXR_ERR_SUCCESS) point_at_row(&block, picture, y);
        if (code == EXR_ERR_SUCCESS && y == 0) code = exr_encoding_choose_default_routines(context, 0, &block);
        if (code == EXR_ERR_SUCCESS) code = exr_encoding_run(context, 0, &block);
    }
    exr_encoding_destroy(context, &block);
    return code;
}

static ec_result check(const exr_picture *picture, ec_error *err)
{
    if (picture->width == 0 || picture->height == 0 || picture->channel_count == 0)
        return ec_fail(err, "cannot write '%s': an image of %u x %u pixels and %u channels is empty", picture->path,
                       picture->width, picture->height, picture->channel_count);
    for (uint32_t i = 0; i < picture->channel_count; i++) {
        const ec_channel *channel = &picture->channels[i];
        if ((uint64_t)picture->width * channel->stride > INT32_MAX / sizeof(float) || picture->height > INT32_MAX)
            return ec_fail(err, "cannot write '%s': %u x %u pixels are too many for OpenEXR; render a smaller image",
                           picture->path, picture->width, picture->height);
        for (uint32_t j = 0; j < i; j++)
            if (strcmp(channel->name, picture->channels[j].name) == 0)
                return ec_fail(err, "cannot write '%s': channel '%s' is given twice", picture->path, channel->name);
    }
    return EC_OK;
}

ec_result ec_exr_write(const char *path, uint32_t width, uint32_t height, const ec_channel *channels,
                       uint32_t channel_count, const ec_attribute *attributes, uint32_t attribute_count, ec_error *err)
{
    const exr_picture picture = {path, width, height, channels, channel_count, attributes, attribute_count};
    EC_TRY(check(&picture, err));
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
    if (code == EXR_ERR_SUCCESS) code = write_pixels(context, &picture);
    exr_result_t finish_code = context ? exr_finish(&context) : EXR_ERR_SUCCESS; /* writes the table of blocks */
    if (code == EXR_ERR_SUCCESS) code = finish_code;

    if (code == EXR_ERR_SUCCESS) return ec_atomic_commit(&file, err);
    ec_atomic_abort(&file);
    if (stream.write_error) return ec_write_failed(err, path, stream.write_error);
    return ec_fail(err, "cannot write '%s': %s", path, exr_get_default_error_message(code));
}

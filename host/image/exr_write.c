/* Writes OpenEXR row by row: scan lines, ZIP (16 lines per block) or uncompressed; one part, or several and a seal. */
#include <openexr.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/freed.h"
#include "image/exr_blocks.h"
#include "image/image.h"
#include "image/seal.h"

enum {
    SHORT_NAME_MAX = 31, /* longer names need a flag in the file header */
    ROOM_MAX = 4096
};

/* A file being written. The parts are the caller's; after the header, only names of channels are needed of what they point to. */
struct ec_exr_rows {
    ec_atomic_file file;
    const char *path;     /* the caller's */
    uint32_t width, height;
    const ec_exr_part *parts;
    uint32_t part_count;
    uint32_t room;           /* bytes of blanks in the header */
    exr_context_t context;
    uint64_t header_size;
    ec_exr_blocks blocks;
    int part;                /* the part being written, from row y on */
    uint32_t y;
    int write_error;         /* errno of the first failed write */
};

/* Receives a header that is made again, to replace the first one. */
typedef struct header_bytes {
    uint8_t *bytes;
    uint64_t size, most;
} header_bytes;

/* The library calls both of these with its lock held: nothing that takes the lock, such as error reports, may be called from here, or a full disk
 * would hang the program. */
static void ignore_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context, (void)code, (void)message;
}

static int64_t write_all(exr_const_context_t context, void *user, const void *buffer, uint64_t size, uint64_t offset,
                         exr_stream_error_func_ptr_t report)
{
    ec_exr_rows *stream = user;
    (void)context, (void)report;
    int failed = ec_write_all(stream->file.fd, buffer, size, (off_t)offset);
    if (failed && !stream->write_error) stream->write_error = failed;
    return failed ? -1 : (int64_t)size;
}

static int64_t write_to_memory(exr_const_context_t context, void *user, const void *buffer, uint64_t size, uint64_t offset,
                               exr_stream_error_func_ptr_t report)
{
    header_bytes *header = user;
    (void)context, (void)report;
    if (offset > header->most || size > header->most - offset) return -1;
    memcpy(header->bytes + offset, buffer, size);
    if (header->size < offset + size) header->size = offset + size;
    return (int64_t)size;
}

static exr_result_t set_attribute(exr_context_t context, int part, const ec_attribute *attribute)
{
    switch (attribute->type) {
    case EC_ATTR_STRING: return exr_attr_set_string(context, part, attribute->name, attribute->string);
    case EC_ATTR_INT: return exr_attr_set_int(context, part, attribute->name, (int32_t)attribute->number);
    case EC_ATTR_DOUBLE: return exr_attr_set_double(context, part, attribute->name, attribute->number);
    }
    return EXR_ERR_INVALID_ARGUMENT;
}

static int has_long_name(const ec_exr_part *parts, uint32_t part_count)
{
    for (uint32_t k = 0; k < part_count; k++) {
        const ec_exr_part *part = &parts[k];
        for (uint32_t i = 0; i < part->channel_count; i++)
            if (strlen(part->channels[i].name) > SHORT_NAME_MAX) return 1;
        for (uint32_t i = 0; i < part->attribute_count; i++)
            if (strlen(part->attributes[i].name) > SHORT_NAME_MAX) return 1;
    }
    return 0;
}

static const exr_pixel_type_t pixel_types[] = {[EC_CHANNEL_FLOAT] = EXR_PIXEL_FLOAT, [EC_CHANNEL_HALF] = EXR_PIXEL_HALF,
                                               [EC_CHANNEL_UINT] = EXR_PIXEL_UINT, [EC_CHANNEL_WORDS] = EXR_PIXEL_UINT};

static exr_result_t add_part(exr_context_t context, const ec_exr_rows *rows, const ec_exr_part *part)
{
    int index = 0;
    exr_result_t code = exr_add_part(context, part->name, EXR_STORAGE_SCANLINE, &index);
    if (code == EXR_ERR_SUCCESS)
        code = exr_initialize_required_attr_simple(context, index, (int32_t)rows->width, (int32_t)rows->height,
                                                   part->is_plain ? EXR_COMPRESSION_NONE : EXR_COMPRESSION_ZIP);
    for (uint32_t i = 0; code == EXR_ERR_SUCCESS && i < part->channel_count; i++)
        code = exr_add_channel(context, index, part->channels[i].name,
                               pixel_types[part->channels[i].type], EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    for (uint32_t i = 0; code == EXR_ERR_SUCCESS && i < part->attribute_count; i++)
        code = set_attribute(context, index, &part->attributes[i]);
    return code;
}

/* Writes the header. blanks: size of the attribute that pads it; 0: none. */
static exr_result_t write_header(exr_context_t context, const ec_exr_rows *rows, const ec_exr_part *parts, uint32_t blanks)
{
    char text[ROOM_MAX + 1];
    exr_result_t code = has_long_name(parts, rows->part_count) ? exr_set_longname_support(context, 1) : EXR_ERR_SUCCESS;
    for (uint32_t k = 0; code == EXR_ERR_SUCCESS && k < rows->part_count; k++) code = add_part(context, rows, &parts[k]);
    memset(text, ' ', blanks);
    text[blanks] = 0;
    if (code == EXR_ERR_SUCCESS && blanks) code = exr_attr_set_string(context, 0, "eclat.room", text);
    return code == EXR_ERR_SUCCESS ? exr_write_header(context) : code;
}

static exr_context_initializer_t setup_of(void *user, exr_write_func_ptr_t write)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = ignore_message;
    setup.user_data = user;
    setup.write_fn = write;
    return setup;
}

static ec_result failed(const ec_exr_rows *rows, exr_result_t code, ec_error *err)
{
    if (rows->write_error) return ec_write_failed(err, rows->path, rows->write_error);
    return ec_fail(err, "cannot write '%s': %s", rows->path, exr_get_default_error_message(code));
}

static ec_result check(const ec_exr_rows *picture, const ec_exr_part *part, ec_error *err)
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

static ec_result begin(ec_exr_rows *rows, ec_error *err)
{
    for (uint32_t k = 0; k < rows->part_count; k++) EC_TRY(check(rows, &rows->parts[k], err));
    EC_TRY(ec_atomic_open(&rows->file, rows->path, err));
    const exr_context_initializer_t setup = setup_of(rows, write_all);
    exr_result_t code = ec_exr_blocks_create(&rows->blocks);
    if (code == EXR_ERR_SUCCESS) code = exr_start_write(&rows->context, rows->path, EXR_WRITE_FILE_DIRECTLY, &setup);
    if (code == EXR_ERR_SUCCESS) code = write_header(rows->context, rows, rows->parts, rows->room);
    off_t size = lseek(rows->file.fd, 0, SEEK_END);
    rows->header_size = size > 0 ? (uint64_t)size : 0;
    return code == EXR_ERR_SUCCESS ? EC_OK : failed(rows, code, err);
}

ec_result ec_exr_rows_begin(ec_exr_rows **made, const char *path, uint32_t width, uint32_t height, const ec_exr_part *parts,
                            uint32_t part_count, uint32_t room, ec_error *err)
{
    ec_exr_rows *rows = calloc(1, sizeof *rows);
    *made = NULL;
    if (!rows) return ec_fail(err, "out of memory for '%s'", path);
    *rows = (ec_exr_rows){.file.fd = -1, .path = path, .width = width, .height = height, .parts = parts, .part_count = part_count,
                          .room = room < ROOM_MAX ? room : ROOM_MAX};
    if (begin(rows, err) != EC_OK) {
        ec_exr_rows_abort(rows);
        return EC_FAILED;
    }
    *made = rows;
    return EC_OK;
}

ec_result ec_exr_rows_put(ec_exr_rows *rows, const ec_exr_part *part, uint32_t count, ec_error *err)
{
    int32_t block_height = 1;
    exr_result_t code = exr_get_scanlines_per_chunk(rows->context, rows->part, &block_height);
    if (code == EXR_ERR_SUCCESS)
        code = ec_exr_blocks_write(&rows->blocks, rows->context, rows->part, part, rows->width, rows->y, count, (uint32_t)block_height);
    if (code != EXR_ERR_SUCCESS) return failed(rows, code, err);
    rows->y += count;
    if (rows->y < rows->height) return EC_OK;
    rows->part++;
    rows->y = 0;
    return EC_OK;
}

/* Writes the header again over the first one, with what was not known then. Blanks compensate for texts that became longer or shorter. */
static ec_result write_header_again(ec_exr_rows *rows, const ec_exr_part *part, ec_error *err)
{
    EC_FREED uint8_t *bytes = malloc(rows->header_size + ROOM_MAX);
    header_bytes header = {.bytes = bytes, .most = rows->header_size + ROOM_MAX};
    if (!bytes) return ec_fail(err, "out of memory for '%s'", rows->path);
    exr_result_t code = EXR_ERR_SUCCESS;
    for (uint32_t attempt = 0, blanks = rows->room;
         code == EXR_ERR_SUCCESS && header.size != rows->header_size && attempt < 2; attempt++) {
        const exr_context_initializer_t setup = setup_of(&header, write_to_memory);
        exr_context_t context = NULL;
        header.size = 0;
        code = exr_start_write(&context, rows->path, EXR_WRITE_FILE_DIRECTLY, &setup);
        if (code == EXR_ERR_SUCCESS) code = write_header(context, rows, part, blanks);
        uint64_t size = header.size;
        if (context) exr_finish(&context); /* of a file without pixels; its output goes behind the header, or nowhere */
        header.size = size;
        blanks = blanks + (uint32_t)rows->header_size - (uint32_t)size;
        if (!rows->room || blanks == 0 || blanks > ROOM_MAX) break;
    }
    bool fits = code == EXR_ERR_SUCCESS && header.size == rows->header_size;
    if (fits && write_all(NULL, rows, header.bytes, header.size, 0, NULL) < 0) code = EXR_ERR_WRITE_IO;
    if (code != EXR_ERR_SUCCESS) return failed(rows, code, err);
    return fits ? EC_OK : ec_fail(err, "cannot write '%s': its attributes do not fit into its header", rows->path);
}

ec_result ec_exr_rows_end(ec_exr_rows *rows, const ec_attribute *attributes, uint32_t attribute_count, ec_error *err)
{
    exr_result_t code = exr_finish(&rows->context); /* writes the table of block offsets */
    ec_result result = code == EXR_ERR_SUCCESS ? EC_OK : failed(rows, code, err);
    if (result == EC_OK && attributes) {
        ec_exr_part part = rows->parts[0];
        part.attributes = attributes;
        part.attribute_count = attribute_count;
        result = write_header_again(rows, &part, err);
    }
    const bool is_sealed = rows->part_count > 1 || rows->parts[0].is_sealed;
    if (result == EC_OK && is_sealed && (rows->write_error = ec_seal(rows->file.fd)) != 0)
        result = failed(rows, code, err);
    if (result == EC_OK) result = ec_atomic_commit(&rows->file, err);
    ec_exr_rows_abort(rows);
    return result;
}

void ec_exr_rows_abort(ec_exr_rows *rows)
{
    if (!rows) return;
    ec_exr_blocks_free(&rows->blocks);
    if (rows->context) exr_finish(&rows->context);
    ec_atomic_abort(&rows->file);
    free(rows);
}

ec_result ec_exr_write(const char *path, uint32_t width, uint32_t height, const ec_channel *channels,
                       uint32_t channel_count, const ec_attribute *attributes, uint32_t attribute_count, ec_error *err)
{
    const ec_exr_part part = {.name = "", .channels = channels, .channel_count = channel_count,
                              .attributes = attributes, .attribute_count = attribute_count};
    return ec_exr_write_parts(path, width, height, &part, 1, err);
}

ec_result ec_exr_write_parts(const char *path, uint32_t width, uint32_t height, const ec_exr_part *parts,
                             uint32_t part_count, ec_error *err)
{
    ec_exr_rows *rows;
    EC_TRY(ec_exr_rows_begin(&rows, path, width, height, parts, part_count, 0, err));
    ec_result result = EC_OK;
    for (uint32_t k = 0; k < part_count && result == EC_OK; k++) result = ec_exr_rows_put(rows, &parts[k], height, err);
    if (result == EC_OK) return ec_exr_rows_end(rows, NULL, 0, err);
    ec_exr_rows_abort(rows);
    return result;
}

/* OpenEXR in: the first part's full-resolution image, scan lines or tiles, any compression, to float planes. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "image/exr_context.h"
#include "image/exr_read_rgba.h"
#include "image/image.h"

enum { SIDE_MAX = 1 << 17 };                       /* pixels; beyond it a header is taken for damaged */
static const uint64_t value_max = 1ull << 32;      /* width * height * channels: 16 GiB of planes */
/* No compression packs more pixels into a byte, nor a few hundred bytes gigabytes: the largest blocks, 256 lines, have 16 bytes of table
 * and header each, and their colours come on top. */
enum { PIXELS_A_BYTE_MAX = 1 << 17 };

typedef struct exr_source {
    exr_context_t context;
    ec_exr_stream stream;
    const char *path;
    float *unwanted; /* a line, for channels that nobody asked for: not every routine of the library passes them over */
    int32_t origin_x, origin_y;
    exr_storage_t storage;
    int32_t tile_width, tile_height;
} exr_source;

static ec_result damaged(const exr_source *source, exr_result_t code, ec_error *err)
{
    return ec_fail(err, "cannot read '%s': %s; the file may be damaged or cut short, replace it", source->path,
                   ec_exr_reason(&source->stream, code));
}

static ec_result check_storage(exr_source *source, ec_error *err)
{
    exr_result_t code = exr_get_storage(source->context, 0, &source->storage);
    if (code != EXR_ERR_SUCCESS) return damaged(source, code, err);
    if (source->storage == EXR_STORAGE_DEEP_SCANLINE || source->storage == EXR_STORAGE_DEEP_TILED)
        return ec_fail(err, "cannot read '%s': deep OpenEXR images are not supported; flatten it first", source->path);
    if (source->storage != EXR_STORAGE_TILED) return EC_OK;
    code = exr_get_tile_sizes(source->context, 0, 0, 0, &source->tile_width, &source->tile_height);
    if (code != EXR_ERR_SUCCESS) return damaged(source, code, err);
    if (source->tile_width > 0 && source->tile_height > 0) return EC_OK;
    return ec_fail(err, "cannot read '%s': its tiles have no size; the file is damaged, replace it", source->path);
}

static ec_result read_size(exr_source *source, ec_exr *exr, ec_error *err)
{
    exr_attr_box2i_t window;
    exr_result_t code = exr_get_data_window(source->context, 0, &window);
    if (code != EXR_ERR_SUCCESS) return damaged(source, code, err);
    int64_t width = (int64_t)window.max.x - window.min.x + 1, height = (int64_t)window.max.y - window.min.y + 1;
    if (width < 1 || height < 1 || width > SIDE_MAX || height > SIDE_MAX)
        return ec_fail(err, "cannot read '%s': %lld x %lld pixels is not a usable size (1 to %d a side)", source->path,
                       (long long)width, (long long)height, SIDE_MAX);
    struct stat file;
    if (stat(source->path, &file) == 0 && (uint64_t)(width * height) / PIXELS_A_BYTE_MAX > (uint64_t)file.st_size)
        return ec_fail(err, "cannot read '%s': %lld x %lld pixels in %lld bytes; the file is damaged or cut short, replace it", source->path,
                       (long long)width, (long long)height, (long long)file.st_size);
    source->origin_x = window.min.x;
    source->origin_y = window.min.y;
    exr->width = (uint32_t)width;
    exr->height = (uint32_t)height;
    return EC_OK;
}

static int is_wanted(const char *const *wanted, const char *name)
{
    for (; wanted && *wanted; wanted++)
        if (!strcmp(*wanted, name)) return 1;
    return !wanted;
}

static ec_result allocate_planes(const exr_source *source, const exr_attr_chlist_t *list, const char *const *wanted,
                                 ec_exr *exr, ec_error *err)
{
    uint64_t pixels = (uint64_t)exr->width * exr->height, count = (uint64_t)list->num_channels, planes = 0;
    for (uint64_t i = 0; i < count; i++) planes += (uint64_t)is_wanted(wanted, list->entries[i].name.str);
    const uint64_t bytes = pixels * planes * sizeof(float), free_now = ec_memory_free(); /* else promised, and the process killed as it is used */
    if (bytes > free_now)
        return ec_fail(err, "cannot read '%s': %u x %u pixels with %llu channels take %.1f GB of memory, and %.1f are free; crop it", source->path, exr->width,
                       exr->height, (unsigned long long)planes, (double)bytes / 1e9, (double)free_now / 1e9);
    exr->names = calloc(count, sizeof *exr->names);
    exr->planes = calloc(count, sizeof *exr->planes);
    int enough = exr->names && exr->planes && pixels * planes <= value_max;
    for (uint64_t i = 0; enough && i < count; i++) {
        const char *name = list->entries[i].name.str;
        exr->names[i] = strdup(name);
        if (is_wanted(wanted, name)) exr->planes[i] = calloc(pixels, sizeof(float));
        exr->channel_count++;
        enough = exr->names[i] && (exr->planes[i] || !is_wanted(wanted, name));
    }
    if (enough) return EC_OK;
    return ec_fail(err, "cannot read '%s': %u x %u pixels with %llu channels do not fit into memory", source->path,
                   exr->width, exr->height, (unsigned long long)planes);
}

static ec_result read_channel_list(const exr_source *source, const char *const *wanted, ec_exr *exr, ec_error *err)
{
    const exr_attr_chlist_t *list = NULL;
    exr_result_t code = exr_get_channels(source->context, 0, &list);
    if (code != EXR_ERR_SUCCESS || !list || list->num_channels < 1)
        return ec_fail(err, "cannot read '%s': it has no channels", source->path);
    for (int i = 0; i < list->num_channels; i++)
        if (list->entries[i].x_sampling != 1 || list->entries[i].y_sampling != 1)
            return ec_fail(err, "cannot read '%s': channel '%s' is subsampled (luminance and chroma); save it as RGB",
                           source->path, list->entries[i].name.str);
    return allocate_planes(source, list, wanted, exr, err);
}

/* Decodes one block or tile into the planes, its first pixel being (x, y). */
static exr_result_t decode(const exr_source *source, exr_decode_pipeline_t *block, const exr_chunk_info_t *info,
                           ec_exr *exr, uint32_t x, uint32_t y)
{
    exr_result_t code = block->channels ? exr_decoding_update(source->context, 0, info, block)
                                        : exr_decoding_initialize(source->context, 0, info, block);
    if (code != EXR_ERR_SUCCESS) return code;
    if (block->channel_count != (int)exr->channel_count || info->width < 1 || info->height < 1 ||
        x + (uint64_t)info->width > exr->width || y + (uint64_t)info->height > exr->height)
        return EXR_ERR_CORRUPT_CHUNK;
    for (int c = 0; c < block->channel_count; c++) {
        exr_coding_channel_info_t *channel = &block->channels[c];
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = sizeof(float);
        channel->user_pixel_stride = sizeof(float);
        channel->user_line_stride = exr->planes[c] ? (int32_t)(exr->width * sizeof(float)) : 0;
        channel->decode_to_ptr = (uint8_t *)(exr->planes[c] ? exr->planes[c] + (uint64_t)y * exr->width + x : source->unwanted);
    }
    code = exr_decoding_choose_default_routines(source->context, 0, block);
    return code == EXR_ERR_SUCCESS ? exr_decoding_run(source->context, 0, block) : code;
}

static exr_result_t read_scanlines(const exr_source *source, exr_decode_pipeline_t *block, ec_exr *exr)
{
    int32_t lines = 1;
    exr_result_t code = exr_get_scanlines_per_chunk(source->context, 0, &lines);
    if (code == EXR_ERR_SUCCESS && lines < 1) code = EXR_ERR_FILE_BAD_HEADER;
    for (uint32_t y = 0; code == EXR_ERR_SUCCESS && y < exr->height; y += (uint32_t)lines) {
        exr_chunk_info_t info;
        code = exr_read_scanline_chunk_info(source->context, 0, source->origin_y + (int32_t)y, &info);
        if (code == EXR_ERR_SUCCESS) code = decode(source, block, &info, exr, 0, y);
    }
    return code;
}

static exr_result_t read_tiles(const exr_source *source, exr_decode_pipeline_t *block, ec_exr *exr)
{
    uint32_t tile_width = (uint32_t)source->tile_width, tile_height = (uint32_t)source->tile_height;
    exr_result_t code = EXR_ERR_SUCCESS;
    for (uint32_t y = 0; y < exr->height; y += tile_height)
        for (uint32_t x = 0; code == EXR_ERR_SUCCESS && x < exr->width; x += tile_width) {
            exr_chunk_info_t info;
            code = exr_read_tile_chunk_info(source->context, 0, (int)(x / tile_width), (int)(y / tile_height), 0, 0,
                                            &info);
            if (code == EXR_ERR_SUCCESS) code = decode(source, block, &info, exr, x, y);
        }
    return code;
}

static ec_result read_pixels(const exr_source *source, ec_exr *exr, ec_error *err)
{
    exr_compression_t compression;
    if (exr_get_compression(source->context, 0, &compression) == EXR_ERR_SUCCESS &&
        (compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB))
        return ec_exr_read_rgba(source->path, source->origin_x, source->origin_y, exr, err);

    exr_decode_pipeline_t block = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t code = source->storage == EXR_STORAGE_TILED ? read_tiles(source, &block, exr)
                                                             : read_scanlines(source, &block, exr);
    exr_decoding_destroy(source->context, &block);
    return code == EXR_ERR_SUCCESS ? EC_OK : damaged(source, code, err);
}

ec_result ec_exr_read(const char *path, ec_exr *exr, ec_error *err) { return ec_exr_read_some(path, NULL, exr, err); }

ec_result ec_exr_read_some(const char *path, const char *const *wanted, ec_exr *exr, ec_error *err)
{
    *exr = (ec_exr){0};
    EC_TRY(ec_image_check_regular(path, err));
    exr_source source = {.path = path};
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = ec_exr_keep_message;
    setup.user_data = &source.stream;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION; /* half a picture is an error, not a picture */
    exr_result_t code = exr_start_read(&source.context, path, &setup);
    if (code == EXR_ERR_FILE_ACCESS) return ec_fail(err, "cannot open '%s'; check the path and its permissions", path);
    if (code != EXR_ERR_SUCCESS) return damaged(&source, code, err);

    ec_result result;
    EC_TRY_CLEANUP(check_storage(&source, err));
    EC_TRY_CLEANUP(read_size(&source, exr, err));
    EC_TRY_CLEANUP(read_channel_list(&source, wanted, exr, err));
    source.unwanted = wanted ? malloc(exr->width * sizeof(float)) : NULL;
    if (wanted && !source.unwanted) EC_TRY_CLEANUP(ec_fail(err, "cannot read '%s': out of memory", path));
    EC_TRY_CLEANUP(read_pixels(&source, exr, err));
cleanup:
    free(source.unwanted);
    exr_finish(&source.context);
    if (result != EC_OK) ec_exr_free(exr);
    return result;
}

const float *ec_exr_plane(const ec_exr *exr, const char *name)
{
    for (uint32_t i = 0; i < exr->channel_count; i++)
        if (strcmp(exr->names[i], name) == 0) return exr->planes[i];
    return NULL;
}

void ec_exr_free(ec_exr *exr)
{
    for (uint32_t i = 0; i < exr->channel_count; i++) {
        free(exr->names[i]);
        free(exr->planes[i]);
    }
    free(exr->names);
    free(exr->planes);
    *exr = (ec_exr){0};
}

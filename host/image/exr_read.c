/* Reads OpenEXR: the full-resolution image of the first part, scan lines or tiles, any compression, into float planes. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/freed.h"
#include "base/memory.h"
#include "image/exr_input.h"
#include "image/exr_read_rgba.h"
#include "image/image.h"

enum { SIDE_MAX = 1 << 17 };                       /* pixels; a header with more is taken for damaged */
static const uint64_t value_max = 1ull << 32;      /* width * height * channels: 16 GiB of planes */
/* More pixels per byte than any compression reaches, so that a few hundred bytes cannot claim gigabytes: the largest blocks, 256 lines, have 16 bytes
 * of table and header each, plus their colours. */
enum { PIXELS_A_BYTE_MAX = 1 << 17 };

static ec_result damaged(const ec_exr_input *in, exr_result_t code, ec_error *err)
{
    return ec_fail(err, "cannot read '%s': %s; the file may be damaged or cut short, replace it", in->path, ec_exr_reason(in, code));
}

static ec_result check_storage(const ec_exr_input *in, ec_error *err)
{
    exr_storage_t storage;
    int32_t tile_width = 1, tile_height = 1;
    exr_result_t code = exr_get_storage(in->context, 0, &storage);
    if (code != EXR_ERR_SUCCESS) return damaged(in, code, err);
    if (storage == EXR_STORAGE_DEEP_SCANLINE || storage == EXR_STORAGE_DEEP_TILED)
        return ec_fail(err, "cannot read '%s': deep OpenEXR images are not supported; flatten it first", in->path);
    if (storage == EXR_STORAGE_TILED) code = exr_get_tile_sizes(in->context, 0, 0, 0, &tile_width, &tile_height);
    if (code != EXR_ERR_SUCCESS) return damaged(in, code, err);
    if (tile_width > 0 && tile_height > 0) return EC_OK;
    return ec_fail(err, "cannot read '%s': its tiles have no size; the file is damaged, replace it", in->path);
}

static ec_result read_size(const ec_exr_input *in, ec_exr *exr, exr_attr_v2i_t *origin, ec_error *err)
{
    exr_attr_box2i_t window;
    exr_result_t code = exr_get_data_window(in->context, 0, &window);
    if (code != EXR_ERR_SUCCESS) return damaged(in, code, err);
    int64_t width = (int64_t)window.max.x - window.min.x + 1, height = (int64_t)window.max.y - window.min.y + 1;
    if (width < 1 || height < 1 || width > SIDE_MAX || height > SIDE_MAX)
        return ec_fail(err, "cannot read '%s': %lld x %lld pixels is not a usable size (1 to %d a side)", in->path,
                       (long long)width, (long long)height, SIDE_MAX);
    struct stat file;
    if (stat(in->path, &file) == 0 && (uint64_t)(width * height) / PIXELS_A_BYTE_MAX > (uint64_t)file.st_size)
        return ec_fail(err, "cannot read '%s': %lld x %lld pixels in %lld bytes; the file is damaged or cut short, replace it", in->path,
                       (long long)width, (long long)height, (long long)file.st_size);
    *origin = window.min;
    exr->width = (uint32_t)width;
    exr->height = (uint32_t)height;
    return EC_OK;
}

static bool is_wanted(const char *const *wanted, const char *name)
{
    for (; wanted && *wanted; wanted++)
        if (!strcmp(*wanted, name)) return true;
    return !wanted;
}

static ec_result allocate_planes(const ec_exr_input *in, const exr_attr_chlist_t *list, const char *const *wanted,
                                 ec_exr *exr, ec_error *err)
{
    uint64_t pixels = (uint64_t)exr->width * exr->height, count = (uint64_t)list->num_channels, planes = 0;
    for (uint64_t i = 0; i < count; i++) planes += is_wanted(wanted, list->entries[i].name.str);
    const uint64_t bytes = pixels * planes * sizeof(float), free_now = ec_memory_free(); /* or memory is promised, and the process killed later */
    if (bytes > free_now)
        return ec_fail(err, "cannot read '%s': %u x %u pixels with %llu channels need %.1f GB of memory, but %.1f GB are free; crop it", in->path, exr->width,
                       exr->height, (unsigned long long)planes, (double)bytes / 1e9, (double)free_now / 1e9);
    exr->names = calloc(count, sizeof *exr->names);
    exr->planes = calloc(count, sizeof *exr->planes);
    bool enough = exr->names && exr->planes && pixels * planes <= value_max;
    for (uint64_t i = 0; enough && i < count; i++) {
        const char *name = list->entries[i].name.str;
        exr->names[i] = strdup(name);
        if (is_wanted(wanted, name)) exr->planes[i] = calloc(pixels, sizeof(float));
        exr->channel_count++;
        enough = exr->names[i] && (exr->planes[i] || !is_wanted(wanted, name));
    }
    if (enough) return EC_OK;
    return ec_fail(err, "cannot read '%s': %u x %u pixels with %llu channels do not fit into memory", in->path,
                   exr->width, exr->height, (unsigned long long)planes);
}

static ec_result read_channel_list(const ec_exr_input *in, const char *const *wanted, ec_exr *exr, ec_error *err)
{
    const exr_attr_chlist_t *list = NULL;
    exr_result_t code = exr_get_channels(in->context, 0, &list);
    if (code != EXR_ERR_SUCCESS || !list || list->num_channels < 1)
        return ec_fail(err, "cannot read '%s': it has no channels", in->path);
    for (int i = 0; i < list->num_channels; i++)
        if (list->entries[i].x_sampling != 1 || list->entries[i].y_sampling != 1)
            return ec_fail(err, "cannot read '%s': channel '%s' is subsampled (luminance and chroma); save it as RGB",
                           in->path, list->entries[i].name.str);
    return allocate_planes(in, list, wanted, exr, err);
}

static ec_result read_pixels(const ec_exr_input *in, exr_attr_v2i_t origin, ec_exr *exr, ec_error *err)
{
    exr_compression_t compression;
    if (exr_get_compression(in->context, 0, &compression) == EXR_ERR_SUCCESS &&
        (compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB))
        return ec_exr_read_rgba(in->path, origin.x, origin.y, exr, err);
    EC_FREED ec_exr_room *rooms = malloc(exr->channel_count * sizeof *rooms);
    uint32_t count = 0;
    if (!rooms) return ec_fail(err, "cannot read '%s': out of memory", in->path);
    for (uint32_t i = 0; i < exr->channel_count; i++)
        if (exr->planes[i]) rooms[count++] = (ec_exr_room){exr->names[i], exr->planes[i], 1};
    exr_result_t code = ec_exr_decode(in, 0, rooms, count, true);
    return code == EXR_ERR_SUCCESS ? EC_OK : damaged(in, code, err);
}

ec_result ec_exr_read(const char *path, ec_exr *exr, ec_error *err) { return ec_exr_read_some(path, NULL, exr, err); }

ec_result ec_exr_read_some(const char *path, const char *const *wanted, ec_exr *exr, ec_error *err)
{
    ec_exr_input in;
    exr_attr_v2i_t origin = {0};
    *exr = (ec_exr){0};
    EC_TRY(ec_image_check_regular(path, err));
    exr_result_t code = ec_exr_input_open(&in, path);
    if (code == EXR_ERR_FILE_ACCESS) return ec_fail(err, "cannot open '%s'; check the path and its permissions", path);
    if (code != EXR_ERR_SUCCESS) return damaged(&in, code, err);
    ec_result result = check_storage(&in, err);
    if (result == EC_OK) result = read_size(&in, exr, &origin, err);
    if (result == EC_OK) result = read_channel_list(&in, wanted, exr, err);
    if (result == EC_OK) result = read_pixels(&in, origin, exr, err);
    ec_exr_input_close(&in);
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
